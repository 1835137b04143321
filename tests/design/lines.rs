//! Influence lines of governing values: closed forms, and the sums that they must give.

use std::path::Path;

use design::{GoverningLine, LineSubject, governing_lines, influence_csv, solve};
use formats::design::Design;
use report::text::design_report::design_report;
use serde_json::{Value, json};
use trains::{GirderResponse, SectionSide};

use super::{design as worked, root, run, spec, table};

/// Reads and solves a design beside its spec; returns it with its influence lines and their table.
fn solved(spec: &Value, design: &Value) -> (Design, Vec<GoverningLine>, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [("spec.json", spec), ("design.json", design)] {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a writable folder");
    }
    lines_of(&folder.path().join("design.json"))
}

fn lines_of(path: &Path) -> (Design, Vec<GoverningLine>, String) {
    let (design, inputs) = Design::open(path).expect("a design without faults");
    let result = solve(&design, &inputs).expect("a structure that stands");
    let lines = governing_lines(&design, &inputs, &result).expect("the same structure");
    let csv = influence_csv(&design, &lines).expect("memory suffices");
    (design, lines, csv)
}

fn of(lines: &[GoverningLine], wanted: GirderResponse, is_max: bool) -> &GoverningLine {
    let is_own = |line: &&GoverningLine| {
        line.is_max == is_max
            && matches!(line.subject, LineSubject::Girder { quantity, .. } if quantity == wanted)
    };
    lines
        .iter()
        .find(is_own)
        .unwrap_or_else(|| panic!("no line of {wanted:?}"))
}

/// Without horizontal forces the forces times the ordinates and the dead load are the governing value.
fn assert_sums(lines: &[GoverningLine]) {
    for line in lines {
        let sum = line.of_wheels() + line.governing.dead;
        let error = (sum - line.governing.value).abs() / line.governing.value.abs();
        assert!(
            error < 1e-9,
            "{:?}: {sum}, not {}",
            line.subject,
            line.governing.value
        );
    }
}

/// Analytic: lines of a simple beam of length L. Moment at a: x (L - a)/L up to a; shear force at the end: 1 - x/L;
/// deflection at midspan: x (3 L^2 - 4 x^2)/(48 EI); reaction 1 - x/L.
#[test]
fn lines_of_a_simple_beam_have_their_closed_forms() {
    let (length, stiffness) = (8.0, 2.1e8 * 5e-4);
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "theory": "euler-bernoulli",
        "girder": {"spans": [length], "E": 2.1e8, "I_vertical": 5e-4}, "stations": [0, length]
    });
    let mut design = worked();
    design["trains"][0]["wheels"] = json!([{"x": 0, "vertical": 100}]);
    let (_, lines, _) = solved(&spec, &design);
    assert_sums(&lines);
    let moment = of(&lines, GirderResponse::VerticalMoment, true);
    assert!((moment.governing.x - 4.0).abs() < 1e-9 && moment.lines.len() == 1);
    let deflection = of(&lines, GirderResponse::VerticalDeflection, true);
    let end = deflection.governing.x;
    assert!((end - 4.0).abs() < 1e-5);
    let reaction = lines
        .iter()
        .find(|line| matches!(line.subject, LineSubject::Reaction { .. }));
    let reaction = reaction.expect("supports have reactions");
    let LineSubject::Reaction { support, .. } = &reaction.subject else {
        panic!("it is a reaction")
    };
    for x in [0.5, 1.7, 3.9] {
        let at = |line: &GoverningLine| line.lines[0].value(x, SectionSide::At);
        assert!((at(moment) - 0.5 * x).abs() < 1e-12, "moment at {x}");
        let sag = x * (3.0 * length * length - 4.0 * x * x) / (48.0 * stiffness);
        assert!(
            (at(deflection) / sag - 1.0).abs() < 1e-6,
            "deflection at {x}"
        );
        let share = if support == "support1" {
            1.0 - x / length
        } else {
            x / length
        };
        assert!((at(reaction) - share).abs() < 1e-12, "{support} at {x}");
    }
    let shear = &lines.iter().find(|line| {
        matches!(
            line.subject,
            LineSubject::Girder {
                quantity: GirderResponse::VerticalShear,
                ..
            }
        )
    });
    let shear = shear.expect("the beam has shear forces");
    assert!(
        (shear.of_wheels().abs() - 100.0).abs() < 1e-9,
        "the wheel stands beside the support"
    );
}

