//! Effects of weight and inertia against closed forms and equilibrium.

use std::f64::consts::PI;

use fea::{
    BeamTheory, CrossSection, Dof, DofSet, Effect, FactoredFrame, ForceComponent, Girder, Member,
    Model, PointMass, Rail, RailSegment, Restraint, Support, refined_modes,
};

const SPAN: f64 = 12.0;
const LINE_MASS: f64 = 340.0;

fn girder(spans: Vec<f64>, theory: BeamTheory) -> Girder {
    let whole: f64 = spans.iter().sum();
    Girder {
        spans,
        e: 2.1e11,
        g: Some(8.1e10),
        area: Some(0.04),
        i_vertical: 6e-4,
        i_lateral: Some(9e-5),
        j: Some(3e-5),
        ka_vertical: Some(0.02),
        mass_per_length: Some(LINE_MASS),
        theory,
        stations: vec![0.0, whole],
        ..Girder::default()
    }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs().max(1e-9),
        "{found} for {expected}"
    );
}

/// Effects of the vertical reactions, supports first to last.
fn vertical(frame: &FactoredFrame, model: &Model) -> Vec<Effect> {
    let holds = frame
        .restraints(model)
        .into_iter()
        .filter(|hold| hold.dof == Dof::Uy);
    let mut holds: Vec<Restraint> = holds.collect();
    holds.sort_by(|a, b| model.points[a.point][0].total_cmp(&model.points[b.point][0]));
    holds.into_iter().map(Effect::Reaction).collect()
}

#[test]
fn weight_of_two_spans_rests_on_supports_as_the_three_moment_theorem_says() {
    let (model, rail) = girder(vec![SPAN, SPAN], BeamTheory::EulerBernoulli)
        .model_and_rail()
        .expect("a girder");
    let frame = FactoredFrame::new(&model, &[rail]).expect("it stands");
    let mut effects = vertical(&frame, &model);
    let cut = |place, component| Effect::InternalForce {
        member: 0,
        place,
        component,
    };
    effects.extend([
        cut(0.375, ForceComponent::BendingZ),
        cut(0.375, ForceComponent::ShearY),
        cut(1.0, ForceComponent::BendingZ),
        cut(1.0, ForceComponent::ShearY),
    ]);
    let found = frame.effects_of_weight(&model, &frame.weight(&model, [0.0, 1.0, 0.0]), &effects);
    let found = found.expect("effects of the weight");
    // The load M a for a = 1 upwards; weight is the opposite.
    let w = LINE_MASS;
    for (row, expected) in [
        (0, -3.0 / 8.0 * w * SPAN),
        (1, -10.0 / 8.0 * w * SPAN),
        (2, -3.0 / 8.0 * w * SPAN),
        // The beam hogs under an upward load: the largest span moment is 9/128 w L^2, where the shear is zero.
        (3, -9.0 / 128.0 * w * SPAN * SPAN),
        (5, w * SPAN * SPAN / 8.0),
        (6, -5.0 / 8.0 * w * SPAN),
    ] {
        close(found[row], expected, 1e-11);
    }
    assert!(found[4].abs() < 1e-10 * w * SPAN);
}

#[test]
fn weight_bends_a_cantilever_with_a_mass_at_its_tip_as_statics_says() {
    let section = CrossSection {
        e: 2.1e11,
        g: 8.1e10,
        area: 0.013,
        iy: 3.1e-5,
        iz: 8.7e-5,
        j: 2.3e-5,
        shear_y: Some(0.006),
        shear_z: None,
        mass: 111.0,
    };
    let fixed: DofSet = [true; 6];
    let model = Model {
        points: vec![[1.0, 2.0, 3.0], [1.0 + SPAN, 2.0, 3.0]],
        sections: vec![section],
        members: vec![Member::beam([0, 1], 0, [0.0, 1.0, 0.0])],
        supports: vec![Support { point: 0, fixed }],
        masses: vec![PointMass {
            point: 1,
            mass: 50.0,
            inertia: [0.0; 3],
            offset: [0.0, 0.0, 0.7],
        }],
        up: [0.0, 1.0, 0.0],
        theory: BeamTheory::Timoshenko,
        ..Model::default()
    };
    let rail = Rail {
        origin: model.points[0],
        axis: [1.0, 0.0, 0.0],
        segments: vec![RailSegment {
            member: 0,
            offset: [0.0; 3],
        }],
        stations: vec![0.0, SPAN],
    };
    let frame = FactoredFrame::new(&model, &[rail]).expect("it stands");
    let places = [0.0, 0.3, 0.8, 1.0];
    let parts = [
        ForceComponent::BendingZ,
        ForceComponent::ShearY,
        ForceComponent::Torsion,
    ];
    let mut effects: Vec<Effect> = Vec::new();
    for place in places {
        effects.extend(parts.map(|component| Effect::InternalForce {
            member: 0,
            place,
            component,
        }));
    }
    let all = frame.effects_of_weight(&model, &frame.weight(&model, [0.0, 1.0, 0.0]), &effects);
    let all = all.expect("effects of the weight");
    for (k, place) in places.into_iter().enumerate() {
        let beyond = SPAN * (1.0 - place);
        // Forces of the part beyond on the face, for a load upwards: Mz, Vy, and Mx by the arm of the mass.
        let moment = all[3 * k] - 111.0 * beyond * beyond / 2.0 - 50.0 * beyond;
        assert!(
            moment.abs() < 1e-11 * 111.0 * SPAN * SPAN,
            "{moment:e} at {place}"
        );
        close(all[3 * k + 1], 111.0 * beyond + 50.0, 1e-11);
        close(all[3 * k + 2], -50.0 * 0.7, 1e-11);
    }
}

