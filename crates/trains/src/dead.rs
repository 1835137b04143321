//! Dead load: the weight of the structure and uniform loads on rails.

use fea::{BeamTheory, Effect};
use nalgebra::Vector3;
use splines::Probe;

use crate::bent::Bent;
use crate::error::Error;
use crate::kernel::RailPoint;
use crate::line::Lines;
use crate::polynomial::Polynomial;
use crate::structure::{
    Carrier, DEFLECTIONS, GirderResponse, OnMember, QUANTITIES, Structure, deflection_axis,
    end_effects,
};

/// Loads that stay.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeadLoads {
    /// Acceleration of gravity with which everything that has mass weighs, along minus up; 0 for no weight.
    pub gravity: f64,
    /// Force per length of each rail, downwards; an empty list for none.
    pub lines: Vec<f64>,
}

impl DeadLoads {
    /// The load on a rail per length.
    pub(crate) fn line(&self, rail: usize) -> f64 {
        self.lines.get(rail).copied().unwrap_or(0.0)
    }

    /// Whether there is any.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.gravity == 0.0 && self.lines.iter().all(|line| *line == 0.0)
    }
}

/// The quantities of one carrier under dead load, as polynomials in the distance along it.
#[derive(Clone, Debug, Default)]
pub(crate) struct DeadLoad {
    /// Internal forces: a + b s + c s^2 + d s^3 each, d under axial force alone.
    forces: [[f64; 4]; QUANTITIES],
    /// Deflections downwards and along +z, of degree four.
    deflections: [[f64; 5]; 2],
}

impl DeadLoad {
    /// Response k at a place that is a polynomial itself.
    pub fn along(&self, k: usize, place: &Polynomial) -> Polynomial {
        let [a, b, c, d] = self.forces[k];
        if [a, b, c, d] == [0.0; 4] {
            return Polynomial::default();
        }
        let linear = Polynomial::new(&[a]).plus(place, b);
        if [c, d] == [0.0; 2] {
            return linear;
        }
        let square = place.times(place);
        let quadratic = linear.plus(&square, c);
        if d == 0.0 {
            quadratic
        } else {
            quadratic.plus(&square.times(place), d)
        }
    }

    /// A deflection at a place that is linear.
    pub fn deflection_along(&self, direction: usize, place: &Polynomial) -> Polynomial {
        let add = |sum: Polynomial, c: &f64| sum.times(place).plus(&Polynomial::new(&[*c]), 1.0);
        self.deflections[direction]
            .iter()
            .rev()
            .fold(Polynomial::default(), add)
    }

    /// Bound of sign times a quantity over a stretch of the carrier.
    pub fn bound(&self, quantity: GirderResponse, sign: f64, [from, to]: [f64; 2]) -> f64 {
        let place = Polynomial::new(&[from, 1.0]);
        let along = match (quantity as usize).checked_sub(QUANTITIES) {
            None => self.along(quantity as usize, &place),
            Some(direction) => self.deflection_along(direction, &place),
        };
        Polynomial::default().plus(&along, sign).bound(to - from)
    }

    /// Coefficients of quantity k.
    pub fn cubic(&self, k: usize) -> [f64; 4] {
        self.forces[k]
    }

    /// Bound of the second derivative of a quantity over a member of some length.
    pub fn bend(&self, quantity: GirderResponse, length: f64) -> f64 {
        let all = match (quantity as usize).checked_sub(QUANTITIES) {
            None => {
                let [a, b, c, d] = self.forces[quantity as usize];
                [a, b, c, d, 0.0]
            }
            Some(direction) => self.deflections[direction],
        };
        let [_, _, c, d, e] = all.map(f64::abs);
        2.0 * c + length * (6.0 * d + length * 12.0 * e)
    }

    /// Value of a quantity at a place.
    pub fn at(&self, quantity: GirderResponse, s: f64) -> f64 {
        let value = |c: &[f64]| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
        match (quantity as usize).checked_sub(QUANTITIES) {
            None => value(&self.forces[quantity as usize]),
            Some(direction) => value(&self.deflections[direction]),
        }
    }

    /// The same times a factor.
    pub fn times(&self, factor: f64) -> DeadLoad {
        DeadLoad {
            forces: self.forces.map(|c| c.map(|c| factor * c)),
            deflections: self.deflections.map(|c| c.map(|c| factor * c)),
        }
    }
}

