//! Data sets that are read, resolved and solved at given states.

use adams::{AdamsModel, DataSet, Error, ModelState, Pose, SolvedModelState, StatementId};
use nalgebra::{Matrix3, Vector3};

fn model(text: &str) -> AdamsModel {
    let set = DataSet::read(text).unwrap_or_else(|error| panic!("{error}"));
    AdamsModel::new(&set).unwrap_or_else(|error| panic!("{error}"))
}

fn solved(text: &str, time: f64) -> SolvedModelState {
    let model = model(text);
    let state = ModelState {
        time,
        ..model.initial()
    };
    model
        .solve(&state)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A variable on a spring k over a compliance g, as a wheel on a girder: v = y + g k (1.25 - v).
fn looped(k: f64, start: f64, force: &str) -> String {
    format!(
        "loop\nPART/1,GROUND\nPART/2,QG=0,1.2,0\nMARKER/1,PART=1\nMARKER/2,PART=2\nMARKER/9,PART=1,FLOATING\n\
         VARIABLE/1,IC={start},FUN=DY(2,1)+GFORCE(1,0,3,1)*1.09E-7\n\
         GFORCE/1,I=2,JFLOAT=9,RM=1,FX=0\\,FY={}\\,FZ=0\\,TX=0\\,TY=0\\,TZ=0\nEND\n",
        force.replace("$K", &format!("{k:E}"))
    )
}

#[test]
fn newton_closes_the_loop_where_substitution_diverges() {
    // k g = 10.9: each substitution would multiply the error by this factor.
    let out = solved(&looped(1e8, 0.0, "-$K*(VARVAL(1)-1.25)"), 0.0);
    let exact = (1.2 + 10.9 * 1.25) / 11.9;
    assert!(
        (out.variables[&1] - exact).abs() < 4e-16 * exact,
        "{}",
        out.variables[&1]
    );
    assert!(out.iterations <= 3, "{}", out.iterations);
    let mut substituted = exact + 1e-9;
    for _ in 0..5 {
        substituted = 1.2 + 10.9 * (1.25 - substituted);
    }
    assert!((substituted - exact).abs() > 1e-4);
    // A one-sided progressive law, starting from penetrations of 1.25 ft and from no contact.
    for start in [0.0, 1.25, 3.0] {
        let out = solved(
            &looped(1e8, start, "IMPACT(VARVAL(1),VY(2,1),1.25,$K,1.1,1E5,.01)"),
            0.0,
        );
        let gap = out.variables[&1];
        let force = 1e8 * (1.25 - gap).powf(1.1);
        assert!(
            (gap - 1.2 - 1.09e-7 * force).abs() < 1e-15,
            "{start}: {gap}"
        );
        assert!((out.loads[&("GFORCE", 1)].force.y - force).abs() < 1e-8 * force);
    }
}

#[test]
fn loop_without_a_solution_is_refused_by_name() {
    let error = model("none\nVARIABLE/7,FUN=VARVAL(7)+1\nEND\n").solve(&ModelState::default());
    assert!(
        matches!(error, Err(Error::Loop { ref statement, .. }) if *statement == StatementId::new("VARIABLE", 7)),
        "{error:?}"
    );
    let text = looped(1e8, 0.0, "SQRT(-1-VARVAL(1)**2)");
    let error = model(&text).solve(&model(&text).initial());
    assert!(
        matches!(
            error,
            Err(Error::In {
                statement: StatementId { id: 1, .. },
                ..
            })
        ),
        "{error:?}"
    );
}

#[test]
fn velocities_are_seen_in_the_fourth_marker() {
    // Marker 2 on a turning part, marker 3 fixed to ground: derivative in ground against derivative in the
    // part.
    let text = "turn\nPART/1,GROUND\nPART/2\nMARKER/3,PART=1,QP=2,0,0\nMARKER/2,PART=2\n\
                VARIABLE/1,FUN=VX(3,2,2)\nVARIABLE/2,FUN=VY(3,2,2)\nVARIABLE/3,FUN=VY(3,2,2,2)\n\
                VARIABLE/4,FUN=VY(3,2)\nVARIABLE/5,FUN=WZ(2,3)\nVARIABLE/6,FUN=VM(2,3)\nEND\n";
    let model = model(text);
    let mut state = model.initial();
    let angle = 0.3;
    let rotation = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), angle).into_inner();
    let velocity = Vector3::new(1.0, 0.5, 0.0);
    state.parts.insert(
        2,
        Pose::moving(
            Vector3::zeros(),
            rotation,
            velocity,
            Vector3::new(0.0, 0.0, 4.0),
        ),
    );
    let out = model.solve(&state).expect("velocities");
    let local = rotation.transpose() * -velocity;
    let close = |id: u32, value: f64| {
        assert!(
            (out.variables[&id] - value).abs() < 1e-14,
            "{id}: {}",
            out.variables[&id]
        )
    };
    close(1, local.x);
    close(2, local.y);
    // Observed from the part, the point rotates backwards: - w x d.
    close(3, local.y - 4.0 * 2.0 * angle.cos());
    close(4, -0.5);
    close(5, 4.0);
    close(6, velocity.norm());
    // Small rotations as in a simulator: the rate of A^T d itself.
    let theta = Matrix3::new(0.0, -angle, 0.0, angle, 0.0, 0.0, 0.0, 0.0, 0.0);
    let rate = theta * (4.0 / angle);
    let pose = Pose {
        origin: Vector3::zeros(),
        rotation: Matrix3::identity() + theta,
        velocity,
        rate,
        angular_velocity: Vector3::z(),
    };
    state.parts.insert(2, pose);
    let out = model.solve(&state).expect("velocities");
    let exact = (rate.transpose() * Vector3::new(2.0, 0.0, 0.0)
        - (Matrix3::identity() + theta).transpose() * velocity)
        .y;
    assert!((out.variables[&3] - exact).abs() < 1e-15);
}

