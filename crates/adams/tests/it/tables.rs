//! SPLINE statements: what this crate writes reads back, what other programs write is read, and anything else
//! is refused with its place.

use adams::tables::{read, write};
use adams::{
    AdamsFault, AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit, AdamsUnits, Error, Spline,
    SplineValues, StatementId, Tables,
};

/// A table of the form of the paper's: a sine in both directions, with all digits.
fn table() -> SplineValues {
    let x: Vec<f64> = (0..7).map(|i| 15.0 * f64::from(i) - 15.0).collect();
    let y = x.iter().map(|z| {
        x.iter()
            .map(|x| 1e-7 * (x / 19.0).sin() * (z / 19.0).sin())
            .collect()
    });
    let y = y.collect();
    SplineValues::new(x.clone(), x, y).expect("increasing")
}

fn set(splines: Vec<Spline>) -> Tables {
    let units = AdamsUnits {
        force: AdamsForceUnit::Pound,
        mass: AdamsMassUnit::Slug,
        length: AdamsLengthUnit::Foot,
    };
    Tables {
        title: Some("bridge_flex".into()),
        units: Some(units),
        splines,
    }
}

fn spline(id: u32, curves: SplineValues) -> Spline {
    Spline {
        id,
        name: Some(format!("vertical_{id}")),
        units: Some("no_units".into()),
        linear_extrapolate: true,
        curves,
    }
}

fn bits(set: &Tables) -> Vec<u64> {
    let table = |s: &Spline| [s.curves.x(), s.curves.z(), &s.curves.y().concat()].concat();
    set.splines
        .iter()
        .flat_map(table)
        .map(f64::to_bits)
        .collect()
}

fn round_trips(set: &Tables) {
    let text = write(set).expect("writable");
    assert!(text.is_ascii() && text.ends_with("END\n"));
    for line in text.lines() {
        assert!(line.len() <= 79, "{line}");
    }
    let back = read(&text).expect("readable");
    assert_eq!(&back, set);
    assert_eq!(bits(&back), bits(set));
    assert_eq!(write(&back).as_deref(), Ok(text.as_str()));
}

#[test]
fn data_set_reads_back_bit_for_bit() {
    let x = vec![0.0, 0.1, 1.0 / 3.0, 2e9];
    let curve = SplineValues::new(x, Vec::new(), vec![vec![-0.0, 5e-324, f64::MAX, -1.5e-7]]);
    let mut plain = spline(4, curve.expect("four points"));
    (plain.name, plain.units, plain.linear_extrapolate) = (None, None, false);
    round_trips(&set(vec![spline(6, table()), plain]));
    round_trips(&Tables {
        title: None,
        units: None,
        splines: vec![],
    });
    for (force, mass, length) in [
        (
            AdamsForceUnit::Newton,
            AdamsMassUnit::Kilogram,
            AdamsLengthUnit::Meter,
        ),
        (
            AdamsForceUnit::Kilonewton,
            AdamsMassUnit::Tonne,
            AdamsLengthUnit::Millimeter,
        ),
        (
            AdamsForceUnit::Kilopound,
            AdamsMassUnit::Slinch,
            AdamsLengthUnit::Inch,
        ),
        (
            AdamsForceUnit::Pound,
            AdamsMassUnit::Pound,
            AdamsLengthUnit::Foot,
        ),
    ] {
        let mut set = set(vec![]);
        set.units = Some(AdamsUnits {
            force,
            mass,
            length,
        });
        round_trips(&set);
    }
}

#[test]
fn random_bits_read_back() {
    let mut random = fastrand::Rng::with_seed(99);
    let mut any = || loop {
        let bits = random.u64(..);
        if f64::from_bits(bits).is_finite() {
            return f64::from_bits(bits);
        }
    };
    for _ in 0..50 {
        let mut x: Vec<f64> = (0..9).map(|_| any()).collect();
        x.sort_by(f64::total_cmp);
        x.dedup();
        let y = (0..3).map(|_| x.iter().map(|_| any()).collect()).collect();
        round_trips(&set(vec![spline(
            1,
            SplineValues::new(x, vec![-1.0, 0.5, 7e8], y).expect("sorted"),
        )]));
    }
}

