//! Static equilibrium of data sets with known solutions.

use adams::{AdamsFault, AdamsModel, DataSet, Equilibrium, Error, StatementId};

fn model(text: &str) -> AdamsModel {
    let set = DataSet::read(text).unwrap_or_else(|error| panic!("{error}"));
    AdamsModel::new(&set).unwrap_or_else(|error| panic!("{error}"))
}

fn at_rest(text: &str, time: f64) -> Equilibrium {
    let model = model(text);
    model
        .equilibrium(time, &model.initial())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn near(found: f64, expected: f64, within: f64) {
    assert!(
        (found - expected).abs() <= within,
        "{found} instead of {expected}"
    );
}

/// The angle of a part about ground z.
fn heading(out: &Equilibrium, part: u32) -> f64 {
    let rotation = out.state.parts[&part].rotation;
    rotation[(1, 0)].atan2(rotation[(0, 0)])
}

#[test]
fn pendulum_with_a_torsion_spring_turns_far() {
    // k theta = m g a cos(theta) for a bar that was level: k = 3, m g a = 30.
    let text = "bar\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=3,CM=3,IP=1,1,1\nMARKER/2,PART=2\n\
                MARKER/3,PART=2,QP=1,0,0\nJOINT/1,REVOLUTE,I=2,J=1\n\
                SFORCE/1,ROTATIONAL,I=2,J=1,FUN=-3*AZ(2,1)\nACCGRAV/JGRAV=-10\nEND\n";
    let out = at_rest(text, 0.0);
    let theta = heading(&out, 2);
    near(3.0 * theta, -30.0 * theta.cos(), 1e-12);
    assert!(theta < -1.0, "{theta}");
    near(out.reactions[&("JOINT", 1)].force.y, 30.0, 1e-12);
    assert_eq!(out.rank_deficiency, 0);
}

#[test]
fn cantilever_of_one_beam_bends_as_timoshenko_says() {
    // Tip load P at a length L: P L^3 / 3 E I + P L ASY / G A, slope P L^2 / 2 E I; small, so nearly linear.
    let text = "tip\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=1E-6,CM=2,IP=1,1,1,QG=2,0,0\nMARKER/2,PART=2\n\
                BEAM/1,I=2,J=1,LENGTH=2,IXX=1E-4,IYY=2E-4,IZZ=3E-4,AREA=.01,EMODULUS=2E8,GMODULUS=8E7,ASY=1.2,ASZ=1.1\n\
                MARKER/9,PART=1,FLOATING\nVFORCE/1,I=2,JFLOAT=9,RM=1,FX=0\\,FY=-1\\,FZ=1\nEND\n";
    let out = at_rest(text, 0.0);
    let tip = out.state.parts[&2].origin;
    let (ei, ga) = ([2e8 * 3e-4, 2e8 * 2e-4], 8e7 * 0.01);
    near(tip.y, -(8.0 / (3.0 * ei[0]) + 2.0 * 1.2 / ga), 1e-10);
    near(tip.z, 8.0 / (3.0 * ei[1]) + 2.0 * 1.1 / ga, 1e-10);
    near(heading(&out, 2), -4.0 / (2.0 * ei[0]), 1e-10);
    // The reaction of the clamp: the load and its moment.
    let beam = out.solution.loads[&("BEAM", 1)];
    near(beam.force.y, 1.0, 1e-12);
    near(beam.torque.norm(), 0.0, 1e-9);
}

#[test]
fn body_above_its_stop_is_let_down_onto_it() {
    let text = "drop\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=100,CM=2,IP=1,1,1,QG=0,7,0\nMARKER/2,PART=2\n\
                JPRIM/1,INLINE,I=2,J=3\nJPRIM/2,ORIENTATION,I=2,J=3\nMARKER/3,PART=1,REULER=0D,90D,0D\n\
                SFORCE/1,TRANSLATIONAL,I=2,J=1,FUN=IMPACT(DM(2,1),VR(2,1),1,1E6,1.5,10,.1)\nACCGRAV/JGRAV=-10\nEND\n";
    let mut model = model(&text.replace("ORIENTATION", "PARALLEL_AXES"));
    let mut out = model.equilibrium(0.0, &model.initial());
    assert!(
        matches!(out, Err(Error::Equilibrium { .. })),
        "axes are not parallel: {out:?}"
    );
    model = self::model(&text.replace("QG=0,7,0", "QG=0,7,0,REULER=0D,90D,0D"));
    out = model.equilibrium(0.0, &model.initial());
    let out = out.unwrap_or_else(|error| panic!("{error}"));
    near(
        out.state.parts[&2].origin.y,
        1.0 - 1e-3_f64.powf(1.0 / 1.5),
        1e-12,
    );
}

/// A wheel with a stiff one-sided contact on a rail of compliance G(x) = 1e-3 x (4 - x), with force and deflection in
/// a loop: y = -W (G(x) + 1/k) at every place, although the deflection changes by 1e3 to 1e6 penetrations from one
/// place to the next, so that the wheel is off its rail, or far below it, before the forces are found.
#[test]
fn stiff_wheel_follows_a_rail_that_deflects_by_many_penetrations() {
    for k in [1e3, 1e5, 1e6, 1e7] {
        let text = format!(
            "wheel\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=1,CM=2,IP=1,1,1\nMARKER/2,PART=2\n\
             MARKER/9,PART=1,FLOATING\nMARKER/5,PART=1,ZP=1,0,0\nMARKER/6,PART=2,ZP=1,0,0\n\
             JPRIM/1,ORIENTATION,I=2,J=1\nJPRIM/2,INPLANE,I=2,J=1\n\
             MOTION/1,I=2,J=1,X,FUN=TIME\n\
             VARIABLE/1,FUN=DX(2,1)*(4-DX(2,1))*1E-3*VARVAL(2)\n\
             VARIABLE/2,IC=10,FUN=MAX(0,{k}*(-DY(2,1)-VARVAL(1)))\n\
             VFORCE/1,I=2,JFLOAT=9,RM=1,FX=0\\,FY=VARVAL(2)\\,FZ=0\nACCGRAV/JGRAV=-10\nEND\n"
        );
        let times: Vec<f64> = (0..=16).map(|i| 0.25 * f64::from(i)).collect();
        let path = model(&text)
            .quasi_static_path(&times)
            .unwrap_or_else(|error| panic!("k = {k}: {error}"));
        for one in &path {
            let x = one.state.time;
            near(
                one.state.parts[&2].origin.y,
                -10.0 * (1e-3 * x * (4.0 - x) + 1.0 / k),
                1e-13,
            );
            near(one.solution.variables[&2], 10.0, 1e-8);
            assert!(
                one.iterations < 40,
                "k = {k}, x = {x}: {} iterations",
                one.iterations
            );
        }
    }
}

#[test]
fn motions_hold_angles_places_and_integrals_of_speeds() {
    let text = "move\nPART/1,GROUND\nMARKER/1,PART=1\nMARKER/5,PART=1,ZP=1,0,0\n\
                PART/2,MASS=1,CM=2,IP=1,1,1,QG=0,0,0\nMARKER/2,PART=2\nMARKER/4,PART=2,ZP=1,0,0\n\
                JOINT/1,REVOLUTE,I=2,J=1\nMOTION/1,ROTATIONAL,JOINT=1,FUN=200D*TIME\n\
                PART/3,MASS=1,CM=3,IP=1,1,1\nMARKER/3,PART=3,ZP=1,0,0\nJOINT/2,TRANSLATIONAL,I=3,J=5\n\
                MOTION/2,TRANSLATIONAL,JOINT=2,VELOCITY,ICDISP=.5,FUN=STEP(TIME,0,0,2,3)\n\
                ACCGRAV/JGRAV=-10\nREQUEST/1,F2=JOINT(1,0,3,1)\\,F3=MOTION(2,0,1)\nEND\n";
    let path = model(text)
        .quasi_static_path(&[0.0, 0.5, 1.0, 2.0, 3.0])
        .unwrap_or_else(|error| panic!("{error}"));
    for one in &path {
        let turned = 200_f64.to_radians() * one.state.time;
        let heading = heading(one, 2);
        near((heading - turned).sin(), 0.0, 1e-12);
        near((heading - turned).cos(), 1.0, 1e-12);
        near(one.solution.requests[&1][&2], 10.0, 1e-9);
    }
    // The integral of the cubic STEP over its length is half of it.
    near(path[3].state.parts[&3].origin.x, 0.5 + 3.0, 1e-12);
    near(path[4].state.parts[&3].origin.x, 0.5 + 6.0, 1e-12);
}

#[test]
fn differential_equations_rest_where_their_rates_vanish() {
    // A spring whose displacement passes through a first-order lag: x' = (DY - x)/2 explicit, and 0 = 3 y - x
    // + DIF1 implicit.
    let text = "lag\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=2,CM=2,IP=1,1,1\nMARKER/2,PART=2,REULER=0D,90D,0D\n\
                MARKER/3,PART=1,REULER=0D,90D,0D\nJOINT/1,TRANSLATIONAL,I=2,J=3\nMARKER/9,PART=1,FLOATING\n\
                DIFF/1,IC=7,FUN=(DY(2,1)-DIF(1))/2\nDIFF/2,IC=0,IMPLICIT,FUN=3*DIF(2)-DIF(1)+DIF1(2)\n\
                DIFF/3,IC=4,STATIC_HOLD,FUN=TIME+1\n\
                VFORCE/1,I=2,JFLOAT=9,RM=1,FX=0\\,FY=-15*DIF(2)+DIF(3)\\,FZ=0\nACCGRAV/JGRAV=-10\nEND\n";
    let out = at_rest(text, 0.0);
    near(out.state.differentials[&2], -16.0 / 15.0, 1e-12);
    near(out.state.differentials[&1], -16.0 / 5.0, 1e-12);
    near(out.state.parts[&2].origin.y, -16.0 / 5.0, 1e-12);
    near(out.state.differentials[&3], 4.0, 0.0);
    // At a given state explicit rates are evaluated and implicit ones are solved.
    let model = model(text);
    let rates = model.solve(&model.initial()).expect("rates").rates;
    assert_eq!((rates[&1], rates[&2], rates[&3]), (-3.5, 7.0, 1.0));
}

#[test]
fn force_and_mass_units_meet_in_the_weight() {
    for (units, weight) in [
        ("FORCE=POUND_FORCE,MASS=SLUG,LENGTH=FOOT,TIME=SECOND", 20.0),
        (
            "FORCE=POUND_FORCE,MASS=POUND_MASS,LENGTH=FOOT,TIME=SECOND",
            20.0 / 32.174_048_556_430_45,
        ),
        (
            "FORCE=NEWTON,MASS=KILOGRAM,LENGTH=MILLIMETER,TIME=SECOND",
            0.02,
        ),
        ("SYSTEM=MKS", 20.0),
    ] {
        let text = format!(
            "weight\nUNITS/{units}\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=2,CM=2,IP=1,1,1\nMARKER/2,PART=2\n\
             JOINT/1,FIXED,I=2,J=1\nACCGRAV/JGRAV=-10\nEND\n"
        );
        let out = at_rest(&text, 0.0);
        near(out.reactions[&("JOINT", 1)].force.y, weight, 1e-12 * weight);
    }
}

#[test]
fn constraints_that_say_the_same_share_and_those_that_do_not_are_refused() {
    let text = "twice\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=2,CM=2,IP=1,1,1\nMARKER/2,PART=2\n\
                JOINT/1,FIXED,I=2,J=1\nJOINT/2,FIXED,I=2,J=$J\nMARKER/3,PART=1,QP=0,1,0\nACCGRAV/JGRAV=-10\nEND\n";
    let out = at_rest(&text.replace("$J", "1"), 0.0);
    near(out.reactions[&("JOINT", 1)].force.y, 10.0, 1e-9);
    near(out.reactions[&("JOINT", 2)].force.y, 10.0, 1e-9);
    assert_eq!(out.rank_deficiency, 6);
    let model = model(&text.replace("$J", "3"));
    let error = model.equilibrium(0.0, &model.initial());
    assert!(matches!(error, Err(Error::Equilibrium { .. })), "{error:?}");
}

#[test]
fn free_body_without_support_has_no_equilibrium() {
    let model = model(
        "free\nPART/1,GROUND\nPART/2,MASS=1,CM=2,IP=1,1,1\nMARKER/2,PART=2\nACCGRAV/JGRAV=-1\nEND\n",
    );
    let error = model.equilibrium(0.0, &model.initial());
    assert!(
        matches!(error, Err(Error::Equilibrium { ref statement, .. }) if *statement == StatementId::new("PART", 2)),
        "{error:?}"
    );
}

#[test]
fn references_are_checked_by_statement() {
    let head = "refs\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2,MASS=1,CM=2,IP=1,1,1\nMARKER/2,PART=2\nMARKER/9,PART=1,FLOATING\n";
    let missing = |keyword: &str, id: u32| AdamsFault::Missing {
        statement: StatementId::new(keyword, id),
    };
    let lacks = |argument: &'static str| AdamsFault::MissingArgument { argument };
    for (tail, expected) in [
        ("MARKER/3,PART=7", missing("PART", 7)),
        ("JOINT/1,REVOLUTE,I=2,J=8", missing("MARKER", 8)),
        ("JOINT/1,REVOLUTE,I=2", lacks("J")),
        ("JOINT/1,SCREW,I=2,J=1", AdamsFault::Unsupported),
        ("JOINT/1,I=2,J=1", AdamsFault::Type),
        ("MOTION/1,JOINT=4,FUN=0", missing("JOINT", 4)),
        ("VARIABLE/1,FUN=DX(5,1)", missing("MARKER", 5)),
        ("VARIABLE/1,FUN=AKISPL(0,0,6)", missing("SPLINE", 6)),
        ("VARIABLE/1,FUN=VARVAL(2)", missing("VARIABLE", 2)),
        ("VARIABLE/1,FUN=GFORCE(3,0,1,1)", missing("GFORCE", 3)),
        (
            "VARIABLE/1,FUN=USER(1,2)",
            AdamsFault::Unknown {
                name: "USER".to_owned(),
            },
        ),
        ("VARIABLE/1,FUN=STEP(TIME,0,0,1)", AdamsFault::Arguments),
        ("VARIABLE/1,FUN=DX(2.5,1)", AdamsFault::Id),
        ("VARIABLE/1", lacks("FUNCTION")),
        (
            "JOINT/1,FIXED,I=2,J=1\nVARIABLE/1,FUN=JOINT(1,0,2,1)",
            AdamsFault::Reaction,
        ),
        ("GFORCE/1,I=2,JFLOAT=1,RM=1,FX=0", AdamsFault::Floating),
        ("GFORCE/1,I=2,JFLOAT=9,FX=0", lacks("RM")),
        ("CONTACT/1,IGEOM=1", AdamsFault::Unsupported),
        (
            "SPLINE/6,X=0,1,2,3,Y=0,1,2,3,4,Y=1,1,2,3,4\nVARIABLE/1,FUN=AKISPL(0,0,6,1)",
            AdamsFault::Derivative,
        ),
        (
            "MOTION/1,I=2,J=1,X,VELOCITY,FUN=DX(2,1)",
            AdamsFault::Unsupported,
        ),
    ] {
        let set = DataSet::read(&format!("{head}{tail}\nEND\n"))
            .unwrap_or_else(|error| panic!("{error}"));
        match AdamsModel::new(&set) {
            Err(Error::Statement { fault, .. } | Error::In { fault, .. }) => {
                assert_eq!(*fault, expected, "{tail}")
            }
            other => panic!("{tail}: {:?}", other.map(|_| ())),
        }
    }
}

#[test]
fn nothing_at_all_is_at_rest() {
    for text in [
        "empty\nEND\n",
        "ground\nPART/1,GROUND\nMARKER/1,PART=1\nVARIABLE/1,FUN=DX(1)\nEND\n",
    ] {
        let out = at_rest(text, 0.0);
        assert!(out.state.parts.is_empty() && out.reactions.is_empty());
    }
}

#[test]
fn damaged_listing_comes_to_rest_or_is_refused_without_panic() {
    let whole = include_str!("listings/rigid.adm");
    let letters: Vec<char> = "0123456789,./=()*-+E".chars().collect();
    let mut random = fastrand::Rng::with_seed(3);
    let mut below = |n: usize| random.usize(..n);
    let mut rested = 0;
    for _ in 0..300 {
        let mut text: Vec<char> = whole.chars().collect();
        let at = text.len() - 1 - below(text.len() - 500);
        text[at] = letters[below(letters.len())];
        let text: String = text.into_iter().collect();
        let Ok(model) = DataSet::read(&text).and_then(|set| AdamsModel::new(&set)) else {
            continue;
        };
        if let Ok(out) = model.equilibrium(0.0, &model.initial()) {
            rested += 1;
            assert!(
                out.state
                    .parts
                    .values()
                    .all(|pose| pose.origin.iter().all(|value| value.is_finite()))
            );
        }
    }
    assert!(rested > 50, "{rested}");
}
