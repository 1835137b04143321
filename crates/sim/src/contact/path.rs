//! Compliance of three or more wheels of one structure, interpolated along their path.
//!
//! For structures with a symmetric G, the compliance is evaluated at both ends of a path of up to four steps and
//! interpolated between them. The wheels of one contact move together; a group consists of the wheels of one contact
//! that act on one element. With s in [0, 1] the fraction of the path, G(s) is the cubic defined by the values and
//! the slopes at both ends. The slopes of single groups are the quadratics of least curvature that satisfy dG/ds =
//! G_x x' + G_y y', so that the work of forces along the rail equals the change of the elastic energy in the rail. At
//! a distance from the path, G is extrapolated by its slopes.

use splines::{Compliance, Influence, Probe};

use super::candidates::Candidates;
use super::matrices::RailMatrices;
use super::probes::Entry;
use crate::Foundation;
use crate::mechanics::assembly::Mechanics;

/// Number of probes from which interpolation along a path is faster than evaluation.
const MANY: usize = 3;

/// The wheels of one contact that act on one element.
#[derive(Clone)]
struct Group {
    element: usize,
    /// One of its wheels.
    wheel: usize,
    tangential: Option<usize>,
}

/// The contribution of one probe to a group.
#[derive(Clone, Copy)]
struct Member {
    group: usize,
    probe: usize,
    weight: f64,
}

/// The compliance over the groups at one end of the path.
#[derive(Clone, Default)]
struct PathEnd {
    /// Rail coordinate of each group's wheel.
    x: Vec<f64>,
    value: Vec<f64>,
    /// Derivatives with respect to the position of the row's group.
    slope: Vec<f64>,
}

/// The path of the wheels of a structure.
#[derive(Clone)]
pub(crate) struct CompliancePath {
    groups: Vec<Group>,
    /// Group, probe and weight of each entry. A drive and a brake on the same wheel have a common probe.
    members: Vec<Member>,
    probes: Vec<Probe>,
    /// The wheel of each probe.
    wheels: Vec<usize>,
    influence: Influence,
    ends: [PathEnd; 2],
    /// Rail coordinates of all wheels at the end of the path.
    last: Vec<f64>,
    /// Length of the path of each group, and the distance of each group from the path at the latest position.
    length: Vec<f64>,
    offset: Vec<f64>,
    /// Polynomial coefficients, s^0 to s^3 of the values and s^0 to s^2 of the slopes, over pairs of groups,
    /// row-major.
    value: [Vec<f64>; 4],
    slope: [Vec<f64>; 3],
    /// Values and slopes at the latest position, and the groups of the rows that are current.
    now: [Vec<f64>; 2],
    rows: Vec<usize>,
    is_set: bool,
}

impl CompliancePath {
    /// Creates the path of the probes `entries`, which is not set yet. Returns `None` if direct evaluation of the
    /// compliance is as fast, if the compliance is not symmetric, or if the structure consists of rigid parts.
    pub fn new(mechanics: &Mechanics, foundation: &Foundation, entries: &[Entry]) -> Option<CompliancePath> {
        let compliance = foundation.compliance.as_ref()?;
        if entries.len() < MANY || !compliance.is_symmetric() || foundation.parts.is_some() {
            return None;
        }
        let mut groups: Vec<Group> = Vec::new();
        let (mut members, mut probes, mut wheels) = (Vec::new(), Vec::<Probe>::new(), Vec::new());
        for Entry { element, weight, wheel, probe, tangential } in entries {
            let contact = |wheel: usize| mechanics.wheels[wheel].contact;
            let same = |known: &Group| known.element == *element && contact(known.wheel) == contact(*wheel);
            let group = groups.iter().position(same).unwrap_or(groups.len());
            if group == groups.len() {
                groups.push(Group { element: *element, wheel: *wheel, tangential: *tangential });
            }
            let own =
                |(at, of): (&Probe, &usize)| at.rail == probe.rail && at.axis == probe.axis && of == wheel;
            let place = probes.iter().zip(&wheels).position(own).unwrap_or(probes.len());
            if place == probes.len() {
                probes.push(*probe);
                wheels.push(*wheel);
            }
            members.push(Member { group, probe: place, weight: *weight });
        }
        let count = groups.len();
        let square = || vec![0.0; count * count];
        let node = || PathEnd { x: vec![0.0; count], value: square(), slope: square() };
        Some(CompliancePath {
            influence: Influence::zeros(probes.len()),
            members,
            probes,
            wheels,
            ends: [node(), node()],
            last: vec![0.0; mechanics.wheels.len()],
            length: vec![0.0; count],
            offset: vec![0.0; count],
            value: std::array::from_fn(|_| square()),
            slope: std::array::from_fn(|_| square()),
            now: [square(), square()],
            rows: Vec::with_capacity(count),
            groups,
            is_set: false,
        })
    }

