//! Sets of tables of random numbers, and the program in a folder.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use adams::SplineValues;
use formats::grid::block::GridBlock;
use formats::tables::{Product, Table, TableSet};
use formats::units::{Force, Length, Units};
use tempfile::TempDir;

pub const FT_LBF: Units = Units {
    length: Length::Foot,
    force: Force::Pound,
};

/// The formats, by their endings.
pub const ENDINGS: [&str; 5] = ["adm", "cmd", "csv", "json", "npz"];

/// Random numbers from a seed.
pub struct Dice(fastrand::Rng);

impl Dice {
    pub fn new(seed: u64) -> Dice {
        Dice(fastrand::Rng::with_seed(seed))
    }

    pub fn below(&mut self, bound: usize) -> usize {
        self.0.usize(..bound.max(1))
    }

    /// Any finite double, by its bits.
    pub fn any(&mut self) -> f64 {
        loop {
            let value = f64::from_bits(self.0.u64(..));
            if value.is_finite() {
                return value;
            }
        }
    }

    /// So many increasing doubles of any size.
    pub fn increasing(&mut self, count: usize) -> Vec<f64> {
        let mut list: Vec<f64> = (0..count).map(|_| self.any()).collect();
        list.sort_by(f64::total_cmp);
        list.dedup();
        list
    }

    pub fn curves(&mut self, rows: usize, columns: usize) -> SplineValues {
        let (x, z) = (self.increasing(columns), self.increasing(rows));
        let values = (0..rows.max(1))
            .map(|_| x.iter().map(|_| self.any()).collect())
            .collect();
        SplineValues::new(x, z, values).expect("increasing")
    }
}

pub fn table(id: u32, name: &str, quantity: Option<GridBlock>, curves: SplineValues) -> Table {
    Table {
        id,
        name: name.to_owned(),
        quantity,
        rails: None,
        curves,
    }
}

/// Tables of any doubles, some with quantities, in shapes of every kind.
pub fn random_set(dice: &mut Dice) -> TableSet {
    let tables = vec![
        table(
            6,
            "bridge_rail_vertical",
            Some(GridBlock::Vertical),
            dice.curves(5, 5),
        ),
        table(
            10,
            "bridge_rail_vertical_longitudinal",
            Some(GridBlock::VerticalLongitudinal),
            dice.curves(4, 7),
        ),
        table(31, "spare", None, dice.curves(1, 4)),
        table(4_000_000_000, "one_curve", None, dice.curves(0, 9)),
    ];
    TableSet {
        name: "bridge".to_owned(),
        units: FT_LBF,
        tables,
        products: Vec::new(),
        left_out: Vec::new(),
    }
}

/// Curves of any doubles and the products that use them.
pub fn random_factored(dice: &mut Dice) -> TableSet {
    let (x, z) = (dice.increasing(6), dice.increasing(4));
    let mut tables = Vec::new();
    for k in 0..8 {
        let stations = if k < 4 { &x } else { &z };
        let values = stations.iter().map(|_| dice.any()).collect();
        let curves =
            SplineValues::new(stations.clone(), Vec::new(), vec![values]).expect("increasing");
        tables.push(table(101 + 25 * k, &format!("curve_{k}"), None, curves));
    }
    let id = |k: usize| tables[k].id;
    let product = |name: &str, quantity, terms| Product {
        name: name.to_owned(),
        quantity,
        rails: None,
        terms,
    };
    let products = vec![
        product(
            "a_vertical",
            Some(GridBlock::Vertical),
            (0..4).map(|k| [id(k), id(k)]).collect(),
        ),
        product(
            "a_vertical_lateral",
            Some(GridBlock::VerticalLateral),
            (0..4).map(|k| [id(k + 4), id(k)]).collect(),
        ),
        product("nothing", None, Vec::new()),
    ];
    TableSet {
        name: "bridge".to_owned(),
        units: FT_LBF,
        tables,
        products,
        left_out: Vec::new(),
    }
}

/// All numbers of a set, as bits.
pub fn bits(set: &TableSet) -> Vec<u64> {
    let numbers = |table: &Table| {
        [
            table.curves.x(),
            table.curves.z(),
            &table.curves.y().concat(),
        ]
        .concat()
    };
    set.tables
        .iter()
        .flat_map(numbers)
        .map(f64::to_bits)
        .collect()
}

pub fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../tests/tables/data")
        .join(name)
}

pub fn bytes(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("a readable file")
}

/// The program, in `folder`.
pub fn girderway(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

pub fn told(run: &Output) -> String {
    String::from_utf8_lossy(&run.stderr).into_owned()
}

/// The grid of the girder whose printed tables are SPLINE/6 and 7.
pub fn bogie_grid(folder: &Path) {
    let spec = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bogie/spec.json");
    let run = girderway(
        folder,
        &[
            "fea",
            &spec.display().to_string(),
            "-o",
            "grid.json",
            "--quiet",
        ],
    );
    assert_eq!(run.status.code(), Some(0), "{}", told(&run));
}
