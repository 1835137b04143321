//! Cards of bulk data beyond plain frames: coordinate systems, principal axes, neutral axes, partial links, lumped mass.

use import::structure::MassDistribution;
use import::{ImportOptions, Imported};
use serde_json::json as value;

use super::{deck, displacements, frame, from_memory, json, plain, told};

fn good(text: &str) -> Imported {
    deck(text, &plain()).unwrap_or_else(|wrong| panic!("{}{text}", told(&wrong)))
}

fn refused(text: &str) -> String {
    told(&deck(text, &plain()).expect_err(text))
}

/// Displacements of grids under a load on the first of them.
fn moved(text: &str, grids: &[&str], load: [f64; 6]) -> Vec<f64> {
    let options = ImportOptions {
        up: Some([0.0, 1.0, 0.0]),
        rails: vec!["r=1".parse().expect("a rail")],
        ..plain()
    };
    let imported = deck(text, &options).unwrap_or_else(|wrong| panic!("{}{text}", told(&wrong)));
    displacements(&frame(&imported), grids, load)
        .as_slice()
        .to_vec()
}

fn close(found: f64, expected: f64) {
    assert!(
        (found - expected).abs() <= 1e-10 * expected.abs().max(1e-9),
        "{found} {expected}"
    );
}

const STEEL: &str = "MAT1,1,2.+11,,.25,8000.\n";
const LINE: &str = "GRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.\n";

#[test]
fn systems_of_every_kind_are_read_where_grids_refer_to_them() {
    let common = format!(
        "{STEEL}PBAR,5,1,.02,1.-4,2.-4,1.-4\nCBAR,1,5,1,2,0.,0.,1.\nGRID,1,,0.,0.,0.,,123456\n"
    );
    let cylinder = "CORD2C,7,,1.,0.,0.,1.,0.,1.\n,2.,0.,0.\n";
    let sphere = "CORD2S,8,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
    for (systems, grid, place) in [
        (
            cylinder.to_owned(),
            "GRID,2,7,2.,90.,3.",
            value!([1.0, 2.0, 3.0]),
        ),
        (
            sphere.to_owned(),
            "GRID,2,8,2.,90.,180.",
            value!([-2.0, 0.0, 0.0]),
        ),
        // a system on grids of another system, in a system of a system
        (
            format!(
                "{cylinder}GRID,11,7,0.,0.,0.\nGRID,12,7,0.,0.,5.\nGRID,13,7,2.,90.,0.\nCORD1R,3,11,12,13\n"
            ),
            "GRID,2,3,4.,0.,1.",
            value!([1.0, 4.0, 1.0]),
        ),
    ] {
        let spec = json(&good(&format!("{common}{systems}{grid}\n")));
        assert_eq!(spec["points"][1], place, "{grid}");
    }
    // what nothing refers to may even be degenerate
    let idle = "CORD2C,9,77,0.,0.,0.,0.,0.,0.\n,0.,0.,0.\nCORD1S,10,1,1,1\n";
    assert!(deck(&format!("{common}{idle}GRID,2,,2.,0.,0.\n"), &plain()).is_ok());
    for (card, part) in [
        (
            "CORD2R,4,4,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,2,4,2.,0.,0.\n",
            "systems or grids that depend on it",
        ),
        (
            "CORD1R,4,1,2,2\nGRID,2,4,2.,0.,0.\n",
            "systems or grids that depend on it",
        ),
        (
            "CORD2R,4,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,2,4,2.,0.,0.\n",
            "must not be collinear",
        ),
        (
            "GRID,2,99,2.,0.,0.\n",
            "0 or the number of a coordinate system",
        ),
    ] {
        let wrong = refused(&format!("{common}{card}"));
        assert!(wrong.contains(part), "{card}: {wrong}");
    }
}

