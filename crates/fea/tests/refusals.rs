//! Models and loads that are refused, with the name of the entry.

mod common;

use common::{mill, paper, probes};
use fea::{Error, Fault, Frame, Freedom, Girder, Item, Quantity, Theory, grid, nodal, surface};
use splines::{Axis, Compliance, Influence, Probe};

fn refusal(model: &fea::Model) -> Error {
    Frame::new(model, &[]).expect_err("a refusal")
}

#[test]
fn girder_without_vertical_supports_is_a_mechanism_by_name() {
    let (mut model, _) = paper().frame().expect("sound");
    for support in &mut model.supports {
        support.fix[Freedom::Uy as usize] = false;
    }
    let Error::Mechanism { freedom, .. } = refusal(&model) else { panic!("{:?}", refusal(&model)) };
    assert!(matches!(freedom, Freedom::Uy | Freedom::Rz), "{freedom}");
}

#[test]
fn girder_free_along_its_axis_is_a_mechanism_by_name() {
    let (mut model, _) = paper().frame().expect("sound");
    model.supports[0].fix[Freedom::Ux as usize] = false;
    assert!(
        matches!(refusal(&model), Error::Mechanism { freedom: Freedom::Ux, .. }),
        "{:?}",
        refusal(&model)
    );
}

#[test]
fn girder_free_to_twist_is_a_mechanism_by_name() {
    let (mut model, _) = paper().frame().expect("sound");
    for support in &mut model.supports {
        support.fix[Freedom::Rx as usize] = false;
    }
    assert!(
        matches!(refusal(&model), Error::Mechanism { freedom: Freedom::Rx, .. }),
        "{:?}",
        refusal(&model)
    );
}

