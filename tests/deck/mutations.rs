//! Decks that are wrong must be told from the simulator.

use adams::{ArgumentValue, DataSet, Statement};
use deck::DeckForm;

use super::{Loaded, example, scene};

/// The text of a deck after a change to the arguments of one statement.
fn changed(
    loaded: &Loaded,
    form: DeckForm,
    keyword: &str,
    id: u32,
    change: impl Fn(&mut Statement),
) -> String {
    let mut set = DataSet::read(&loaded.text(form)).expect("our own text");
    let before = set.clone();
    let one = set
        .statements
        .iter_mut()
        .find(|one| one.keyword == keyword && one.id == Some(id));
    change(one.unwrap_or_else(|| panic!("no {keyword}/{id}")));
    assert_ne!(set, before, "the change changes something");
    set.write().expect("a text")
}

/// Replaces text in the expressions of a statement.
fn replace(statement: &mut Statement, from: &str, to: &str) {
    for argument in &mut statement.arguments {
        if let ArgumentValue::Function(text) = &mut argument.value {
            *text = text.replace(' ', "").replace(from, to);
        }
    }
}

fn caught(loaded: &Loaded, form: DeckForm, text: &str, what: &str) {
    let report = loaded.check(form, text, 60);
    assert!(
        !report.holds(),
        "{what} goes unseen:\n{}",
        report.lines().join("\n")
    );
}

#[test]
fn a_cross_term_that_is_missing_or_of_the_wrong_place_is_caught() {
    let loaded = Loaded::new(&example("bogie"));
    for (from, to) in [
        ("-VARVAL(205)*AKISPL(VARVAL(201),VARVAL(101),6)", ""),
        (
            "AKISPL(VARVAL(201),VARVAL(101),6)",
            "AKISPL(VARVAL(201),VARVAL(201),6)",
        ),
        (
            "AKISPL(VARVAL(201),VARVAL(101),6)",
            "AKISPL(VARVAL(101),VARVAL(201),6)",
        ),
    ] {
        let text = changed(&loaded, DeckForm::Akispl, "VARIABLE", 102, |one| {
            replace(one, from, to)
        });
        caught(&loaded, DeckForm::Akispl, &text, from);
    }
}

#[test]
fn wrong_signs_are_caught() {
    let loaded = Loaded::new(&scene("crane"));
    for (component, from, to) in [
        ("FY", "VARVAL(105)", "-VARVAL(105)"),
        ("FZ", "-VARVAL(107)", "VARVAL(107)"),
        ("TZ", "-(", "("),
    ] {
        let text = changed(&loaded, DeckForm::Factored, "GFORCE", 1, |one| {
            for argument in one
                .arguments
                .iter_mut()
                .filter(|argument| argument.name == component)
            {
                if let ArgumentValue::Function(text) = &mut argument.value {
                    *text = text.replace(' ', "").replacen(from, to, 1);
                }
            }
        });
        caught(&loaded, DeckForm::Factored, &text, component);
    }
    // the force along the rail, the rail's rise in the gap, the flange's side
    for (id, from, to) in [
        (109, "-VARVAL(105)", "VARVAL(105)"),
        (104, "-VARVAL(102)", "+VARVAL(102)"),
    ] {
        let text = changed(&loaded, DeckForm::Factored, "VARIABLE", id, |one| {
            replace(one, from, to)
        });
        caught(&loaded, DeckForm::Factored, &text, from);
    }
}

#[test]
fn velocities_without_their_fourth_marker_are_caught_on_a_moving_frame() {
    for (path, id, name) in [
        (example("wheel"), 105, "VY("),
        (example("wheel"), 108, "VX("),
    ] {
        let loaded = Loaded::new(&path);
        let text = changed(&loaded, DeckForm::Akispl, "VARIABLE", id, |one| {
            let (from, to) = ("(5,4,4,4)", "(5,4,4)");
            replace(
                one,
                &format!("{name}{}", &from[1..]),
                &format!("{name}{}", &to[1..]),
            );
        });
        let report = loaded.check(DeckForm::Akispl, &text, 60);
        assert!(
            report.forces[0].holds(),
            "on a fixed rail three markers are enough"
        );
        assert!(
            !report.forces[1].holds(),
            "{name}\n{}",
            report.lines().join("\n")
        );
    }
}

#[test]
fn displacements_resolved_in_ground_are_caught_on_a_moving_frame() {
    let loaded = Loaded::new(&example("wheel"));
    let text = changed(&loaded, DeckForm::Akispl, "VARIABLE", 104, |one| {
        replace(one, "DY(5,4,4)", "DY(5,4)")
    });
    let report = loaded.check(DeckForm::Akispl, &text, 60);
    assert!(report.forces[0].holds() && !report.forces[1].holds());
}

