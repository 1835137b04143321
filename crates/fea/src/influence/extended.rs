//! Influence coefficients in double-doubles, for geometry at which doubles lose digits.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use nalgebra::DMatrix;
use num_traits::Zero;
use splines::{Axis, ElementFunctions, Probe, RailElement};

use crate::assembly::{Bodies, Combination, Element, Extended, Matrix12, Real};
use crate::error::Error;
use crate::factor::{Certificate, Factor, Factored, Solver};
use crate::influence::frame::{ExtendedFrame, FactoredFrame};
use crate::influence::layout::{StateRows, released_rows, tip_rows, to_rail_axes};

/// A probe with its load in double-doubles.
struct Place {
    axis: Axis,
    x: Extended,
    functions: ElementFunctions<Extended>,
    shapes: [Extended; 12],
    load: Vec<(usize, Extended)>,
}

impl FactoredFrame {
    /// Influence coefficients of the probes `at`, computed in double-doubles and rounded, and their certificate.
    /// `None` where the factor in double-doubles would take minutes, or does not exist.
    ///
    /// # Errors
    /// As [`FactoredFrame::grid`].
    pub(super) fn extended_grid(
        &self,
        at: &[Probe],
    ) -> Result<Option<(DMatrix<f64>, Certificate)>, Error> {
        let Some(extended) = self.extended() else {
            return Ok(None);
        };
        let (factor, certificate, inverse_norm) = match (&extended.factored, self.solver()) {
            (
                Some(Factored {
                    solver: Solver::Extended(factor),
                    certificate,
                    inverse_norm,
                }),
                _,
            ) => (factor, *certificate, *inverse_norm),
            (None, Solver::Extended(factor)) => (factor, self.certificate(), self.inverse_norm()),
            _ => return Ok(None),
        };
        let mut rows = BTreeMap::new();
        let places: Vec<Place> = at
            .iter()
            .map(|&probe| self.place(extended, probe, &mut rows))
            .collect::<Result<_, Error>>()?;
        let mut value = DMatrix::zeros(at.len(), at.len());
        for (j, place) in places.iter().enumerate() {
            let x = solved(factor, &place.load);
            for (i, other) in places.iter().enumerate().skip(j) {
                let zero = Extended::zero();
                let through = other
                    .load
                    .iter()
                    .fold(zero, |sum, &(k, load)| sum + load * x[k]);
                let entry = (through + self.between_fixed_ends(other, place)?).double();
                value[(i, j)] = entry;
                value[(j, i)] = entry;
            }
        }
        let diagonal: Vec<f64> = (0..at.len()).map(|k| value[(k, k)]).collect();
        let rounding = self.extended_rounding(at, &diagonal, inverse_norm)?;
        let error_bound = certificate.error_bound + rounding;
        Ok(Some((
            value,
            Certificate {
                error_bound,
                ..certificate
            },
        )))
    }

    /// Formed when it is first needed.
    fn extended(&self) -> Option<&ExtendedFrame> {
        let form = || {
            let numbering = &self.stiffness().numbering;
            let factored = match self.solver() {
                Solver::Extended(_) => None,
                Solver::Double(_) => Some(Factored::extended(self.model(), self.stiffness()).ok()?),
            };
            let mut bodies = Bodies::new(self.model());
            bodies.turn(&numbering.turned);
            Some(ExtendedFrame { factored, bodies })
        };
        self.extended_cell().get_or_init(form).as_ref()
    }

    /// The load of a unit force at a probe.
    fn place(
        &self,
        extended: &ExtendedFrame,
        probe: Probe,
        rows: &mut BTreeMap<usize, [Combination<Extended>; 6]>,
    ) -> Result<Place, Error> {
        let x = Extended::from(probe.x);
        let index = self.carrier(self.line()?.row(probe)?.element, probe);
        let functions = ElementFunctions::new(self.exact_layout().elements[index].clone());
        let shapes = functions.shapes(probe.axis, x);
        let mut sum = Combination::default();
        for (k, &shape) in shapes
            .iter()
            .enumerate()
            .filter(|(_, shape)| **shape != Extended::zero())
        {
            let state = functions.element().ends[k / 6];
            let own = match rows.entry(state) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(place) => place.insert(self.state_rows(extended, state)?),
            };
            sum.add_scaled(&own[k % 6], shape);
        }
        let unknown = |(column, value): (usize, Extended)| {
            let k = self.unknown(column)?;
            Some((k, value * Extended::from(self.scale(k))))
        };
        let load = extended
            .bodies
            .supported(&sum)
            .terms()
            .filter_map(unknown)
            .collect();
        Ok(Place {
            axis: probe.axis,
            x,
            functions,
            shapes,
            load,
        })
    }

    /// The rail element that carries a probe to all digits: `near`, or where its rounded ends mislead, another one.
    pub(super) fn carrier(&self, near: usize, probe: Probe) -> usize {
        let x = Extended::from(probe.x);
        let elements = &self.exact_layout().elements;
        let holds = |element: &RailElement<Extended>| {
            element.rail == probe.rail && element.x[0] <= x && x <= element.x[1]
        };
        if holds(&elements[near]) {
            near
        } else {
            elements.iter().position(holds).unwrap_or(near)
        }
    }

    /// Rows of a state in double-doubles.
    fn state_rows(
        &self,
        extended: &ExtendedFrame,
        state: usize,
    ) -> Result<[Combination<Extended>; 6], Error> {
        match &self.exact_layout().states[state] {
            StateRows::Tip {
                point,
                offset,
                rail,
            } => Ok(tip_rows(&extended.bodies, *point, offset, rail)),
            StateRows::Released { member, end, rail } => {
                let element = Element::<Extended>::new(self.model(), *member)?;
                Ok(element
                    .released
                    .as_deref()
                    .map_or_else(Default::default, |released| {
                        released_rows(
                            &element,
                            released,
                            &extended.bodies,
                            *end,
                            &rail.axes,
                            rail.error,
                        )
                    }))
            }
        }
    }

    /// Coefficient of two places while the tips of the rigid offsets of their members are fixed: Green's function,
    /// and the compliance of the releases. Zero on different members.
    fn between_fixed_ends(&self, p: &Place, q: &Place) -> Result<Extended, Error> {
        let carriers =
            [p, q].map(|place| place.functions.element().member.map(|carrier| carrier.id));
        let [Some(member), Some(other)] = carriers else {
            return Ok(Extended::zero());
        };
        if member != other {
            return Ok(Extended::zero());
        }
        let mut sum = p
            .functions
            .clamped_green(p.axis, p.x, &q.functions, q.axis, q.x);
        if self.elements[member].released.is_some()
            && let Some(released) = Element::<Extended>::new(self.model(), member)?.released
        {
            let loads = [p, q].map(|place| {
                let to_rail: Matrix12<Extended> = to_rail_axes(place.functions.element());
                to_rail.transpose() * nalgebra::SVector::<Extended, 12>::from(place.shapes)
            });
            sum += (loads[0].transpose() * released.compliance * loads[1])[0];
        }
        Ok(sum)
    }
}

/// K^-1 p.
fn solved(factor: &Factor<Extended>, load: &[(usize, Extended)]) -> Vec<Extended> {
    let mut x = vec![Extended::zero(); factor.len()];
    load.iter().for_each(|&(k, value)| x[k] += value);
    factor.solve(&mut x);
    x
}
