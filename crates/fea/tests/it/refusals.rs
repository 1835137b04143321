//! Models and loads that are refused, with the name of the entry.

use crate::common;

use common::{mill, paper, probes};
use fea::{
    BeamTheory, Dof, EntryAttribute, EntryFault, Error, FactoredFrame, Girder, ModelEntry, grid,
    point_compliance, surface,
};
use splines::{Axis, Compliance, Influence, Probe};

fn refusal(model: &fea::Model) -> Error {
    FactoredFrame::new(model, &[]).expect_err("a refusal")
}

#[test]
fn girder_without_vertical_supports_is_a_mechanism_by_name() {
    let (mut model, _) = paper().model_and_rail().expect("sound");
    for support in &mut model.supports {
        support.fixed[Dof::Uy as usize] = false;
    }
    let Error::Mechanism { dof: freedom, .. } = refusal(&model) else {
        panic!("{:?}", refusal(&model))
    };
    assert!(matches!(freedom, Dof::Uy | Dof::Rz), "{freedom}");
}

#[test]
fn girder_free_along_its_axis_is_a_mechanism_by_name() {
    let (mut model, _) = paper().model_and_rail().expect("sound");
    model.supports[0].fixed[Dof::Ux as usize] = false;
    assert!(
        matches!(refusal(&model), Error::Mechanism { dof: Dof::Ux, .. }),
        "{:?}",
        refusal(&model)
    );
}

#[test]
fn girder_free_to_twist_is_a_mechanism_by_name() {
    let (mut model, _) = paper().model_and_rail().expect("sound");
    for support in &mut model.supports {
        support.fixed[Dof::Rx as usize] = false;
    }
    assert!(
        matches!(refusal(&model), Error::Mechanism { dof: Dof::Rx, .. }),
        "{:?}",
        refusal(&model)
    );
}

#[test]
fn hinge_that_makes_a_span_fold_is_a_mechanism_at_that_point() {
    // Three points in a row on two end supports, a hinge at the middle one.
    let girder = Girder {
        spans: vec![30.0, 30.0],
        e: 4.32e9,
        i_vertical: 9.528,
        ..Girder::default()
    };
    let (mut model, _) = girder.model_and_rail().expect("sound");
    model.supports.remove(1);
    model.members[1].releases[0][Dof::Rz as usize] = true;
    let Error::Mechanism {
        point,
        dof: freedom,
    } = refusal(&model)
    else {
        panic!("{:?}", refusal(&model))
    };
    assert_eq!(point, 1);
    assert!(matches!(freedom, Dof::Uy | Dof::Rz), "{freedom}");
}

#[test]
fn mechanism_in_a_large_structure_is_found() {
    // The far end of a roof tie without its support: the truss can swing there.
    let (mut model, _) = mill(BeamTheory::Timoshenko);
    model.supports.retain(|support| support.point != 41);
    model.springs.retain(|spring| spring.point != 41);
    let Error::Mechanism {
        point,
        dof: freedom,
    } = refusal(&model)
    else {
        panic!("{:?}", refusal(&model))
    };
    assert_eq!((point, freedom), (41, Dof::Uy));
}

#[test]
fn released_sets_with_an_inner_mechanism_are_refused() {
    let (model, _) = paper().model_and_rail().expect("sound");
    for (releases, end, dof) in [
        ([[Dof::Ux], [Dof::Ux]], 1, Dof::Ux),
        ([[Dof::Rx], [Dof::Rx]], 1, Dof::Rx),
    ] {
        let mut model = model.clone();
        for (k, set) in releases.iter().enumerate() {
            set.iter()
                .for_each(|f| model.members[1].releases[k][*f as usize] = true);
        }
        assert_eq!(
            refusal(&model),
            Error::Released {
                member: 1,
                end,
                dof
            }
        );
    }
    let mut model = model;
    for (end, freedom) in [(0, Dof::Rz), (1, Dof::Rz), (0, Dof::Uy)] {
        model.members[1].releases[end][freedom as usize] = true;
    }
    assert!(matches!(refusal(&model), Error::Released { member: 1, .. }));
}