#[test]
fn supports_offsets_and_orientations_follow_the_displacement_system() {
    let common = format!("{STEEL}PBAR,5,1,.02,1.-4,2.-4,1.-4\nGRID,1,,0.,0.,0.,,123456\n");
    // at 90 degrees r is along y and theta along -x
    let system = "CORD2C,7,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,2,7,2.,90.,0.,7\n";
    let spec = json(&good(&format!(
        "{common}{system}CBAR,1,5,2,1,0.,1.,0.\nSPC1,3,13,2\n"
    )));
    assert_eq!(
        spec["supports"][1],
        value!({ "point": 1, "fix": ["uy", "uz"] })
    );
    assert_eq!(
        spec["cell_data"]["orientation"],
        value!([[[-1.0, 0.0, 0.0]]])
    );
    let spec = json(&good(&format!(
        "{common}{system}CBAR,1,5,2,1,1.,0.,0.,BGG\n,,,.5,0.,.1\n"
    )));
    assert_eq!(
        spec["cell_data"]["orientation"],
        value!([[[1.0, 0.0, 0.0]]])
    );
    assert_eq!(spec["cell_data"]["offset_a"], value!([[[0.0, 0.5, 0.1]]]));
    // the same offset in the axes of the element: x from 2 to 1 is -y, y is x
    let spec = json(&good(&format!(
        "{common}{system}CBAR,1,5,2,1,1.,0.,0.,BOO\n,,,-.5,0.,.1\n"
    )));
    assert_eq!(spec["cell_data"]["offset_a"], value!([[[0.0, 0.5, 0.1]]]));
    // at 45 degrees pairs of directions may be restrained, single ones not
    let skew =
        "CORD2C,7,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,2,7,2.,45.,0.,7\nCBAR,1,5,2,1,0.,0.,1.\n";
    let spec = json(&good(&format!("{common}{skew}SPC1,3,12456,2\n")));
    assert_eq!(
        spec["supports"][1],
        value!({ "point": 1, "fix": ["ux", "uy", "rx", "ry", "rz"] })
    );
    assert!(refused(&format!("{common}{skew}SPC1,3,1,2\n")).contains("along the global axes"));
}

