//! Files as other programs write them.

use formats::tables::{TableSet, read};
use formats::text::diagnostic::Diagnostic;
use formats::units::{Force, Length, Units};

use super::{FT_LBF, bytes, data};

const M_KN: Units = Units {
    length: Length::Metre,
    force: Force::Kilonewton,
};

/// cos(x/20) cos(z/20) 1e-8, as the script beside the files makes it.
fn shape(x: f64, z: f64) -> f64 {
    (x / 20.0).cos() * (z / 20.0).cos() * 1e-8
}

fn of_numpy(name: &str) -> TableSet {
    read(name, &bytes(&data(name)), None).unwrap_or_else(|wrong| panic!("{name}: {wrong:?}"))
}

#[test]
fn files_that_numpy_wrote_are_read() {
    for (name, units, rows, columns, exact) in [
        ("plain.npz", FT_LBF, 5, 5, true),
        ("packed.npz", FT_LBF, 5, 5, true),
        ("fortran.npz", FT_LBF, 5, 5, true),
        ("oblong.npz", M_KN, 3, 5, true),
        ("big.npz", FT_LBF, 5, 5, true),
        ("single.npz", FT_LBF, 4, 4, false),
    ] {
        let set = of_numpy(name);
        assert_eq!(set.units, units, "{name}");
        let table = &set.tables[0];
        assert_eq!((table.name.as_str(), table.id), ("vertical", 6), "{name}");
        let curves = &table.curves;
        assert_eq!(
            (curves.z().len(), curves.x().len()),
            (rows, columns),
            "{name}"
        );
        for (z, row) in curves.z().iter().zip(curves.y()) {
            for (x, value) in curves.x().iter().zip(row) {
                // a cosine may round differently, a float of four bytes keeps 24 bits
                let allowed = if exact {
                    4.0 * f64::EPSILON
                } else {
                    2_f64.powi(-24)
                };
                assert!(
                    (value / shape(*x, *z) - 1.0).abs() <= allowed,
                    "{name} at {x}, {z}"
                );
            }
        }
    }
    let both = of_numpy("packed.npz");
    assert_eq!(
        (both.name.as_str(), both.tables[1].id, both.tables.len()),
        ("bridge", 7, 2)
    );
    assert_eq!(both, of_numpy("plain.npz"));
    let curve = of_numpy("curve.npz");
    assert_eq!(
        (
            curve.tables[0].name.as_str(),
            curve.tables[0].curves.z().len()
        ),
        ("shape", 0)
    );
}

fn csv(text: &str, told: Option<Units>) -> Result<TableSet, Vec<Diagnostic>> {
    read("north_vertical.csv", text.as_bytes(), told)
}

/// What every sheet below holds.
fn expected(set: &TableSet) {
    let table = &set.tables[0];
    assert_eq!(set.units, FT_LBF);
    assert_eq!(
        (table.id, table.name.as_str(), set.tables.len()),
        (6, "north_vertical", 1)
    );
    assert_eq!(table.curves.x(), [-1.5, 0.0, 2.0, 4.0]);
    assert_eq!(table.curves.z(), [0.0, 2.0]);
    assert_eq!(
        table.curves.y(),
        [[1.5e-8, 0.0, -2e-8, 1.0], [0.25, 0.0, 3.0, 4e-9]]
    );
}

#[test]
fn matrices_of_spreadsheets_and_matlab_are_read() {
    for text in [
        "z\\x,-1.5,0,2,4\n0,1.5e-8,0,-2e-8,1\n2,0.25,0,3,4e-9\n",
        // as Excel saves where the decimal mark is a comma: byte order mark, CRLF, semicolons, empty cells behind
        "\u{feff};-1,5;0;2;4;;\r\n0;1,5E-08;0;-2E-08;1;;\r\n2;0,25;0;3;4e-9;;\r\n;;;;;;\r\n",
        // tabs, a nan in the corner, Fortran exponents
        "nan\t-1.5\t0\t2\t4\n0\t1.5D-8\t0\t-2d-8\t1\n2\t0.25\t0\t3\t4e-9",
        // blanks, no corner, comments of MATLAB and of numpy, blank lines, old line ends
        "% influence\r# units: ft lbf s\r\r  -1.5  0  2 4\r0 1.5e-8 0 -2e-8 1\r\r2   .25 0 3 4e-9\r",
        "\"z, x\",\"-1.5\",\"0\",2,4\n\"0\",1.5e-8,0,-2e-8,1\n2,\"0.25\" ,0, 3 ,4e-9\n",
    ] {
        expected(&csv(text, Some(FT_LBF)).unwrap_or_else(|wrong| panic!("{text}: {wrong:?}")));
    }
}

