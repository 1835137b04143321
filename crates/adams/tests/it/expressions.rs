//! Function expressions: grammar, values of functions, exact derivatives.

use adams::functions::Function;
use adams::{AdamsModel, DataSet, Dual, Scalar};

fn evaluated(text: &str) -> f64 {
    let text = format!("one\nVARIABLE/1,FUN={text}\nEND\n");
    let set = DataSet::read(&text).unwrap_or_else(|error| panic!("{error}"));
    let model = AdamsModel::new(&set).unwrap_or_else(|error| panic!("{error}"));
    model
        .solve(&model.initial())
        .unwrap_or_else(|error| panic!("{error}"))
        .variables[&1]
}

#[test]
fn operators_bind_as_in_fortran() {
    for (text, value) in [
        ("2**3**2", 512.0),
        ("-2**2", -4.0),
        ("2*-3", -6.0),
        ("2**-1", 0.5),
        ("-(-3)", 3.0),
        ("7-2-1", 4.0),
        ("24/4/2", 3.0),
        ("1+2*3**2", 19.0),
        ("-8-8*(1.0)*2", -24.0),
        ("1E8*1.5D+01/.5e+1", 3e8),
        ("SIN(90D)+cos(0)", 2.0),
        ("180D/PI + DTOR*RTOD", 2.0),
        ("90D+5", 90e5),
        ("IF(TIME-1: 10, 20, 30)", 10.0),
        ("IF(0: 10, 20, 30)+IF(2-1:1,2,3)", 23.0),
        ("MODE", 4.0),
        ("+5", 5.0),
    ] {
        assert!(
            (evaluated(text) - value).abs() <= 1e-15 * value.abs(),
            "{text}: {}",
            evaluated(text)
        );
    }
}

#[test]
fn functions_have_the_values_of_their_definitions() {
    for (text, value) in [
        ("MAX(1,MIN(5,3))", 3.0),
        ("SIGN(2,-0.5)-ABS(-3)", -5.0),
        ("MOD(-7,3)", -1.0),
        ("DIM(3,5)+DIM(5,3)", 2.0),
        ("ATAN2(-1,0)", -std::f64::consts::FRAC_PI_2),
        ("SQRT(16)+EXP(0)+LOG(1)+LOG10(1000)", 8.0),
        ("ASIN(1)-ACOS(0)", 0.0),
        ("AINT(-2.7)+ANINT(2.6)", 1.0),
        ("POLY(3,1,5,4,2)", 21.0),
        ("STEP(0.25,0,1,1,3)", 1.0 + 2.0 * 0.15625),
        ("STEP(-1,0,1,1,3)+STEP(9,0,1,1,3)", 4.0),
        (
            "STEP5(0.25,0,1,1,3)",
            1.0 + 2.0 * 0.015625 * (10.0 - 3.75 + 0.375),
        ),
        ("HAVSIN(0.5,0,1,1,3)", 2.0),
        // k p^e with full damping beyond d, without tension, and zero above the contact.
        ("IMPACT(.5,0,1,8,2,4,.1)", 2.0),
        ("IMPACT(.5,-1,1,8,2,4,.1)", 6.0),
        ("IMPACT(.5,9,1,8,2,4,.1)", 0.0),
        ("IMPACT(.9,-1,1,8,1,4,.2)", 0.8 + 2.0),
        ("IMPACT(1.5,-9,1,8,2,4,.1)", 0.0),
        ("BISTOP(.5,-1,1,2,8,2,4,.1)", 6.0),
        ("BISTOP(2.5,1,1,2,8,2,4,.1)", -6.0),
        ("BISTOP(2.5,-9,1,2,8,2,4,.1)", 0.0),
        ("BISTOP(1.5,3,1,2,8,2,4,.1)", 0.0),
    ] {
        assert!(
            (evaluated(text) - value).abs() <= 1e-14 * value.abs(),
            "{text}: {}",
            evaluated(text)
        );
    }
}

#[test]
fn derivatives_are_those_of_the_values() {
    let cases: [(&str, &[f64]); 14] = [
        ("SIN", &[0.7]),
        ("TAN", &[0.7]),
        ("SQRT", &[0.7]),
        ("LOG10", &[0.7]),
        ("ACOS", &[0.3]),
        ("TANH", &[0.4]),
        ("ATAN2", &[0.3, -0.8]),
        ("POLY", &[1.2, 0.3, 2.0, -1.0, 0.5]),
        ("STEP", &[0.3, -0.1, 2.0, 1.3, -4.0]),
        ("STEP5", &[0.3, -0.1, 2.0, 1.3, -4.0]),
        ("HAVSIN", &[0.3, -0.1, 2.0, 1.3, -4.0]),
        ("IMPACT", &[0.8, -0.3, 1.0, 5.0, 1.3, 2.0, 0.4]),
        ("BISTOP", &[2.2, 0.3, 1.0, 2.0, 5.0, 1.3, 2.0, 0.4]),
        ("MOD", &[7.3, 2.1]),
    ];
    for (name, at) in cases {
        let (function, least, most) = Function::find(name).expect("a function");
        assert!((least..=most).contains(&at.len()));
        let duals: Vec<Dual> = at
            .iter()
            .enumerate()
            .map(|(k, x)| Dual::unknown(*x, k, at.len()))
            .collect();
        let exact = function.value(&duals).expect("a value");
        for k in 0..at.len() {
            let moved = |step: f64| {
                let mut at = at.to_vec();
                at[k] += step;
                function.value(&at).expect("a value")
            };
            let step = 1e-5;
            let slope = (moved(step) - moved(-step)) / (2.0 * step);
            assert!(
                (slope - exact.derivative(k)).abs() < 1e-8 * (1.0 + slope.abs()),
                "{name} {k}: {slope}"
            );
        }
        assert_eq!(exact.value(), function.value(at).expect("a value"));
    }
}

