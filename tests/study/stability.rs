//! Maps of where methods fail, on the paper's girder: published numbers, and no point where the program is silently wrong.

use std::path::Path;
use std::sync::Arc;

use formats::scene::Document;
use foundations::solve;
use foundations::{SolvedStructure, distinct_specs};
use study::SilentObserver;
use study::stability::{MapSubject, MapVerdict, StabilityMap, maps};

fn found(map: &StabilityMap, what: &str) -> f64 {
    // beta 10 is not beta 100
    let is_meant = |own: &str| {
        own.strip_prefix(what)
            .is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    let finding = map.findings.iter().find(|finding| is_meant(&finding.what));
    finding
        .unwrap_or_else(|| panic!("{}: nothing is called {what}", map.name))
        .value
}

fn close(map: &StabilityMap, what: &str, wanted: f64, by: f64) {
    let value = found(map, what);
    println!("{}: {what}: {value}, wanted {wanted}", map.name);
    assert!(
        (value / wanted - 1.0).abs() < by,
        "{}: {what}: {value}, wanted {wanted}",
        map.name
    );
}

/// Points of a method with a verdict.
fn count(map: &StabilityMap, method: &str, word: &str) -> usize {
    let layer = map.layers.iter().find(|layer| layer.method == method);
    let layer = layer.unwrap_or_else(|| panic!("{}: no method {method}", map.name));
    layer
        .points
        .iter()
        .filter(|cell| cell.verdict.word() == word)
        .count()
}

#[test]
fn nothing_is_silently_wrong_on_the_papers_girder_and_published_numbers_are_found() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bogie/scene.json");
    let document = Document::open(&path).expect("an example");
    let known = distinct_specs(&document)
        .iter()
        .map(|(_, _, spec)| SolvedStructure {
            spec: Arc::clone(spec),
            solution: Arc::new(solve(spec).expect("it stands")),
        })
        .collect::<Vec<_>>();
    let subject = MapSubject::of(document.scene(), &known).expect("a truck on a girder");
    let (maps, absent) = maps(&subject, true, &SilentObserver);
    let names: Vec<&str> = absent.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["ties"], "{absent:?}");
    let map = |name: &str| {
        maps.iter()
            .find(|map| map.name == name)
            .unwrap_or_else(|| panic!("no map {name}"))
    };

    let ours = || {
        maps.iter()
            .flat_map(|map| &map.layers)
            .filter(|layer| layer.is_ours)
    };
    let points: usize = ours().map(|layer| layer.points.len()).sum();
    let refused = ours()
        .flat_map(|layer| &layer.points)
        .filter(|cell| matches!(cell.verdict, MapVerdict::Refused(_)));
    let refused = refused.count();
    println!("{points} points of girderway, {refused} refused");
    for map in &maps {
        assert_eq!(map.silent_count(), 0, "{}", map.name);
    }
    assert!(
        points > 900 && refused * 10 <= points,
        "{refused} of {points}"
    );

    // k G at midspan of one wheel and two, and where it is 1: independent computation, scipy
    let contact = map("contact");
    close(contact, "one wheel: k times", 10.93, 1e-3);
    close(contact, "truck: k times", 21.74, 1e-3);
    close(contact, "one wheel: distance", 4.94, 2e-3);
    close(contact, "truck: distance", 1.85 + 4.0 / 3.0, 2e-3);
    assert!(count(contact, "fixed point, one wheel", "diverges") > 50);

    // the paper's table, seven stations: growth at least as found by an independent random search; work of a loop
    let excitation = map("excitation");
    assert!(found(excitation, "akispl: largest growth") > 0.325);
    close(excitation, "akispl: largest growth", 0.325, 0.08);
    // at 43.5 ft, or as far from the other support
    let place = found(excitation, "akispl: position");
    assert!((place.max(60.0 - place) - 43.5).abs() < 0.3, "{place}");
    close(excitation, "akispl: damper of each wheel", 1.8e5, 0.06);
    close(excitation, "akispl: work of a closed loop", 30_789.0, 1e-3);
    assert_eq!(found(excitation, "girderway, exact: work"), 0.0);
    let worst = "girderway, akispl, worst position";
    assert!(
        count(excitation, worst, "wrong, with a warning") > 5,
        "the energy audit tells"
    );

    // doubles lose digits with the elements; the certificate is never below the error (a verdict of its own)
    let elements = map("elements");
    assert!(
        found(elements, "doubles: relative error at 1024")
            > 1e5 * found(elements, "doubles: relative error at 4")
    );
    assert_eq!(
        count(elements, "girderway", "right"),
        elements.layers[1].points.len()
    );
    assert!(
        count(
            map("short-element"),
            "doubles, banded Cholesky",
            "silently wrong"
        ) > 5
    );
    assert!(count(map("penalty"), "stiff post, 16 elements", "silently wrong") > 5);

    // Willis and Stokes, converged to five digits by two codes
    let lift = map("lift-off");
    for (beta, factor, lost) in [
        (100.0, 1.0103, None),
        (25.0, 1.0454, None),
        (10.0, 1.1416, Some(0.967)),
        (5.0, 1.3227, Some(0.869)),
        (2.0, 1.7799, Some(0.919)),
    ] {
        for who in ["Stokes", "girderway"] {
            close(lift, &format!("{who}: factor at beta {beta}"), factor, 1e-4);
            if let Some(lost) = lost {
                close(
                    lift,
                    &format!("{who}: x/L of lift-off at beta {beta}"),
                    lost,
                    1e-3,
                );
            }
        }
    }

    // Floquet: 2.24 a span at 300 ft/s where the damper stands on the ground; methods as published for the same wheel
    let steps = map("steps");
    close(steps, "frequency", 36.6, 1e-3);
    close(steps, "fraction of critical damping", 0.0183, 1e-3);
    close(steps, "growth over a span at the highest speed", 2.24, 2e-3);
    assert!(
        (2.8..5.0).contains(&found(steps, "Runge-Kutta 4")),
        "explicit: bounded steps"
    );
    assert!(
        steps
            .findings
            .iter()
            .all(|own| !own.what.starts_with("BDF2")),
        "BDF2 fails nowhere on this grid"
    );
    assert!(
        count(steps, "midpoint", "silently wrong") > 0,
        "unconditional stability is lost"
    );
    let accuracies = map("accuracies");
    assert_eq!(
        count(accuracies, "girderway", "right"),
        accuracies.layers[0].points.len()
    );
}
