//! Error that the evaluation of a grid adds to that of the factor.

use std::collections::BTreeMap;

use nalgebra::SVector;
use splines::{Probe, RailElement, RoundingSizes};

use crate::assembly::{Combination, Extended, Matrix12, Real, Released};
use crate::error::Error;
use crate::factor::Solver;
use crate::influence::frame::FactoredFrame;
use crate::influence::layout::{StateRows, tip_rows, to_rail_axes};

/// Largest relative error of one rounding: half the spacing of doubles at one.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// Roundings in an entry of a load, relative to the magnitudes that it is added up from: cubic, place, arms; and half
/// of those at which a term counts as zero.
const LOAD: f64 = 12.0;
/// Roundings in the Green's function of the fixed rail element.
const ELEMENT: f64 = 16.0;
/// Roundings in products and reciprocals of the sections, and in the last sum.
pub(super) const SECTION: f64 = 4.0;
/// Roundings of a product of two solves beside those of its sum.
const PRODUCT: f64 = 2.0;
/// Roundings in the compliance of the releases of a member, relative to those of Green's function.
const RELEASE: f64 = 4.0;
/// Roundings of double-doubles in loads, Green's function and products of two loads: 12, 16 and at most 24.
const EXTENDED: f64 = 64.0;
/// Rounding of coordinates in double-doubles, in roundings of their sizes.
const COORDINATE: f64 = 1.0;

/// The precision whose rounding is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Evaluation {
    /// Doubles. The bound is infinite for a place whose compliance is only rounding.
    Doubles,
    /// Doubles, without such places.
    DoublesWhereStiff,
    /// Double-doubles, without such places.
    Extended,
}

impl Evaluation {
    /// Relative errors of an entry of a load and of Green's function.
    fn units(self) -> [f64; 2] {
        match self {
            Evaluation::Extended => [EXTENDED * Extended::ROUNDING; 2],
            _ => [LOAD * UNIT, ELEMENT * UNIT],
        }
    }
}

impl FactoredFrame {
    /// Bound of |error of G_ij| / sqrt(G_ii G_jj) from the rounding of loads, products and rail elements in doubles,
    /// for the probes `at` with G_ii = `diagonal`; `roundings` are those of the sum that a product is.
    ///
    /// With w = L^-1 p an error dp changes w by |L^-1 dp| <= sum |dp_k| |L^-1 e_k|, and G_ij by that times
    /// |w_j|. An error of the place changes the load by its derivative. The norms |L^-1 e_k| are at first bounded by
    /// sqrt(|K^-1|); only if that bound does not meet the accuracy are they computed.
    ///
    /// # Source
    /// Higham, Accuracy and Stability of Numerical Algorithms (2002), sections 3.1 and 5.1.
    pub(super) fn rounding(
        &self,
        at: &[Probe],
        roundings: usize,
        diagonal: &[f64],
        evaluation: Evaluation,
    ) -> Result<f64, Error> {
        let products = UNIT * (SECTION + roundings as f64 + PRODUCT);
        let bound = match self.solver() {
            Solver::Double(_) => Some(self.inverse_norm().sqrt()),
            Solver::Extended(_) => None,
        };
        let rough = products
            + self.place_rounding(&mut UnitNorms::new(self, bound), at, diagonal, evaluation)?;
        if bound.is_none() || self.certificate().error_bound + rough <= self.accuracy() {
            return Ok(rough);
        }
        Ok(products
            + self.place_rounding(&mut UnitNorms::new(self, None), at, diagonal, evaluation)?)
    }

    /// The same in double-doubles, with `inverse_norm` of their stiffness, rounded to doubles at the end.
    pub(super) fn extended_rounding(
        &self,
        at: &[Probe],
        diagonal: &[f64],
        inverse_norm: f64,
    ) -> Result<f64, Error> {
        let bounds = [Some(inverse_norm.sqrt()), None];
        let mut places = f64::INFINITY;
        for bound in bounds {
            places = self.place_rounding(
                &mut UnitNorms::new(self, bound),
                at,
                diagonal,
                Evaluation::Extended,
            )?;
            if places <= UNIT {
                break;
            }
        }
        Ok(SECTION * UNIT + places)
    }