#[test]
fn the_first_mode_bends_midspan_by_m_over_pi_squared() {
    for theory in [BeamTheory::EulerBernoulli, BeamTheory::Timoshenko] {
        let mut short = girder(vec![SPAN], theory);
        short.i_lateral = None;
        short.ka_vertical = None;
        let (model, rail) = short.model_and_rail().expect("a girder");
        let refined = refined_modes(&model, &[rail], 3, 1e-10).expect("modes");
        let frame = FactoredFrame::new(&refined.model, &refined.rails).expect("it stands");
        let mut effects = vertical(&frame, &refined.model);
        for component in [ForceComponent::BendingZ, ForceComponent::ShearY] {
            effects.push(refined.effect(Effect::InternalForce {
                member: 0,
                place: 0.5,
                component,
            }));
        }
        let inertia = frame.inertia_of_modes(&refined.model, &refined.modes.modes);
        let found = frame
            .effects_of_modes(&refined.model, &effects, &refined.modes.modes, &inertia)
            .expect("effects");
        let mode = refined
            .modes
            .modes
            .iter()
            .position(|mode| mode.coupling[1].abs() > 1.0);
        let mode = mode.expect("the first symmetric mode in the vertical plane");
        // Rotary inertia acts at midspan only through the size of the shape, which it changes.
        let size = refined.modes.modes[mode].coupling[1] * PI / (2.0 * LINE_MASS * SPAN);
        let tolerance = if theory == BeamTheory::EulerBernoulli {
            1e-6
        } else {
            1e-2
        };
        let load = LINE_MASS * size;
        close(found[(0, mode)], -load * SPAN / PI, tolerance);
        close(found[(2, mode)], -load * (SPAN / PI).powi(2), tolerance);
        assert!(
            found[(3, mode)].abs() < 1e-6 * load * SPAN,
            "no shear at midspan"
        );
    }
}

#[test]
fn reactions_to_inertia_balance_the_momentum_of_every_mode() {
    let mut short = girder(vec![9.0, SPAN, 7.0], BeamTheory::Timoshenko);
    short.overhangs = [2.0, 0.0];
    short.rail_height = 0.8;
    let (model, rail) = short.model_and_rail().expect("a girder");
    let refined = refined_modes(&model, &[rail], 25, 1e-4).expect("modes");
    let frame = FactoredFrame::new(&refined.model, &refined.rails).expect("it stands");
    let holds = frame.restraints(&refined.model);
    let effects: Vec<Effect> = holds.iter().copied().map(Effect::Reaction).collect();
    let inertia = frame.inertia_of_modes(&refined.model, &refined.modes.modes);
    let found = frame
        .effects_of_modes(&refined.model, &effects, &refined.modes.modes, &inertia)
        .expect("effects");
    for (k, freedom) in [Dof::Ux, Dof::Uy, Dof::Uz].into_iter().enumerate() {
        let own = |value: &dyn Fn(usize) -> f64| -> f64 {
            let rows = holds
                .iter()
                .enumerate()
                .filter(|(_, hold)| hold.dof == freedom);
            rows.map(|(row, _)| value(row)).sum()
        };
        for (mode, shape) in refined.modes.modes.iter().enumerate() {
            let sum = own(&|row| found[(row, mode)]);
            let whole = own(&|row| found[(row, mode)].abs());
            let apart = (sum + shape.coupling[k]).abs();
            assert!(
                apart <= 1e-9 * whole.max(1.0),
                "mode {mode}, axis {k}: {sum} for {}",
                shape.coupling[k]
            );
        }
        let along = std::array::from_fn(|axis| f64::from(u8::from(axis == k)));
        let weight = frame.weight(&refined.model, along);
        let under = frame
            .effects_of_weight(&refined.model, &weight, &effects)
            .expect("effects of the weight");
        let sum = own(&|row| under[row]);
        close(sum, -refined.modes.rigid_mass[k][k], 1e-10);
    }
}
