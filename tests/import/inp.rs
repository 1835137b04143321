//! Abaqus input files: closed forms of their sections and directions, files of gmsh and meshio, refusals by name.

use std::path::Path;

use formats::text::diagnostic::Diagnostic;
use formats::text::source::Source;
use formats::units::Length;
use import::{ImportOptions, Imported};
use serde_json::json as value;

use super::{displacements, frame, from_memory, json, plain, text, told};

fn input(text: &str, options: &ImportOptions) -> Result<Imported, Vec<Diagnostic>> {
    from_memory("model.inp", &[("model.inp", text)], options)
}

fn good(text: &str) -> Imported {
    input(text, &plain()).unwrap_or_else(|wrong| panic!("{}{text}", told(&wrong)))
}

/// A cantilever of 2 m along x with the n1 direction -z, fixed at node 1.
fn cantilever(kind: &str, section: &str) -> String {
    format!(
        "*Heading\n a cantilever\n*Node, nset=all\n1, 0., 0., 0.\n2, 2., 0., 0.\n*Element, type={kind}, elset=beam\n\
         1, 1, 2\n{section}*Material, name=Steel\n*Elastic\n2.1e11, 0.25\n*Density\n7850.,\n*Boundary\n1, encastre\n"
    )
}

fn tip(text: &str, load: [f64; 6]) -> Vec<f64> {
    let options = ImportOptions {
        up: Some([0.0, 1.0, 0.0]),
        rails: vec!["r=1/axis=1,0,0".parse().expect("a rail")],
        ..plain()
    };
    let imported = input(text, &options).unwrap_or_else(|wrong| panic!("{}{text}", told(&wrong)));
    displacements(&frame(&imported), &["node 2"], load)
        .as_slice()
        .to_vec()
}

fn close(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
}

