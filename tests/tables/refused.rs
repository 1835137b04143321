//! What is wrong with a file is said with its place.

use std::io::{Cursor, Write};

use formats::tables::read;
use formats::units::Units;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::{FT_LBF, bytes, data};

fn refusal(name: &str, bytes: &[u8], told: Option<Units>) -> String {
    let wrong = read(name, bytes, told).map(|_| ()).expect_err("refused");
    wrong
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn sheets_are_refused_at_line_and_column() {
    for (text, expected) in [
        ("", "a.csv: the file has no rows"),
        ("# nothing\n\n", "a.csv: the file has no rows"),
        ("x,value\n", "a.csv:1:1: the file has no values"),
        (
            ",0,1,2,3\n",
            "a.csv:1:1: must have rows of values below x  hint: a matrix has x in its first row and z in its first column",
        ),
        (
            ",0,1,2\n0,1,2,3\n",
            "a.csv:1:1: must have at least 4 x values, got 3  hint: a SPLINE needs at least four x values",
        ),
        (
            ",0,1,2,3\n0,1,2,x,4\n",
            "a.csv:2:7: must be a finite number, got \"x\"",
        ),
        (
            ",0,1,2,3\n0,1,2,,4\n",
            "a.csv:2:7: must be a finite number, got nothing",
        ),
        (
            ",0,1,2,3\n0,1,2,NaN,4\n",
            "a.csv:2:7: must be a finite number, got \"NaN\"",
        ),
        (
            ",0,1,2,3\n0,1,2,3\n",
            "a.csv:2:1: must have 4 numbers, one for each x, got 3",
        ),
        (
            ",0,1,2,3\n0,1,2,3,4,5\n",
            "a.csv:2:1: must have 4 numbers, one for each x, got 5",
        ),
        (
            ",0,1,1,3\n0,1,2,3,4\n",
            "a.csv:1:6: must be above the one before it, 1, got 1",
        ),
        (
            ",0,1,2,3\n5,1,2,3,4\n4,1,2,3,4\n",
            "a.csv:3:1: must be above the one before it, 5, got 4",
        ),
        (
            "1,2,3,4,5\n2,3,4,5,6\n3,4,5,6,7\n",
            "a.csv:1:1: the corner must be empty or text, got 1  hint: a matrix has x in its first row and z in its first column",
        ),
        (
            "0,2,3,4,5\n2,3,4,5,6\n3,4,5,6,7\n",
            "a.csv:1:1: the corner must be empty or text, got 0  hint: a matrix has x in its first row and z in its first column",
        ),
        (
            ",0,\"1,2,3\n",
            "a.csv:1:4: a quotation mark is not closed  hint: a cell cannot extend over several lines",
        ),
        (
            "z,x,value,colour\n",
            "a.csv:1:11: unknown column `colour`  hint: known columns are id, name, z, x, value",
        ),
        (
            "x,x,value\n",
            "a.csv:1:3: duplicate column `x`  hint: known columns are id, name, z, x, value",
        ),
        ("z,value\n1,2\n", "a.csv:1:1: missing column `x`"),
        (
            "z,x,value\n0,0,1\n0,1,2\n0,2,\n",
            "a.csv:4:5: must be a finite number, got nothing",
        ),
        (
            "z,x,value\n0,0,1,7\n",
            "a.csv:2:7: a row must have 3 cells, like the header",
        ),
        (
            "z,x,value\n0,0,1\n,1,2\n",
            "a.csv:3:1: must have a z, like the other rows of the table",
        ),
        (
            "id,x,value\n0,0,1\n",
            "a.csv:2:1: must be a whole number above 0",
        ),
        (
            "id,name,x,value\n6,a,0,1\n6,b,0,1\n",
            "a.csv:3:1: this id belongs to a table with another name",
        ),
        (
            "z,x,value\n0,0,1\n0,1,2\n0,2,3\n0,3,4\n0,1,5\n",
            "a.csv:6:3: the value at this z and x is given twice",
        ),
        (
            "z,x,value\n0,0,1\n0,1,2\n0,2,3\n0,3,4\n1,0,1\n1,1,2\n1,2,3\n1,4,4\n",
            "a.csv:9:3: every z must have values at the same x, got x = 4 at z = 1",
        ),
        (
            "z [ft],x [m],value [ft/lbf]\n",
            "a.csv:1:14: must be a unit of length per force  hint: such as [ft/lbf]",
        ),
    ] {
        assert_eq!(
            refusal("a.csv", text.as_bytes(), Some(FT_LBF)),
            expected,
            "{text}"
        );
    }
}

#[test]
fn json_is_refused_by_path() {
    let units = "\"units\": {\"length\": \"ft\", \"force\": \"lbf\", \"time\": \"s\"}";
    let ours = |tables: &str| {
        format!("{{\"format\": \"girderway-tables/1\", {units}, \"tables\": {tables}}}")
    };
    for (text, expected) in [
        (ours("[]"), "tables: must have at least one table"),
        (
            ours("[{\"x\": [0,1,2,3], \"values\": [[1,2,3]]}]"),
            "tables[0].values[0]: must have 4 numbers, one for each x, got 3",
        ),
        (
            ours("[{\"x\": [0,1,2,3], \"z\": [0, 1], \"values\": [[1,2,3,4]]}]"),
            "tables[0].values: must have 2 rows, one for each z, got 1",
        ),
        (
            ours("[{\"x\": [0,1,1,3], \"values\": [[1,2,3,4]]}]"),
            "tables[0].x[2]: must be above the one before it, 1, got 1",
        ),
        (
            ours("[{\"x\": [0,1,2,3], \"z\": [1, 0], \"values\": [[1,2,3,4], [1,2,3,4]]}]"),
            "tables[0].z[1]: must be above the one before it, 1, got 0",
        ),
        (
            ours("[{\"x\": [0,1,2,3]}]"),
            "tables[0]: missing key `values`",
        ),
        (
            ours("[{\"id\": 0, \"x\": [0,1,2,3], \"values\": [[1,2,3,4]]}]"),
            "tables[0].id: must be positive, got 0",
        ),
        (
            ours("[{\"x\": [0,1,2,3], \"values\": [[1,2,3,4]], \"y\": [[1,2,3,4]]}]"),
            "tables[0].y: unknown key `y`  hint: known keys are id, name, quantity, rail, load_rail, x, z, values",
        ),
        (
            ours("[{\"quantity\": \"vertica\", \"x\": [0,1,2,3], \"values\": [[1,2,3,4]]}]"),
            "tables[0].quantity: must be \"vertical\", \"lateral\", \"longitudinal\", \"vertical_lateral\", \"vertical_longitudinal\" or \"lateral_longitudinal\", got \"vertica\"  hint: did you mean \"vertical\"?",
        ),
        (
            format!("{{{units}, \"x\": [0,1,2,3], \"stations\": [], \"values\": []}}"),
            "x: cannot be combined with `stations`",
        ),
        (format!("{{{units}, \"values\": []}}"), "missing key `x`"),
    ] {
        let found = refusal("a.json", text.as_bytes(), None);
        let (_, place) = found.split_once(": ").expect("a place");
        assert_eq!(place, expected, "{text}");
    }
    let bare = "{\"x\": [0,1,2,3], \"values\": [[1,2,3,4]]}";
    assert!(
        refusal("a.json", bare.as_bytes(), None)
            .starts_with("a.json: has no `units`  hint: such as \"units\": {\"length\": \"ft\"")
    );
    let factored = format!(
        "{{\"format\": \"girderway-tables/1\", {units}, \"tables\": [{{\"id\": 1, \"x\": [0,1,2,3], \"values\": [[1,2,3,4]]}}],
 \"factored\": [{{\"name\": \"a\", \"terms\": [[1, 2]]}}]}}"
    );
    assert_eq!(
        refusal("a.json", factored.as_bytes(), None),
        "a.json:2:43: factored[0].terms[0][1]: must be the id of a table of one curve, got 2"
    );
}

#[test]
fn commands_are_refused_at_line_and_column() {
    let head = "defaults units length=foot force=pound_force\n";
    for (text, expected) in [
        (
            "data_element create spline x=0,1,2,3 y=1,2,3,4",
            "a.cmd: has no `defaults units`  hint: such as: defaults units length=foot force=pound_force mass=slug time=sec; or specify --length ft --force lbf, or in a scene \"units\" of the tables",
        ),
        (
            "defaults units &\n length = cubit",
            "a.cmd:2:11: unknown unit",
        ),
    ] {
        assert_eq!(refusal("a.cmd", text.as_bytes(), None), expected, "{text}");
    }
    let text = format!("{head}data_element create spline &\n  x = 0, 1, 2, (3+1)");
    assert_eq!(
        refusal("a.cmd", text.as_bytes(), None),
        "a.cmd:3:16: unexpected text"
    );
}

/// Names and bytes.
type Members = Vec<(&'static str, Vec<u8>)>;

/// An archive of one or more members, as given.
fn archive(members: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in members {
        writer
            .start_file(*name, SimpleFileOptions::default())
            .expect("a member");
        writer.write_all(bytes).expect("memory");
    }
    writer.finish().expect("an archive").into_inner()
}

fn array(descr: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut header =
        format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}").into_bytes();
    header.resize(118, b' ');
    [b"\x93NUMPY\x01\x00\x76\x00".to_vec(), header, data.to_vec()].concat()
}

fn numbers(list: &[f64], shape: &str) -> Vec<u8> {
    array(
        "<f8",
        shape,
        &list
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect::<Vec<_>>(),
    )
}

#[test]
fn archives_are_refused_by_array_and_index() {
    let stations = || ("stations.npy", numbers(&[0.0, 1.0, 2.0, 3.0], "(4,)"));
    let row = |shape: &str| ("vertical.npy", numbers(&[1.0, 2.0, 3.0, 4.0], shape));
    let cases: Vec<(Members, &str)> = vec![
        (
            vec![],
            "has no table  hint: a table is a matrix: row z, column x; its stations are an array `stations`",
        ),
        (
            vec![stations()],
            "has no table  hint: a table is a matrix: row z, column x; its stations are an array `stations`",
        ),
        (
            vec![row("(1, 4)")],
            "vertical: has no stations: no array `vertical_x`, `x` or `stations`  hint: numpy.savez(file, stations=x, vertical=values, units=[\"ft\", \"lbf\", \"s\"])",
        ),
        (
            vec![stations(), row("(1, 4)")],
            "vertical: must have 4 rows, one for each z, got 1",
        ),
        (
            vec![stations(), row("(2, 2, 1)")],
            "vertical: unknown array, got the shape [2, 2, 1]  hint: tables are matrices; other arrays are name, units, stations, x, z, tables, ids, names, quantity, rail, load_rail, curves, products, expressions",
        ),
        (
            vec![
                ("x.npy", numbers(&[0.0, 1.0, 2.0, f64::NAN], "(4,)")),
                row("(4,)"),
            ],
            "x[3]: must be finite, got NaN",
        ),
        (
            vec![
                ("x.npy", numbers(&[0.0, 1.0, 1.0, 2.0], "(4,)")),
                row("(4,)"),
            ],
            "x[2]: must be above the one before it, 1, got 1",
        ),
        (
            vec![
                ("x.npy", numbers(&[0.0, 1.0, 2.0, 3.0], "(2, 2)")),
                row("(4,)"),
            ],
            "x: must have one dimension, got the shape [2, 2]",
        ),
        (
            vec![
                ("x.npy", numbers(&[0.0, 1.0, 2.0, 3.0], "(4,)")),
                ("z.npy", numbers(&[5.0], "(1,)")),
                (
                    "lateral.npy",
                    numbers(&[0.0, 1.0, f64::INFINITY, 3.0], "(1, 4)"),
                ),
            ],
            "lateral[0][2]: must be finite, got inf",
        ),
        (
            vec![stations(), row("(5,)")],
            "vertical: must have 40 bytes of data, got 32",
        ),
        (
            vec![("vertical.npy", array("|O", "(4,)", &[]))],
            "vertical: must be real numbers or text, got the type |O  hint: such as numpy.asarray(values, dtype=float)",
        ),
        (
            vec![("notes.txt", b"hello".to_vec())],
            "notes.txt: must be an .npy array  hint: numpy.savez writes them",
        ),
        (
            vec![
                ("units.npy", array("|S3", "()", b"cub")),
                stations(),
                row("(4,)"),
            ],
            "units: must be units of length and force  hint: such as [\"ft\", \"lbf\", \"s\"]; length ft, in, m or mm; force lbf, kip, N or kN",
        ),
        (
            vec![
                ("units.npy", numbers(&[1.0], "()")),
                stations(),
                row("(4,)"),
            ],
            "units: must be text  hint: such as numpy.array([\"ft\", \"lbf\", \"s\"])",
        ),
        (
            vec![("tables.npy", array("|S1", "(1,)", b"q")), stations()],
            "tables[0]: no array is called `q`",
        ),
        (
            vec![
                ("tables.npy", array("|S8", "(1,)", b"vertical")),
                ("ids.npy", numbers(&[0.5], "(1,)")),
                stations(),
                row("(4,)"),
            ],
            "ids[0]: must be a whole number above 0, got 0.5",
        ),
    ];
    for (members, expected) in cases {
        assert_eq!(
            refusal("a.npz", &archive(&members), Some(FT_LBF)),
            format!("a.npz: {expected}")
        );
    }
}

#[test]
fn an_archive_that_is_none_or_broken_is_refused() {
    let found = refusal("a.npz", b"hello", None);
    assert!(
        found.starts_with("a.npz: must be a zip archive of arrays, got "),
        "{found}"
    );
    let mut broken = bytes(&data("plain.npz"));
    // a byte of the values: the checksum tells
    broken[700] ^= 1;
    let found = refusal("plain.npz", &broken, None);
    assert!(found.contains("cannot be unpacked"), "{found}");
}

#[test]
fn units_are_never_guessed_nor_overruled() {
    let set = refusal(
        "plain.npz",
        &bytes(&data("plain.npz")),
        Some(Units {
            length: formats::units::Length::Metre,
            ..FT_LBF
        }),
    );
    assert_eq!(
        set,
        "plain.npz: already states its units: ft and lbf, got m and lbf  hint: leave the units out"
    );
    let adm = "t\nSPLINE/6, X=0,1,2,3, Y=1,2,3,4\nEND\n";
    let found = refusal("a.adm", adm.as_bytes(), None);
    assert!(
        found.starts_with("a.adm: has no UNITS statement  hint: such as UNITS/")
            && found.contains("or specify --length ft --force lbf")
    );
    assert_eq!(
        read("a.adm", adm.as_bytes(), Some(FT_LBF)).map(|set| set.units),
        Ok(FT_LBF)
    );
}

#[test]
fn an_ending_without_a_format_is_refused() {
    assert_eq!(
        refusal("a.xlsx", b"PK", None),
        "a.xlsx: the extension of the file is not that of a known format  hint: use .adm, .cmd, .csv, .json or .npz"
    );
}
