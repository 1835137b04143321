//! Data sets of other programs and our own are read, written and read again; wrong ones are refused with
//! their place.

use adams::{AdamsFault, ArgumentValue, DataSet, Error, Statement};

fn read(text: &str) -> DataSet {
    DataSet::read(text).unwrap_or_else(|error| panic!("{error}"))
}

const PACKED: &str = "Adams View model name: MOD1\n\
!---- packed as older versions wrote it\n\
UNITS/FOR=POUND_FORCE, MASS=SLUG,\nLEN=FOOT, TIME=SECOND\n\
!  adams_view_name='ground'\n\
PART/1, GROUND\n\
PART/02, QG=1.0,2,-3.5E+000, REULER=90D,0,45D, MASS=2.07E+005\n,CM=3, IP=1,2,3\n\
mark/3, part=2, qp=0,0,1D+00, reul=0,0.5,0\nMARKER/4, PART=1, FLO\n\
SPLINE/6, LIN\n, X = 0, 1,\n, 2, 3\n, Y = 5E-1, 1, 4, 9\n\
VARI/171,IC=0.0,FUN=DY(3,4)\n,-GFORCE(17,0,3,3)*(-1.0)*AKISPL(DZ(3,4),0,6)\n\
GFORCE/17,I=3,JFL=4,RM=3,FX=0,FY=IF(MODE-5: 0,\n,-1E8*(VARVAL(171)-1.25),\n,0 )\\,FZ=0\n,TX=0\\\n,TY=0\\,TZ=0\n\
REQ/5, CNAMES=\"a, b\", \"c!\"\n, \"d;\", F2 = DX(3,4)*2.0\\\n, RESULTS_NAME = r\n\
CONTACT/9, IGEOM=1, JGEOM=2,3, IMPACT, STIFFNESS=1.0E+05 , COULOMB_FRICTION=on\n\
INTEGRATOR/GSTIFF, SI2, ERROR=1E-5\nACCGRAV/JGRAV=-32.174\nEND\nnothing after\n";

#[test]
fn packed_and_abbreviated_statements_are_read_in_full() {
    let set = read(PACKED);
    assert_eq!(set.title, "Adams View model name: MOD1");
    let part = set.find("PART", 2).expect("a part");
    assert_eq!(
        part.get("REULER"),
        Some(&ArgumentValue::Degrees(vec![90.0, 0.0, 45.0]))
    );
    assert_eq!(
        part.get("MASS"),
        Some(&ArgumentValue::Numbers(vec![2.07e5]))
    );
    assert_eq!(
        set.find("PART", 1)
            .and_then(|one| one.name.clone())
            .as_deref(),
        Some("ground")
    );
    let marker = set.find("MARKER", 3).expect("a marker");
    assert_eq!(
        marker.get("QP"),
        Some(&ArgumentValue::Numbers(vec![0.0, 0.0, 1.0]))
    );
    assert_eq!(
        set.find("MARKER", 4).and_then(|one| one.get("FLOATING")),
        Some(&ArgumentValue::Flag)
    );
    let spline = set.find("SPLINE", 6).expect("a table");
    assert_eq!(
        spline.get("X"),
        Some(&ArgumentValue::Numbers(vec![0.0, 1.0, 2.0, 3.0]))
    );
    let gap = set
        .find("VARIABLE", 171)
        .and_then(|one| one.get("FUNCTION"));
    let text = "DY(3,4)-GFORCE(17,0,3,3)*(-1.0)*AKISPL(DZ(3,4),0,6)";
    assert_eq!(gap, Some(&ArgumentValue::Function(text.to_owned())));
    let force = set.find("GFORCE", 17).expect("a force");
    assert_eq!(
        force.get("FY"),
        Some(&ArgumentValue::Function(
            "IF(MODE-5:0,-1E8*(VARVAL(171)-1.25),0)".to_owned()
        ))
    );
    assert_eq!(
        force.get("TZ"),
        Some(&ArgumentValue::Function("0".to_owned()))
    );
    let request = set.find("REQUEST", 5).expect("a request");
    assert_eq!(
        request.get("CNAMES"),
        Some(&ArgumentValue::Word("\"a, b\", \"c!\", \"d;\"".to_owned()))
    );
    assert_eq!(
        request.get("F2"),
        Some(&ArgumentValue::Function("DX(3,4)*2.0".to_owned()))
    );
    let contact = set.find("CONTACT", 9).expect("kept");
    assert_eq!(
        contact.get("JGEOM"),
        Some(&ArgumentValue::Word("2, 3".to_owned()))
    );
    assert_eq!(contact.get("IMPACT"), Some(&ArgumentValue::Flag));
    assert_eq!(set.count("INTEGRATOR"), 1);
    assert_eq!(
        set.statements.last().map(|one| one.keyword.as_str()),
        Some("ACCGRAV")
    );
}