/// A text in the style of other programs: packed lines, trailing commas, blanks, comments, D exponents, lower
/// case, abbreviations, statements of other kinds, several statements on a line.
#[test]
fn reads_what_others_write() {
    let text = "\
Adams View model name: girder
!
!-------------------------------- SYSTEM UNITS ---------------------------------
!
UNITS/FORCE = POUND_FORCE, MASS = SLUG, LENGTH = FOOT, TIME = SECOND
PART/1, GROUND
!                       adams_view_name='VFORCE_3'
VFORCE/3, I = 1, FX = IF(MODE-5: 0,
,-DIF(101)-2,
,0 )\\ FY = 0
!
!                       adams_view_name='vertical'
!                       adams_view_units='no_units'
SPLINE/6
, X = -15, 0.0, 1.5D+01
, 30,
! a comment in between
, 45.
, LINEAR_EXTRAPOLATE
, Y = 0, 1.0E-007, 2, 3, 4, 5
, Y = 10,
 +.5, .25
   , 3,, 4, 5
spl/ 7 , linear, x=1,2,3,4, y=4,3,2,1; SPLINE/8,X=0,1,2,3,Y=1,2,3,4
MARKER/9, PART = 1
END
SPLINE/9, X = nonsense
";
    let set = read(text).expect("readable");
    assert_eq!(set.title.as_deref(), Some("Adams View model name: girder"));
    assert_eq!(
        set.units,
        Some(AdamsUnits {
            force: AdamsForceUnit::Pound,
            mass: AdamsMassUnit::Slug,
            length: AdamsLengthUnit::Foot
        })
    );
    assert_eq!(
        set.splines.iter().map(|s| s.id).collect::<Vec<_>>(),
        [6, 7, 8]
    );
    let [six, seven, eight] = &set.splines[..] else {
        panic!("three splines")
    };
    assert_eq!(
        (six.name.as_deref(), six.units.as_deref()),
        (Some("vertical"), Some("no_units"))
    );
    assert_eq!(six.curves.x(), [-15.0, 0.0, 15.0, 30.0, 45.0]);
    assert_eq!(six.curves.z(), [0.0, 10.0]);
    assert_eq!(
        six.curves.y(),
        [
            vec![1e-7, 2.0, 3.0, 4.0, 5.0],
            vec![0.5, 0.25, 3.0, 4.0, 5.0]
        ]
    );
    assert_eq!(
        (
            six.linear_extrapolate,
            seven.linear_extrapolate,
            eight.linear_extrapolate
        ),
        (true, true, false)
    );
    assert_eq!((seven.curves.y()[0][0], &seven.name), (4.0, &None));
    assert_eq!(eight.curves.z(), [] as [f64; 0]);
}

/// Each text with the line, column and fault of its error.
#[test]
fn faults_have_their_place() {
    let points = |index| AdamsFault::Spline {
        id: 6,
        source: Box::new(AdamsFault::Order { index }),
    };
    let few = AdamsFault::Spline {
        id: 6,
        source: Box::new(AdamsFault::Points { found: 3, least: 4 }),
    };
    let cases: &[(&str, usize, usize, AdamsFault)] = &[
        (
            "t\nSPLINE/6, X=0,1,2,3\n, FILE=force.dac",
            3,
            3,
            AdamsFault::File { id: 6 },
        ),
        (
            "t\nSPLINE/6, X=0,1,2,3\n, B=1",
            3,
            3,
            AdamsFault::File { id: 6 },
        ),
        ("t\nSPLINE/6, X=0,1,2,3, Z=0", 2, 22, AdamsFault::Argument),
        ("t\nSPLINE/6, X=0,1,2,3, X=0", 2, 22, AdamsFault::Repeated),
        ("t\nSPLINE/6, LINEAR, LINEAR", 2, 19, AdamsFault::Repeated),
        ("t\nSPLINE/x", 2, 8, AdamsFault::Id),
        ("t\nSPLINE/0", 2, 8, AdamsFault::Id),
        ("t\nSPLINE/-3", 2, 8, AdamsFault::Id),
        ("t\nSPLINE/99999999999", 2, 8, AdamsFault::Id),
        ("t\nSPLINE/", 2, 7, AdamsFault::Id),
        (
            "t\nSPLINE/6, X=0,1,2,3, Y=0,1,2,3\nSPLINE/6",
            3,
            8,
            AdamsFault::DuplicateId { id: 6 },
        ),
        ("t\nSPLINE/6, X=0,1,2,3", 2, 8, AdamsFault::NoY { id: 6 }),
        ("t\nSPLINE/6\n, Y=0,1,2,3", 2, 8, AdamsFault::NoX { id: 6 }),
        (
            "t\nSPLINE/6, X=0,1,2,3\n, Y=0,1,2",
            3,
            3,
            AdamsFault::Count {
                id: 6,
                found: 3,
                expected: 4,
            },
        ),
        (
            "t\nSPLINE/6, X=0,1,2,3\n, Y=0,1,2,3,4\n, Y=1,2",
            4,
            3,
            AdamsFault::Count {
                id: 6,
                found: 2,
                expected: 5,
            },
        ),
        ("t\nSPLINE/6, X=0,1,2, Y=0,1,2", 2, 8, few),
        ("t\nSPLINE/6, X=0,1,1,2, Y=0,1,2,3", 2, 8, points(2)),
        (
            "t\nSPLINE/6, X=0,1,2,3\n, Y=1,0,0,0,0\n, Y=1,0,0,0,0",
            2,
            8,
            points(1),
        ),
        ("t\nSPLINE/6, X=0,1,2,90D", 2, 19, AdamsFault::Number),
        ("t\nSPLINE/6, X=0,1,2,1e999", 2, 19, AdamsFault::Number),
        ("t\nSPLINE/6, X=0,1,2,1.2.3", 2, 19, AdamsFault::Number),
        ("t\nSPLINE/6, X=0 1", 2, 15, AdamsFault::UnexpectedText),
        ("t\nSPLINE/6, X 0", 2, 11, AdamsFault::UnexpectedText),
        ("t\nSPLINE/6, 5", 2, 11, AdamsFault::UnexpectedText),
        ("t\nSPLINE/6, X=\"a\"", 2, 13, AdamsFault::UnexpectedText),
        ("t\n  , X=1", 2, 3, AdamsFault::UnexpectedText),
        ("t\nUNITS/FORCE=STONE", 2, 13, AdamsFault::Unit),
        ("t\nUNITS/FORCE=NEWTON", 2, 1, AdamsFault::Unit),
        ("t\nUNITS/UCF=1", 2, 7, AdamsFault::Argument),
        ("t\nUNITS/SYSTEM=CGS", 2, 14, AdamsFault::Unit),
    ];
    for (text, line, column, fault) in cases {
        let expected = Error::At {
            line: *line,
            column: *column,
            fault: fault.clone(),
        };
        assert_eq!(read(text), Err(expected), "{text}");
    }
}