    /// Largest relative error of loads and Green's function over the places.
    fn place_rounding(
        &self,
        norms: &mut UnitNorms,
        at: &[Probe],
        diagonal: &[f64],
        evaluation: Evaluation,
    ) -> Result<f64, Error> {
        let [load_unit, element_unit] = evaluation.units();
        let mut worst = 0.0_f64;
        for (&probe, &own) in at.iter().zip(diagonal) {
            let (index, axes, sizes) = self.rounding_sizes(probe, evaluation)?;
            let carrier = &self.line()?.elements()[index];
            let mut moved = 0.0;
            let errors: [f64; 12] =
                std::array::from_fn(|k| load_unit * sizes.row[k] + sizes.moved_row[k]);
            for (k, &error) in errors.iter().enumerate().filter(|(_, error)| **error > 0.0) {
                moved += error * self.state_norm(carrier.ends[k / 6], k % 6, norms, evaluation);
            }
            let [ends, growth] =
                self.released_errors(carrier, &sizes.row, &errors, axes * load_unit);
            moved += ends.sqrt();
            let element = element_unit * (sizes.green + RELEASE * growth * own) + sizes.moved_green;
            if moved == 0.0 && element == 0.0 {
                continue;
            }
            let turned = 2.0 * load_unit * (sizes.turned_green / own).sqrt();
            let relative = 2.0 * moved / own.sqrt() + element / own + turned;
            if relative < 1.0 {
                worst = worst.max(relative);
            } else if evaluation == Evaluation::Doubles {
                return Ok(f64::INFINITY);
            }
        }
        Ok(worst)
    }

    /// Compliance of the releases of the member that carries an element, under the `errors` of a shape row with the
    /// sizes `row`; and by how much the releases enlarge the rounding of this compliance.
    fn released_errors(
        &self,
        carrier: &RailElement,
        row: &[f64; 12],
        errors: &[f64; 12],
        turned: f64,
    ) -> [f64; 2] {
        let released = carrier
            .member
            .and_then(|member| self.elements[member.id].released.as_deref());
        let Some(Released {
            compliance, growth, ..
        }) = released
        else {
            return [0.0; 2];
        };
        let to_rail: Matrix12 = to_rail_axes(carrier);
        let all = Matrix12::from_fn(|i, j| if i / 3 == j / 3 { turned } else { 0.0 });
        let (row, errors) = (
            SVector::<f64, 12>::from(*row),
            SVector::<f64, 12>::from(*errors),
        );
        // A load at one end of the rail element acts at the other end of the member where that runs against it.
        let errors =
            to_rail.abs().transpose() * errors + swapped_if(all * row, carrier.is_reversed());
        [
            (errors.transpose() * compliance.abs() * errors)[0] * growth,
            *growth,
        ]
    }

    /// Element of a probe, the error of its axes in roundings, and sizes behind its functions there.
    fn rounding_sizes(
        &self,
        probe: Probe,
        evaluation: Evaluation,
    ) -> Result<(usize, f64, RoundingSizes), Error> {
        let line = self.line()?;
        let near = line.element_at(probe)?;
        let layout = self.exact_layout();
        if evaluation == Evaluation::Extended {
            let element = self.carrier(near, probe);
            let [first, last] = layout.elements[element].x;
            let x = Extended::from(probe.x);
            let distances = [(x - first).double(), (last - x).double()];
            let errors = layout.coordinates[element].map(|x| COORDINATE * Extended::ROUNDING * x);
            let (fractions, shift) = place_and_shift(distances, (last - first).double(), errors);
            let axes = layout.axes_error[element];
            return Ok((
                element,
                axes,
                line.rounding_sizes(element, probe.axis, fractions, [axes, shift], false),
            ));
        }
        let [first, last] = line.elements()[near].x;
        let distances = [probe.x - first, last - probe.x];
        // The rounding of the ends to doubles is known.
        let errors = layout.rounding(near);
        let (fractions, shift) = place_and_shift(distances, last - first, errors);
        let axes = layout.axes_error[near] * Extended::ROUNDING / UNIT;
        let mut sizes = line.rounding_sizes(near, probe.axis, fractions, [axes, shift], true);
        // The place may be on the next element.
        let unsure = distances
            .iter()
            .zip(errors)
            .any(|(x, error)| error > 0.0 && *x <= 2.0 * error);
        if unsure && evaluation == Evaluation::Doubles {
            sizes.moved_green = f64::INFINITY;
        }
        Ok((near, axes, sizes))
    }