#[test]
fn sections_have_their_dimensions_along_the_axes_of_the_guide() {
    // a along the 1-axis, which is -z; b along the 2-axis, t x n1 = x cross -z = y
    let rect = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n0., 0., -1.\n";
    let (e, g, a) = (2.1e11, 8.4e10, 0.03);
    let found = tip(&cantilever("B33", rect), [0.0, 1e4, 1e4, 0.0, 0.0, 0.0]);
    let bend = |i: f64| 1e4 * 8.0 / (3.0 * e * i);
    close(found[1], bend(0.1 * 0.027 / 12.0));
    close(found[2], bend(0.3 * 0.001 / 12.0));
    // B31 deforms in shear too, with k = 0.85 for rectangles
    let found = tip(&cantilever("B31", rect), [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
    close(
        found[1],
        bend(0.1 * 0.027 / 12.0) + 1e4 * 2.0 / (0.85 * g * a),
    );
    // transverse shear stiffnesses in place of k G A: K23 along the 2-axis
    let shear = format!("{rect}*Transverse Shear Stiffness\n1.e8, 2.e8\n");
    let found = tip(&cantilever("B31", &shear), [0.0, 1e4, 1e4, 0.0, 0.0, 0.0]);
    close(found[1], bend(0.1 * 0.027 / 12.0) + 2e4 / 1e8);
    close(found[2], bend(0.3 * 0.001 / 12.0) + 2e4 / 2e8);
    // an I section bends about its 1-axis with its web along the 2-axis
    let flanged = "*Beam Section, elset=beam, material=steel, section=I\n0.15, 0.3, 0.2, 0.2, 0.02, 0.02, 0.01\n\n";
    let found = tip(&cantilever("B33", flanged), [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
    close(
        found[1],
        bend((0.2 * 0.027 - 0.19 * 0.26f64.powi(3)) / 12.0),
    );
    for (section, area) in [
        ("CIRC\n0.1\n", 0.01 * std::f64::consts::PI),
        ("BOX\n0.1,0.2,0.01,0.02,0.01,0.02\n", 0.0072),
    ] {
        let of = format!("*BEAM SECTION, ELSET=BEAM, MATERIAL=STEEL, SECTION={section}");
        close(
            tip(&cantilever("B33", &of), [1e4, 0.0, 0.0, 0.0, 0.0, 0.0])[0],
            1e4 * 2.0 / (e * area),
        );
    }
}

/// A cantilever of 2 m along x of one straight beam with three nodes, of which the third is at `middle`.
fn second_order(kind: &str, middle: f64) -> String {
    let rect = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n0., 0., -1.\n";
    cantilever(kind, rect)
        .replace("*Element", &format!("3, {middle:?}, 0., 0.\n*Element"))
        .replace("\n1, 1, 2\n", "\n1, 1, 3, 2\n")
}

#[test]
fn straight_beams_of_three_nodes_bend_as_their_closed_form_wherever_the_middle_node_is() {
    let (e, g, a, i) = (2.1e11, 8.4e10, 0.03, 0.1 * 0.027 / 12.0);
    let end = 1e4 * 8.0 / (3.0 * e * i) + 1e4 * 2.0 / (0.85 * g * a);
    for kind in ["B32", "B32R", "B32H", "b32"] {
        for middle in [1.0, 0.4, 1.75] {
            let text = second_order(kind, middle);
            close(tip(&text, [0.0, 1e4, 0.0, 0.0, 0.0, 0.0])[1], end);
            // under the same force at the tip the middle node moves by P x^2 (3 L - x) / (6 E I) + P x / (k G A)
            let options = ImportOptions {
                up: Some([0.0, 1.0, 0.0]),
                rails: vec!["r=beam".parse().expect("a rail")],
                ..plain()
            };
            let imported = input(&text, &options).expect("a model");
            let load = [0.0, 1e4, 0.0, 0.0, 0.0, 0.0];
            let moved = displacements(&frame(&imported), &["node 2", "node 3"], load);
            let x: f64 = middle;
            close(
                moved[7],
                1e4 * x * x * (6.0 - x) / (6.0 * e * i) + 1e4 * x / (0.85 * g * a),
            );
            let spec = json(&imported);
            assert_eq!(spec["cell_sets"]["beam"], value!([[0, 1]]));
            assert_eq!(spec["rails"]["r"]["stations"], value!([0.0, middle, 2.0]));
        }
    }
    // a beam of two nodes with one point of integration
    let rect = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n0., 0., -1.\n";
    close(
        tip(&cantilever("B31R", rect), [0.0, 1e4, 0.0, 0.0, 0.0, 0.0])[1],
        end,
    );
}

#[test]
fn a_beam_of_three_nodes_is_released_at_its_ends_alone_and_turned_by_a_fourth_node() {
    let text = second_order("B32", 1.0);
    let released = text.replace("*Boundary", "*Release\n1, S1, M1\n1, S2, M2\n*Boundary");
    let data = &json(&good(&released))["cell_data"];
    assert_eq!(data["release_a"], value!([[["ry"], []]]));
    assert_eq!(data["release_b"], value!([[[], ["rz"]]]));
    let turned = text
        .replace("*Element", "9, 0., 5., 0.\n*Element")
        .replace("1, 1, 3, 2\n", "1, 1, 3, 2, 9\n");
    let data = &json(&good(&turned))["cell_data"];
    assert_eq!(
        data["orientation"],
        value!([[[0.0, 5.0, 0.0], [0.0, 5.0, 0.0]]])
    );
}

/// The stiffness of a circle goes with the fourth power of its radius, which Abaqus states; CalculiX states the diameter.
#[test]
fn circles_have_the_dimension_of_their_program() {
    let bend = |r: f64| 1e4 * 8.0 / (3.0 * 2.1e11 * std::f64::consts::FRAC_PI_4 * r.powi(4));
    let shear = |r: f64| 1e4 * 2.0 / (0.89 * 8.4e10 * std::f64::consts::PI * r * r);
    let of = |kind: &str, dimension: &str| {
        let rect = "section=RECT\n0.1, 0.3\n";
        let text = if kind.contains('2') {
            second_order(kind, 1.0)
        } else {
            let line =
                "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n0., 0., -1.\n";
            cantilever(kind, line)
        };
        text.replace(rect, &format!("section=CIRC\n{dimension}\n"))
    };
    let force = [0.0, 1e4, 0.0, 0.0, 0.0, 0.0];
    for (kind, dimension, radius) in [
        ("B32R", "0.2", 0.1),
        ("B32", "0.2, 0.2", 0.1),
        ("B31", "0.2", 0.2),
        ("B32H", "0.2", 0.2),
    ] {
        close(
            tip(&of(kind, dimension), force)[1],
            bend(radius) + shear(radius),
        );
    }
    let parts = of("B32", "0.2").replace("*Heading\n", "*Preprint, echo=NO\n*Heading\n");
    close(tip(&parts, force)[1], bend(0.2) + shear(0.2));
    for (text, part) in [
        (
            of("B32", "0.2"),
            "must not be CIRC, because its dimension is the radius in Abaqus",
        ),
        (of("B32R", "0.2, 0.1, 0.1"), "must have 2 dimensions"),
        (
            of("B32R", "0.2").replace("section=CIRC", "section=CIRC, offset1=0.5"),
            "OFFSET1: is not supported",
        ),
        (
            second_order("B32R", 1.0).replace("0.1, 0.3\n", "0.1, 0.3, 0.2\n"),
            "must have 2 dimensions",
        ),
        (
            second_order("B32R", 1.0).replace("section=RECT", "section=RECT, nodal thickness"),
            "NODALTHICKNESS",
        ),
    ] {
        let wrong = told(&input(&text, &plain()).expect_err(part));
        assert!(wrong.contains(part), "{part}: {wrong}");
    }
    let centred =
        second_order("B32R", 1.0).replace("section=RECT", "section=RECT, offset1=0., offset2=0");
    assert!(input(&centred, &plain()).is_ok());
}

/// CalculiX 2.20 reads two diameters along n1 and the 2-axis: its own displacements of 20 elements of B32R are within 3 % of
/// these, and it reads one side of a rectangle as that of a square, RECTANGULAR as RECT, each with equal digits.
#[test]
fn shapes_of_calculix_have_all_its_forms() {
    let of = |shape: &str| second_order("B32R", 1.0).replace("section=RECT\n0.1, 0.3\n", shape);
    let pi = std::f64::consts::PI;
    let (e, g, a, b) = (2.1e11_f64, 8.4e10, 0.1_f64, 0.3_f64);
    let ellipse = of("section=CIRC\n0.1, 0.3\n");
    // n1 is -z, the 2-axis y; a and b are the diameters along them
    let bend = |i: f64| 8.0 / (3.0 * e * i) + 2.0 / (0.89 * g * pi * a * b / 4.0);
    let found = tip(&ellipse, [1.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    close(found[0], 2.0 / (e * pi * a * b / 4.0));
    close(found[1], bend(pi * a * b.powi(3) / 64.0));
    close(found[2], bend(pi * a.powi(3) * b / 64.0));
    let j = pi * a.powi(3) * b.powi(3) / (16.0 * (a * a + b * b));
    close(found[3], 2.0 / (g * j));
    let spec = |text: &str| {
        let spec = json(&good(text));
        (spec["sections"].clone(), spec["cell_data"].clone())
    };
    assert_eq!(
        spec(&of("section=rectangular\n0.1, 0.3\n")),
        spec(&second_order("B32R", 1.0))
    );
    let square = spec(&of("section=RECT\n0.1, 0.1\n"));
    for kind in ["B32R", "B32"] {
        let one = of("section=RECT\n0.1\n").replace("B32R", kind);
        assert_eq!(spec(&one), square, "{kind}");
    }
    // Abaqus needs both sides
    let part = of("section=RECT\n0.1\n")
        .replace("B32R", "B32")
        .replace("*Heading\n", "*Preprint, echo=NO\n*Heading\n");
    let wrong = told(&input(&part, &plain()).expect_err("one side"));
    assert!(wrong.contains("*BEAM SECTION: b: is missing"), "{wrong}");
}

#[test]
fn coordinates_that_are_rounding_errors_are_zero() {
    let beam = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n0., 0., -1.\n";
    let text = cantilever("B31", beam);
    let exact = good(&text).text;
    for z in ["5.6527705662195241E-32", "-1.d-300"] {
        let nearly = text
            .replace("1, 0., 0., 0.", &format!("1, 0., 0., {z}"))
            .replace("0., 0., -1.", &format!("{z}, 0., -1."));
        assert_eq!(good(&nearly).text, exact, "{z}");
    }
    for (from, to, part) in [
        (
            "2.1e11",
            "2.1e-31",
            "*ELASTIC: E: must be 0, or between 1e-30",
        ),
        (
            "2, 2., 0.",
            "2, 2.e31, 0.",
            "*NODE: x: must be 0, or between 1e-30",
        ),
    ] {
        let wrong = told(&input(&text.replace(from, to), &plain()).expect_err(part));
        assert!(wrong.contains(part), "{part}: {wrong}");
    }
}

/// Abaqus Analysis User's Guide, "Springs": SPRINGA acts along the line between its nodes.
#[test]
fn springs_between_two_nodes_act_along_their_line() {
    let rect = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n0., 0., -1.\n";
    let spring = "*Node\n3, 2.6, 0.8, 0.\n4, 2., 5., 0.\n*Element, type=SPRINGA, elset=tie\n7, 2, 3\n8, 4, 2\n\
                  *Spring, elset=tie\n\n2.e7\n*Boundary\n3, 1, 3\n4, 1, 3\n";
    let text = cantilever("B33", rect) + spring;
    // the tip has the stiffness E A / L along the beam, 3 E I / L^3 across, and that of springs along (0.6, 0.8) and (0, 1)
    let (e, k) = (2.1e11, 2e7);
    let along = e * 0.03 / 2.0 + 0.36 * k;
    let across = 3.0 * e * (0.1 * 0.027 / 12.0) / 8.0 + 0.64 * k + k;
    let both = 0.48 * k;
    let det = along * across - both * both;
    for text in [
        text.clone(),
        text.replace("\n\n2.e7", "\n2.e7"),
        text.replace("\n\n2.e7", "\n,\n2.e7"),
    ] {
        let found = tip(&text, [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
        close(found[1], 1e4 * along / det);
        close(found[0], -1e4 * both / det);
    }
    let spec = json(&good(&text));
    assert_eq!(
        spec["cell_data"]["kind"],
        value!([["beam", "truss", "truss"]])
    );
    assert_eq!(spec["materials"][1].get("density"), None);
    for (from, to, part) in [
        (
            "elset=tie\n\n2.e7",
            "elset=tie, nonlinear\n\n0., 0.\n2.e7, 1.",
            "*SPRING: NONLINEAR: is not supported",
        ),
        (
            "\n2.e7\n",
            "\n2.e7,,0.\n1.e7,,99.\n3.e7,,200.\n",
            "one stiffness",
        ),
        ("*Spring, elset=tie\n\n2.e7\n", "", "must have a stiffness"),
        (
            "3, 2.6, 0.8, 0.",
            "3, 2., 0., 0.",
            "must have a positive length",
        ),
        (
            "*Boundary\n3",
            "*Spring, elset=tie\n\n1.e7\n*Boundary\n3",
            "must not assign a second stiffness",
        ),
        (
            "type=SPRINGA, elset=tie\n7, 2, 3\n8, 4, 2",
            "type=SPRING1, elset=tie\n7, 2",
            "must have a degree of freedom from 1 to 6",
        ),
    ] {
        let wrong = told(&input(&text.replacen(from, to, 1), &plain()).expect_err(part));
        assert!(wrong.contains(part), "{part}: {wrong}");
    }
}

#[test]
fn supports_of_temperatures_are_left_out_like_loads() {
    let beam = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n";
    let model = cantilever("B31", beam);
    let wanted = good(&model).text;
    for more in [
        "*Boundary\n1, 11, 11, 25.\n2, 11, , 25.\n",
        "*Step\n*Static\n*End Step\n*Step\n*Static\n*Boundary\n1, 11, 11, 25.\n*End Step\n",
    ] {
        let imported = good(&format!("{model}{more}"));
        assert_eq!(imported.text, wanted, "{more}");
        let warned = told(&imported.warnings);
        assert!(
            warned.contains("*BOUNDARY: is ignored at degrees of freedom from 11 on"),
            "{warned}"
        );
    }
    for more in ["*Boundary\n2, 1, 11\n", "*Boundary\n2, 8, 8\n"] {
        let wrong = told(&input(&format!("{model}{more}"), &plain()).expect_err(more));
        assert!(wrong.contains("degrees of freedom from 1 to 6"), "{wrong}");
    }
}

#[test]
fn a_file_without_members_names_its_elements_and_normals_are_said_to_turn_them() {
    let skip = ImportOptions {
        skip: vec!["S4".to_owned()],
        ..plain()
    };
    let text = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT,TYPE=S4\n7,1,2,3,4\n8,1,2,3,4\n\
                *ELEMENT,TYPE=MASS,ELSET=m\n9,1\n*MASS,ELSET=m\n5.\n";
    let wrong = told(&input(text, &skip).expect_err("no members"));
    assert!(
        wrong.contains("contains no members; its elements are MASS (1), S4 (2)"),
        "{wrong}"
    );
    let beam = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n";
    let text = cantilever("B31", beam) + "*Normal\n1, 1, 0., 1., 0.\n";
    let wrong = told(&input(&text, &plain()).expect_err("a normal"));
    assert!(
        wrong.contains("the normal turns the sections of beams at its nodes")
            && wrong.contains("--skip NORMAL changes the model")
            && !wrong.contains("if it can be ignored"),
        "{wrong}"
    );
}

#[test]
fn sets_of_elements_that_are_left_out_are_empty() {
    let text = second_order("B32", 1.0).replace(
        "*Material",
        "*Element, type=S4, elset=plate\n7, 1, 2, 3, 1\n*Elset, elset=all\nplate, beam\n*Material",
    );
    assert!(told(&input(&text, &plain()).expect_err("a shell")).contains("S4: is not supported"));
    let skip = ImportOptions {
        skip: vec!["S4".to_owned()],
        ..plain()
    };
    let imported = input(&text, &skip).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    assert_eq!(
        json(&imported)["cell_sets"],
        value!({ "all": [[0, 1]], "beam": [[0, 1]] })
    );
}

#[test]
fn a_truss_of_three_nodes_is_one_member_unless_something_holds_its_middle() {
    let text = "*NODE\n1,0,0,0\n2,4,3,0\n3,2,1.5,0\n4,0,3,0\n*ELEMENT, TYPE=T3D3, ELSET=tie\n1,1,3,2\n\
        *SOLID SECTION, ELSET=tie, MATERIAL=steel\n0.002\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n*BOUNDARY\n1, 1, 6\n2, 3, 6\n";
    let spec = json(&good(text));
    assert_eq!(spec["cells"][0]["data"], value!([[0, 1]]));
    assert_eq!(spec["points"], value!([[0.0, 0.0, 0.0], [4.0, 3.0, 0.0]]));
    for held in [
        "*ELEMENT, TYPE=T3D2, ELSET=tie\n2,3,4\n",
        "*ELEMENT, TYPE=T3D3, ELSET=tie\n2,4,3,5\n*NODE\n5,4,0,0\n",
        "*BOUNDARY\n3, 2\n",
    ] {
        let wrong = told(&input(&format!("{text}{held}"), &plain()).expect_err(held));
        assert!(
            wrong.contains("a middle node that nothing else uses"),
            "{held}: {wrong}"
        );
    }
}

#[test]
fn general_sections_bend_about_their_principal_axes() {
    let general = "*Beam General Section, elset=beam, density=7850.\n0.01, 4.e-4, 1.e-4, 2.e-4, 3.e-6\n0,0,-1\n2.1e11, 8.e10\n";
    let text = cantilever("B33", general);
    let found = tip(&text, [0.0, 1e4, 0.0, 0.0, 0.0, 0.0]);
    // the 2-axis is y and the 1-axis -z: M = E [[I11, -I12], [-I12, I22]] of the curvatures of y and z
    let (i11, i12, i22) = (4e-4, 1e-4, 2e-4);
    let det = i11 * i22 - i12 * i12;
    let unit = 1e4 * 8.0 / (3.0 * 2.1e11);
    close(found[1], unit * i22 / det);
    close(found[2], unit * i12 / det);
    let spec = json(&good(&text));
    assert_eq!(spec["materials"][0]["density"], value!(7850.0));
    assert_eq!(
        spec["sections"][0].get("Asy"),
        None,
        "B33 is rigid in shear"
    );
}

#[test]
fn supports_springs_masses_and_links_become_what_they_say() {
    let text = "*NODE\n1,0,0,0\n2,2,0,0\n3,4,0,0\n4,4,1,0\n5,6,0,0\n*ELEMENT, TYPE=B31, ELSET=girder\n1,1,2\n2,2,3\n\
        *ELEMENT, TYPE=T3D2, ELSET=tie\n3,3,5\n*ELEMENT, TYPE=SPRING1, ELSET=bearing\n4,2\n\
        *ELEMENT, TYPE=MASS, ELSET=point\n5,3\n*SPRING, ELSET=bearing\n2\n5.e6\n*MASS, ELSET=point\n120.\n\
        *NSET, NSET=ends, GENERATE\n1, 5, 4\n*BEAM SECTION, ELSET=girder, MATERIAL=steel, SECTION=PIPE\n0.1, 0.01\n0,1,0\n\
        *SOLID SECTION, ELSET=tie, MATERIAL=steel\n0.002\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n\
        *MPC\nBEAM, 4, 3\n*RELEASE\n2, S2, M1-T\n*BOUNDARY\nends, 1, 3\n1, 4\n*STEP\n*STATIC\n*CLOAD\n4, 2, -1.\n*END STEP\n";
    let imported = good(text);
    let spec = json(&imported);
    assert_eq!(
        spec["cell_data"]["kind"],
        value!([["beam", "beam", "truss"]])
    );
    assert_eq!(
        spec["cell_data"]["release_b"],
        value!([[[], ["rx", "ry"], []]])
    );
    assert_eq!(
        spec["springs"],
        value!([{ "point": 1, "dof": "uy", "k": 5e6 }])
    );
    assert_eq!(
        spec["masses"],
        value!([{ "point": 2, "mass": 120.0, "inertia": [0.0, 0.0, 0.0], "offset": [0.0, 0.0, 0.0] }])
    );
    assert_eq!(spec["links"], value!([{ "from": 2, "to": 3 }]));
    assert_eq!(
        spec["supports"],
        value!([{ "point": 0, "fix": ["ux", "uy", "uz", "rx"] }, { "point": 4, "fix": ["ux", "uy", "uz"] }])
    );
    assert_eq!(spec["point_sets"]["ends"], value!([0, 4]));
    let warned = told(&imported.warnings);
    assert!(
        warned.contains("*CLOAD: is ignored (occurs once)") && warned.contains("*STATIC"),
        "{warned}"
    );
}

#[test]
fn parts_are_read_in_the_flat_form_and_files_are_included() {
    let beam = "*Beam Section, elset=beam, material=steel, section=CIRC\n0.1\n";
    let flat = json(&good(&cantilever("B31", beam)));
    let body = cantilever("B31", beam);
    let body = body.replace("*Node,", "*Part, name=P\n*Node,").replace("*Material,", "*End Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n*Nset, nset=foot, instance=P-1\n 1,\n*End Assembly\n*Material,");
    let body = body.replace("1, encastre", "foot, encastre");
    let parts = json(&good(&body));
    for key in ["points", "cells", "supports", "materials"] {
        assert_eq!(parts[key], flat[key], "{key}");
    }
    assert_eq!(
        parts["sections"][0]["name"], "P-1.beam 1",
        "names of a part have that of its instance"
    );
    assert_eq!(
        json(&good(&body.replace("\nfoot, enc", "\nP-1.1, enc")))["supports"],
        flat["supports"]
    );
    let moved = body.replace("part=P\n*End", "part=P\n1., 0., 0.\n*End");
    assert!(
        told(&input(&moved, &plain()).expect_err("moved"))
            .contains("must not be translated or rotated")
    );
    let text = cantilever("B31", beam);
    let (head, tail) = text.split_once("*Material").expect("a material");
    let (main, rest) = (
        format!("{head}*INCLUDE, INPUT=sub/rest.inc\n"),
        format!("*Material{tail}"),
    );
    let files = [("m/model.inp", main.as_str()), ("m/sub/rest.inc", &rest)];
    assert_eq!(
        json(&from_memory("m/model.inp", &files, &plain()).expect("a model")),
        flat
    );
    let files = [
        ("m/model.inp", main.as_str()),
        ("m/sub/rest.inc", "*INCLUDE, INPUT=../model.inp\n"),
    ];
    let wrong = told(&from_memory("m/model.inp", &files, &plain()).expect_err("a loop"));
    assert!(wrong.contains("*INCLUDE"), "{wrong}");
}

#[test]
fn a_name_within_a_part_differs_from_the_same_name_outside() {
    let text = "*Part, name=Part-1\n*Node\n1, 0., 0., 0.\n2, 5., 0., 0.\n3, 10., 0., 0.\n*Element, type=B31\n1, 1, 2\n2, 2, 3\n\
        *Nset, nset=Set-1, generate\n1, 3, 1\n*Elset, elset=Set-1\n1, 2\n\
        *Beam Section, elset=Set-1, material=Steel, section=RECT\n0.1, 0.2\n0., 0., -1.\n*End Part\n\
        *Assembly, name=Assembly\n*Instance, name=Part-1-1, part=Part-1\n*End Instance\n\
        *Nset, nset=Set-1, instance=Part-1-1\n1, 3\n*End Assembly\n*Material, name=Steel\n*Elastic\n2.1e11, 0.3\n\
        *Step, name=Step-1\n*Static\n1., 1.\n*Boundary\nSet-1, ENCASTRE\n*End Step\n";
    let held = |text: &str| {
        let spec = json(&good(text));
        let supports = spec["supports"].as_array().expect("supports").iter();
        supports
            .filter_map(|support| support["point"].as_u64())
            .collect::<Vec<u64>>()
    };
    assert_eq!(held(text), [0, 2]);
    assert_eq!(
        held(&text.replace("Boundary\nSet-1", "Boundary\nPart-1-1.Set-1")),
        [0, 1, 2]
    );
    assert_eq!(
        held(&text.replace("Boundary\nSet-1", "Boundary\nPART-1-1.2")),
        [1]
    );
    let wrong = input(
        &text.replace("Boundary\nSet-1", "Boundary\nPart-1-1.Set-2"),
        &plain(),
    );
    assert!(told(&wrong.expect_err("no such set")).contains("does not exist"));
}

#[test]
fn what_is_not_understood_is_refused_by_name_and_left_out_where_it_cannot_matter() {
    let beam = "*Beam Section, elset=beam, material=steel, section=RECT\n0.1, 0.3\n";
    let model = cantilever("B31", beam);
    for (more, part) in [
        (
            "*EQUATION\n2\n",
            "*EQUATION: is not supported (occurs once)",
        ),
        (
            "*ELEMENT, TYPE=S4\n7,1,2,3,4\n8,1,2,3,4\n",
            "S4: is not supported (occurs 2 times)",
        ),
        ("*ELEMENT, TYPE=B31OS\n7,1,2\n", "B31OS: is not supported"),
        ("*BOUNDARY\n2, 1, 1, 0.1\n", "displacement: must be 0"),
        ("*NSET, NSET=a\nb\n", "the name of a previously defined set"),
        (
            "*BOUNDARY\nnowhere, 1\n",
            "refers to a set or number that does not exist",
        ),
        ("*PLASTIC\n2.e8, 0.\n", "ignore it with --skip-unused"),
        ("*NODE\n2, 0, 0, 0\n", "is defined twice"),
        ("*NODE\n3, 0, zero, 0\n", "model.inp:"),
    ] {
        let wrong = told(&input(&format!("{model}{more}"), &plain()).expect_err(more));
        assert!(wrong.contains(part), "{more}: {wrong}");
    }
    let unused = ImportOptions {
        skip_unused: true,
        ..plain()
    };
    let more = "*PLASTIC\n2.e8, 0.\n*BOUNDARY\n2, 1, 1, 0.1\n";
    let taken = input(&format!("{model}{more}"), &unused)
        .unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let warned = told(&taken.warnings);
    assert!(
        warned.contains("*PLASTIC") && warned.contains("displacement of the support is taken as 0"),
        "{warned}"
    );
    let shells = ImportOptions {
        skip: vec!["S4".to_owned(), "EQUATION".to_owned()],
        ..plain()
    };
    assert!(
        input(
            &format!("{model}*ELEMENT, TYPE=S4\n7,1,2,3,4\n*EQUATION\n2\n"),
            &shells
        )
        .is_ok()
    );
    for (section, part) in [
        (
            "*Beam Section, elset=beam, material=steel, section=L\n.1,.1,.01,.01\n",
            "is not supported, got L",
        ),
        (
            "*Beam Section, elset=beam, material=steel, section=I\n.1,.3,.2,.2,.02,.02,.01\n",
            "height of the centroid, 0.15",
        ),
        (
            "*Beam Section, elset=beam, material=wood, section=RECT\n.1,.3\n",
            "the name of a *MATERIAL",
        ),
        (
            "*Beam Section, elset=beam, material=steel, section=RECT\n.1,-.3\n",
            "must be positive",
        ),
        (
            "*Beam Section, elset=beam, material=steel, section=RECT\n.1,.3\n1,0,0\n",
            "n1 direction",
        ),
        ("", "must have a section"),
    ] {
        let wrong = told(&input(&cantilever("B31", section), &plain()).expect_err(section));
        assert!(wrong.contains(part), "{section}: {wrong}");
    }
    let wrong = told(&input(&model, &ImportOptions::default()).expect_err("no units"));
    assert!(wrong.contains("--length and --force"), "{wrong}");
}

#[test]
fn files_of_gmsh_and_meshio_need_sections_by_the_names_of_their_sets() {
    let sections = text("meshes/portal.json");
    let options = |name: &str| ImportOptions {
        length: Some(Length::Millimetre),
        up: Some([0.0, 0.0, 1.0]),
        sections: Some(Source {
            name: "sections.json".to_owned(),
            text: sections.replace("runway girder", name),
        }),
        ..ImportOptions::default()
    };
    for (file, girder, feet) in [
        ("gmsh.inp", "runway_girder", "support_feet"),
        ("meshio.inp", "girder", "feet"),
    ] {
        let bytes = text(&format!("meshes/{file}"));
        let read = |options: &ImportOptions| from_memory(file, &[(file, &bytes)], options);
        let asked = ImportOptions {
            fix: vec![
                format!("{feet}=ux,uy,uz,rx,ry,rz")
                    .parse()
                    .expect("a support"),
            ],
            rails: vec![format!("crane={girder}").parse().expect("a rail")],
            ..options(girder)
        };
        let imported = read(&asked).unwrap_or_else(|wrong| panic!("{file}: {}", told(&wrong)));
        let spec = json(&imported);
        assert_eq!(spec["points"].as_array().map(Vec::len), Some(15), "{file}");
        assert_eq!(
            spec["cells"][0]["data"].as_array().map(Vec::len),
            Some(15),
            "{file}"
        );
        assert_eq!(spec["cell_sets"]["brace"], value!([[14]]), "{file}");
        assert_eq!(spec["supports"].as_array().map(Vec::len), Some(3), "{file}");
        let model = frame(&imported).model;
        assert_eq!(model.members[14].kind, fea::MemberKind::Truss, "{file}");
        let wrong = told(&read(&options("other")).expect_err("a set without a section"));
        assert!(
            wrong.contains("must be in exactly one set of elements that the sections file defines"),
            "{file}: {wrong}"
        );
        let wrong = told(&read(&plain()).expect_err("no sections"));
        assert!(wrong.contains("--sections"), "{file}: {wrong}");
    }
}

#[test]
fn a_file_read_with_a_sections_file_loses_nothing_silently() {
    let options = |skip: &[&str]| ImportOptions {
        length: Some(Length::Millimetre),
        up: Some([0.0, 0.0, 1.0]),
        sections: Some(Source {
            name: "sections.json".to_owned(),
            text: text("meshes/portal.json").replace("runway girder", "girder"),
        }),
        skip: skip.iter().map(|name| (*name).to_owned()).collect(),
        ..ImportOptions::default()
    };
    let lines = text("meshes/meshio.inp");
    let lines = lines.trim_end();
    for (more, name, skip) in [
        ("*BOUNDARY\n1, 1, 6\n", "*BOUNDARY", &["BOUNDARY"][..]),
        ("*MPC\nBEAM, 1, 2\n", "*MPC or *RIGID BODY", &["MPC"]),
        ("*RELEASE\n1, S1, M1\n", "*RELEASE", &["RELEASE"]),
        (
            "*ELEMENT, TYPE=SPRING1, ELSET=s\n901, 1\n*SPRING, ELSET=s\n3\n1.e6\n",
            "SPRING1",
            &["SPRING1", "SPRING"],
        ),
        (
            "*ELEMENT, TYPE=SPRINGA, ELSET=s\n901, 1, 2\n",
            "SPRINGA",
            &["SPRINGA"],
        ),
        ("*ELEMENT, TYPE=MASS, ELSET=s\n901, 1\n", "MASS", &["MASS"]),
    ] {
        let whole = format!("{lines}\n{more}");
        let wrong = told(&input(&whole, &options(&[])).expect_err(more));
        let expected = format!("{name}: is not supported in a file that is read with --sections");
        assert!(wrong.contains(&expected), "{more}: {wrong}");
        let taken = input(&whole, &options(skip))
            .map(|_| ())
            .map_err(|wrong| told(&wrong));
        assert_eq!(taken, Ok(()), "{more}");
    }
}

#[test]
fn an_inp_file_of_nastran_is_read_as_bulk_data() {
    let deck = format!("ID A,B\nCEND\nBEGIN BULK\n{}", text("decks/pinned.bdf"));
    let found = from_memory("deck.inp", &[("deck.inp", &deck)], &plain());
    assert!(found.is_ok(), "{}", told(&found.expect_err("an error")));
    let open = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    assert!(import::import(Path::new("none.inp"), &open, &plain()).is_err());
}
