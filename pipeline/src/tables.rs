//! Influence grids as SPLINE tables, in several formats.

use adams::{Curves, Spline, Tables};
use serde_json::json;

use crate::crosscheck::Quantity;
use crate::grid::Grid;
use crate::output;
use crate::units::{Dimension, Force, Length, Units};

/// Number of the first SPLINE: the paper's vertical table is SPLINE/6, its lateral one SPLINE/7.
const FIRST: usize = 6;

impl Units {
    /// The units of a data set.
    #[must_use]
    pub fn of_adams(units: adams::Units) -> Units {
        Units {
            length: match units.length {
                adams::Length::Foot => Length::Foot,
                adams::Length::Inch => Length::Inch,
                adams::Length::Meter => Length::Metre,
                adams::Length::Millimeter => Length::Millimetre,
            },
            force: match units.force {
                adams::Force::Pound => Force::Pound,
                adams::Force::Kilopound => Force::Kip,
                adams::Force::Newton => Force::Newton,
                adams::Force::Kilonewton => Force::Kilonewton,
            },
        }
    }

    /// A data set's UNITS; its mass unit is that of the system, or one that every solver knows.
    #[must_use]
    pub fn to_adams(self) -> adams::Units {
        let (length, mass) = match self.length {
            Length::Foot => (adams::Length::Foot, adams::Mass::Slug),
            Length::Inch => (adams::Length::Inch, adams::Mass::Pound),
            Length::Metre => (adams::Length::Meter, adams::Mass::Kilogram),
            Length::Millimetre => (adams::Length::Millimeter, adams::Mass::Kilogram),
        };
        let force = match self.force {
            Force::Pound => adams::Force::Pound,
            Force::Kip => adams::Force::Kilopound,
            Force::Newton => adams::Force::Newton,
            Force::Kilonewton => adams::Force::Kilonewton,
        };
        adams::Units { force, mass, length }
    }
}

/// The tables of a grid: x is where the load stands, z where the displacement is taken.
///
/// SPLINE/6 holds the vertical grid, 7 the lateral, 8 the longitudinal one, 9 to 11 the couplings
/// vertical-lateral, vertical-longitudinal, lateral-longitudinal. Of several rails, the six of the first with
/// itself come first, then those of each other pair; a direct grid of two rails stands once. Rails of fewer
/// than four stations, the least that a SPLINE may have, take no loads.
#[must_use]
pub fn data_set(grid: &Grid) -> Tables {
    let mut splines = Vec::new();
    let rails = &grid.rails;
    let mut pair = 0;
    let mut top = 0;
    for (r, row) in rails.iter().enumerate() {
        let mut left = 0;
        for (c, column) in rails.iter().enumerate() {
            for (index, quantity) in Quantity::ALL.into_iter().enumerate() {
                let direct = quantity.direct() == [quantity; 2];
                let Some(block) = grid.block(quantity).filter(|_| !direct || r <= c) else { continue };
                let (n, m) = (row.stations.len(), column.stations.len());
                let values = block.view((top, left), (n, m));
                let values = values.row_iter().map(|line| line.iter().copied().collect()).collect();
                let Ok(curves) = Curves::new(column.stations.clone(), row.stations.clone(), values) else {
                    continue;
                };
                let name = if r == c {
                    format!("{}_{}_{quantity}", grid.name, row.name)
                } else {
                    format!("{}_{}_from_{}_{quantity}", grid.name, row.name, column.name)
                };
                splines.push(Spline {
                    id: u32::try_from(FIRST + 6 * pair + index).unwrap_or(u32::MAX),
                    name: Some(plain(&name)),
                    units: Some("no_units".to_owned()),
                    linear: true,
                    curves,
                });
            }
            pair += 1;
            left += column.stations.len();
        }
        top += row.stations.len();
    }
    let unit = grid.units.label(Dimension::FLEXIBILITY);
    let title = format!("{}: influence coefficients, {unit}", grid.name);
    Tables { title: Some(title), units: Some(grid.units.to_adams()), splines }
}

