//! Natural frequencies of imported decks: those of closed forms, and those that NASTRAN published for decks of others.

use std::path::PathBuf;

use formats::units::{Force, Length};
use import::structure::MassDistribution;
use import::{ImportOptions, Imported, import};

use super::{deck, frame, plain, told};

/// Frequencies in Hz as `girderway fea --modes` computes them, and the estimate of their error.
fn frequencies(imported: &Imported, count: usize) -> (Vec<f64>, f64) {
    let model = frame(imported).model;
    let found = fea::refined_modes(&model, &[], count, 1e-3).expect("solvable");
    let all = found
        .modes
        .modes
        .iter()
        .map(|mode| mode.omega / std::f64::consts::TAU);
    (all.collect(), found.error.expect("an estimate"))
}

fn of(text: &str, rail: &str, count: usize) -> (Vec<f64>, f64) {
    let options = ImportOptions {
        up: Some([0.0, 0.0, 1.0]),
        rails: vec![rail.parse().expect("a rail")],
        mass: (!text.contains("COUPMASS")).then_some(MassDistribution::Lumped),
        ..plain()
    };
    let imported = deck(text, &options).unwrap_or_else(|wrong| panic!("{}{text}", told(&wrong)));
    frequencies(&imported, count)
}

#[test]
fn lumped_bars_vibrate_as_masses_on_springs() {
    let common = "GRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.,,1345\nCBAR,1,5,1,2,0.,1.,0.\nMAT1,1,2.+11,,.25,8000.\n\
        PBAR,5,1,.02,1.-4,2.-4,1.-4\n";
    // a cantilever with half of its mass at its tip, which moves along y alone
    let (stiffness, mass) = (3.0 * 2e11 * 1e-4 / 8.0, 0.5 * 8000.0 * 0.02 * 2.0);
    let (found, error) = of(common, "r=1", 1);
    let exact = f64::sqrt(stiffness / mass) / std::f64::consts::TAU;
    assert!(
        (found[0] / exact - 1.0).abs() < 1e-10 && error == 0.0,
        "{found:?} {exact} {error}"
    );
    // consistent mass: the cantilever of the textbook, with k L = 1.875104; rotary inertia lowers it by 0.3 %
    let (found, _) = of(&format!("{common}PARAM,COUPMASS,1\n"), "r=1", 1);
    let exact =
        (1.875_104_f64 / 2.0).powi(2) * f64::sqrt(2e11 * 1e-4 / 160.0) / std::f64::consts::TAU;
    assert!((found[0] / exact - 1.0).abs() < 5e-3, "{found:?} {exact}");
}

#[test]
fn the_error_of_trusses_is_that_of_their_axial_motion() {
    // a bar fixed at one end: pi/2 c/L, and sqrt(3) c/L for one element of consistent mass
    let text = "GRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.,,23456\nCROD,1,5,1,2\nPROD,5,1,.01\nMAT1,1,2.+11,,.25,8000.\n\
        PARAM,COUPMASS,1\n";
    let (found, error) = of(text, "r=1", 1);
    let speed = f64::sqrt(2e11 / 8000.0);
    let [one, exact] = [3.0_f64.sqrt(), std::f64::consts::FRAC_PI_2]
        .map(|k| k * speed / 2.0 / std::f64::consts::TAU);
    assert!((found[0] / one - 1.0).abs() < 1e-12);
    let actual = one / exact - 1.0;
    assert!(
        error > actual && error < 1.5 * actual,
        "{error} for {actual}"
    );
}

/// Decks of NASTRAN_CoFE with the frequencies of NASTRAN beside them (`modes.f06`). They are read where the folder
/// GIRDERWAY_DECKS has a copy of that repository, by the name of the repository.
#[test]
fn published_decks_have_their_published_frequencies() {
    let Some(folder) = std::env::var_os("GIRDERWAY_DECKS").map(PathBuf::from) else {
        eprintln!("GIRDERWAY_DECKS is not set: no decks of NASTRAN_CoFE checked");
        return;
    };
    let folder = folder.join("NASTRAN_CoFE/testing/system_verification");
    for (name, rail, published) in [
        (
            "004_72_bar_truss",
            "r=49",
            [25.45570, 25.45570, 38.94089, 68.55535, 73.70520, 73.70520],
        ),
        (
            "003_svanberg_bar",
            "r=1",
            [46.46440, 146.9333, 279.0229, 752.9903, 815.3514, 882.3479],
        ),
        (
            "002_svanberg_beam",
            "r=1",
            [46.46440, 146.9333, 279.0229, 752.9903, 815.3514, 882.3479],
        ),
    ] {
        let path = folder.join(name).join("nastran_runs/modes.dat");
        if !path.exists() {
            // the terms of the decks keep them out of this repository
            eprintln!("{} is not here: not checked", path.display());
            continue;
        }
        let options = ImportOptions {
            length: Some(Length::Inch),
            force: Some(Force::Pound),
            up: Some([0.0, 0.0, 1.0]),
            rails: vec![rail.parse().expect("a rail")],
            // the published frequencies are those of NASTRAN's own masses
            mass: Some(MassDistribution::Lumped),
            ..ImportOptions::default()
        };
        let imported = import(&path, &|path| std::fs::read(path), &options);
        let (found, _) = frequencies(
            &imported.unwrap_or_else(|wrong| panic!("{}", told(&wrong))),
            6,
        );
        for (found, published) in found.iter().zip(published) {
            assert!(
                (found / published - 1.0).abs() < 1e-5,
                "{name}: {found} {published}"
            );
        }
        eprintln!("{name}: checked");
    }
}