#[test]
fn absent_stiffness_refuses_only_the_directions_that_need_it() {
    let girder = Girder {
        spans: vec![60.0],
        overhangs: [15.0; 2],
        e: 4.32e9,
        i_vertical: 9.528,
        rail_height: 3.0,
        ..Girder::default()
    };
    let available = |girder: &Girder| {
        let (model, rail) = girder.model_and_rail().expect("sound");
        let frame = FactoredFrame::new(&model, &[rail]).expect("vertical is stiff");
        Axis::ALL.map(|axis| frame.resists(0, axis))
    };
    assert_eq!(available(&girder), [false, true, false]);
    let girder = Girder {
        area: Some(1.0),
        ..girder
    };
    assert_eq!(available(&girder), [true, true, false]);
    let girder = Girder {
        i_lateral: Some(0.9),
        ..girder
    };
    assert_eq!(
        available(&girder),
        [true, true, false],
        "the rail stands off the axis: twist matters"
    );
    assert_eq!(
        available(&Girder {
            rail_height: 0.0,
            ..girder.clone()
        }),
        [true, true, true]
    );
    let girder = Girder {
        j: Some(0.6),
        g: Some(1.66e9),
        ..girder
    };
    assert_eq!(available(&girder), [true, true, true]);
}

#[test]
fn unstiffened_directions_are_refused_by_grid_and_surface_alike() {
    let girder = Girder {
        spans: vec![60.0],
        e: 4.32e9,
        i_vertical: 9.528,
        ..Girder::default()
    };
    let (model, rail) = girder.model_and_rail().expect("sound");
    let rails = [rail];
    let at = [Probe {
        rail: 0,
        x: 20.0,
        axis: Axis::Lateral,
    }];
    let refused = splines::Error::NoStiffness {
        rail: 0,
        x: 20.0,
        axis: Axis::Lateral,
    };
    assert_eq!(
        grid(&model, &rails, &at).err(),
        Some(Error::Rail(refused.clone()))
    );
    let exact = surface(&model, &rails).expect("vertical is stiff");
    assert_eq!(
        exact.surface.fill(&at, &mut Influence::zeros(1)).err(),
        Some(refused)
    );
}

#[test]
fn freedoms_that_nothing_stiffens_are_infinite_in_nodal() {
    let girder = Girder {
        spans: vec![60.0],
        overhangs: [15.0, 0.0],
        e: 4.32e9,
        i_vertical: 9.528,
        ..Girder::default()
    };
    let (model, _) = girder.model_and_rail().expect("sound");
    let (value, _) = point_compliance(&model, &[0]).expect("solvable");
    for k in 0..6 {
        assert_eq!(
            value[(k, k)].is_finite(),
            k == 1 || k == 5,
            "degree of freedom {k}"
        );
    }
}

#[test]
fn places_off_the_rail_are_refused() {
    let (model, mut rail) = paper().model_and_rail().expect("sound");
    let at = probes(Axis::Vertical, &[75.1]);
    let refused = splines::Error::OffRail { rail: 0, x: 75.1 };
    assert_eq!(
        grid(&model, &[rail.clone()], &at).err(),
        Some(Error::Rail(refused))
    );
    rail.stations.push(80.0);
    let item = ModelEntry::Station {
        rail: 0,
        station: 7,
    };
    let refused = Error::Invalid {
        entry: item,
        fault: EntryFault::Uncovered { x: 80.0 },
    };
    assert_eq!(
        FactoredFrame::new(&model, &[rail.clone()]).err(),
        Some(refused)
    );
    rail.stations = vec![0.0, 20.0, 10.0];
    let item = ModelEntry::Station {
        rail: 0,
        station: 2,
    };
    let refused = Error::Invalid {
        entry: item,
        fault: EntryFault::Unsorted { value: 10.0 },
    };
    assert_eq!(FactoredFrame::new(&model, &[rail]).err(), Some(refused));
}