#[test]
fn values_that_are_not_finite_are_refused_by_name() {
    for text in [
        "1/(TIME-TIME)",
        "SQRT(TIME-1)",
        "LOG(0*TIME)",
        "EXP(1E5)",
        "(-8)**(1/3)",
        "STEP(0,1,0,1,1)",
    ] {
        let set = DataSet::read(&format!("bad\nVARIABLE/31,FUN={text}\nEND\n")).expect("grammar");
        let model = AdamsModel::new(&set).expect("names");
        let error = model.solve(&model.initial());
        assert!(
            matches!(
                error,
                Err(adams::Error::In {
                    statement: adams::StatementId { id: 31, .. },
                    ..
                })
            ),
            "{text}: {error:?}"
        );
    }
}

#[test]
fn forces_are_read_on_either_side_and_in_any_frame() {
    let text = "sides\nPART/1,GROUND\nMARKER/1,PART=1\nMARKER/3,PART=1,REULER=90D,0,0\nMARKER/9,PART=1,FLOATING\n\
                MARKER/8,PART=1,FLOATING\nPART/2,QG=3,4,0\nMARKER/2,PART=2,REULER=30D,0D,0D\n\
                GFORCE/1,I=2,JFLOAT=9,RM=3,FX=1\\,FY=2\\,FZ=3\\,TX=4\\,TY=5\\,TZ=6\n\
                VFORCE/1,I=2,JFLOAT=8,RM=1,FX=7\\,FY=0\\,FZ=0\n\
                SFORCE/1,TRANSLATIONAL,I=2,J=1,FUN=10\n";
    for (expression, value) in [
        ("GFORCE(1,0,2,3)", 1.0),
        ("GFORCE(1,1,2,3)", -1.0),
        // x of marker 3 is y of ground.
        ("GFORCE(1,0,2,1)", -2.0),
        ("GFORCE(1,0,3)", 1.0),
        ("GFORCE(1,1,1,2)", 14_f64.sqrt()),
        ("GFORCE(1,0,5,2)", 77_f64.sqrt()),
        ("GFORCE(1,1,8,2)", -6.0),
        ("GFORCE(1,0,6,1)", -5.0),
        ("VFORCE(1,0,2,2)", 7.0 * 30_f64.to_radians().cos()),
        ("VFORCE(1,0,6,2)", 0.0),
        ("SFORCE(1,0,3,1)", 8.0),
        ("SFORCE(1,1,2,1)", -6.0),
        ("DM(2,1)+DX(2,1,3)+DY(2,1,3)", 5.0 + 4.0 - 3.0),
        ("DX(9,1)", 3.0),
        ("AZ(2,1)*RTOD", 30.0),
    ] {
        let set =
            DataSet::read(&format!("{text}VARIABLE/1,FUN={expression}\nEND\n")).expect("grammar");
        let model = AdamsModel::new(&set).unwrap_or_else(|error| panic!("{error}"));
        let out = model
            .solve(&model.initial())
            .unwrap_or_else(|error| panic!("{error}"));
        assert!(
            (out.variables[&1] - value).abs() < 1e-14 * value.abs().max(1.0),
            "{expression}: {}",
            out.variables[&1]
        );
        // The same expression evaluated afterwards.
        let asked = model.evaluate(&model.initial(), &out, expression);
        assert_eq!(asked, Ok(out.variables[&1]), "{expression}");
    }
}

#[test]
fn forces_may_read_themselves_and_each_other() {
    // FX = -0.3 FZ; FZ = 10 + 0.5 FZ.
    let text = "self\nPART/1,GROUND\nMARKER/1,PART=1\nMARKER/9,PART=1,FLOATING\nPART/2\nMARKER/2,PART=2\n\
                GFORCE/1,I=2,JFLOAT=9,RM=1,FX=-0.3*GFORCE(1,0,4,1)\\,FY=0\\,FZ=10+.5*GFORCE(1,0,4,1)\\,TX=0\\,TY=0\\,TZ=0\nEND\n";
    let model = AdamsModel::new(&DataSet::read(text).expect("grammar")).expect("names");
    let out = model.solve(&model.initial()).expect("a solution");
    let [x, _, z, ..] = out.loads[&("GFORCE", 1)].components;
    assert!(
        (x + 6.0).abs() < 1e-14 && (z - 20.0).abs() < 1e-14,
        "{x} {z}"
    );
}