impl Structure {
    /// The dead load of carriers. `lines` are the influence lines at the first end of each.
    pub(crate) fn dead_loads(
        &self,
        dead: &DeadLoads,
        carriers: &[Carrier],
        lines: &[Lines<QUANTITIES>],
    ) -> Result<Vec<DeadLoad>, Error> {
        if dead.is_empty() {
            return Ok(vec![DeadLoad::default(); carriers.len()]);
        }
        let up = Vector3::from(self.model.up).normalize();
        let effects: Vec<Effect> = carriers.iter().flat_map(end_effects).collect();
        let weight = self
            .frame
            .effects_of_weight(&self.model, self.unit_weight(), &effects)?;
        let mut out = Vec::with_capacity(carriers.len());
        let mut jumps = Vec::with_capacity(carriers.len());
        for (index, (carrier, lines)) in carriers.iter().zip(lines).enumerate() {
            let own = std::array::from_fn(|k| -dead.gravity * weight[QUANTITIES * index + k]);
            let mut start = carrier.quantities(own);
            for (rail, cells) in lines.rails.iter().enumerate() {
                let load = -dead.line(rail);
                for (k, start) in start.iter_mut().enumerate() {
                    *start += load
                        * cells
                            .iter()
                            .map(|cell| integral(&cell.cubics[1][k], cell.x))
                            .sum::<f64>();
                }
            }
            let [force, couple] = self.distributed(dead, carrier, &up)?;
            let jump = carrier.jump(&force, &couple);
            let spread = carrier.jump_of_load(&force, &couple);
            out.push(DeadLoad {
                forces: along(carrier, &start, &spread),
                deflections: [[0.0; 5]; 2],
            });
            jumps.push(jump);
        }
        self.add_deflections(dead, carriers, &jumps, &mut out)?;
        Ok(out)
    }

    /// A sum of effects under dead load; `line` is its influence line.
    pub(crate) fn dead_effect(
        &self,
        effects: &[Effect],
        line: &Lines<1>,
        dead: &DeadLoads,
    ) -> Result<f64, Error> {
        if dead.is_empty() {
            return Ok(0.0);
        }
        let weight: f64 = self
            .frame
            .effects_of_weight(&self.model, self.unit_weight(), effects)?
            .iter()
            .sum();
        let on_rails: f64 = line
            .rails
            .iter()
            .enumerate()
            .map(|(rail, cells)| {
                dead.line(rail)
                    * cells
                        .iter()
                        .map(|cell| integral(&cell.cubics[1][0], cell.x))
                        .sum::<f64>()
            })
            .sum();
        Ok(-dead.gravity * weight - on_rails)
    }

    /// Force and couple per length of the member of a carrier.
    fn distributed(
        &self,
        dead: &DeadLoads,
        carrier: &Carrier,
        up: &Vector3<f64>,
    ) -> Result<[Vector3<f64>; 2], Error> {
        let section = &self.model.sections[self.model.members[carrier.member].section];
        let mut force = up * (-section.mass * dead.gravity);
        let mut couple = Vector3::zeros();
        for OnMember { other, stretch, .. } in self.on_member(carrier) {
            let [f, m] = self.load(stretch, 1)?;
            let load = -dead.line(other.rail) / other.rate();
            force += f * load;
            couple += m * load;
        }
        Ok([force, couple])
    }