#[test]
fn a_damper_against_the_ground_is_caught() {
    let loaded = Loaded::new(&example("bogie"));
    let text = changed(&loaded, DeckForm::Akispl, "VARIABLE", 105, |one| {
        replace(one, "+100000.0*DIF1(1)", "-100000.0*VY(5,4,4,4)")
    });
    caught(
        &loaded,
        DeckForm::Akispl,
        &text,
        "a damper against the ground",
    );
}

/// A damper of a body that also has one to ground, whose force determines the speed of the body.
#[test]
fn a_damper_against_the_ground_is_caught_beside_one_that_belongs_there() {
    let text = std::fs::read_to_string(example("bogie")).expect("the scene");
    let mut value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let spec = example("bogie").with_file_name("spec.json");
    value["structures"]["girder"]["spec"] = spec.to_str().expect("a path in UTF-8").into();
    let mut grounded = value["wheels"]["crane"].clone();
    grounded["vertical"]["damper"] = "ground".into();
    value["wheels"]["crane"]["vertical"]["damper"] = "rail".into();
    value["wheels"]["grounded"] = grounded;
    let mut truck = value["trucks"][0].clone();
    truck["name"] = "second".into();
    truck["wheel"] = "grounded".into();
    truck["tree"] = serde_json::json!([-3.0, 3.0]);
    value["trucks"].as_array_mut().expect("a list").push(truck);
    value.as_object_mut().expect("an object").remove("compare");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.json");
    std::fs::write(&path, value.to_string()).expect("a temporary file");
    let loaded = Loaded::new(&path);
    let form = DeckForm::Factored;
    let right = loaded.check(form, &loaded.text(form), 100);
    assert!(right.holds(), "{}", right.lines().join("\n"));
    for (from, to) in [
        ("+100000.0*DIF1(1)", "-100000.0*VY(5,4,4,4)"),
        ("DIF1(1)", "DIF1(2)"),
    ] {
        let text = changed(&loaded, form, "VARIABLE", 105, |one| replace(one, from, to));
        caught(&loaded, form, &text, to);
    }
}

#[test]
fn another_exponent_is_caught() {
    let loaded = Loaded::new(&example("wheel"));
    let text = changed(&loaded, DeckForm::Akispl, "VARIABLE", 105, |one| {
        replace(one, ",1.1,", ",1.0,")
    });
    caught(&loaded, DeckForm::Akispl, &text, "exponent 1");
}

#[test]
fn a_rail_whose_origin_is_shifted_is_caught() {
    let loaded = Loaded::new(&example("bogie"));
    let text = changed(&loaded, DeckForm::Factored, "MARKER", 4, |one| {
        for argument in one
            .arguments
            .iter_mut()
            .filter(|argument| argument.name == "QP")
        {
            argument.value = ArgumentValue::Numbers(vec![1e-9, 0.0, 0.0]);
        }
    });
    caught(&loaded, DeckForm::Factored, &text, "a shift of 1e-9 ft");
}

#[test]
fn masses_in_another_unit_and_other_motions_are_caught_by_the_path() {
    let loaded = Loaded::new(&example("bogie"));
    let heavier = changed(&loaded, DeckForm::Akispl, "PART", 2, |one| {
        for argument in one
            .arguments
            .iter_mut()
            .filter(|argument| argument.name == "MASS")
        {
            if let ArgumentValue::Numbers(all) = &mut argument.value {
                all[0] *= 32.174;
            }
        }
    });
    let faster = changed(&loaded, DeckForm::Akispl, "MOTION", 1, |one| {
        replace(one, "5.0*TIME", "5.001*TIME")
    });
    for text in [heavier, faster] {
        let report = loaded.check(DeckForm::Akispl, &text, 20);
        assert!(
            report
                .forces
                .iter()
                .all(deck::check::CheckDifference::holds)
        );
        assert!(report.path.is_some_and(|path| !path.holds()));
    }
}

#[test]
fn a_value_of_a_table_that_is_off_by_a_millionth_is_caught() {
    let loaded = Loaded::new(&example("bogie"));
    let text = changed(&loaded, DeckForm::Symmetrised, "SPLINE", 6, |one| {
        let rows = one
            .arguments
            .iter_mut()
            .filter(|argument| argument.name == "Y");
        for argument in rows.skip(3).take(1) {
            if let ArgumentValue::Numbers(all) = &mut argument.value {
                all[4] *= 1.0 + 1e-6;
            }
        }
    });
    caught(&loaded, DeckForm::Symmetrised, &text, "a value");
}