/// The tables of a structure as an ADAMS data set; `None` where no rail has the stations that a SPLINE needs.
///
/// # Errors
/// More tables than identifiers.
pub fn adm(name: &str, grid: &Grid) -> Result<Option<String>, adams::Error> {
    let set = data_set(&Grid { name: name.to_owned(), ..grid.clone() });
    if set.splines.is_empty() { Ok(None) } else { adams::tables::write(&set).map(Some) }
}

/// A name that a data set can hold.
fn plain(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).take(56).collect()
}

/// The tables as JSON.
#[must_use]
pub fn to_json(grid: &Grid, set: &Tables) -> String {
    let table = |spline: &Spline| {
        json!({
            "id": spline.id, "name": spline.name, "x": spline.curves.x(), "z": spline.curves.z(), "values": spline.curves.y(),
        })
    };
    let tables: Vec<_> = set.splines.iter().map(table).collect();
    let object = json!({
        "format": "girderway-tables/1", "name": grid.name, "units": grid.units.json(), "tables": tables,
    });
    output::json(&object)
}

/// The tables as CSV, one value a line.
#[must_use]
pub fn to_csv(set: &Tables) -> String {
    let mut text = String::from("id,name,z,x,value\n");
    for spline in &set.splines {
        let name = spline.name.as_deref().unwrap_or_default().replace([',', '"'], "_");
        for (i, z) in spline.curves.z().iter().enumerate() {
            for (j, x) in spline.curves.x().iter().enumerate() {
                let value = json!(spline.curves.y()[i][j]);
                text.push_str(&format!("{},{name},{},{},{value}\n", spline.id, json!(z), json!(x)));
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::GridRail;
    use nalgebra::DMatrix;

    fn grid(rails: usize) -> Grid {
        let rails: Vec<GridRail> = (0..rails)
            .map(|index| GridRail { name: format!("rail {index}"), stations: vec![0.0, 1.0, 2.5, 4.0] })
            .collect();
        let n = 4 * rails.len();
        let vertical = DMatrix::from_fn(n, n, |i, j| 1e-8 / (1.0 + (i + j) as f64));
        let coupling = DMatrix::from_fn(n, n, |i, j| 1e-9 * (i as f64 - 2.0 * j as f64));
        Grid {
            name: "two rails".to_owned(),
            units: Units { length: Length::Foot, force: Force::Kip },
            theory: None,
            rails,
            blocks: vec![(Quantity::Vertical, vertical), (Quantity::VerticalLateral, coupling)],
            certificate: None,
            effects: None,
            notes: Vec::new(),
        }
    }

    #[test]
    fn a_data_set_read_back_has_the_grid_bit_for_bit() {
        let set = data_set(&grid(1));
        let text = adams::tables::write(&set).expect("plain names");
        let back = adams::tables::read(&text).expect("our own text");
        assert_eq!(back.splines, set.splines);
        assert_eq!(back.units.map(Units::of_adams), Some(grid(1).units));
        let ids: Vec<u32> = back.splines.iter().map(|spline| spline.id).collect();
        assert_eq!(ids, [6, 9]);
        let vertical = &grid(1).blocks[0].1;
        assert_eq!(back.splines[0].curves.y().concat(), vertical.transpose().as_slice());
    }

    #[test]
    fn every_pair_of_rails_has_its_tables_once() {
        let set = data_set(&grid(2));
        let ids: Vec<u32> = set.splines.iter().map(|spline| spline.id).collect();
        // pairs (0, 0), (0, 1), (1, 0), (1, 1); the vertical grid of (1, 0) is the transpose of (0, 1)
        assert_eq!(ids, [6, 9, 12, 15, 21, 24, 27]);
        let across = &set.splines[2].curves;
        assert_eq!(across.y()[1][2], grid(2).blocks[0].1[(1, 6)]);
    }

    #[test]
    fn csv_has_one_line_a_value() {
        let set = data_set(&grid(1));
        let text = to_csv(&set);
        assert_eq!(text.lines().count(), 1 + 2 * 16);
        assert_eq!(text.lines().nth(1), Some("6,two_rails_rail_0_vertical,0.0,0.0,1e-8"));
    }
}