#[test]
fn products_of_inertia_turn_the_principal_axes() {
    // E [[I1, I12], [I12, I2]] of the curvatures in planes 1 and 2
    let (i1, i2, i12) = (1e-4, 2e-4, 5e-5);
    let det = i1 * i2 - i12 * i12;
    let unit = 1e4 * 8.0 / (3.0 * 2e11);
    for property in [
        "PBAR,5,1,.02,1.-4,2.-4,1.-4\n,\n,,,5.-5\n",
        "PBEAM,5,1,.02,1.-4,2.-4,5.-5,1.-4\n,\n,0.,0.\n",
    ] {
        let kind = if property.starts_with("PBAR") {
            "CBAR"
        } else {
            "CBEAM"
        };
        let text = format!("{STEEL}{LINE}{kind},1,5,1,2,0.,1.,0.\n{property}");
        let found = moved(&text, &["GRID 2"], [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
        close(found[1], unit * i2 / det);
        close(found[2], -unit * i12 / det);
    }
    let pinned = format!(
        "{STEEL}{LINE}CBAR,1,5,1,2,0.,1.,0.\n,,5\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n,\n,,,5.-5\n"
    );
    assert!(refused(&pinned).contains("pin flags in both planes or neither"));
    let large =
        format!("{STEEL}{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n,\n,,,5.-4\n");
    assert!(refused(&large).contains("less than the square root"));
}

/// MSC Nastran Quick Reference Guide 2022.4, PBAR, remark 5: K1 and K2 are ignored where I12 is not 0. The same is in
/// NASTRAN-95 (`mis/kbar.f`) and MYSTRAN (`BAR1.f90`).
#[test]
fn bars_with_a_product_of_inertia_are_rigid_in_shear() {
    // a cantilever of 2 m bends by L^3 I2 / (3 E (I1 I2 - I12^2)) in plane 1
    let unit = 1e4 * 8.0 / (3.0 * 2e11);
    let (i1, i2, i12) = (1e-4, 2e-4, 5e-5);
    for (factors, warnings) in [(".5,.5", 2), (".5,.8", 2), ("0.,.8", 1), (",", 0)] {
        let text = format!(
            "{STEEL}{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n,\n,{factors},5.-5\n"
        );
        let found = moved(&text, &["GRID 2"], [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
        close(found[1], unit * i2 / (i1 * i2 - i12 * i12));
        let warned = told(&good(&text).warnings);
        let ignored = warned.matches("is ignored, because I12 is not 0").count();
        assert_eq!(ignored, warnings, "{factors}: {warned}");
    }
    // the sum of the second moments of two arms of 0.1 by 0.01 about the centroid of an angle, with I1 = I2
    let angle = "L,,,,,\n,.1,.1,.01,.01\n";
    let (leg, wall): (f64, f64) = (0.1, 0.01);
    let (a, b) = (leg * wall, (leg - wall) * wall);
    let centre = (a * leg / 2.0 + b * wall / 2.0) / (a + b);
    let across = |y: f64, area: f64| area * (y - centre).powi(2);
    let i = leg.powi(3) * wall / 12.0
        + wall.powi(3) * (leg - wall) / 12.0
        + across(leg / 2.0, a)
        + across(wall / 2.0, b);
    let product = a * (leg / 2.0 - centre) * (wall / 2.0 - centre)
        + b * (wall / 2.0 - centre) * ((leg + wall) / 2.0 - centre);
    let exact = unit * i / (i * i - product * product);
    let of = |kind: &str| {
        let text = format!("{STEEL}{LINE}C{kind},1,5,1,2,0.,1.,0.\nP{kind}L,5,1,,{angle}");
        let found = moved(&text, &["GRID 2"], [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
        (found[1], told(&good(&text).warnings))
    };
    let (bar, warned) = of("BAR");
    close(bar, exact);
    assert!(
        warned.contains("has a product of inertia: its members are rigid in shear"),
        "{warned}"
    );
    // beams keep their shear factors
    let (beam, warned) = of("BEAM");
    assert!(
        beam > exact * (1.0 + 1e-6) && !warned.contains("rigid in shear"),
        "{warned}"
    );
}

#[test]
fn poissons_ratio_may_have_any_value_where_both_moduli_are_given() {
    let deck_with = |material: &str| {
        format!("{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\nMAT1,1,{material}\n")
    };
    let imported = good(&deck_with("2.+11,8.+10,16.76,7850."));
    let material = &json(&imported)["materials"][0];
    assert_eq!(
        (&material["E"], &material["G"]),
        (&value!(2e11), &value!(8e10))
    );
    assert!(
        told(&imported.warnings).contains(
            "MAT1 1: NU: must be greater than -1 and at most 0.5; it is ignored, got 16.76"
        ),
        "{}",
        told(&imported.warnings)
    );
    for material in ["2.+11,,16.76", ",8.+10,16.76"] {
        let wrong = refused(&deck_with(material));
        assert!(
            wrong.contains("MAT1 1: NU: must be greater than -1"),
            "{wrong}"
        );
    }
}

/// Decks of NASTRAN-95 have blanks before the exponent, such as `10.4 +6`.
#[test]
fn blanks_may_stand_before_the_exponent_in_fixed_fields() {
    let bar = "CBAR    1       5       1       2       0.      1.      0.\n\
               PBAR    5       1       .02     1. -4   2.   -4 1. E-4\n";
    let deck_with = |material: &str| format!("{LINE}{bar}MAT1    1       {material}\n");
    let spec = json(&good(&deck_with("10.4 +6 4.  +6          .056")));
    assert_eq!(spec["materials"][0]["E"], value!(1.04e7));
    assert_eq!(spec["materials"][0]["G"], value!(4e6));
    assert_eq!(spec["sections"][0]["Iy"], value!(2e-4));
    assert_eq!(spec["sections"][0]["J"], value!(1e-4));
    let wrong = refused(&deck_with("10.4  6 4.  +6"));
    assert!(
        wrong.contains("MAT1 1: E: must be a real number"),
        "{wrong}"
    );
}

#[test]
fn positions_that_are_rounding_errors_are_zero() {
    let text = |z: &str, area: &str| {
        format!(
            "{STEEL}GRID,1,,0.,0.,{z},,123456\nGRID,2,,2.,0.,0.\nCBAR,1,5,1,2,{z},1.,0.\n,,,0.,{z},0.\n\
             PBAR,5,1,{area},1.-4,2.-4,1.-4\n"
        )
    };
    let exact = good(&text("0.", ".02")).text;
    for z in ["5.65-32", "-1.E-300"] {
        assert_eq!(good(&text(z, ".02")).text, exact, "{z}");
    }
    let wrong = refused(&text("0.", "5.65-32"));
    assert!(
        wrong.contains("PBAR 5: A: must be 0, or between 1e-30"),
        "{wrong}"
    );
    let wrong = refused(&text("1.+31", ".02"));
    assert!(
        wrong.contains("GRID 1: X3: must be 0, or between 1e-30"),
        "{wrong}"
    );
}

#[test]
fn a_deck_without_members_names_its_elements() {
    let skip = ImportOptions {
        skip: vec!["CQUAD4".to_owned()],
        ..plain()
    };
    let text = format!(
        "{LINE}CQUAD4,1,1,1,2,3,4\nCQUAD4,2,1,1,2,3,4\nCONM2,3,2,,5.\nCORD2R,9,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
    );
    let wrong = told(&deck(&text, &skip).expect_err("no members"));
    assert!(
        wrong.contains("contains no members; its elements are CONM2 (1), CQUAD4 (2)"),
        "{wrong}"
    );
}

#[test]
fn springs_of_scalar_points_are_refused_by_name() {
    let bar = format!("{STEEL}{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n");
    for spring in ["CELAS2,7,1.+5,2,0", "CELAS2,7,1.+5,2"] {
        let wrong = refused(&format!("{bar}{spring}\n"));
        assert!(
            wrong.contains("CELAS2 7: C: must be a single digit from 1 to 6")
                && wrong.contains("scalar point, which is not supported"),
            "{wrong}"
        );
    }
    let wrong = refused(&format!("{bar}CELAS2,7,1.+5,2,12\n"));
    assert!(!wrong.contains("scalar point"), "{wrong}");
}

#[test]
fn neutral_axes_are_off_the_shear_centre_by_their_offset() {
    let text = format!(
        "{STEEL}{LINE}CBEAM,1,5,1,2,0.,1.,0.\nPBEAM,5,1,.02,1.-4,2.-4,,1.-4\n,\n,0.,0.\n,,,,,.1,.2\n"
    );
    let grids = ["GRID 2"];
    // an axial force at the shear centre bends about the neutral axis; a torque or shear force there does not
    let axial = moved(&text, &grids, [1e5, 0.0, 0.0, 0.0, 0.0, 0.0]);
    close(
        axial[0],
        1e5 * 2.0 / 2e11 * (1.0 / 0.02 + 0.01 / 1e-4 + 0.04 / 2e-4),
    );
    let torque = moved(&text, &grids, [0.0, 0.0, 0.0, 1e3, 0.0, 0.0]);
    close(torque[3], 1e3 * 2.0 / (8e10 * 1e-4));
    assert!(
        torque[1].abs() < 1e-12 * torque[3] && torque[2].abs() < 1e-12 * torque[3],
        "{torque:?}"
    );
    let side = moved(&text, &grids, [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
    close(side[1], 1e4 * 8.0 / (3.0 * 2e11 * 1e-4));
    assert!(refused(&text.replace(",.1,.2", ",.1,.2,.3,.2")).contains("must be equal to N1(A)"));
    assert!(
        refused(&text.replace("0.,1.,0.\n", "0.,1.,0.\n,56\n")).contains("must not have pin flags")
    );
}

#[test]
fn partial_links_become_hinges_and_supports() {
    let common = format!(
        "{STEEL}PBAR,5,1,.02,1.-4,2.-4,1.-4\nCBAR,1,5,1,2,0.,1.,0.\nGRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.\n"
    );
    let other = "GRID,3,,2.,0.,0.\nGRID,4,,5.,0.,0.,,123456\n";
    let linked = format!("{common}{other}CBAR,2,5,3,4,0.,1.,0.\nRBE2,9,2,123,3\n");
    let pinned = format!("{common}GRID,4,,5.,0.,0.,,123456\nCBAR,2,5,2,4,0.,1.,0.\n,456\n");
    let load = [1e4, 1e4, 1e4, 1e3, 1e3, 1e3];
    let (a, b) = (
        moved(&linked, &["GRID 2"], load),
        moved(&pinned, &["GRID 2"], load),
    );
    a.iter().zip(&b).for_each(|(a, b)| close(*a, *b));
    // the independent grid is fixed: a support
    let held = format!("{common}GRID,3,,2.,0.,1.,,123456\nRBE2,9,3,2,2\n");
    assert_eq!(
        json(&good(&held))["supports"][1],
        value!({ "point": 1, "fix": ["uy"] })
    );
    // rods do not turn their ends
    let rods = format!(
        "{common}GRID,3,,2.,1.,0.\nGRID,4,,5.,1.,0.,,123456\nCONROD,2,3,4,1,.01\nRBE2,9,2,123,3\n"
    );
    assert_eq!(
        json(&good(&rods))["links"],
        value!([{ "from": 1, "to": 2 }])
    );
    // two beams at the dependent grid share its rotation
    let two = format!("{linked}GRID,5,,2.,0.,3.,,123456\nCBAR,3,5,3,5,0.,1.,0.\n");
    assert!(refused(&two).contains("equivalent to a hinge or a support"));
    // a chain of partial links: the grid between them turns freely
    let chain = format!("{rods}GRID,6,,2.,2.,0.\nCONROD,7,6,4,1,.01\nRBE2,10,3,123,6\n");
    assert!(refused(&chain).contains("equivalent to a hinge or a support"));
}

#[test]
fn mass_may_be_lumped_at_the_ends_of_all_members() {
    let text = format!(
        "{STEEL}GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,2.,0.,4.\nCBAR,1,5,1,2,0.,1.,0.\nCBEAM,2,6,2,3,0.,1.,0.\n\
         ,,,0.,0.,0.,0.,0.,-1.\nPBAR,5,1,.02,1.-4,2.-4,1.-4,40.\nPBEAM,6,1,.01,1.-4,2.-4,,1.-4\nPARAM,WTMASS,.5\n"
    );
    let lumped = ImportOptions {
        mass: Some(MassDistribution::Lumped),
        ..plain()
    };
    let spec = json(&deck(&text, &lumped).expect("a deck"));
    assert!(spec["materials"][0].get("density").is_none());
    // half of (8000 A + NSM) L at each end, and rho (I1 + I2) L in twist for CBEAM
    let (bar, beam, twist) = (
        0.5 * 0.5 * 200.0 * 2.0,
        0.5 * 0.5 * 80.0 * 3.0,
        0.5 * 0.5 * 8000.0 * 3e-4 * 3.0,
    );
    let masses = spec["masses"].as_array().expect("masses");
    let found: Vec<[f64; 3]> = masses
        .iter()
        .map(|mass| {
            [&mass["point"], &mass["mass"], &mass["inertia"][2]]
                .map(|value| value.as_f64().expect("a number"))
        })
        .collect();
    let wanted = [
        [0.0, bar, 0.0],
        [1.0, bar + beam, twist],
        [2.0, beam, twist],
    ];
    for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
        close(*found, *wanted);
    }
    assert_eq!(masses[2]["offset"], value!([0.0, 0.0, -1.0]));
    let asked = ImportOptions {
        mass: Some(MassDistribution::Distributed),
        ..plain()
    };
    let consistent = good(&format!("{text}PARAM,COUPMASS,1\n"));
    assert_eq!(consistent.text, deck(&text, &asked).expect("a deck").text);
    assert!(json(&consistent).get("masses").is_none());
    // by default the mass of beams acts along them, and that of rods at their ends
    assert_eq!(good(&text).text, consistent.text);
    let rods = format!("{STEEL}{LINE}CROD,1,5,1,2\nPROD,5,1,.02\n");
    let rods = json(&good(&rods));
    assert_eq!(rods["masses"].as_array().map(Vec::len), Some(2));
    assert!(rods["materials"][0].get("density").is_none());
}

#[test]
fn masses_may_be_stated_in_turned_systems() {
    let common = format!(
        "{STEEL}{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\nPARAM,COUPMASS,1\n"
    );
    // x of the system is y, y is -x
    let turned =
        "CORD2R,3,,0.,0.,0.,0.,0.,1.\n,0.,1.,0.\nCONM2,9,2,3,10.,1.,0.,0.\n,4.,0.,5.,,,6.\n";
    assert_eq!(
        json(&good(&format!("{common}{turned}")))["masses"],
        value!([{ "point": 1, "mass": 10.0, "inertia": [5.0, 4.0, 6.0], "offset": [0.0, 1.0, 0.0] }])
    );
    let products = format!("{common}CONM2,9,2,,10.\n,4.,1.,5.,,,6.\n");
    assert!(refused(&products).contains("--skip-unused"));
    let unused = ImportOptions {
        skip_unused: true,
        ..plain()
    };
    let taken = deck(&products, &unused).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    assert!(told(&taken.warnings).contains("products of inertia do not affect the stiffness"));
}

#[test]
fn rods_may_be_two_on_a_card_and_tubes_are_rods() {
    let common = format!("{STEEL}{LINE}GRID,3,,2.,3.,0.,,123456\n");
    let two = json(&good(&format!(
        "{common}CROD,1,5,1,2,2,5,2,3\nPROD,5,1,.01,.001\n"
    )));
    let one = json(&good(&format!(
        "{common}CROD,1,5,1,2\nCROD,2,5,2,3\nPROD,5,1,.01,.001\n"
    )));
    assert_eq!(two, one);
    let tube = json(&good(&format!("{common}CTUBE,1,5,1,2\nPTUBE,5,1,.2,.01\n")));
    let section = &tube["sections"][0];
    let pi = std::f64::consts::PI;
    close(section["A"].as_f64().expect("A"), pi * (0.01 - 0.0081));
    close(
        section["J"].as_f64().expect("J"),
        pi / 2.0 * (1e-4 - 0.6561e-4),
    );
    assert_eq!(tube["cell_data"]["kind"], value!([["rod"]]));
}

#[test]
fn cards_that_cannot_change_statics_are_left_out_on_request_and_listed() {
    let deck_text = format!(
        "{STEEL}{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\nMATT2,1,200\nDESVAR,1,A,1.\nDESVAR,2,B,1.\n\
         SUPORT,2,1\nAERO,,1.,1.,1.\nSPLINE1,1,1,1,1,1\nCDAMP2,3,1.,2,1\nMDLPRM,HDF5,0\nSPC,1,2,3,.5\n"
    );
    let wrong = refused(&deck_text);
    for part in [
        "DESVAR: is not supported (2 cards)",
        "MATT2",
        "SUPORT",
        "ignore it with --skip-unused",
        "SPC 1: D",
    ] {
        assert!(wrong.contains(part), "{part}: {wrong}");
    }
    assert!(!wrong.contains("MDLPRM"), "a request for output: {wrong}");
    let unused = ImportOptions {
        skip_unused: true,
        ..plain()
    };
    let taken = deck(&deck_text, &unused).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let warned = told(&taken.warnings);
    for part in [
        "DESVAR: is ignored (2 cards): it does not affect the stiffness",
        "AERO",
        "SPLINE1",
        "CDAMP2",
    ] {
        assert!(warned.contains(part), "{part}: {warned}");
    }
    assert_eq!(
        json(&taken)["supports"][1],
        value!({ "point": 1, "fix": ["uz"] })
    );
    // stiffness is never left out by this flag
    for card in [
        "CSHEAR,7,1,1,2,3,4",
        "CBUSH,7,1,1,2",
        "MPC,1,1,1,1.,2,1,1.",
        "DMIG,A,0,6,1",
    ] {
        assert!(
            deck(&format!("{deck_text}{card}\n"), &unused).is_err(),
            "{card}"
        );
    }
    // equations that case control does not select have no effect
    let selected = |control: &str| {
        deck(
            &format!("CEND\n{control}BEGIN BULK\n{deck_text}MPC,1,1,1,1.,2,1,1.\n"),
            &unused,
        )
    };
    assert!(selected("").is_ok() && selected("MPC=1\n").is_err());
}

#[test]
fn materials_of_heat_transfer_are_left_out_like_loads() {
    let bar = format!("{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n");
    let heat = "MAT4,1,200.\nMAT4,2,100.\nMAT5,3,200.\nMATT4,1,9\n";
    let imported = good(&format!("{STEEL}{bar}{heat}"));
    let warned = told(&imported.warnings);
    for part in [
        "MAT4: is ignored (2 cards)",
        "MAT5: is ignored (1 card)",
        "MATT4: is ignored",
    ] {
        assert!(warned.contains(part), "{part}: {warned}");
    }
    assert_eq!(
        json(&imported)["materials"].as_array().map(Vec::len),
        Some(1)
    );
    // they are no materials of members
    let wrong = refused(&format!("{bar}{heat}"));
    assert!(
        wrong.contains("must be the number of a MAT1, got 1"),
        "{wrong}"
    );
}

#[test]
fn errors_of_one_kind_are_counted_and_defaults_are_blamed_once() {
    let mut bars = format!("{STEEL}{LINE}");
    for id in 1..=50 {
        bars.push_str(&format!("CBAR,{id},,1,2\n"));
    }
    let wrong = deck(&bars, &plain()).expect_err("no orientation");
    assert_eq!(wrong.len(), 1, "{}", told(&wrong));
    assert!(
        wrong[0]
            .expected
            .contains("50 errors of this kind, the last in line 53"),
        "{}",
        told(&wrong)
    );
    for (default, part) in [
        (
            "BAROR,,7,,,0.,1.,0.",
            "deck.bdf:54:1: BAROR: refers to a property that does not exist",
        ),
        (
            "BAROR,,5,,,1.,0.,0.",
            "deck.bdf:54:1: BAROR: X1: must not be zero or parallel to an element",
        ),
        (
            "BAROR,,5,,,99",
            "deck.bdf:54:1: BAROR: G0: refers to a grid that does not exist",
        ),
        (
            "BAROR,,5,,,0.,1.,0.,GXX",
            "BAROR: OFFT: must be three letters",
        ),
    ] {
        let wrong = deck(
            &format!("{bars}{default}\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n"),
            &plain(),
        )
        .expect_err(default);
        assert_eq!(wrong.len(), 1, "{default}: {}", told(&wrong));
        assert!(told(&wrong).contains(part), "{default}: {}", told(&wrong));
    }
    // the flag of older programs in place of OFFT
    let old = format!("{bars}BAROR,,5,,,0.,1.,0.,1\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n");
    assert!(deck(&old, &plain()).is_ok());
}

/// A bar whose property is to be tested beside one along which a rail can lie.
fn beside(property: &str, support: &str) -> String {
    format!(
        "{STEEL}GRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.,,{support}\nCBAR,1,5,1,2,0.,1.,0.\n{property}\n\
         GRID,3,,0.,0.,9.,,123456\nGRID,4,,2.,0.,9.\nCBAR,2,6,3,4,0.,1.,0.\nPBAR,6,1,.02,1.-4,2.-4,1.-4\n"
    )
}

/// Whether a bar that a rail needs holds it: the bar with the property is between the support and the bar with the rail.
fn holds(property: &str) -> bool {
    let text = format!(
        "{STEEL}GRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.\nGRID,3,,4.,0.,0.\nCBAR,1,5,1,2,0.,1.,0.\n\
         CBAR,2,6,2,3,0.,1.,0.\n{property}\nPBAR,6,1,.02,1.-4,2.-4,1.-4\n"
    );
    let imported = with_rail(&text, "r=2").unwrap_or_else(|wrong| panic!("{wrong}"));
    let frame = frame(&imported);
    let rails: Vec<fea::Rail> = frame.rails.iter().map(|(_, rail)| rail.clone()).collect();
    fea::FactoredFrame::new(&frame.model, &rails).is_ok()
}

fn with_rail(text: &str, rail: &str) -> Result<Imported, String> {
    let options = ImportOptions {
        up: Some([0.0, 1.0, 0.0]),
        rails: vec![rail.parse().expect("a rail")],
        ..plain()
    };
    deck(text, &options).map_err(|wrong| told(&wrong))
}

#[test]
fn bars_without_an_area_bend_and_have_no_axial_stiffness() {
    for area in ["", "0."] {
        // a cantilever of 2 m: P L^3 / (3 E I) in both planes; the support holds it along its axis
        let text = beside(&format!("PBAR,5,1,{area},1.-4,2.-4,1.-4,12."), "14");
        let imported = with_rail(&text, "r=2").unwrap_or_else(|wrong| panic!("{wrong}"));
        let load = [0.0, 1e4, 1e4, 0.0, 0.0, 0.0];
        let found = displacements(&frame(&imported), &["GRID 2"], load);
        close(found[1], 1e4 * 8.0 / (3.0 * 2e11 * 1e-4));
        close(found[2], 1e4 * 8.0 / (3.0 * 2e11 * 2e-4));
        assert!(
            told(&imported.warnings)
                .contains("PBAR 5: has no A: its members have no axial stiffness")
        );
        // without an area the density gives no mass, the mass per length all of it
        let spec = json(&imported);
        let part = |list: &str, key: &str| spec[list][0][key].as_f64().expect("a number");
        close(part("sections", "A") * part("materials", "density"), 12.0);
        // nothing else holds the grid along the bar
        assert!(!holds(&format!("PBAR,5,1,{area},1.-4,2.-4,1.-4")));
        assert!(holds("PBAR,5,1,.02,1.-4,2.-4,1.-4"));
        let wrong = with_rail(&text, "r=1").expect_err("a rail on a bar without area");
        assert!(
            wrong.contains("element 1, because its section PBAR 5 has no A"),
            "{wrong}"
        );
    }
    let wrong = refused(&beside("PBAR,5,1", "14"));
    assert!(
        wrong.contains("must be positive if I1, I2 and J are 0"),
        "{wrong}"
    );
}

#[test]
fn bars_with_one_second_moment_bend_in_its_plane_alone() {
    let load = 1e4;
    for (property, freedom, held, missing) in [
        ("PBAR,5,1,.02,1.-4", 1, "345", "I2"),
        ("PBAR,5,1,.02,1.-4,0.,1.-5", 1, "345", "I2"),
        ("PBAR,5,1,.02,,1.-4", 2, "246", "I1"),
        // shear of the plane that bends: P L / (K1 G A) in addition
        ("PBAR,5,1,.02,1.-4\n+\n+,.5", 1, "345", "I2"),
    ] {
        let imported =
            with_rail(&beside(property, held), "r=2").unwrap_or_else(|wrong| panic!("{wrong}"));
        let mut force = [0.0; 6];
        force[freedom] = load;
        let found = displacements(&frame(&imported), &["GRID 2"], force);
        let shear = if property.ends_with(".5") {
            load * 2.0 / (0.5 * 8e10 * 0.02)
        } else {
            0.0
        };
        close(found[freedom], load * 8.0 / (3.0 * 2e11 * 1e-4) + shear);
        // the rotation of the tip is P L^2 / (2 E I)
        let turn = if freedom == 1 { found[5] } else { -found[4] };
        close(turn, load * 4.0 / (2.0 * 2e11 * 1e-4));
        let warned = told(&imported.warnings);
        assert!(
            warned.contains(&format!(
                "PBAR 5: has no {missing}: its members have no bending stiffness"
            )),
            "{warned}"
        );
        // the other plane has no stiffness: grids that nothing holds there move freely
        assert!(!holds(property));
        let wrong = with_rail(&beside(property, held), "r=1").expect_err("a rail");
        assert!(wrong.contains(&format!("has no {missing}")), "{wrong}");
    }
    // a product of inertia needs both, as do beams
    assert!(refused(&beside("PBAR,5,1,.02,1.-4\n+\n+,,,1.-5", "")).contains("I12"));
    let beam = beside("PBEAM,5,1,.02,1.-4", "345").replace("CBAR,1", "CBEAM,1");
    assert!(refused(&beam).contains("I2"));
}

#[test]
fn the_mass_of_the_deck_is_told_where_it_acts_elsewhere() {
    // a cantilever that moves along y alone: half of its mass at its tip, or all of it along it
    let text = format!(
        "{STEEL}GRID,1,,0.,0.,0.,,123456\nGRID,2,,2.,0.,0.,,1345\nCBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n"
    );
    let told_of =
        |text: &str, options: &ImportOptions| told(&deck(text, options).expect("a deck").warnings);
    let warned = told_of(&text, &plain());
    let hertz: Vec<f64> = warned
        .split(" Hz")
        .filter_map(|before| before.rsplit(' ').next()?.parse().ok())
        .collect();
    let [along, at_ends] = hertz[..] else {
        panic!("{warned}")
    };
    let cycle = std::f64::consts::TAU;
    let [stiffness, mass]: [f64; 2] = [2e11 * 1e-4, 8000.0 * 0.02];
    let tip = (3.0 * stiffness / 8.0 / mass).sqrt() / cycle;
    assert!((at_ends / tip - 1.0).abs() < 1e-3, "{at_ends} {tip}");
    // k L = 1.875104 (Euler and Bernoulli; rotary inertia lowers it by 0.3 %)
    let whole = (1.875_104_f64 / 2.0).powi(2) * (stiffness / mass).sqrt() / cycle;
    assert!((along / whole - 1.0).abs() < 5e-3, "{along} {whole}");
    // WTMASS scales both
    let scaled = told_of(&format!("{text}PARAM,WTMASS,.25\n"), &plain());
    assert!(
        scaled.contains(&format!("with the masses of the deck {:.2} Hz", 2.0 * tip)),
        "{scaled}"
    );
    // nothing to tell where the user asked for it, or where the deck has its mass along its members
    for mass in [MassDistribution::Lumped, MassDistribution::Distributed] {
        let asked = ImportOptions {
            mass: Some(mass),
            ..plain()
        };
        assert!(!told_of(&text, &asked).contains("Hz"), "{mass:?}");
    }
    assert!(!told_of(&format!("{text}PARAM,COUPMASS,1\n"), &plain()).contains("Hz"));
    // masses that are left out are told as such
    let unused = ImportOptions {
        skip_unused: true,
        ..plain()
    };
    let warned = told_of(&format!("{text}CMASS2,9,5.,2,2\n"), &unused);
    assert!(
        warned.contains("CMASS2: is ignored (1 card): its mass is missing in natural frequencies"),
        "{warned}"
    );
}

#[test]
fn replicated_cards_make_the_same_model() {
    let replicated = format!(
        "{STEEL}GRDSET,8)4\nGRID,1,,0.,0.,0.,,123456\nGRID,2,,.5,0.,0.\n=,*(1),=,*(.5),==\n=(2)\n\
         CBAR,1,5,1,2,0.,1.,0.\n=(4),*(1),=,*(1),/,==\nPBAR,5,1,.02 1.-4 2.-4,1.-4\n"
    );
    let mut written = format!("{STEEL}GRDSET,,,,,,,4\nGRID,1,,0.,0.,0.,,123456\n");
    for k in 2..=5 {
        written += &format!("GRID,{k},,{:?},0.,0.\n", 0.5 * (f64::from(k) - 1.0));
    }
    for k in 1..=4 {
        written += &format!("CBAR,{k},5,{k},{},0.,1.,0.\n", k + 1);
    }
    written += "PBAR,5,1,.02,1.-4,2.-4,1.-4\n";
    assert!(refused(&replicated).contains("refers to a grid that does not exist"));
    let replicated = replicated.replace("=(4),*(1)", "=(3),*(1)");
    assert_eq!(good(&replicated).text, good(&written).text);
}

#[test]
fn lines_of_signs_and_a_mark_at_the_beginning_mean_nothing_in_any_file_of_bulk_data() {
    let text = format!(
        "CEND\nBEGIN BULK\n{STEEL}{LINE}CBAR,1,5,1,2,0.,1.,0.\nPBAR,5,1,.02,1.-4,2.-4,1.-4\n"
    );
    let marked = text.replace("BEGIN BULK\n", "BEGIN BULK\n&&&& &&\n&\n");
    let marked = format!("\u{feff}{marked}");
    let wanted = good(&text).text;
    for name in ["deck.fem", "deck.nas", "deck.DAT", "deck.inp"] {
        let found = from_memory(name, &[(name, &marked)], &plain());
        assert_eq!(
            found
                .unwrap_or_else(|wrong| panic!("{}", told(&wrong)))
                .text,
            wanted,
            "{name}"
        );
    }
}
