//! Adams View commands: what this crate writes reads back, what other programs write is read, and anything
//! else is refused with its place.

use adams::view::{ModifiedSpline, read, read_with_modified, write};
use adams::{
    AdamsFault, AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit, AdamsUnits, Error, Spline,
    SplineValues, StatementId, Tables,
};

/// Any finite double, by its bits.
fn any(random: &mut fastrand::Rng) -> f64 {
    loop {
        let value = f64::from_bits(random.u64(..));
        if value.is_finite() {
            return value;
        }
    }
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

fn four() -> SplineValues {
    SplineValues::new(
        vec![0.0, 1.0, 2.0, 3.0],
        Vec::new(),
        vec![vec![1.0, 2.0, 3.0, 4.0]],
    )
    .expect("increasing")
}

fn round_trips(set: &Tables) {
    let text = write(set, &["made for a test".to_owned()]).expect("writable");
    assert!(text.is_ascii());
    for line in text.lines() {
        assert!(line.len() <= 79, "{line}");
    }
    let back = read(&text).expect("readable");
    assert_eq!(&back, set);
    let bits = |set: &Tables| -> Vec<u64> {
        let table = |s: &Spline| [s.curves.x(), s.curves.z(), &s.curves.y().concat()].concat();
        set.splines
            .iter()
            .flat_map(table)
            .map(f64::to_bits)
            .collect()
    };
    assert_eq!(bits(&back), bits(set));
}

#[test]
fn commands_of_any_doubles_read_back_bit_for_bit() {
    let mut random = fastrand::Rng::with_seed(7);
    for _ in 0..50 {
        let mut x: Vec<f64> = (0..9).map(|_| any(&mut random)).collect();
        x.sort_by(f64::total_cmp);
        x.dedup();
        let y = (0..3)
            .map(|_| x.iter().map(|_| any(&mut random)).collect())
            .collect();
        let family = SplineValues::new(x, vec![-1.0, 0.5, 7e8], y).expect("sorted");
        let plain = Spline {
            name: None,
            units: None,
            linear_extrapolate: false,
            ..spline(1, four())
        };
        round_trips(&set(vec![spline(6, family), plain]));
    }
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
        let units = Some(AdamsUnits {
            force,
            mass,
            length,
        });
        round_trips(&Tables {
            units,
            ..set(vec![spline(4, four())])
        });
    }
}