    /// Deflections of the rails over the carriers: those of the ends by the structure, and between them the particular
    /// solution for the internal forces that vanishes at both ends,
    ///
    /// v'' = (M/EI - q/GAs)/mu in each plane of bending, with mu = 1 + N/GAs, EI theta'' = M' for its rotation, GJ theta'' = T'
    /// for the twist, and EA u'' = N' for the stretch. The rail moves by u + v + theta x arm. `jumps` are the loads along each
    /// carrier.
    fn add_deflections(
        &self,
        dead: &DeadLoads,
        carriers: &[Carrier],
        jumps: &[[f64; QUANTITIES]],
        out: &mut [DeadLoad],
    ) -> Result<(), Error> {
        let resisted = |carrier: &Carrier| {
            let resists = self.rails[carrier.rail].resists;
            DEFLECTIONS.map(|quantity| resists[deflection_axis(quantity).0.component()])
        };
        let probes = |carrier: &Carrier| {
            let (rail, ends) = (carrier.rail, self.just_within(carrier.x));
            let all = DEFLECTIONS
                .into_iter()
                .zip(resisted(carrier))
                .filter(|(_, resists)| *resists);
            all.flat_map(move |(quantity, _)| {
                ends.map(|x| Probe {
                    rail,
                    x,
                    axis: deflection_axis(quantity).0,
                })
            })
        };
        let at: Vec<Probe> = carriers.iter().flat_map(probes).collect();
        let moved = self
            .frame
            .displacements_of_weight(self.unit_weight(), &at)?;
        let mut moved = moved.chunks_exact(2);
        for ((carrier, jump), load) in carriers.iter().zip(jumps).zip(out) {
            let interior = self.interior_motion(carrier, load, jump)?;
            for (direction, (quantity, resists)) in
                DEFLECTIONS.into_iter().zip(resisted(carrier)).enumerate()
            {
                let (axis, sign) = deflection_axis(quantity);
                let Some(ends) = (if resists { moved.next() } else { None }) else {
                    continue;
                };
                let mut ends = [0, 1].map(|end| -dead.gravity * sign * ends[end]);
                let within = self.just_within(carrier.x);
                if carrier.bent.is_some() {
                    for (end, x) in ends.iter_mut().zip(within) {
                        *end += sign
                            * self.held_deflection(
                                dead,
                                carrier,
                                Probe {
                                    rail: carrier.rail,
                                    x,
                                    axis,
                                },
                            )?;
                    }
                }
                for (end, x) in ends.iter_mut().zip(within) {
                    if dead.lines.iter().all(|line| *line == 0.0) {
                        break;
                    }
                    let used = [false, true, false, false, false];
                    let line = self.deflection_line(carrier.rail, x, quantity, used)?;
                    for (rail, cells) in line.rails.iter().enumerate() {
                        let all = cells
                            .iter()
                            .map(|cell| integral(&cell.cubics[1][0], cell.x));
                        *end -= dead.line(rail) * all.sum::<f64>();
                    }
                }
                let component = axis.component();
                let inside = interior
                    .map(|power| sign * power.dot(&self.rails[carrier.rail].axes[component]));
                let deflection = &mut load.deflections[direction];
                deflection.copy_from_slice(&inside);
                deflection[0] += ends[0];
                deflection[1] += (ends[1] - ends[0]) / carrier.length;
            }
        }
        Ok(())
    }

    /// Displacement at a probe on a carrier by the weight of its member alone, whose ends are held.
    fn held_deflection(
        &self,
        dead: &DeadLoads,
        carrier: &Carrier,
        at: Probe,
    ) -> Result<f64, Error> {
        let section = &self.model.sections[self.model.members[carrier.member].section];
        let up = Vector3::from(self.model.up).normalize();
        let (_, under) = self.frame.line()?.uniform_load(at)?;
        let [_, y, z] = &carrier.local;
        Ok(-dead.gravity * section.mass * (up.dot(y) * under[0][0] + up.dot(z) * under[1][0]))
    }