    /// Sets the path between the positions `from` and `to` of all wheels; no rail element may end between them. If
    /// `goes_on` is true and `from` is within the distance `reach` of the end of the last path, the new path starts
    /// at that end.
    ///
    /// # Errors
    /// Errors of the compliance.
    pub fn set(
        &mut self,
        compliance: &dyn Compliance,
        [from, to]: [&[f64]; 2],
        reach: f64,
        goes_on: bool,
    ) -> Result<(), splines::Error> {
        let is_near = goes_on
            && self.is_set
            && self.groups.iter().zip(&self.ends[1].x).all(|(s, x)| (from[s.wheel] - x).abs() <= reach);
        self.is_set = false;
        self.ends.swap(0, 1);
        if !is_near {
            self.evaluate(0, compliance, from)?;
        }
        self.evaluate(1, compliance, to)?;
        self.last.copy_from_slice(to);
        self.fit();
        self.is_set = true;
        Ok(())
    }

    /// Whether `places` is within the distance `reach` of the path.
    pub fn leads_to(&mut self, places: &[f64], reach: f64) -> bool {
        self.is_set && self.project(places).1 <= reach
    }

    /// Rail coordinates of all wheels at the end of the path.
    pub fn end(&self) -> &[f64] {
        &self.last
    }

    /// Removes the path.
    pub fn clear(&mut self) {
        self.is_set = false;
    }

    /// Evaluates the compliance at one end and sums its entries over the groups.
    fn evaluate(
        &mut self,
        end: usize,
        compliance: &dyn Compliance,
        places: &[f64],
    ) -> Result<(), splines::Error> {
        for (probe, &wheel) in self.probes.iter_mut().zip(&self.wheels) {
            probe.x = places[wheel];
        }
        compliance.fill(&self.probes, &mut self.influence)?;
        let (node, count, size) = (&mut self.ends[end], self.groups.len(), self.probes.len());
        node.value.fill(0.0);
        node.slope.fill(0.0);
        for (x, group) in node.x.iter_mut().zip(&self.groups) {
            *x = places[group.wheel];
        }
        let (values, slopes) = (self.influence.value.as_slice(), self.influence.slope.as_slice());
        for column in &self.members {
            let span = column.probe * size..(column.probe + 1) * size;
            let (values, slopes) = (&values[span.clone()], &slopes[span]);
            for row in &self.members {
                let weight = row.weight * column.weight;
                let place = row.group * count + column.group;
                node.value[place] += weight * values[row.probe];
                node.slope[place] += weight * slopes[row.probe];
            }
        }
        Ok(())
    }

    fn fit(&mut self) {
        let count = self.groups.len();
        let [from, to] = &self.ends;
        for (length, (a, b)) in self.length.iter_mut().zip(from.x.iter().zip(&to.x)) {
            *length = b - a;
        }
        for i in 0..count {
            for j in 0..=i {
                let (there, back) = (i * count + j, j * count + i);
                let (x, y) = (self.length[i], self.length[j]);
                let along = |node: &PathEnd| node.slope[there] * x + node.slope[back] * y;
                let (rise, start, end) = (to.value[there] - from.value[there], along(from), along(to));
                let cubic =
                    [from.value[there], start, 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise];
                // dG/ds minus the part of linearly varying group slopes equals bend (x^2 + y^2) s (1 - s).
                let squares = x * x + y * y;
                let bend = if squares > 0.0 { -3.0 * cubic[3] / squares } else { 0.0 };
                for (pair, length) in [(there, x), (back, y)] {
                    let by = bend * length;
                    let line = to.slope[pair] - from.slope[pair];
                    for (to, from) in self.value.iter_mut().zip(cubic) {
                        to[pair] = from;
                    }
                    for (to, from) in self.slope.iter_mut().zip([from.slope[pair], line + by, -by]) {
                        to[pair] = from;
                    }
                }
            }
        }
    }