#[test]
fn bad_entries_are_named() {
    let (model, rail) = paper().model_and_rail().expect("sound");
    let fault = |change: &dyn Fn(&mut fea::Model)| {
        let mut model = model.clone();
        change(&mut model);
        match refusal(&model) {
            Error::Invalid { entry: item, fault } => (item, fault),
            other => panic!("{other:?}"),
        }
    };
    let nan = EntryFault::NotFinite {
        quantity: EntryAttribute::Coordinate,
    };
    assert_eq!(
        fault(&|m| m.points[2][1] = f64::NAN),
        (ModelEntry::Point(2), nan)
    );
    assert_eq!(
        fault(&|m| m.members[1].points[0] = 9),
        (ModelEntry::Member(1), EntryFault::NoPoint { point: 9 })
    );
    assert_eq!(
        fault(&|m| m.members[1].section = 3),
        (ModelEntry::Member(1), EntryFault::NoSection { section: 3 })
    );
    assert_eq!(
        fault(&|m| m.members[0].points[1] = 0),
        (ModelEntry::Member(0), EntryFault::NoLength)
    );
    assert_eq!(
        fault(&|m| m.members[2].orientation = [2.0, 0.0, 0.0]),
        (ModelEntry::Member(2), EntryFault::Orientation)
    );
    assert_eq!(
        fault(&|m| m.supports[1].point = 7),
        (ModelEntry::Support(1), EntryFault::NoPoint { point: 7 })
    );
    let negative = EntryFault::NotPositive {
        quantity: EntryAttribute::E,
        value: -1.0,
    };
    assert_eq!(
        fault(&|m| m.sections[0].e = -1.0),
        (ModelEntry::Section(0), negative)
    );

    let mut bad = rail.clone();
    bad.segments[1].member = 8;
    let item = ModelEntry::Segment {
        rail: 0,
        segment: 1,
    };
    let refused = Error::Invalid {
        entry: item,
        fault: EntryFault::NoMember { member: 8 },
    };
    assert_eq!(FactoredFrame::new(&model, &[bad]).err(), Some(refused));
    let mut bad = rail.clone();
    bad.axis = [0.0, 3.0, 0.0];
    let refused = Error::Invalid {
        entry: ModelEntry::Rail(0),
        fault: EntryFault::Axis,
    };
    assert_eq!(FactoredFrame::new(&model, &[bad]).err(), Some(refused));
    let mut bad = rail;
    bad.segments.push(bad.segments[1]);
    let item = ModelEntry::Segment {
        rail: 0,
        segment: 3,
    };
    let refused = Error::Invalid {
        entry: item,
        fault: EntryFault::Overlap { segment: 1, x: 0.0 },
    };
    assert_eq!(FactoredFrame::new(&model, &[bad]).err(), Some(refused));
}

#[test]
fn bad_girders_are_named() {
    let fault = |girder: Girder| match girder.model_and_rail().err() {
        Some(Error::Invalid { entry: item, fault }) => (item, fault),
        other => panic!("{other:?}"),
    };
    let length = |value| EntryFault::NotPositive {
        quantity: EntryAttribute::Length,
        value,
    };
    let empty = EntryFault::Empty {
        quantity: EntryAttribute::Spans,
    };
    assert_eq!(
        fault(Girder {
            spans: vec![],
            ..paper()
        }),
        (ModelEntry::Girder, empty)
    );
    assert_eq!(
        fault(Girder {
            spans: vec![60.0, -60.0],
            ..paper()
        }),
        (ModelEntry::Span(1), length(-60.0))
    );
    let negative = EntryFault::Negative {
        quantity: EntryAttribute::Length,
        value: -1.0,
    };
    assert_eq!(
        fault(Girder {
            overhangs: [0.0, -1.0],
            ..paper()
        }),
        (ModelEntry::Overhang(1), negative)
    );
    let shear = Girder {
        ka_vertical: Some(0.3),
        g: None,
        theory: BeamTheory::Timoshenko,
        ..paper()
    };
    assert_eq!(
        fault(shear),
        (ModelEntry::Girder, EntryFault::NoShearModulus)
    );
}