#[test]
fn hinge_that_makes_a_span_fold_is_a_mechanism_at_that_point() {
    // Three points in a row on two end supports, a hinge at the middle one.
    let girder = Girder { spans: vec![30.0, 30.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
    let (mut model, _) = girder.frame().expect("sound");
    model.supports.remove(1);
    model.members[1].releases[0][Freedom::Rz as usize] = true;
    let Error::Mechanism { point, freedom } = refusal(&model) else { panic!("{:?}", refusal(&model)) };
    assert_eq!(point, 1);
    assert!(matches!(freedom, Freedom::Uy | Freedom::Rz), "{freedom}");
}

#[test]
fn mechanism_in_a_large_structure_is_found() {
    // The far end of a roof tie without its support: the truss can swing there.
    let (mut model, _) = mill(Theory::Timoshenko);
    model.supports.retain(|support| support.point != 41);
    model.springs.retain(|spring| spring.point != 41);
    let Error::Mechanism { point, freedom } = refusal(&model) else { panic!("{:?}", refusal(&model)) };
    assert_eq!((point, freedom), (41, Freedom::Uy));
}

#[test]
fn released_sets_with_an_inner_mechanism_are_refused() {
    let (model, _) = paper().frame().expect("sound");
    for (releases, end, freedom) in
        [([[Freedom::Ux], [Freedom::Ux]], 1, Freedom::Ux), ([[Freedom::Rx], [Freedom::Rx]], 1, Freedom::Rx)]
    {
        let mut model = model.clone();
        for (k, set) in releases.iter().enumerate() {
            set.iter().for_each(|f| model.members[1].releases[k][*f as usize] = true);
        }
        assert_eq!(refusal(&model), Error::Released { member: 1, end, freedom });
    }
    let mut model = model;
    for (end, freedom) in [(0, Freedom::Rz), (1, Freedom::Rz), (0, Freedom::Uy)] {
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
        let (model, rail) = girder.frame().expect("sound");
        let frame = Frame::new(&model, &[rail]).expect("vertical is stiff");
        Axis::ALL.map(|axis| frame.available(0, axis))
    };
    assert_eq!(available(&girder), [false, true, false]);
    let girder = Girder { area: Some(1.0), ..girder };
    assert_eq!(available(&girder), [true, true, false]);
    let girder = Girder { i_lateral: Some(0.9), ..girder };
    assert_eq!(available(&girder), [true, true, false], "the rail stands off the axis: twist matters");
    assert_eq!(available(&Girder { rail_height: 0.0, ..girder.clone() }), [true, true, true]);
    let girder = Girder { j: Some(0.6), g: Some(1.66e9), ..girder };
    assert_eq!(available(&girder), [true, true, true]);
}

#[test]
fn unstiffened_directions_are_refused_by_grid_and_surface_alike() {
    let girder = Girder { spans: vec![60.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
    let (model, rail) = girder.frame().expect("sound");
    let rails = [rail];
    let at = [Probe { rail: 0, x: 20.0, axis: Axis::Lateral }];
    let refused = splines::Error::Unstiffened { rail: 0, x: 20.0, axis: Axis::Lateral };
    assert_eq!(grid(&model, &rails, &at).err(), Some(Error::Rail(refused.clone())));
    let exact = surface(&model, &rails).expect("vertical is stiff");
    assert_eq!(exact.surface.fill(&at, &mut Influence::zeros(1)).err(), Some(refused));
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
    let (model, _) = girder.frame().expect("sound");
    let (value, _) = nodal(&model, &[0]).expect("solvable");
    for k in 0..6 {
        assert_eq!(value[(k, k)].is_finite(), k == 1 || k == 5, "degree of freedom {k}");
    }
}

#[test]
fn places_off_the_rail_are_refused() {
    let (model, mut rail) = paper().frame().expect("sound");
    let at = probes(Axis::Vertical, &[75.1]);
    let refused = splines::Error::OffRail { rail: 0, x: 75.1 };
    assert_eq!(grid(&model, &[rail.clone()], &at).err(), Some(Error::Rail(refused)));
    rail.stations.push(80.0);
    let item = Item::Station { rail: 0, station: 7 };
    let refused = Error::Invalid { item, fault: Fault::Uncovered { x: 80.0 } };
    assert_eq!(Frame::new(&model, &[rail.clone()]).err(), Some(refused));
    rail.stations = vec![0.0, 20.0, 10.0];
    let item = Item::Station { rail: 0, station: 2 };
    let refused = Error::Invalid { item, fault: Fault::Unsorted { value: 10.0 } };
    assert_eq!(Frame::new(&model, &[rail]).err(), Some(refused));
}

#[test]
fn bad_entries_are_named() {
    let (model, rail) = paper().frame().expect("sound");
    let fault = |change: &dyn Fn(&mut fea::Model)| {
        let mut model = model.clone();
        change(&mut model);
        match refusal(&model) {
            Error::Invalid { item, fault } => (item, fault),
            other => panic!("{other:?}"),
        }
    };
    let nan = Fault::NotFinite { quantity: Quantity::Coordinate };
    assert_eq!(fault(&|m| m.points[2][1] = f64::NAN), (Item::Point(2), nan));
    assert_eq!(fault(&|m| m.members[1].points[0] = 9), (Item::Member(1), Fault::NoPoint { point: 9 }));
    assert_eq!(fault(&|m| m.members[1].section = 3), (Item::Member(1), Fault::NoSection { section: 3 }));
    assert_eq!(fault(&|m| m.members[0].points[1] = 0), (Item::Member(0), Fault::NoLength));
    assert_eq!(fault(&|m| m.members[2].orientation = [2.0, 0.0, 0.0]), (Item::Member(2), Fault::Orientation));
    assert_eq!(fault(&|m| m.supports[1].point = 7), (Item::Support(1), Fault::NoPoint { point: 7 }));
    let negative = Fault::NotPositive { quantity: Quantity::E, value: -1.0 };
    assert_eq!(fault(&|m| m.sections[0].e = -1.0), (Item::Section(0), negative));

    let mut bad = rail.clone();
    bad.segments[1].member = 8;
    let item = Item::Segment { rail: 0, segment: 1 };
    let refused = Error::Invalid { item, fault: Fault::NoMember { member: 8 } };
    assert_eq!(Frame::new(&model, &[bad]).err(), Some(refused));
    let mut bad = rail.clone();
    bad.axis = [0.0, 3.0, 0.0];
    let refused = Error::Invalid { item: Item::Rail(0), fault: Fault::Axis };
    assert_eq!(Frame::new(&model, &[bad]).err(), Some(refused));
    let mut bad = rail;
    bad.segments.push(bad.segments[1]);
    let item = Item::Segment { rail: 0, segment: 3 };
    let refused = Error::Invalid { item, fault: Fault::Overlap { segment: 1, x: 0.0 } };
    assert_eq!(Frame::new(&model, &[bad]).err(), Some(refused));
}

#[test]
fn bad_girders_are_named() {
    let fault = |girder: Girder| match girder.frame().err() {
        Some(Error::Invalid { item, fault }) => (item, fault),
        other => panic!("{other:?}"),
    };
    let length = |value| Fault::NotPositive { quantity: Quantity::Length, value };
    let empty = Fault::Empty { quantity: Quantity::Spans };
    assert_eq!(fault(Girder { spans: vec![], ..paper() }), (Item::Girder, empty));
    assert_eq!(fault(Girder { spans: vec![60.0, -60.0], ..paper() }), (Item::Span(1), length(-60.0)));
    let negative = Fault::Negative { quantity: Quantity::Length, value: -1.0 };
    assert_eq!(fault(Girder { overhangs: [0.0, -1.0], ..paper() }), (Item::Overhang(1), negative));
    let shear = Girder { ka_vertical: Some(0.3), g: None, theory: Theory::Timoshenko, ..paper() };
    assert_eq!(fault(shear), (Item::Girder, Fault::NoShearModulus));
}