    /// Sum of |p_k| |L^-1 e_k| over the unknowns of a load along degree of freedom `dof` of a state, with the
    /// magnitudes of its row.
    fn state_norm(
        &self,
        state: usize,
        dof: usize,
        norms: &mut UnitNorms,
        evaluation: Evaluation,
    ) -> f64 {
        if let Some(&known) = norms.of_states.get(&(state, dof)) {
            return known;
        }
        let norm = match &self.exact_layout().states[state] {
            StateRows::Tip {
                point,
                offset,
                rail,
            } if evaluation == Evaluation::Extended => {
                self.load_norm(&tip_rows(&self.bodies, *point, offset, rail)[dof], norms)
            }
            _ => self.load_norm(&self.states()[state][dof], norms),
        };
        norms.of_states.insert((state, dof), norm);
        norm
    }

    fn load_norm<T: Real>(&self, row: &Combination<T>, norms: &mut UnitNorms) -> f64 {
        let mut total = 0.0;
        for (column, size) in row.magnitudes() {
            let (body, own) = (&self.bodies.list[column / 6], column % 6);
            for k in 0..6 {
                let part = size * body.basis[(own, k)].abs();
                if part > 0.0
                    && let Some(unknown) = self.unknown(column - own + k)
                {
                    total += part * self.scale(unknown) * norms.of(unknown);
                }
            }
        }
        total
    }
}

/// Distances of a place from both ends in lengths of the element, and the error of the smaller distance by those of the
/// coordinates of the ends.
fn place_and_shift(distances: [f64; 2], extent: f64, errors: [f64; 2]) -> ([f64; 2], f64) {
    let fractions = distances.map(|x| x / extent);
    let near = usize::from(fractions[1] < fractions[0]);
    // Places beyond an end count as the end.
    if distances[near] < -errors[near] {
        return (fractions, 0.0);
    }
    (
        fractions,
        errors[near] + fractions[near].max(0.0) * (errors[0] + errors[1]),
    )
}

/// Loads on both ends of a member, exchanged where it runs against its rail element.
fn swapped_if(loads: SVector<f64, 12>, reversed: bool) -> SVector<f64, 12> {
    SVector::from_fn(|k, _| loads[if reversed { (k + 6) % 12 } else { k }])
}

/// |L^-1 e_k|: one bound for all, or computed for each unknown that is asked for.
struct UnitNorms<'a> {
    frame: &'a FactoredFrame,
    bound: Option<f64>,
    computed: BTreeMap<usize, f64>,
    /// Norms of the loads along the degrees of freedom of states, in one precision.
    of_states: BTreeMap<(usize, usize), f64>,
}

impl UnitNorms<'_> {
    fn new(frame: &FactoredFrame, bound: Option<f64>) -> UnitNorms<'_> {
        UnitNorms {
            frame,
            bound,
            computed: BTreeMap::new(),
            of_states: BTreeMap::new(),
        }
    }

    fn of(&mut self, unknown: usize) -> f64 {
        let compute = || {
            let own = self.frame.gram(&[vec![(unknown, 1.0)]]).value;
            own[(0, 0)].sqrt()
        };
        self.bound
            .unwrap_or_else(|| *self.computed.entry(unknown).or_insert_with(compute))
    }
}
