//! Meshes written by gmsh.

use std::path::Path;

use fea::MemberKind;
use formats::text::diagnostic::Diagnostic;
use formats::text::source::Source;
use formats::units::Length;
use import::{ImportOptions, Imported, import};
use serde_json::json as value;

use super::{displacements, folder, frame, json, text, told};

fn options(sections: &str) -> ImportOptions {
    let name = format!("meshes/{sections}");
    ImportOptions {
        length: Some(Length::Millimetre),
        up: Some([0.0, 0.0, 1.0]),
        sections: Some(Source {
            text: text(&name),
            name,
        }),
        ..ImportOptions::default()
    }
}

fn mesh(name: &str, options: &ImportOptions) -> Result<Imported, Vec<Diagnostic>> {
    import(
        &folder().join("meshes").join(name),
        &|path| std::fs::read(path),
        options,
    )
}

fn portal() -> ImportOptions {
    ImportOptions {
        rails: vec![
            "crane=runway girder/offset=0,0,0.2"
                .parse()
                .expect("a rail"),
        ],
        fix: vec!["support feet=ux,uy,uz,rx,ry,rz".parse().expect("a support")],
        ..options("portal.json")
    }
}

#[test]
fn physical_names_become_sections_and_sets() {
    let imported = mesh("portal.msh", &portal()).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    assert!(imported.warnings.is_empty(), "{}", told(&imported.warnings));
    let spec = json(&imported);
    // the mesh is in mm, its sections in m: so is the spec
    assert_eq!(
        spec["units"],
        value!({ "length": "m", "force": "kN", "time": "s" })
    );
    assert_eq!(spec["points"].as_array().map(Vec::len), Some(15));
    assert_eq!(spec["points"][4], value!([6.0, 0.0, 4.0]));
    assert_eq!(
        spec["point_sets"],
        value!({ "middle": [4], "support feet": [0, 1, 2] })
    );
    assert_eq!(
        spec["cell_sets"],
        value!({ "brace": [[14]], "column": [[0, 1, 2, 3, 4, 5]], "runway girder": [[6, 7, 8, 9, 10, 11, 12, 13]] })
    );
    let frame = frame(&imported);
    let [column, girder, brace] = [0, 6, 14].map(|index| frame.model.members[index]);
    assert_eq!(
        (column.kind, column.section, column.orientation),
        (MemberKind::Beam, 0, [1.0, 0.0, 0.0])
    );
    assert_eq!((girder.section, girder.orientation), (1, [0.0, 0.0, 1.0]));
    assert_eq!((brace.kind, brace.section), (MemberKind::Truss, 2));
    assert_eq!(frame.model.supports.len(), 3);
    let (_, rail) = &frame.rails[0];
    assert_eq!(rail.axis, [1.0, 0.0, 0.0]);
    assert_eq!((rail.stations.len(), frame.ranges[0]), (9, [0.0, 12.0]));
    // it can be solved
    let solved = fea::FactoredFrame::new(&frame.model, std::slice::from_ref(rail))
        .expect("a structure that stands");
    assert!(solved.certificate().error_bound < 1e-6);
}

#[test]
fn a_mesh_that_saves_everything_is_the_same() {
    let wanted = mesh("portal.msh", &portal())
        .expect("a mesh")
        .text
        .replace("\"portal\"", "");
    let all = mesh("portal_all.msh", &portal()).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let [all, wanted] = [all.text.replace("\"portal_all\"", ""), wanted].map(|text| {
        let value: serde_json::Value =
            serde_json::from_str(&text.replace("\"name\": ,", "")).expect("JSON");
        value
    });
    // element numbers shift, nothing else
    assert_eq!(all, wanted);
}