fn round_trips(set: &DataSet) {
    let text = set.write().unwrap_or_else(|error| panic!("{error}"));
    assert!(
        text.is_ascii() && text.lines().all(|line| line.len() <= 79),
        "{text}"
    );
    // Comments may be broken into lines once.
    let bare = |set: &DataSet| {
        let mut set = set.clone();
        set.statements
            .iter_mut()
            .for_each(|one| one.remarks.clear());
        set
    };
    let again = read(&text);
    assert!(bare(&again) == bare(set), "{text}");
    assert_eq!(again.write().map(|text| read(&text)).as_ref(), Ok(&again));
}

#[test]
fn what_is_read_is_written_and_read_the_same() {
    for text in [
        PACKED,
        include_str!("listings/flexible.adm"),
        include_str!("listings/rigid.adm"),
        include_str!("../../../../examples/bogie/printed.adm"),
    ] {
        round_trips(&read(text));
    }
}

#[test]
fn long_lists_and_expressions_are_broken_so_that_they_read_back() {
    let terms: Vec<String> = (1..60)
        .map(|k| format!("1.5E-07*AKISPL(DZ({k},46),DZ({k},46),6)**2/X"))
        .collect();
    let names: Vec<String> = (1..20).map(|k| format!("\"wheel, number {k}\"")).collect();
    let numbers: Vec<f64> = (0..50).map(|k| (f64::from(k)).sqrt() * 1e-9).collect();
    let set = DataSet {
        title: "long".to_owned(),
        statements: vec![
            Statement::new("SPLINE", 1)
                .numbers("X", &numbers)
                .numbers("Y", &numbers),
            Statement::new("VARIABLE", 2)
                .numbers("IC", &[1.25])
                .function("FUNCTION", terms.join("-")),
            Statement::new("REQUEST", 3)
                .word("CNAMES", &names.join(", "))
                .function("F2", terms.join("+"))
                .function("F3", "0"),
            Statement::new("MARKER", 4)
                .reference("PART", 1)
                .with("REULER", ArgumentValue::Degrees(vec![0.1, 0.0, -1e-9])),
        ],
    };
    round_trips(&set);
}

#[test]
fn faults_have_their_place() {
    for (text, line, column, fault) in [
        (
            "t\nMARKER/1, PART=1, QP=0,0,q9\n",
            2,
            26,
            AdamsFault::Argument,
        ),
        (
            "t\nMARKER/1, PART=1, QP=0,0,\n",
            2,
            0,
            AdamsFault::UnexpectedText,
        ),
        (
            "t\nMARKER/1, PART=1\n, PART=2\n",
            3,
            3,
            AdamsFault::Repeated,
        ),
        ("t\nMARKER/, PART=1\n", 2, 8, AdamsFault::Id),
        ("t\nMARKER/0, PART=1\n", 2, 8, AdamsFault::Id),
        (
            "t\nPART/1\nPART/1\n",
            3,
            1,
            AdamsFault::DuplicateId { id: 1 },
        ),
        (
            "t\nVARIABLE/1, FUNCTION = 1+\n,  (2*/3)\n",
            3,
            7,
            AdamsFault::UnexpectedText,
        ),
        (
            "t\nVARIABLE/1, FUNCTION = DX(21\n,6,49)\n",
            3,
            2,
            AdamsFault::UnexpectedText,
        ),
        (
            "t\nVARIABLE/1, FUNCTION = 1.2.3\n",
            2,
            24,
            AdamsFault::Number,
        ),
        (
            "t\nVARIABLE/1, FUNCTION = (1\n",
            2,
            26,
            AdamsFault::UnexpectedText,
        ),
        ("t\nGFORCE/1, I=2.5\n", 2, 13, AdamsFault::Id),
        ("t\nPART/1, MASS=1E400\n", 2, 14, AdamsFault::Number),
        ("t\nPART/1, MASS 1\n", 2, 14, AdamsFault::UnexpectedText),
        ("t\nPART/1 GROUND\n", 2, 8, AdamsFault::UnexpectedText),
        ("t\nPART/1\nGROUND\n", 3, 1, AdamsFault::UnexpectedText),
    ] {
        // A list that ends with a comma is complete: several commas count as one.
        if column == 0 {
            assert!(DataSet::read(text).is_ok());
            continue;
        }
        let found = DataSet::read(text);
        assert_eq!(
            found,
            Err(Error::At {
                line,
                column,
                fault
            }),
            "{text}"
        );
    }
}

