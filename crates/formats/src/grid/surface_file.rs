//! Member `surface` of a grid file: the exact compliance, stored as rail elements and the compliance of their end
//! nodes.
//!
//! `cells` are the rail elements. `compliance` is a matrix over the node states, each with six degrees of freedom (ux
//! uy uz rx ry rz, in the frame of the rail). `null` represents an infinite compliance, which belongs to an
//! unrestrained motion.

use std::sync::Arc;

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use splines::{ElementMember, ExactSurface, Flexibility, RailElement, Rails};

use super::rows::MatrixRows;
use crate::text::fault::{Fault, Faults};
use crate::text::place::Place;

crate::text::object::objects!(RawSurface, RawCell);

/// The exact influence surface between the stations.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
pub(crate) struct RawSurface {
    /// Rail elements.
    cells: Vec<RawCell>,
    /// Compliance of the end states of all rail elements, with six degrees of freedom for each state.
    compliance: Vec<Vec<Option<f64>>>,
}

/// A rail element: a part of a rail on one member.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "an object", remote = "Self")]
struct RawCell {
    /// Index of the rail.
    rail: usize,
    /// First and last coordinate along the rail, length.
    x: [f64; 2],
    /// What rounding took from them, to be added; none where they are exact.
    x_rest: Option<[f64; 2]>,
    /// Indices of the two end states.
    ends: [usize; 2],
    /// Length of the element.
    length: f64,
    /// Unit vectors of the local axes, in the axes of the rail.
    frame: [[f64; 3]; 3],
    /// Vector from the element to the rail, length.
    offset: [f64; 3],
    /// 1/EA, 1/GJ, 1/EIy, 1/EIz, 1/(G Asy) and 1/(G Asz); null where nothing resists.
    flexibility: [Option<f64>; 6],
    /// Axial force about which the element is linear, positive in tension; by default 0.
    tension: Option<f64>,
    /// Number that is equal for all elements on one member.
    member: Option<usize>,
    /// Whether the member runs opposite to the rail.
    #[serde(default)]
    reversed: bool,
}

/// The member of a surface as it is written, straight from its numbers: a tree of JSON values would take nine times
/// their memory. JSON has no infinity: `serde_json` writes `null`.
#[derive(Serialize)]
pub(crate) struct WrittenSurface<'a> {
    cells: Vec<WrittenCell<'a>>,
    compliance: MatrixRows<'a>,
}

/// A rail element as it is written.
#[derive(Serialize)]
struct WrittenCell<'a> {
    rail: usize,
    x: &'a [f64; 2],
    ends: &'a [usize; 2],
    length: f64,
    frame: &'a [[f64; 3]; 3],
    offset: &'a [f64; 3],
    flexibility: [f64; 6],
    #[serde(skip_serializing_if = "Option::is_none")]
    tension: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    x_rest: Option<&'a [f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    member: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reversed: Option<bool>,
}

impl<'a> WrittenSurface<'a> {
    /// The member of `surface`.
    pub(crate) fn of(surface: &'a ExactSurface) -> WrittenSurface<'a> {
        let rails = surface.rails();
        let cells = rails
            .elements()
            .iter()
            .zip(rails.rests())
            .map(|(cell, rest)| {
                let f = &cell.flexibility;
                WrittenCell {
                    rail: cell.rail,
                    x: &cell.x,
                    ends: &cell.ends,
                    length: cell.length,
                    frame: &cell.frame,
                    offset: &cell.offset,
                    flexibility: [
                        f.axial,
                        f.torsion,
                        f.bending_y,
                        f.bending_z,
                        f.shear_y,
                        f.shear_z,
                    ],
                    tension: (f.tension != 0.0).then_some(f.tension),
                    x_rest: (*rest != [0.0; 2]).then_some(rest),
                    member: cell.member.map(|carrier| carrier.id),
                    reversed: cell
                        .member
                        .and_then(|carrier| carrier.reversed.then_some(true)),
                }
            });
        WrittenSurface {
            cells: cells.collect(),
            compliance: MatrixRows(surface.nodal()),
        }
    }
}

impl RawSurface {
    /// Reads the compliance from the member; `None` and a fault if the elements or the matrix are invalid.
    pub fn surface(&self, place: &Place<'_>, faults: &mut Faults) -> Option<ExactSurface> {
        let finite_or_infinite = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
        let cells: Vec<RailElement> = self
            .cells
            .iter()
            .map(|raw| {
                let [axial, torsion, bending_y, bending_z, shear_y, shear_z] =
                    raw.flexibility.map(finite_or_infinite);
                RailElement {
                    rail: raw.rail,
                    x: raw.x,
                    ends: raw.ends,
                    length: raw.length,
                    frame: raw.frame,
                    offset: raw.offset,
                    flexibility: Flexibility {
                        axial,
                        torsion,
                        bending_y,
                        bending_z,
                        shear_y,
                        shear_z,
                        tension: raw.tension.unwrap_or_default(),
                    },
                    member: raw.member.map(|member| ElementMember {
                        id: member,
                        reversed: raw.reversed,
                    }),
                }
            })
            .collect();
        let rests: Vec<[f64; 2]> = self
            .cells
            .iter()
            .map(|raw| raw.x_rest.unwrap_or_default())
            .collect();
        for (index, (raw, rest)) in self.cells.iter().zip(&rests).enumerate() {
            if raw.x.iter().zip(rest).any(|(x, rest)| x + rest != *x) {
                let list = place.key("cells");
                let fault = Fault::new(
                    &list.index(index).key("x_rest"),
                    "must be less than the rounding of `x`",
                );
                faults.add(fault.got(format!("{rest:?}")));
                return None;
            }
        }
        let line = match Rails::new(cells) {
            Ok(line) => Arc::new(line.with_rests(rests)),
            Err(error) => {
                faults.add(Fault::new(&place.key("cells"), error.to_string()));
                return None;
            }
        };
        let size = 6 * line.state_count();
        let at = place.key("compliance");
        if self.compliance.len() != size || self.compliance.iter().any(|row| row.len() != size) {
            faults.add(Fault::new(
                &at,
                format!("must be {size} x {size}: six degrees of freedom for each state"),
            ));
            return None;
        }
        let nodal = DMatrix::from_fn(size, size, |i, j| finite_or_infinite(self.compliance[i][j]));
        match ExactSurface::new(line, nodal) {
            Ok(surface) => Some(surface),
            Err(error) => {
                faults.add(Fault::new(&at, error.to_string()));
                None
            }
        }
    }
}