/// Other commands in between, everything on one line, abbreviated commands, no identifiers, later changes of
/// units.
#[test]
fn reads_what_others_write() {
    let text = "\
[PLUGINS]
 PLUGIN_LIST  =  'acar'
!
defaults units  &
   length = mm  &
   angle = deg  &
   force = newton  &
   mass = kg  &
   time = sec
!
defaults units  &
   coordinate_system_type = cartesian  &
   orientation_type = body313
if condition = (! db_exists(\".colors.RED\"))
end
DATA_ELEMENT CREATE SPLINE &\r
    spline_name = .crane.force &\r
    x = -1.5, 0,1 , 2.0E+00    y = 1.0D-07,2,3,4\r
data_element attributes data_element_name = .crane.force visibility = off
data_elem cre spl spline_name=\"SPLINE_6\" adams_id=6 comments=\"a = b & c, (d)\" &
  x=0,1,2,3 &
! in between
  y = 1,2,3,4,  &
      5,6,7,8 &
  z=0,1 linear_extrapolate=yes units=no_units
default units length = inch
";
    let set = read(text).expect("readable");
    assert_eq!(
        set.units,
        Some(AdamsUnits {
            force: AdamsForceUnit::Newton,
            mass: AdamsMassUnit::Kilogram,
            length: AdamsLengthUnit::Inch
        })
    );
    assert_eq!(set.title.as_deref(), Some("crane"));
    let [force, six] = &set.splines[..] else {
        panic!("two splines")
    };
    assert_eq!(
        (force.id, force.name.as_deref(), force.linear_extrapolate),
        (7, Some("force"), false)
    );
    assert_eq!(
        (force.curves.x(), force.curves.z().len()),
        (&[-1.5, 0.0, 1.0, 2.0][..], 0)
    );
    assert_eq!(force.curves.y()[0][0], 1e-7);
    assert_eq!(
        (
            six.id,
            &six.name,
            six.linear_extrapolate,
            six.units.as_deref()
        ),
        (6, &None, true, Some("no_units"))
    );
    assert_eq!(six.curves.y(), [[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, 7.0, 8.0]]);
}

/// Each text with the line, column and fault of its error.
#[test]
fn faults_have_their_place() {
    let head = "data_element create spline ";
    let few = AdamsFault::Spline {
        id: 0,
        source: Box::new(AdamsFault::Points { found: 3, least: 4 }),
    };
    let order = AdamsFault::Spline {
        id: 6,
        source: Box::new(AdamsFault::Order { index: 2 }),
    };
    let cases: &[(&str, usize, usize, AdamsFault)] = &[
        (
            "x=0,1,2,3 file_name=\"a.dac\"",
            1,
            38,
            AdamsFault::File { id: 0 },
        ),
        ("x=0,1,2,3 colour=red", 1, 38, AdamsFault::Argument),
        ("x=0,1,2,3 x=0", 1, 38, AdamsFault::Repeated),
        ("adams_id=0 x=0,1,2,3", 1, 28, AdamsFault::Id),
        ("adams_id=-3", 1, 28, AdamsFault::Id),
        ("x=0,1,2,3", 1, 1, AdamsFault::NoY { id: 0 }),
        ("y=0,1,2,3", 1, 1, AdamsFault::NoX { id: 0 }),
        (
            "x=0,1,2,3 y=0,1,2",
            1,
            38,
            AdamsFault::Count {
                id: 0,
                found: 3,
                expected: 4,
            },
        ),
        (
            "x=0,1,2,3 z=0,1 y=0,1,2,3",
            1,
            44,
            AdamsFault::Count {
                id: 0,
                found: 4,
                expected: 8,
            },
        ),
        ("x=0,1,2 y=0,1,2", 1, 1, few),
        ("adams_id=6 x=0,1,1,2 y=0,1,2,3", 1, 1, order),
        ("x=0,1,2,3mm y=0,1,2,3", 1, 36, AdamsFault::Number),
        ("x=0,1,2,\"3\" y=0,1,2,3", 1, 36, AdamsFault::Number),
        ("x=0,1,2,1e999 y=0,1,2,3", 1, 36, AdamsFault::Number),
        ("x=0,1,2,(3) y=0,1,2,3", 1, 36, AdamsFault::UnexpectedText),
        ("x=0 1", 1, 32, AdamsFault::UnexpectedText),
        ("&\n  5", 2, 3, AdamsFault::UnexpectedText),
        ("spline_name=\"a", 1, 40, AdamsFault::UnexpectedText),
        (
            "linear_extrapolate=maybe x=0,1,2,3 y=0,1,2,3",
            1,
            47,
            AdamsFault::UnexpectedText,
        ),
        ("spline_name=.a.b, c x=0", 1, 46, AdamsFault::UnexpectedText),
        ("spline_name= x=0", 1, 28, AdamsFault::UnexpectedText),
    ];
    for (text, line, column, fault) in cases {
        let expected = Error::At {
            line: *line,
            column: *column,
            fault: fault.clone(),
        };
        assert_eq!(read(&format!("{head}{text}")), Err(expected), "{text}");
    }
    let twice = format!("{head}adams_id=6 x=0,1,2,3 y=0,1,2,3\n").repeat(2);
    assert_eq!(
        read(&twice),
        Err(Error::At {
            line: 2,
            column: 1,
            fault: AdamsFault::DuplicateId { id: 6 }
        })
    );
    let changed = "data_element modify spline spline_name=a x=1";
    assert_eq!(
        read(changed),
        Err(Error::At {
            line: 1,
            column: 1,
            fault: AdamsFault::Changed
        })
    );
    let unnamed = "data_element modify spline x=1";
    assert_eq!(
        read(unnamed),
        Err(Error::At {
            line: 1,
            column: 1,
            fault: AdamsFault::Changed
        })
    );
    for (text, column) in [
        ("defaults units length=cubit", 23),
        ("defaults units force=n time=hour", 29),
    ] {
        assert_eq!(
            read(text),
            Err(Error::At {
                line: 1,
                column,
                fault: AdamsFault::Unit
            }),
            "{text}"
        );
    }
}

#[test]
fn a_modified_spline_is_left_out_by_name() {
    let two = "data_element create spline spline_name=.m.soft adams_id=6 x=0,1,2,3 y=0,1,2,3\n\
               data_element create spline spline_name=.m.hard adams_id=7 x=0,1,2,3 y=0,2,4,6\n";
    let change = "data_element modify spline &\n spline_name = .m.soft &\n y = (EVAL(.m.k * 2)), \\\n (f(a=1)), 3\n";
    let (tables, modified) =
        read_with_modified(&format!("{two}{change}{change}")).expect("another remains");
    assert_eq!(
        tables
            .splines
            .iter()
            .map(|spline| spline.id)
            .collect::<Vec<_>>(),
        [7]
    );
    assert_eq!(
        modified,
        [ModifiedSpline {
            id: Some(6),
            name: "soft".into(),
            line: 3
        }]
    );
    let refused = Error::At {
        line: 3,
        column: 1,
        fault: AdamsFault::Changed,
    };
    assert_eq!(
        read(&format!("{two}{change}")),
        Err(refused.clone()),
        "the plain reader takes none"
    );
    let both = format!("{two}{change}{}", change.replace("soft", "HARD"));
    assert_eq!(read_with_modified(&both), Err(refused), "no other remains");
}

#[test]
fn writer_refuses_what_could_not_be_read_back() {
    let good = spline(6, four());
    let refused = |splines| write(&set(splines), &[]);
    assert_eq!(
        refused(vec![good.clone(), good.clone()]),
        Err(Error::Id {
            statement: StatementId::new("SPLINE", 6)
        })
    );
    assert_eq!(
        refused(vec![spline(0, four())]),
        Err(Error::Id {
            statement: StatementId::new("SPLINE", 0)
        })
    );
    for name in ["", "it's", "two words", "a.b", "6th", &"x".repeat(80)] {
        let bad = Spline {
            name: Some(name.into()),
            ..good.clone()
        };
        assert_eq!(
            refused(vec![bad]),
            Err(Error::Name {
                statement: StatementId::new("SPLINE", 6)
            }),
            "{name}"
        );
    }
    let titled = Tables {
        title: Some("a b".into()),
        ..set(vec![])
    };
    assert_eq!(
        write(&titled, &[]),
        Err(Error::Name {
            statement: StatementId::new("MODEL", 0)
        })
    );
    assert!(write(&set(vec![]), &["x".repeat(90)]).is_err());
}

/// No text makes the reader panic: pieces of commands in random order.
#[test]
fn reader_survives_any_order_of_pieces() {
    let pieces = [
        "data_element create spline ",
        "x=",
        "0,1,2,3",
        ",",
        " y = ",
        "=",
        "1.5",
        "\n",
        "!",
        "&\n",
        "z=",
        "&",
        "defaults units ",
        "length=mm",
        "\"",
        "-",
        "adams_id=6 ",
        "\u{e9}",
        "\t",
        ".a.b ",
    ];
    let mut random = fastrand::Rng::with_seed(4);
    for _ in 0..20_000 {
        let text: String = (0..14)
            .map(|_| pieces[random.usize(..pieces.len())])
            .collect();
        if let Ok(set) = read(&text) {
            let _ = write(&set, &[]);
        }
    }
}