    /// Motion of the rail between the ends of a carrier that are held in place, by powers of the distance; global.
    fn interior_motion(
        &self,
        carrier: &Carrier,
        load: &DeadLoad,
        jump: &[f64; QUANTITIES],
    ) -> Result<[Vector3<f64>; 5], Error> {
        let [t, u, z] = carrier.triad;
        let section = &self.model.sections[self.model.members[carrier.member].section];
        let theory: BeamTheory = self.model.theory;
        let flexibility = section.flexibility(theory);
        let quantity = |q: GirderResponse| quadratic(&load.forces[q as usize], carrier.length);
        let y_axis = carrier.local[1];
        let z_axis = t.cross(&y_axis);
        let mut out = [Vector3::zeros(); 5];
        let mut add = |direction: Vector3<f64>, second: [f64; 3]| {
            for (out, c) in out.iter_mut().zip(zero_at_ends(second, carrier.length)) {
                *out += direction * c;
            }
        };
        // Moment and force on the face that looks along +t, in the planes of the section's axes.
        let moments = [
            GirderResponse::VerticalMoment,
            GirderResponse::LateralMoment,
        ];
        let [vertical, lateral] = moments.map(quantity);
        let [rate_of_vertical, rate_of_lateral] = moments.map(|moment| {
            let [_, b, c, d] = load.forces[moment as usize];
            [b, 2.0 * c, 3.0 * d]
        });
        let spread = [GirderResponse::VerticalShear, GirderResponse::LateralShear]
            .map(|shear| jump[shear as usize]);
        let point = RailPoint::new(self, carrier)?;
        let [_, mu_y, mu_z] = point.stiffening;
        let planes = [
            (
                y_axis,
                z_axis,
                1.0,
                flexibility.bending_z,
                mu_y,
                flexibility.shear_y,
            ),
            (
                z_axis,
                y_axis,
                -1.0,
                flexibility.bending_y,
                mu_z,
                flexibility.shear_z,
            ),
        ];
        for (direction, about, sign, own, mu, shear) in planes {
            let times = |c: f64, flexibility: f64| if c == 0.0 { 0.0 } else { c * flexibility };
            let moment =
                |p: usize| sign * (vertical[p] * z.dot(&about) + lateral[p] * u.dot(&about));
            let rate = -spread[0] * u.dot(&direction) + spread[1] * z.dot(&direction);
            let mut second: [f64; 3] = std::array::from_fn(|p| times(moment(p), own / mu));
            second[0] += times(rate, shear / mu);
            if second.iter().all(|c| c.is_finite()) {
                add(direction, second);
            }
            let turning: [f64; 3] = std::array::from_fn(|p| {
                let rate = rate_of_vertical[p] * z.dot(&about) + rate_of_lateral[p] * u.dot(&about);
                times(rate, own)
            });
            if turning.iter().all(|c| c.is_finite()) {
                add(about.cross(&point.arm), turning);
            }
        }
        let stretch = load.forces[GirderResponse::Normal as usize][1];
        if stretch != 0.0 && flexibility.axial.is_finite() {
            add(t, [stretch * flexibility.axial, 0.0, 0.0]);
        }
        let twist = load.forces[GirderResponse::Torsion as usize][1];
        if twist != 0.0 && flexibility.torsion.is_finite() {
            add(t.cross(&point.arm), [twist * flexibility.torsion, 0.0, 0.0]);
        }
        Ok(out)
    }
}

/// Integral of a cubic in the distance from x0 over x0..x1.
fn integral(cubic: &[f64; 4], [from, to]: [f64; 2]) -> f64 {
    let h = to - from;
    let [a, b, c, d] = cubic;
    h * (a + h * (b / 2.0 + h * (c / 3.0 + h * d / 4.0)))
}

/// Quantities along a carrier by those at its first end and their jump per length.
fn along(
    carrier: &Carrier,
    start: &[f64; QUANTITIES],
    jump: &[f64; QUANTITIES],
) -> [[f64; 4]; QUANTITIES] {
    std::array::from_fn(|k| {
        let of = |bent: &Bent| Some((bent.passed(k, start)?, bent.under(k, jump)?));
        if let Some((of_ends, spread)) = carrier.bent.as_deref().and_then(of) {
            return std::array::from_fn(|p| of_ends[p] + spread[p]);
        }
        match GirderResponse::ALL[k].slope() {
            Some(shear) => [start[k], start[shear] + jump[k], 0.5 * jump[shear], 0.0],
            None => [start[k], jump[k], 0.0, 0.0],
        }
    })
}

/// The quadratic that is nearest to a cubic on 0..=h, that without the polynomial of Chebyshev of degree three; it errs by
/// d h^3/32.
fn quadratic(&[a, b, c, d]: &[f64; 4], h: f64) -> [f64; 3] {
    // T3 on 0..=h is -1 + 18 r - 48 r^2 + 32 r^3 with r = s/h.
    let part = d * h * h * h / 32.0;
    if part == 0.0 {
        [a, b, c]
    } else {
        [a + part, b - 18.0 * part / h, c + 48.0 * part / (h * h)]
    }
}

/// The polynomial with second derivative a + b s + c s^2 that is zero at 0 and at `length`.
fn zero_at_ends([a, b, c]: [f64; 3], length: f64) -> [f64; 5] {
    let (second, third, fourth) = (a / 2.0, b / 6.0, c / 12.0);
    let end = length * (second + length * (third + length * fourth));
    [0.0, -end, second, third, fourth]
}