#[test]
fn any_pieces_in_any_order_are_read_or_refused_without_panic() {
    const PIECES: &[&str] = &[
        "t",
        "\n",
        "\n,",
        ",",
        "/",
        "=",
        "\\",
        "!",
        ";",
        " ",
        "\"",
        "(",
        ")",
        ":",
        "**",
        "+",
        "-",
        "90D",
        "1E",
        "1.5D+01",
        ".",
        "7",
        "PART/1",
        "MARKER/3",
        "GFORCE/17",
        "VARIABLE/1",
        "REQUEST/2",
        "CONTACT/4",
        "SPLINE/6",
        "UNITS/",
        "MOTION/1",
        "BEAM/1",
        "I=",
        "JFLOAT=",
        "RM=",
        "FX=",
        "TZ=",
        "FUNCTION=",
        "QP=",
        "REULER=",
        "X=",
        "Y=",
        "X",
        "GROUND",
        "CNAMES=",
        "IC=",
        "PART=",
        "DX(",
        "GFORCE(",
        "IF(",
        "VARVAL(",
        "TIME",
        "END",
        "\u{e9}",
        "\t",
        "JOINT/2",
        "REVOLUTE",
        "DIFF/1",
        "IMPLICIT",
        "DIF1(",
    ];
    let mut random = fastrand::Rng::with_seed(7);
    let mut kept = 0;
    for _ in 0..20_000 {
        let mut text = String::from("title\n");
        for _ in 0..random.usize(..24) {
            text.push_str(PIECES[random.usize(..PIECES.len())]);
        }
        let Ok(set) = DataSet::read(&text) else {
            continue;
        };
        kept += 1;
        // Models of the text do not panic either.
        if let Ok(model) = adams::AdamsModel::new(&set) {
            let _ = model.solve(&model.initial());
        }
        if let Ok(printed) = set.write() {
            let again = DataSet::read(&printed)
                .unwrap_or_else(|error| panic!("{error}\n{text}\n{printed}"));
            assert_eq!(
                again.statements.len(),
                set.statements.len(),
                "{text}\n{printed}"
            );
        }
    }
    assert!(kept > 500, "{kept}");
}

#[test]
fn listing_with_any_letter_damaged_is_read_or_refused_without_panic() {
    let whole = include_str!("listings/rigid.adm");
    let letters: Vec<char> = "0123456789,./=()*-+\\!\n DX".chars().collect();
    let mut random = fastrand::Rng::with_seed(11);
    for _ in 0..3000 {
        let mut text: Vec<char> = whole.chars().collect();
        for _ in 0..1 + random.usize(..3) {
            let at = random.usize(..text.len());
            text[at] = letters[random.usize(..letters.len())];
        }
        let text: String = text.into_iter().collect();
        let Ok(set) = DataSet::read(&text) else {
            continue;
        };
        let Ok(model) = adams::AdamsModel::new(&set) else {
            continue;
        };
        if let Ok(out) = model.solve(&model.initial()) {
            assert!(
                out.loads
                    .values()
                    .all(|load| load.components.iter().all(|value| value.is_finite()))
            );
        }
    }
}