/// Superposition: exact envelopes and influence lines are computed by different ways.
#[test]
fn forces_times_ordinates_are_the_governing_values() {
    let mut spec = spec();
    spec["girder"]["mass_per_length"] = json!(0.1986);
    let mut design = worked();
    design["dead_load"] = json!(true);
    design["cases"] = json!([["crane"], {"trains": ["crane", "crane"], "gap": 0.5, "factors": {"dead": 1.1, "vertical": 1.35}}]);
    let (_, lines, csv) = solved(&spec, &design);
    assert_eq!(
        lines.len(),
        6,
        "two moments, shear, deflection, two reactions"
    );
    assert!(
        lines
            .iter()
            .all(|line| line.governing.dead != 0.0 && line.wheels.len() <= 4)
    );
    assert_sums(&lines);
    let shear = of(&lines, GirderResponse::VerticalShear, lines[2].is_max);
    let jumps = shear
        .points(0)
        .windows(2)
        .filter(|pair| pair[0][0] == pair[1][0])
        .count();
    let at = shear.governing.x;
    assert!(
        jumps == 1 || [0.0, 6.0, 13.5, 19.5].contains(&at),
        "{jumps} jumps, section at {at}"
    );
    assert!(!csv.contains("NaN") && csv.lines().count() > 6 * 200);
}

/// Superposition over two rails of a frame, with the wheels of one train on both.
#[test]
fn a_train_on_two_rails_loads_both_lines() {
    let aisle = root().join("examples/bridge_crane/aisle.json");
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::copy(aisle, folder.path().join("spec.json")).expect("the spec of the example");
    let wheels: Vec<Value> = [("north", 0.0), ("north", 12.0), ("south", 0.0), ("south", 12.0)]
        .iter()
        .map(|(rail, x)| json!({"rail": rail, "x": x, "vertical": if *rail == "north" { 2e5 } else { 9e4 }}))
        .collect();
    let design = json!({
        "format": "girderway-design/1", "name": "aisle", "spec": "spec.json",
        "units": {"length": "ft", "force": "lbf", "time": "s"}, "trains": [{"name": "crane", "wheels": wheels}]
    });
    let path = folder.path().join("design.json");
    std::fs::write(&path, design.to_string()).expect("a writable folder");
    let (read, lines, csv) = lines_of(&path);
    assert_eq!(read.spec.rails().len(), 2);
    assert!(lines.len() >= 8, "{} lines", lines.len());
    assert_sums(&lines);
    assert!(
        lines
            .iter()
            .all(|line| line.wheels.len() == 4 && line.lines.len() == 2)
    );
    assert!(csv.contains(",south,") && csv.contains(",north,"));
}

/// The files of the command: lines whose largest ordinate is where the section is, a picture of each in the report, and
/// a first page for print.
#[test]
fn the_command_writes_lines_and_a_page_for_print() {
    let (folder, output) = run(&spec(), &worked(), &[]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let out = folder.path().join("out");
    let rows = table(&out, "influence.csv");
    let moment: Vec<(f64, f64, f64)> = rows
        .iter()
        .filter(|row| row["quantity"] == "moment" && row["kind"] == "max")
        .map(|row| {
            let number = |key: &str| row[key].parse().expect("a number");
            (number("x"), number("load_x"), number("value"))
        })
        .collect();
    let (x, place, largest) = moment
        .iter()
        .copied()
        .reduce(|best, next| if next.2 > best.2 { next } else { best })
        .expect("rows");
    assert!(
        (x - place).abs() < 0.1,
        "the largest ordinate is at {place}, the section at {x}"
    );
    // Analytic: at midspan between L/8 of a span with clamped ends and L/4 of a simple beam, L = 7.5 m.
    assert!(largest > 7.5 / 8.0 && largest < 7.5 / 4.0, "{largest}");
    let page = std::fs::read_to_string(out.join("report.html")).expect("a report");
    assert_eq!(
        page.matches("Influence line of the largest sagging moment")
            .count(),
        1
    );
    assert_eq!(
        page.matches("<title>Influence line with the governing wheels</title>")
            .count(),
        6
    );
    let verdict = page.find("<h2>Verdict</h2>").expect("a verdict");
    let basis = page
        .find("class=\"ends-page\"")
        .expect("the first page ends");
    let rest = page
        .find("<h2>Deflections and limits</h2>")
        .expect("the second page");
    assert!(verdict < basis && basis < rest);
}

/// The report states the same number as the summary, in the units of reading.
#[test]
fn forces_in_newtons_are_read_in_kilonewtons() {
    let mut spec = spec();
    spec["units"]["force"] = json!("N");
    spec["girder"]["E"] = json!(2.1e11);
    spec["girder"]["G"] = json!(8.1e10);
    let mut design = worked();
    design["units"]["force"] = json!("N");
    for wheel in [0, 1] {
        design["trains"][0]["wheels"][wheel]["vertical"] = json!(180_000);
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [("spec.json", &spec), ("design.json", &design)] {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a writable folder");
    }
    let (read, inputs) = Design::open(&folder.path().join("design.json")).expect("a design");
    let result = solve(&read, &inputs).expect("it stands");
    let page = design_report(&read, &result, &[])
        .html(Some(1))
        .expect("finite numbers");
    // External: 241.2377 kN m, the worked runway of `the_worked_runway_has_its_digits`.
    assert!(page.contains("241.2\u{a0}kN\u{a0}m"), "moments in kN m");
    assert!(
        page.contains("E = 210\u{202f}000 N/mm\u{b2}"),
        "moduli in N/mm2"
    );
    assert!(!page.contains("<h2>Influence lines</h2>"));
}