#[test]
fn listing_of_two_wheels_gives_the_forces_of_its_formulas() {
    let listing = include_str!("listings/flexible.adm");
    let tables = include_str!("../../../../examples/bogie/printed.adm");
    let mut set = DataSet::read(listing).unwrap_or_else(|error| panic!("{error}"));
    let tables = DataSet::read(tables).unwrap_or_else(|error| panic!("{error}"));
    set.statements.extend(
        tables
            .statements
            .into_iter()
            .filter(|one| one.keyword == "SPLINE"),
    );
    let model = AdamsModel::new(&set).unwrap_or_else(|error| panic!("{error}"));
    let mut state = model.initial();
    let drop = 0.5;
    for (part, x) in [(2, 30.0), (3, 30.0 - 4.0 / 3.0), (4, 30.0 + 4.0 / 3.0)] {
        let pose = state.parts.get_mut(&part).expect("a part");
        pose.origin = Vector3::new(0.0, 1.25 - drop, x);
    }
    let out = model
        .solve(&state)
        .unwrap_or_else(|error| panic!("{error}"));
    // The listing has one compliance for both: g(x, x) of the wheel whose force it is, here equal by
    // symmetry.
    let g = model
        .evaluate(&state, &out, "AKISPL(DZ(216,46),DZ(216,46),6)")
        .expect("a value");
    let force = drop / (1e-8 + 2.0 * g);
    for id in [17, 18] {
        let found = out.loads[&("GFORCE", id)];
        assert!(
            (found.components[1] - force).abs() < 1e-9 * force,
            "{found:?} {force}"
        );
        assert!((found.force.y - found.components[1]).abs() < 1e-12 * force);
    }
    assert!(
        (model
            .evaluate(&state, &out, "GFORCE(17,1,3,49)")
            .expect("a value")
            + force)
            .abs()
            < 1e-9 * force
    );
    assert!(out.extrapolated.is_empty());
}

#[test]
fn eight_wheels_are_solved_from_the_kink_of_their_law_at_random_heights() {
    // Compliance g of every wheel by every other falls off with distance; wheels of 1e10 lb/ft, initially
    // touching.
    let (n, stiffness) = (8, 1e10);
    let compliance = |i: usize, j: usize| 1e-7 * (-0.3 * (i as f64 - j as f64).abs()).exp();
    let mut text = String::from("many\nPART/1,GROUND\nMARKER/1,PART=1\n");
    for i in 1..=n {
        let (marker, floating) = (100 + i, 200 + i);
        text += &format!(
            "PART/{marker}\nMARKER/{marker},PART={marker}\nMARKER/{floating},PART=1,FLOATING\n"
        );
        text += &format!("VARIABLE/{i},IC=1.25,FUN=DY({marker},1)");
        for j in 1..=n {
            text += &format!("\n,+GFORCE({j},0,3,1)*{:E}", compliance(i, j));
        }
        text += &format!(
            "\nGFORCE/{i},I={marker},JFLOAT={floating},RM=1,FX=0\\,FY=MAX(0,{stiffness:E}*(1.25-VARVAL({i})))\\,\
             FZ=0\\,TX=0\\,TY=0\\,TZ=0\n"
        );
    }
    let model = model(&text);
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..300 {
        let mut state = model.initial();
        for pose in state.parts.values_mut() {
            pose.origin.y = 1.3 - 0.6 * random.f64();
        }
        let out = model
            .solve(&state)
            .unwrap_or_else(|error| panic!("{error}"));
        for i in 1..=n {
            let force = |k: usize| out.loads[&("GFORCE", k as u32)].components[1];
            let sunk: f64 = (1..=n).map(|j| compliance(i, j) * force(j)).sum();
            let gap = state.parts[&(100 + i as u32)].origin.y + sunk;
            let found = out.variables[&(i as u32)];
            // k g eps: the rounding error of 1.25 in the gap.
            assert!((gap - found).abs() < 1e-12, "{gap} {found}");
            assert_eq!(force(i), (stiffness * (1.25 - found)).max(0.0));
        }
    }
}

#[test]
fn implicit_rate_that_its_expression_lacks_stays_if_the_expression_holds() {
    // A wheel over a support: the compliance is zero, so that the rate is not in the expression.
    let text = "rate\nVARIABLE/1,FUN=TIME*DIF1(1)\nDIFF/1,IC=0,7,IMPLICIT,FUN=DIF(1)-VARVAL(1)\n\
                DIFF/2,IC=3,IMPLICIT,FUN=DIF1(2)*2-VARVAL(1)-DIF(2)\nEND\n";
    let model = model(text);
    let mut state = model.initial();
    let out = model.solve(&state).expect("rates");
    assert_eq!((out.rates[&1], out.rates[&2]), (7.0, 1.5));
    state.time = 2.0;
    state.differentials.insert(1, 8.0);
    let out = model.solve(&state).expect("rates");
    assert_eq!((out.rates[&1], out.rates[&2]), (4.0, 5.5));
    // The compliance is zero, but the expression is not.
    state.time = 0.0;
    let error = model.solve(&state);
    assert!(
        matches!(error, Err(Error::Loop { ref statement, .. }) if *statement == StatementId::new("DIFF", 1)),
        "{error:?}"
    );
}
