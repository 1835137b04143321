//! Deflections of a rail over one carrier as polynomials of the place and of the load's position.
//!
//! At a fraction u of the carrier the deflection under a unit load at p is a cubic in u with coefficients e_j(p) that are
//! cubic along each cell of the influence lines, plus the kernel K of the load where it stands before the section on the
//! same member (`kernel`):
//!
//! w(u, p) = sum over j of u^j e_j(p) + K(s - s_p).
//!
//! The e_j follow from four places, from whose influence lines the kernels are subtracted. The deflection from a chord
//! differs by a linear function of u.

use splines::Probe;

use crate::error::Error;
use crate::kernel::{Kernel, RailPoint};
use crate::line::{Lines, NODES, Stretch, in_powers};
use crate::structure::{Carrier, DEFLECTIONS, OnMember, QUANTITIES, Structure, deflection_axis};
use crate::train::COMPONENTS;

/// Coefficients of the deflection over a carrier.
pub(crate) const POWERS: usize = 4;

/// Influence lines of a carrier: of the quantities just inside its first end, and of the deflections over it, downwards
/// and along +z, where the structure resists them.
#[derive(Clone, Debug)]
pub(crate) struct CarrierLines {
    pub forces: Lines<QUANTITIES>,
    pub deflections: [Option<Lines<POWERS>>; 2],
}

impl Structure {
    /// Influence lines of the coefficients of a deflection over a carrier: absolute, or from the chord between two
    /// coordinates of its rail. `None` where the structure does not resist the deflection.
    pub(crate) fn deflection_lines(
        &self,
        carrier: &Carrier,
        direction: usize,
        chord: Option<[f64; 2]>,
        used: [bool; COMPONENTS],
    ) -> Result<Option<Lines<POWERS>>, Error> {
        let (axis, sign) = deflection_axis(DEFLECTIONS[direction]);
        if !self.rails[carrier.rail].resists[axis.component()] {
            return Ok(None);
        }
        let surface = self.surface()?;
        let loads = self.unit_kernels(carrier, direction)?;
        let places = NODES.map(|node| carrier.x[0] + node * (carrier.x[1] - carrier.x[0]));
        let ends = chord.as_ref().map_or(&[][..], |chord| &chord[..]);
        let within = chord.map(|chord| self.just_within(chord));
        let probes: Vec<Probe> = places
            .iter()
            .chain(within.iter().flatten())
            .map(|&x| Probe {
                rail: carrier.rail,
                x,
                axis,
            })
            .collect();
        let displacements = surface.displacement_lines(&probes)?;
        let mut moved = vec![0.0; probes.len()];
        let value = |probe: Probe, out: &mut [f64]| {
            displacements.fill(probe, &mut moved)?;
            let at = |k: usize| sign * moved[k];
            for (node, out) in out.iter_mut().enumerate() {
                let passed = self.passed(&loads, probe, carrier.place(places[node]));
                let below = chord.map_or(0.0, |[from, to]| {
                    let r = (places[node] - from) / (to - from);
                    (1.0 - r) * at(POWERS) + r * at(POWERS + 1)
                });
                *out = at(node) - passed - below;
            }
            Ok(())
        };
        let split = |stretch: &Stretch| self.opposite(carrier.rail, ends, stretch);
        let mut lines: Lines<POWERS> = self.lines(used, 1, split, value)?.remove(0);
        for cubics in lines
            .rails
            .iter_mut()
            .flatten()
            .flat_map(|cell| &mut cell.cubics)
        {
            let in_place: [[f64; POWERS]; 4] =
                std::array::from_fn(|p| in_powers(cubics.map(|cubic| cubic[p])));
            *cubics = std::array::from_fn(|j| std::array::from_fn(|p| in_place[p][j]));
        }
        Ok(Some(lines))
    }

    /// The rail elements on the member of a carrier, each with the kernels of a deflection for unit loads on it.
    pub(crate) fn unit_kernels<'s>(
        &'s self,
        carrier: &'s Carrier,
        direction: usize,
    ) -> Result<Vec<(OnMember<'s>, [Kernel; COMPONENTS])>, Error> {
        let point = RailPoint::new(self, carrier)?;
        let of = |on: OnMember<'s>| {
            let mut kernels = [Kernel::default(); COMPONENTS];
            for (component, kernel) in kernels.iter_mut().enumerate() {
                let [force, couple] = self.load(on.stretch, component)?;
                *kernel = point.kernels(&force, &couple)[direction];
            }
            Ok((on, kernels))
        };
        self.on_member(carrier).map(of).collect()
    }

    /// The kernel of a unit load at a probe, if it stands on the member of a carrier before the section at place s.
    fn passed(&self, loads: &[(OnMember<'_>, [Kernel; COMPONENTS])], probe: Probe, s: f64) -> f64 {
        let (rail, is_twin) = (
            probe.rail % self.rails.len(),
            probe.rail >= self.rails.len(),
        );
        let within = |on: &OnMember<'_>| {
            on.other.rail == rail && on.other.x[0] <= probe.x && probe.x <= on.other.x[1]
        };
        let Some((on, kernels)) = loads.iter().find(|(on, _)| within(on)) else {
            return 0.0;
        };
        let d = s - (on.start + on.rate * (probe.x - on.other.x[0]));
        if d <= 0.0 {
            return 0.0;
        }
        let component = probe.axis.component();
        let beside = if is_twin && component < 2 {
            kernels[component + 3].at(d)
        } else {
            0.0
        };
        kernels[component].at(d) + beside
    }
}