#[test]
fn values_in_rows_are_read_in_any_order_and_with_few_columns() {
    let rows = [
        "2,2,3",
        "0,-1.5,1.5e-8",
        "0,4,1",
        "2,-1.5,.25",
        "0,0,0",
        "2,0,0",
        "0,2,-2e-8",
        "2,4,4e-9",
    ];
    expected(&csv(&format!("z,x,value\n{}", rows.join("\n")), Some(FT_LBF)).expect("readable"));
    let text = format!(
        "Z [ft], X [ft], Value [ft/lbf]\r\n{}\r\n",
        rows.join("\r\n")
    );
    expected(&csv(&text, None).expect("readable"));
    let set = csv("# units: m, kN, s\nvalue,x\n1,0\n2,1\n3,2\n4,3\n", None).expect("one curve");
    assert_eq!((set.units, set.tables[0].curves.z().len()), (M_KN, 0));
}

#[test]
fn plain_json_is_read() {
    let values = "[[1.5e-8, 0, -2e-8, 1], [0.25, 0, 3, 4e-9]]";
    let text = format!("{{\"x\": [-1.5, 0, 2, 4], \"z\": [0, 2], \"values\": {values}}}");
    expected(&read("north_vertical.json", text.as_bytes(), Some(FT_LBF)).expect("readable"));
    let units = "\"units\": {\"length\": \"m\", \"force\": \"kN\", \"time\": \"s\"}";
    let text = format!(
        "{{\"stations\": [0, 1, 2, 3], {units}, \"name\": \"lateral\", \"values\": [[1,2,3,4],[2,1,2,3],[3,2,1,2],[4,3,2,1]]}}"
    );
    let set = read("a.json", text.as_bytes(), None).expect("readable");
    assert_eq!(
        (set.units, set.tables[0].id, set.tables[0].curves.z()),
        (M_KN, 7, &[0.0, 1.0, 2.0, 3.0][..])
    );
}

/// A data set as Adams View writes it: one argument a line, ten digits, exponents of three digits.
#[test]
fn data_sets_of_adams_view_are_read() {
    let text = "\
Adams View model name: crane
!
!-------------------------------- SYSTEM UNITS ---------------------------------
!
UNITS/
, FORCE = POUND_FORCE
, MASS = SLUG
, LENGTH = FOOT
, TIME = SECOND
!
!--------------------------------- DATA STRUCTURES ----------------------------------
!
!                       adams_view_name='north_vertical'
!                       adams_view_units='no_units'
SPLINE/6
, X = -1.5, 0, 2, 4
, Y = 0, 1.5E-008, 0, -2.0E-008, 1
, Y = 2, 0.25, 0, 3, 4.0E-009
!
OUTPUT/REQSAVE, GRSAVE
!
END
";
    let set = read("deck.adm", text.as_bytes(), None).expect("readable");
    assert_eq!(set.name, "crane");
    expected(&set);
    let view = "\
!
!-------------------------- Default Units for Model ---------------------------!
!
defaults units  &
   length = foot  &
   angle = deg  &
   force = pound_force  &
   mass = slug  &
   time = sec
!
model create  &
   model_name = crane
!
data_element create spline  &
   spline_name = .crane.north_vertical  &
   adams_id = 6  &
   x = -1.5, 0.0, 2.0, 4.0  &
   y = 1.5E-08, 0.0, -2.0E-08, 1.0, 0.25, 0.0, 3.0,  &
      4.0E-09  &
   z = 0.0, 2.0  &
   linear_extrapolate = no
!
";
    let set = read("deck.cmd", view.as_bytes(), None).expect("readable");
    assert_eq!(set.name, "crane");
    expected(&set);
}