    /// Fraction of the path at the point nearest to `places`, and the largest distance of a wheel from that point.
    /// The distances of all groups are stored in `offset`.
    fn project(&mut self, places: &[f64]) -> (f64, f64) {
        let (mut along, mut squares) = (0.0, 0.0);
        for ((group, offset), (start, length)) in
            self.groups.iter().zip(&mut self.offset).zip(self.ends[0].x.iter().zip(&self.length))
        {
            *offset = places[group.wheel] - start;
            along += *offset * length;
            squares += length * length;
        }
        let s = if squares > 0.0 { (along / squares).clamp(0.0, 1.0) } else { 0.0 };
        let mut farthest = 0.0_f64;
        for (offset, length) in self.offset.iter_mut().zip(&self.length) {
            *offset -= s * length;
            farthest = farthest.max(offset.abs());
        }
        (s, farthest)
    }

    /// Updates values and slopes of the rows of `elements` to the positions `places`; entries between them and other
    /// elements are not needed. Returns false if the path is not set or a wheel is farther than `reach` from it.
    pub fn follow(&mut self, places: &[f64], reach: f64, elements: &Candidates) -> bool {
        if !self.is_set {
            return false;
        }
        let (s, farthest) = self.project(places);
        if farthest > reach {
            return false;
        }
        let count = self.groups.len();
        self.rows.clear();
        self.rows.extend((0..count).filter(|&group| elements.has(self.groups[group].element)));
        let [value, slope] = &mut self.now;
        for &row in &self.rows {
            let span = row * count..(row + 1) * count;
            let [a, b, c, d] = self.value.each_ref().map(|of| &of[span.clone()]);
            let now = &mut value[span.clone()];
            for ((now, (a, b)), (c, d)) in now.iter_mut().zip(a.iter().zip(b)).zip(c.iter().zip(d)) {
                *now = a + s * (b + s * (c + s * d));
            }
            let [a, b, c] = self.slope.each_ref().map(|of| &of[span.clone()]);
            for ((now, a), (b, c)) in slope[span].iter_mut().zip(a).zip(b.iter().zip(c)) {
                *now = a + s * (b + s * c);
            }
        }
        if farthest > 0.0 {
            for (place, &i) in self.rows.iter().enumerate() {
                for &j in &self.rows[..=place] {
                    let (there, back) = (i * count + j, j * count + i);
                    let more = slope[there] * self.offset[i] + slope[back] * self.offset[j];
                    value[there] += more;
                    if i != j {
                        value[back] += more;
                    }
                }
            }
        }
        true
    }

    /// Writes the latest values and slopes of the rows that are current into the matrices over `m` elements.
    pub fn put(&self, m: usize, matrices: &mut RailMatrices) {
        let RailMatrices { value: sums, slope: rates, tangential } = matrices;
        for &row in &self.rows {
            let element = self.groups[row].element;
            sums[element * m..(element + 1) * m].fill(0.0);
            rates[element * m..(element + 1) * m].fill(0.0);
        }
        let count = self.groups.len();
        for &place in &self.rows {
            let row = &self.groups[place];
            let [value, slope] = self.now.each_ref().map(|now| &now[place * count..(place + 1) * count]);
            let span = row.element * m..(row.element + 1) * m;
            let (sums, rates) = (&mut sums[span.clone()], &mut rates[span]);
            for (column, (value, slope)) in self.groups.iter().zip(value.iter().zip(slope)) {
                sums[column.element] += value;
                rates[column.element] += slope;
            }
            if let Some(own) = row.tangential {
                let rates = &mut tangential[own * m..(own + 1) * m];
                rates.fill(0.0);
                for (column, slope) in self.groups.iter().zip(slope) {
                    rates[column.element] += slope;
                }
            }
        }
    }
}