#[test]
fn first_line_is_a_title_unless_it_is_a_statement() {
    let body = "X=0,1,2,3, Y=0,1,2,3";
    assert_eq!(
        read(&format!("SPLINE/6, {body}")).map(|set| set.splines.len()),
        Ok(1)
    );
    let set = read("Spline of the girder\nUNITS/SYSTEM=NONE").expect("readable");
    assert_eq!(
        (set.title.as_deref(), set.units),
        (Some("Spline of the girder"), None)
    );
    assert_eq!(read("").map(|set| set.title), Ok(None));
    let mut set = set;
    set.title = Some("SPLINE/6, X=0\n \u{e9}".into());
    let text = write(&set).expect("writable");
    assert_eq!(
        read(&text).map(|set| set.title),
        Ok(Some("Model: SPLINE/6, X=0? ?".into()))
    );
}

#[test]
fn writer_refuses_what_could_not_be_read_back() {
    let good = spline(6, table());
    assert_eq!(
        write(&set(vec![good.clone(), good.clone()])),
        Err(Error::Id {
            statement: StatementId::new("SPLINE", 6)
        })
    );
    assert_eq!(
        write(&set(vec![Spline {
            id: 0,
            ..good.clone()
        }])),
        Err(Error::Id {
            statement: StatementId::new("SPLINE", 0)
        })
    );
    for name in ["", "it's", "two\nlines", &"x".repeat(80)] {
        let bad = Spline {
            name: Some(name.into()),
            ..good.clone()
        };
        assert_eq!(
            write(&set(vec![bad])),
            Err(Error::Name {
                statement: StatementId::new("SPLINE", 6)
            })
        );
    }
}

/// No text makes the reader panic: pieces of statements in random order.
#[test]
fn reader_survives_any_order_of_pieces() {
    let pieces = [
        "SPLINE/", "6", ",", " X", "=", "1.5", "\n", "!", ";", "Y =", "UNITS/", "FORCE", "END",
        "'", "-", "1D", "\u{e9}", "\t", "&", "/",
    ];
    let mut random = fastrand::Rng::with_seed(4);
    for _ in 0..20_000 {
        let text: String = (0..12)
            .map(|_| pieces[random.usize(..pieces.len())])
            .collect();
        if let Ok(set) = read(&text) {
            assert!(write(&set).is_ok() || set.splines.iter().any(|s| s.name.is_some()));
        }
    }
}
