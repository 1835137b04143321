//! Tables of grids: which there are, under which numbers, of one rail and of several.

use formats::grid::block::GridBlock;
use formats::grid::{GridRail, StationGrid};
use formats::tables::{TableFormat, TableSet, data_set, expand, factor, read, select, write};
use formats::units::{Force, Length, Units};
use nalgebra::DMatrix;
use splines::Rank;

use super::ENDINGS;

/// Rails side by side on springs and on each other: G = A A^T over vertical and lateral directions.
fn grid(rails: usize) -> StationGrid {
    let name = |index: usize| format!("rail {}", index + 1);
    let stations = |index: usize| [0.0, 1.0, 2.5, 4.0 + index as f64].to_vec();
    let n = 4 * rails;
    let root = DMatrix::from_fn(2 * n, 2 * n, |i, j| {
        1e-4 * ((i * 7 + j * 3) as f64 / 5.0).cos() / (1.0 + j as f64)
    });
    let all = &root * root.transpose();
    let all = 0.5 * (&all + all.transpose());
    let block = |i: usize, j: usize| all.view((i * n, j * n), (n, n)).into_owned();
    StationGrid {
        name: "two rails".to_owned(),
        units: Units {
            length: Length::Foot,
            force: Force::Kip,
        },
        theory: None,
        rails: (0..rails)
            .map(|index| GridRail {
                name: name(index),
                stations: stations(index),
            })
            .collect(),
        blocks: vec![
            (GridBlock::Vertical, block(0, 0)),
            (GridBlock::Lateral, block(1, 1)),
            (GridBlock::VerticalLateral, block(0, 1)),
        ],
        certificate: None,
        effects: None,
        critical: None,
        notes: Vec::new(),
    }
}

fn ids(set: &TableSet) -> Vec<u32> {
    set.tables.iter().map(|table| table.id).collect()
}

#[test]
fn a_data_set_read_back_has_the_grid_bit_for_bit() {
    let text = adams::tables::write(&data_set(&grid(1))).expect("plain names");
    let back = adams::tables::read(&text).expect("our own text");
    assert_eq!(back.splines, data_set(&grid(1)).splines);
    assert_eq!(back.units.map(Units::of_adams), Some(grid(1).units));
    assert_eq!(ids(&TableSet::of_grid(&grid(1))), [6, 7, 9]);
    let vertical = &grid(1).blocks[0].1;
    assert_eq!(
        back.splines[0].curves.y().concat(),
        vertical.transpose().as_slice()
    );
}

#[test]
fn every_pair_of_rails_has_its_tables_once() {
    let set = TableSet::of_grid(&grid(2));
    // pairs (0, 0), (0, 1), (1, 0), (1, 1); direct tables of (1, 0) are the transposes of (0, 1)
    assert_eq!(ids(&set), [6, 7, 9, 12, 13, 15, 21, 24, 25, 27]);
    let across = &set.tables[3];
    assert_eq!(across.curves.y()[1][2], grid(2).blocks[0].1[(1, 6)]);
    assert_eq!(
        across.rails,
        Some(["rail 1".to_owned(), "rail 2".to_owned()])
    );
    assert_eq!((across.curves.x()[3], across.curves.z()[3]), (5.0, 4.0));
}

#[test]
fn files_of_two_rails_read_back_with_their_rails() {
    let set = TableSet::of_grid(&grid(2));
    for ending in ENDINGS {
        let name = format!("two rails.{ending}");
        let bytes = write(&set, TableFormat::of(&name).expect("a format")).expect("writable");
        let back = read(&name, &bytes, None).expect("our own file");
        for (back, table) in back.tables.iter().zip(&set.tables) {
            assert_eq!(
                (back.id, back.quantity, &back.curves),
                (table.id, table.quantity, &table.curves)
            );
        }
        if ["json", "npz"].contains(&ending) {
            assert_eq!(back, set, "{ending}");
        }
    }
}

#[test]
fn coupled_directions_of_two_rails_share_their_curves() {
    let set = TableSet::of_grid(&grid(2));
    let found = factor(&set, Rank::Full).expect("one structure");
    assert_eq!(found.ranks.len(), 1);
    assert_eq!(found.set.tables.len(), 4 * found.ranks[0][0]);
    assert_eq!(found.set.products.len(), set.tables.len());
    assert!(found.stations.largest < 1e-13, "{:?}", found.stations);
    for ending in ["json", "npz"] {
        let name = format!("two rails.{ending}");
        let bytes = write(&found.set, TableFormat::of(&name).expect("a format")).expect("writable");
        assert_eq!(
            read(&name, &bytes, None).as_ref(),
            Ok(&found.set),
            "{ending}"
        );
    }
    // from text, which has no rails: the same numbers
    let bytes = write(&found.set, TableFormat::Adams).expect("writable");
    let back = expand(&read("a.adm", &bytes, None).expect("our own file"));
    assert_eq!(back.tables.len(), set.tables.len());
    for (back, table) in back.tables.iter().zip(&expand(&found.set).tables) {
        assert_eq!(
            (&back.curves, back.quantity),
            (&table.curves, table.quantity)
        );
    }
}

#[test]
fn directions_choose_tables_and_the_curves_of_their_products() {
    let set = TableSet::of_grid(&grid(2));
    let lateral = select(&set, &[GridBlock::Lateral]);
    assert_eq!(ids(&lateral), [7, 13, 25]);
    let factored = factor(&set, Rank::Full).expect("one structure").set;
    let lateral = select(&factored, &[GridBlock::Lateral]);
    assert_eq!(
        (lateral.products.len(), lateral.tables.len()),
        (3, factored.tables.len() / 2)
    );
    assert_eq!(
        select(&factored, &[GridBlock::Vertical, GridBlock::Lateral]),
        factored
    );
    assert!(select(&set, &[GridBlock::Longitudinal]).tables.is_empty());
}

/// Ranges that a file of tables alone does not tell apart.
#[test]
fn tables_that_do_not_say_their_rails_are_factored_each_alone_or_refused() {
    let mut set = TableSet::of_grid(&grid(2));
    for table in &mut set.tables {
        table.rails = None;
    }
    assert!(factor(&set, Rank::Full).is_err());
    set.tables.retain(|table| [6, 7, 9].contains(&table.id));
    let coupled = factor(&set, Rank::Full).expect("one rail");
    assert_eq!((coupled.ranks.len(), coupled.set.products.len()), (1, 3));
    for table in &mut set.tables {
        table.quantity = None;
    }
    set.tables.truncate(2);
    let alone = factor(&set, Rank::Full).expect("two square tables");
    assert_eq!((alone.ranks.len(), alone.set.products.len()), (2, 2));
    assert!(alone.stations.largest < 1e-13);
}