#[test]
fn every_format_of_a_mesh_gives_the_same_spec() {
    let without_name = |imported: &Imported| {
        let mut spec = json(imported);
        spec["name"] = value!("portal");
        spec
    };
    // the text has one digit less than the numbers
    let mut wanted = without_name(&mesh("portal.msh", &portal()).expect("a mesh"));
    let numbers = |spec: &serde_json::Value| -> Vec<f64> {
        let points = spec["points"].as_array().expect("points").iter();
        points
            .flat_map(|point| point.as_array().expect("a point"))
            .filter_map(serde_json::Value::as_f64)
            .collect()
    };
    let places = numbers(&wanted);
    let drop_numbers = |spec: &mut serde_json::Value| {
        spec["points"] = value!(null);
        spec["rails"]["crane"]["stations"] = value!(null);
    };
    drop_numbers(&mut wanted);
    for name in ["portal_22.msh", "portal_binary.msh", "portal_22_binary.msh"] {
        let found =
            mesh(name, &portal()).unwrap_or_else(|wrong| panic!("{name}: {}", told(&wrong)));
        let mut found = without_name(&found);
        for (found, wanted) in numbers(&found).iter().zip(&places) {
            assert!(
                (found - wanted).abs() < 1e-14 * wanted.abs().max(1.0),
                "{name}: {found} {wanted}"
            );
        }
        drop_numbers(&mut found);
        assert_eq!(found, wanted, "{name}");
    }
}

#[test]
fn a_binary_mesh_that_is_cut_off_is_refused() {
    for name in ["portal_binary.msh", "portal_22_binary.msh"] {
        let whole = std::fs::read(folder().join("meshes").join(name)).expect("a mesh");
        let read = |bytes: &[u8]| import(Path::new("cut.msh"), &|_| Ok(bytes.to_vec()), &portal());
        assert!(read(&whole).is_ok());
        let mut dice = fastrand::Rng::with_seed(13);
        for length in (1..whole.len() - 2).step_by(7) {
            let wrong = read(&whole[..length]).expect_err("cut off");
            assert!(!told(&wrong).is_empty());
        }
        // damaged bytes are refused or taken, without a panic
        for _ in 0..3000 {
            let mut bytes = whole.clone();
            for _ in 0..=dice.usize(..4) {
                let at = dice.usize(..bytes.len());
                bytes[at] = [0, 1, 0x7f, 0xff, dice.u8(..)][dice.usize(..5)];
            }
            let _refused_or_taken = read(&bytes);
        }
    }
}

#[test]
fn elements_that_are_no_lines_are_left_out_by_name() {
    let options = ImportOptions {
        length: Some(Length::Metre),
        ..options("plate.json")
    };
    let imported = mesh("plate.msh", &options).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let warned = told(&imported.warnings);
    assert!(warned.contains("triangles are ignored"), "{warned}");
    let spec = json(&imported);
    assert_eq!(spec["cells"][0]["data"].as_array().map(Vec::len), Some(10));
    assert_eq!(spec["points"].as_array().map(Vec::len), Some(11));
}

#[test]
fn other_versions_are_refused_with_the_way_to_convert_them() {
    let wrong = told(&mesh("portal_40.msh", &portal()).expect_err("another format"));
    let part = "must be version 2.2 or 4.1, got 4";
    assert!(wrong.contains(part) && wrong.contains("hint"), "{wrong}");
}

/// The portal meshed with lines of second order: each beam has a point inside it, the brace has none.
#[test]
fn straight_lines_of_three_nodes_are_members_with_a_point_inside() {
    let [first, second] = ["portal.msh", "portal_order_2.msh"].map(|name| {
        mesh(name, &portal()).unwrap_or_else(|wrong| panic!("{name}: {}", told(&wrong)))
    });
    let [one, two] = [&first, &second].map(json);
    let count =
        |spec: &serde_json::Value, key: &str| spec["cell_sets"][key][0].as_array().map(Vec::len);
    for set in ["column", "runway girder", "brace"] {
        let own = count(&one, set).map(|count| if set == "brace" { count } else { 2 * count });
        assert_eq!(count(&two, set), own, "{set}");
    }
    // members are exact, so that points inside them change no displacement
    let load = [1e3, 2e3, 3e3, 0.0, 0.0, 0.0];
    let [one, two] = [&first, &second].map(|model| displacements(&frame(model), &["middle"], load));
    assert!((&one - &two).amax() < 1e-10 * two.amax(), "{one} {two}");
}

const LINE: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n0 1 \"foot\"\n1 3 \"girder\"\n$EndPhysicalNames\n\
    $Nodes\n3\n1 0 0 0\n2 4000 0 0\n3 1000 0 0\n$EndNodes\n$Elements\n2\n1 15 2 1 1 1\n2 8 2 3 1 1 2 3\n$EndElements\n";

