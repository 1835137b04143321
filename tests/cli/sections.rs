//! Rolled sections and crane rails: their list, and beam specs that name them.

use std::fs;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{base, folder, girderway, json, text};

use crate::common::near;

use near::assert_near;

/// What `girderway sections --json` has of one section and one rail by name.
fn listed(folder: &TempDir, kind: &str, name: &str) -> Value {
    let run = girderway(folder, &["sections", name, "--json"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let all = json(&run.stdout);
    let found = all[kind]
        .as_array()
        .and_then(|all| all.iter().find(|one| one["name"] == name));
    found.expect("a section of this name").clone()
}

/// The output of a command on a spec, and what it says.
fn solved(folder: &TempDir, spec: &Value, flags: &[&str]) -> (Value, String) {
    fs::write(folder.path().join("spec.json"), spec.to_string()).expect("a file");
    let run = girderway(folder, &[&["fea", "spec.json"], flags].concat());
    assert!(run.status.success(), "{}", text(&run.stderr));
    (json(&run.stdout), text(&run.stderr).to_owned())
}

/// A girder over three spans with these keys beside `spans`, in mm and N.
fn girder(keys: Value) -> Value {
    let mut girder = json!({ "spans": [6000, 7500, 6000] });
    girder
        .as_object_mut()
        .expect("an object")
        .extend(keys.as_object().expect("an object").clone());
    json!({
        "format": "girderway-beam/1",
        "name": "runway",
        "units": { "length": "mm", "force": "N", "time": "s" },
        "girder": girder,
        "stations": [0, 3000, 9000, 15000, 19500],
    })
}

/// The numbers of a section as keys of a girder in mm and N.
fn numbers(section: &Value) -> Value {
    let area = section["A_mm2"].as_f64().expect("a number");
    json!({
        "E": 210_000, "G": 81_000, "A": area, "I_vertical": section["I_strong_mm4"],
        "I_lateral": section["I_weak_mm4"], "J": section["J_mm4"], "kA_vertical": section["shear_area_web_mm2"],
        "kA_lateral": section["shear_area_flanges_mm2"], "mass_per_length": area * 7.85e-9,
    })
}

#[test]
fn a_girder_by_name_is_the_girder_of_its_numbers() {
    let folder = folder();
    let mut by_hand = numbers(&listed(&folder, "sections", "HEB 400"));
    let (named, said) = solved(
        &folder,
        &girder(json!({ "section": "heb400" })),
        &["--modes", "2"],
    );
    let (plain, silent) = solved(&folder, &girder(by_hand.clone()), &["--modes", "2"]);
    assert_eq!(named["influence"], plain["influence"]);
    let hz = |grid: &Value| {
        grid["modes"]["modes"][0]["hz"]
            .as_f64()
            .expect("a frequency")
    };
    assert_near(
        "first mode",
        "the same girder by its numbers",
        hz(&plain),
        hz(&named),
        1e-12,
    );
    // the numbers that the file does not state are told, without a warning
    assert!(
        said.contains("note: girder: HEB 400 has A = 19778 mm^2, I_vertical = 576810000 mm^4"),
        "{said}"
    );
    assert!(
        said.contains(
            "note: girder: steel by default, E = 210000 N/mm^2, G = 81000 N/mm^2, density"
        ),
        "{said}"
    );
    assert!(
        !said.contains("warning") && !silent.contains("note: girder"),
        "{said}{silent}"
    );

    // numbers beside the name win
    by_hand["E"] = json!(205_000);
    by_hand["kA_vertical"] = json!(7000);
    let stated = json!({ "section": "HEB 400", "E": 205_000, "kA_vertical": 7000 });
    let (named, said) = solved(&folder, &girder(stated), &[]);
    assert_eq!(
        named["influence"],
        solved(&folder, &girder(by_hand), &[]).0["influence"]
    );
    assert!(
        !said.contains("kA_vertical") && !said.contains("E ="),
        "{said}"
    );
}

#[test]
fn a_crane_rail_adds_its_height_and_its_mass() {
    let folder = folder();
    let mut by_hand = numbers(&listed(&folder, "sections", "HEB 400"));
    by_hand["rail_height"] = json!(285);
    by_hand["mass_per_length"] =
        json!(by_hand["mass_per_length"].as_f64().expect("a number") + 56.2e-6);
    let named = json!({ "section": "HEB 400", "crane_rail": "A75", "rail_height": 200 });
    let (named, said) = solved(&folder, &girder(named), &["--modes", "1"]);
    let (plain, _) = solved(&folder, &girder(by_hand), &["--modes", "1"]);
    assert_eq!(named["influence"], plain["influence"]);
    let hz = |grid: &Value| {
        grid["modes"]["modes"][0]["hz"]
            .as_f64()
            .expect("a frequency")
    };
    assert_near(
        "first mode",
        "mass + 56.2 kg/m",
        hz(&plain),
        hz(&named),
        1e-12,
    );
    assert!(
        said.contains(
            "A75 adds 0.0000562 N s^2/mm^2 (56.2 kg/m) to the mass, 85 mm to rail_height"
        ),
        "{said}"
    );
    assert!(said.contains("rail_height is 285 mm"), "{said}");
}

/// Hand calculation: 600 x 300 mm, flanges 20 mm, web 10 mm: A = 0.0176 m2, I_vertical = (0.3 * 0.6^3 - 0.29 * 0.56^3)/12,
/// I_lateral = (0.04 * 0.3^3 + 0.56 * 0.01^3)/12, J = sum of s t^3/3 over the centre lines, 0.58 m of the web. Numbers beside the shape win, and the mass is that of the density.
#[test]
fn a_girder_takes_the_dimensions_of_its_plates() {
    let folder = folder();
    let shape =
        json!({"kind": "I", "length": "mm", "height": 600, "width": 300, "flange": 20, "web": 10});
    let spec = |keys: Value| {
        let mut spec = json!({
            "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
            "girder": {"spans": [8], "E": 2.1e8, "G": 8.1e7}, "stations": [0, 2, 4, 8],
        });
        let girder = spec["girder"].as_object_mut().expect("an object");
        girder.extend(keys.as_object().expect("an object").clone());
        spec
    };
    let (area, lateral) = (
        0.0176,
        (0.04 * 0.3f64.powi(3) + 0.56 * 0.01f64.powi(3)) / 12.0,
    );
    let vertical = (0.3 * 0.6f64.powi(3) - 0.29 * 0.56f64.powi(3)) / 12.0;
    let torsion = (0.6 * 0.02f64.powi(3) + 0.58 * 0.01f64.powi(3)) / 3.0;
    let by_hand = |vertical: f64, mass: f64| {
        spec(
            json!({"A": area, "I_vertical": vertical, "I_lateral": lateral, "J": torsion, "mass_per_length": mass}),
        )
    };
    let (drawn, said) = solved(
        &folder,
        &spec(json!({"shape": shape, "density": 7.85})),
        &["--modes", "2"],
    );
    let (plain, _) = solved(&folder, &by_hand(vertical, 7.85 * area), &["--modes", "2"]);
    assert_grids_agree(&drawn, &plain, 1e-12);
    for k in 0..2 {
        let hz = |grid: &Value| {
            grid["modes"]["modes"][k]["hz"]
                .as_f64()
                .expect("a frequency")
        };
        assert_near(
            format_args!("mode {}", k + 1),
            "numbers by hand",
            hz(&plain),
            hz(&drawn),
            1e-10,
        );
    }
    assert!(
        said.contains("note: girder: its shape has A = 0.0176 m^2"),
        "{said}"
    );
    let (own, _) = solved(
        &folder,
        &spec(json!({"shape": shape, "I_vertical": 1e-3})),
        &[],
    );
    assert_grids_agree(&own, &solved(&folder, &by_hand(1e-3, 0.0), &[]).0, 1e-12);
}

#[test]
fn a_composite_rail_is_a_part_of_the_plane_section() {
    let folder = folder();
    let section = listed(&folder, "sections", "HEB 400");
    let rail = listed(&folder, "crane_rails", "A75");
    let of = |value: &Value, key: &str| value[key].as_f64().expect("a number");
    let (own, part) = (of(&section, "A_mm2"), of(&rail, "A_mm2"));
    let distance = 200.0 + of(&rail, "centroid_mm");
    let steiner = own * part / (own + part) * distance * distance;
    let mut by_hand = numbers(&section);
    by_hand["A"] = json!(own + part);
    by_hand["I_vertical"] =
        json!(of(&section, "I_strong_mm4") + of(&rail, "I_vertical_mm4") + steiner);
    by_hand["I_lateral"] = json!(of(&section, "I_weak_mm4") + of(&rail, "I_lateral_mm4"));
    by_hand["rail_height"] = json!(285);
    let keys =
        json!({ "section": "HEB 400", "crane_rail": "A75", "rail_height": 200, "composite": true });
    let (named, said) = solved(&folder, &girder(keys), &[]);
    let (plain, _) = solved(&folder, &girder(by_hand), &[]);
    assert_grids_agree(&named, &plain, 1e-12);
    assert!(
        said.contains("composite with the rail A75, A = 26938 mm^2"),
        "{said}"
    );
}

/// Asserts that all blocks of two grids agree to a fraction of the largest value of each block.
fn assert_grids_agree(found: &Value, known: &Value, tolerance: f64) {
    let entries = |block: &Value| -> Vec<f64> {
        let rows = block
            .as_array()
            .expect("rows")
            .iter()
            .flat_map(|row| row.as_array().expect("a row"));
        rows.map(|value| value.as_f64().expect("a number"))
            .collect()
    };
    let blocks = known["influence"].as_object().expect("blocks");
    assert!(!blocks.is_empty());
    for (name, block) in blocks {
        let (known, found) = (entries(block), entries(&found["influence"][name]));
        assert_eq!(known.len(), found.len(), "{name}");
        let largest = known
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        for (one, other) in known.iter().zip(&found) {
            assert!(
                (one - other).abs() <= tolerance * largest,
                "{name}: {one:e} {other:e}"
            );
        }
    }
}

/// The base frame, whose girder has the properties of HEB 400, with a rail 0.2 m above its axis.
fn frame(edit: impl Fn(&mut Value)) -> Value {
    let mut spec = json(&fs::read(base("frame.json")).expect("the base frame"));
    spec["rails"]["top"]["segments"][0]["offset"] = json!([0, 0.2, 0]);
    edit(&mut spec);
    spec
}

#[test]
fn a_frame_takes_a_section_by_name_and_crane_rails_on_its_members() {
    let folder = folder();
    let section = listed(&folder, "sections", "HEB 400");
    let of = |value: &Value, key: &str, unit: f64| value[key].as_f64().expect("a number") * unit;
    let area = of(&section, "A_mm2", 1e-6);
    let by_hand = |extra: f64| {
        json!({
            "name": "girder", "material": "own", "A": area, "Iy": of(&section, "I_weak_mm4", 1e-12),
            "Iz": of(&section, "I_strong_mm4", 1e-12) + extra, "J": of(&section, "J_mm4", 1e-12),
            "Asy": of(&section, "shear_area_web_mm2", 1e-6), "Asz": of(&section, "shear_area_flanges_mm2", 1e-6),
        })
    };
    let named = frame(|spec| {
        spec["sections"][1] = json!({ "name": "girder", "material": "steel", "shape": "HE 400 B" });
        spec["rails"]["top"]["crane_rail"] = json!("A75");
    });
    let plain = frame(|spec| {
        let steel = &spec["materials"][0];
        let density = 7.85 + 0.0562 / area;
        let own = json!({ "name": "own", "E": steel["E"], "G": steel["G"], "density": density });
        spec["materials"] = json!([steel, own]);
        spec["sections"][1] = by_hand(0.0);
        spec["rails"]["top"]["segments"][0]["offset"] = json!([0, 0.285, 0]);
    });
    let (named, said) = solved(&folder, &named, &["--modes", "3"]);
    let (plain, _) = solved(&folder, &plain, &["--modes", "3"]);
    assert_grids_agree(&named, &plain, 1e-12);
    for k in 0..3 {
        let hz = |grid: &Value| {
            grid["modes"]["modes"][k]["hz"]
                .as_f64()
                .expect("a frequency")
        };
        assert_near(
            format_args!("mode {}", k + 1),
            "the same frame by numbers",
            hz(&plain),
            hz(&named),
            1e-10,
        );
    }
    assert!(
        said.contains("note: section \"girder\": HEB 400 has A = 0.019778 m^2"),
        "{said}"
    );
    assert!(
        said.contains("note: rail \"top\": the crane rail A75 adds 0.0562 kN s^2/m^2"),
        "{said}"
    );

    // the rail as a part of the section; the other members of the section keep theirs
    let rail = listed(&folder, "crane_rails", "A75");
    let (part, distance) = (
        of(&rail, "A_mm2", 1e-6),
        0.2 + of(&rail, "centroid_mm", 1e-3),
    );
    let steiner = area * part / (area + part) * distance * distance;
    let named = frame(|spec| {
        spec["sections"][1] = json!({ "name": "girder", "material": "steel", "shape": "HEB 400" });
        spec["rails"]["top"]["crane_rail"] = json!("A75");
        spec["rails"]["top"]["composite"] = json!(true);
        spec["cell_data"]["section"][0] = json!([1, 1, 1]);
    });
    let plain = frame(|spec| {
        let mut column = by_hand(0.0);
        column["material"] = json!("steel");
        let mut girder = by_hand(of(&rail, "I_vertical_mm4", 1e-12) + steiner);
        girder["material"] = json!("steel");
        girder["A"] = json!(area + part);
        girder["Iy"] =
            json!(girder["Iy"].as_f64().expect("a number") + of(&rail, "I_lateral_mm4", 1e-12));
        column["name"] = json!("column");
        spec["sections"][0] = column;
        spec["sections"][1] = girder;
        spec["rails"]["top"]["segments"][0]["offset"] = json!([0, 0.285, 0]);
    });
    assert_grids_agree(
        &solved(&folder, &named, &[]).0,
        &solved(&folder, &plain, &[]).0,
        1e-12,
    );
}

#[test]
fn two_wheels_on_a_girder_by_name_have_the_moments_of_another_code() {
    // HEB 400 over 6 / 7.5 / 6 m, two wheels of 180 kN at 3.6 m, no dead load; A = 0.01978 m2, I = 5.768e-4 m4, shear area 0.00508 m2.
    // The other model has these rounded values
    let folder = folder();
    let spec = json!({
        "format": "girderway-beam/1", "units": { "length": "m", "force": "kN", "time": "s" },
        "girder": { "spans": [6, 7.5, 6], "section": "HEB 400" }, "stations": [0, 6, 13.5, 19.5],
    });
    let design = json!({
        "format": "girderway-design/1", "name": "runway", "units": { "length": "m", "force": "kN", "time": "s" },
        "spec": "spec.json",
        "trains": [{ "name": "crane", "wheels": [{ "x": 0, "vertical": 180 }, { "x": 3.6, "vertical": 180 }] }],
    });
    fs::write(folder.path().join("spec.json"), spec.to_string()).expect("a file");
    fs::write(folder.path().join("design.json"), design.to_string()).expect("a file");
    let run = girderway(&folder, &["design", "design.json", "-o", "out"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(
        text(&run.stderr).contains("note: girder: HEB 400 has"),
        "{}",
        text(&run.stderr)
    );
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    assert!(
        summary["notes"][0]
            .as_str()
            .is_some_and(|note| note.starts_with("girder: HEB 400 has A = 0.0197"))
    );
    let extreme = |quantity: &str, kind: &str| -> f64 {
        let all = summary["extremes"].as_array().expect("extremes").iter();
        let own = all.filter(|one| {
            one["quantity"] == quantity
                && one["kind"] == kind
                && one["plane"] == "vertical"
                && one["value"].is_f64()
        });
        let values = own.map(|one| one["value"].as_f64().expect("a number"));
        values.fold(0.0, |most: f64, value| {
            if value.abs() > most.abs() {
                value
            } else {
                most
            }
        })
    };
    let source = "independent Timoshenko model, elements of 0.05 m";
    assert_near(
        "largest moment",
        source,
        241.556,
        extreme("moment", "max"),
        2e-5,
    );
    assert_near(
        "smallest moment",
        source,
        -194.083,
        extreme("moment", "min"),
        2e-5,
    );
    assert_near(
        "largest deflection",
        source,
        9.642e-3,
        extreme("deflection", "max"),
        6e-5,
    );
}

#[test]
fn a_run_says_what_the_names_of_its_spec_give() {
    let folder = folder();
    let mut spec = json(&fs::read(base("spec.json")).expect("the base spec"));
    spec["girder"] = json!({ "spans": [60], "overhangs": [15, 15], "section": "W36x302", "crane_rail": "ASCE 85" });
    fs::write(folder.path().join("spec.json"), spec.to_string()).expect("a file");
    fs::copy(base("scene.json"), folder.path().join("scene.json")).expect("a scene");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    assert!(
        text(&run.stderr).contains("bridge: girder: W36X302 has A = "),
        "{}",
        text(&run.stderr)
    );
    let summary = fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
    assert!(
        summary.contains("bridge: girder: the crane rail ASCE 85 adds"),
        "{summary}"
    );
}

#[test]
fn sections_are_listed_by_parts_of_their_names() {
    let folder = folder();
    let lines = |arguments: &[&str]| -> Vec<String> {
        let run = girderway(&folder, &[&["sections"], arguments].concat());
        assert!(run.status.success(), "{}", text(&run.stderr));
        text(&run.stdout).lines().map(str::to_owned).collect()
    };
    let found = lines(&["heb", "400"]);
    assert_eq!(found.len(), 3, "{found:?}");
    let cells: Vec<&str> = found[2].split_whitespace().collect();
    assert_eq!(
        cells,
        [
            "HEB", "400", "400", "300", "13.5", "24", "27", "197.8", "57681", "10819", "355.7",
            "50.76", "120", "155.3"
        ]
    );
    // W shapes also in inches and lb/ft
    let found = lines(&["w24x94"]);
    assert!(
        found
            .iter()
            .any(|line| line.starts_with("W24X94  24.3  9.07  0.515  0.875  0.505  27.7")),
        "{found:?}"
    );
    // rails, also by their other names
    assert!(lines(&["a75"])[2].ends_with("56.2  DIN 536-1"));
    assert!(lines(&["ASCE 135"])[2].starts_with("CR 135"));
    assert!(lines(&[]).len() > 90 + 2 * 289);

    let run = girderway(&folder, &["sections", "HEB 410"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(run.stdout.is_empty());
    assert!(
        text(&run.stderr).contains("got \"HEB 410\"  hint: did you mean \"HEB 400\", \"HEB 450\""),
        "{run:?}"
    );
}