fn line(mesh: &str, sections: &str) -> Result<Imported, Vec<Diagnostic>> {
    let options = ImportOptions {
        length: Some(Length::Millimetre),
        up: Some([0.0, 0.0, 1.0]),
        sections: Some(Source {
            name: "sections.json".to_owned(),
            text: sections.to_owned(),
        }),
        rails: vec!["r=girder".parse().expect("a rail")],
        ..ImportOptions::default()
    };
    import(
        Path::new("line.msh"),
        &|_| Ok(mesh.as_bytes().to_vec()),
        &options,
    )
}

#[test]
fn sections_of_meshes_are_those_of_specs() {
    let sections = r#"{"format": "girderway-sections/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "materials": [{"name": "S235", "E": 2.1e8, "G": 8.1e7, "density": 7.85, "fy": 235e3}],
        "sections": [{"name": "girder", "material": "S235", "shape": "HEB 400", "points": [{"name": "top", "y": 0.2}]},
         {"name": "box", "material": "S235", "J": 0, "shape": {"kind": "box", "length": "mm", "height": 500, "width": 300, "flange": 20, "web": 10}}]}"#;
    let imported = line(LINE, sections).unwrap_or_else(|wrong| panic!("{}", told(&wrong)));
    let spec = json(&imported);
    let written: serde_json::Value = serde_json::from_str(sections).expect("JSON");
    for key in ["materials", "sections"] {
        assert_eq!(spec[key], written[key], "{key}");
    }
    // HEB 400: A = 197.8 cm2, Iy = 57,680 cm4 (tables of EN 10365)
    let heb = &frame(&imported).model.sections[0];
    assert!((heb.area / 197.8e-4 - 1.0).abs() < 1e-3, "{}", heb.area);
    assert!((heb.iz / 57_680e-8 - 1.0).abs() < 1e-3, "{}", heb.iz);
    assert_eq!(spec["rails"]["r"]["stations"], value!([0.0, 1.0, 4.0]));
    // faults are those of specs, at their places in the file of sections
    for (old, new, part) in [
        ("HEB 400", "HEB 401", "sections.json:3:"),
        ("235e3", "-1", "sections.json:2:"),
        (
            "\"y\": 0.2",
            "\"x\": 0.2",
            "sections[0].points[0].x: unknown key",
        ),
        ("\"fy\"", "\"fu\"", "materials[0].fu: unknown key"),
    ] {
        let wrong = told(&line(LINE, &sections.replace(old, new)).expect_err(new));
        assert!(wrong.contains(part), "{new}: {wrong}");
    }
}

#[test]
fn results_in_a_mesh_may_occur_again_and_again() {
    let sections = text("meshes/portal.json");
    let plain = mesh("portal.msh", &portal()).expect("a mesh").text;
    let data = "$NodeData\n1\n\"u\"\n1\n0.0\n3\n0\n1\n1\n1 0.5\n$EndNodeData\n";
    let data = format!("{data}{data}{0}{0}", data.replace("Node", "Element"));
    let own = std::fs::read(folder().join("meshes/portal.msh")).expect("a mesh");
    let with_mark = [b"\xef\xbb\xbf", own.as_slice(), data.as_bytes()].concat();
    let imported = import(
        Path::new("portal.msh"),
        &|_| Ok(with_mark.clone()),
        &portal(),
    );
    assert_eq!(
        imported
            .unwrap_or_else(|wrong| panic!("{}", told(&wrong)))
            .text,
        plain
    );
    let binary = std::fs::read(folder().join("meshes/portal_binary.msh")).expect("a mesh");
    let more = [binary.as_slice(), data.as_bytes()].concat();
    assert!(import(Path::new("portal.msh"), &|_| Ok(more.clone()), &portal()).is_ok());
    // the sections that define the mesh may not
    let twice = format!("{LINE}{}", &LINE[LINE.find("$Nodes").expect("nodes")..]);
    let wrong = told(&line(&twice, &sections).expect_err("two sections"));
    assert!(wrong.contains("$Nodes: must occur only once"), "{wrong}");
}

#[test]
fn units_and_sections_are_never_guessed() {
    let wrong = mesh("portal.msh", &ImportOptions::default()).expect_err("nothing said");
    let wrong = told(&wrong);
    assert!(
        wrong.contains("with --length") && wrong.contains("with --sections"),
        "{wrong}"
    );
    let no_up = ImportOptions {
        up: None,
        rails: Vec::new(),
        ..portal()
    };
    let wrong = told(&mesh("portal.msh", &no_up).expect_err("no orientation"));
    assert!(wrong.contains("orientation"), "{wrong}");
}
