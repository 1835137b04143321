//! Compliance of three or more wheels of one structure, interpolated along their path.
//!
//! For structures with a symmetric G, the compliance is evaluated at two nodes of a path of some steps, which lie a seventh
//! of it inside its ends. The wheels of one contact move together; a group consists of the wheels of one contact that act
//! on one element. With s = 0 and s = 1 at the nodes, G(s) is the cubic defined by the values and the slopes there; its
//! error, in proportion to s^2 (1 - s)^2, is no larger at the ends than between the nodes. A path that goes on begins at the
//! second node of the last one. The slopes of single groups are the quadratics of least curvature that satisfy dG/ds =
//! G_x x' + G_y y', so that the work of forces along the rail equals the change of the elastic energy in the rail. At
//! a distance from the path, G is extrapolated by its slopes.

use splines::{Compliance, Influence, Probe};

use super::candidates::Candidates;
use super::matrices::RailMatrices;
use super::probes::Entry;
use crate::Foundation;
use crate::mechanics::assembly::Mechanics;
use crate::numerics::cubic::cubic;

/// Number of probes from which interpolation along a path is faster than evaluation.
const MANY: usize = 3;

/// Part of a path before its first and after its second node, relative to the distance of the nodes.
const BEYOND: f64 = 0.2;

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

/// The compliance over the groups at one node of the path.
#[derive(Clone, Default)]
struct PathNode {
    /// Rail coordinate of each group's wheel.
    x: Vec<f64>,
    value: Vec<f64>,
    /// Derivatives with respect to the position of the row's group.
    slope: Vec<f64>,
}

/// Coefficients of the polynomials of a pair of groups (i, j).
#[derive(Clone)]
struct Pair {
    /// G(i, j): s^0 to s^3.
    value: [f64; 4],
    /// d G(i, j)/d x_i and d G(j, i)/d x_j: s^0 to s^2.
    slopes: [[f64; 2]; 3],
}

impl Pair {
    /// G(i, j), d G(i, j)/d x_i and d G(j, i)/d x_j at `s` and at the distances `beside` of both groups from the path.
    #[inline]
    fn at(&self, s: f64, beside: [f64; 2]) -> [f64; 3] {
        let ([a, b, c, d], [p, q, r]) = (self.value, self.slopes);
        let [slope, back] = std::array::from_fn(|k| p[k] + s * (q[k] + s * r[k]));
        [a + s * (b + s * (c + s * d)) + (slope * beside[0] + back * beside[1]), slope, back]
    }
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
    nodes: [PathNode; 2],
    /// Rail coordinates of all wheels at the second node.
    last: Vec<f64>,
    /// Distance between the nodes for each group, and the distance of each group from the path at the latest position.
    length: Vec<f64>,
    offset: Vec<f64>,
    /// Pairs of groups (i, j) with j <= i, row by row.
    pairs: Vec<Pair>,
    /// Scratch: the groups of the elements that are wanted.
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
        let node = || PathNode { x: vec![0.0; count], value: square(), slope: square() };
        Some(CompliancePath {
            influence: Influence::zeros(probes.len()),
            members,
            probes,
            wheels,
            nodes: [node(), node()],
            last: vec![0.0; mechanics.wheels.len()],
            length: vec![0.0; count],
            offset: vec![0.0; count],
            pairs: Vec::with_capacity(count * (count + 1) / 2),
            rows: Vec::with_capacity(count),
            groups,
            is_set: false,
        })
    }

    /// Sets the path between the positions `from` and `to` of all wheels; no rail element may end between them. If
    /// `goes_on` is true and `from` is within the distance `reach` of the path from the second node of the last path to
    /// `to`, that node is the first of the new path; no rail element may then end between that node and `from`.
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
        let was_set = std::mem::replace(&mut self.is_set, false);
        let inside = BEYOND / (1.0 + 2.0 * BEYOND);
        let between = |a: &[f64], b: &[f64], share: f64| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect()
        };
        let mut second = between(&self.last, to, 1.0 / (1.0 + BEYOND));
        self.nodes.swap(0, 1);
        self.set_length(&second);
        let is_near = goes_on && was_set && self.project(from).1 <= reach;
        if !is_near {
            self.evaluate(0, compliance, &between(from, to, inside))?;
            second = between(from, to, 1.0 - inside);
            self.set_length(&second);
        }
        self.evaluate(1, compliance, &second)?;
        self.last.copy_from_slice(&second);
        self.fit();
        self.is_set = true;
        Ok(())
    }

    /// Whether `places` is within the distance `reach` of the path.
    pub fn leads_to(&mut self, places: &[f64], reach: f64) -> bool {
        self.is_set && self.project(places).1 <= reach
    }

    /// Rail coordinates of all wheels at the second node of the path.
    pub fn second(&self) -> &[f64] {
        &self.last
    }

    /// Removes the path.
    pub fn clear(&mut self) {
        self.is_set = false;
    }

    /// Sets the distances of the groups from the first node to the positions `second` of all wheels.
    fn set_length(&mut self, second: &[f64]) {
        for ((length, group), x) in self.length.iter_mut().zip(&self.groups).zip(&self.nodes[0].x) {
            *length = second[group.wheel] - x;
        }
    }

    /// Evaluates the compliance at one node and sums its entries over the groups.
    fn evaluate(
        &mut self,
        number: usize,
        compliance: &dyn Compliance,
        places: &[f64],
    ) -> Result<(), splines::Error> {
        for (probe, &wheel) in self.probes.iter_mut().zip(&self.wheels) {
            probe.x = places[wheel];
        }
        compliance.fill(&self.probes, &mut self.influence)?;
        let (node, count, size) = (&mut self.nodes[number], self.groups.len(), self.probes.len());
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
        let [from, to] = &self.nodes;
        self.pairs.clear();
        for i in 0..count {
            for j in 0..=i {
                let (there, back) = (i * count + j, j * count + i);
                let (x, y) = (self.length[i], self.length[j]);
                let along = |node: &PathNode| node.slope[there] * x + node.slope[back] * y;
                let value = cubic([from.value[there], to.value[there]], [along(from), along(to)]);
                // dG/ds minus the part of linearly varying group slopes equals bend (x^2 + y^2) s (1 - s).
                let squares = x * x + y * y;
                let bend = if squares > 0.0 { -3.0 * value[3] / squares } else { 0.0 };
                let slope = |pair: usize, length: f64| {
                    let (line, by) = (to.slope[pair] - from.slope[pair], bend * length);
                    [from.slope[pair], line + by, -by]
                };
                let (slope, back) = (slope(there, x), slope(back, y));
                self.pairs.push(Pair { value, slopes: std::array::from_fn(|k| [slope[k], back[k]]) });
            }
        }
    }

    /// The s of the point of the path nearest to `places`, and the largest distance of a wheel from that point.
    /// The distances of all groups are stored in `offset`.
    fn project(&mut self, places: &[f64]) -> (f64, f64) {
        let (mut along, mut squares) = (0.0, 0.0);
        for ((group, offset), (start, length)) in
            self.groups.iter().zip(&mut self.offset).zip(self.nodes[0].x.iter().zip(&self.length))
        {
            *offset = places[group.wheel] - start;
            along += *offset * length;
            squares += length * length;
        }
        let s = if squares > 0.0 { (along / squares).clamp(-BEYOND, 1.0 + BEYOND) } else { 0.0 };
        let mut farthest = 0.0_f64;
        for (offset, length) in self.offset.iter_mut().zip(&self.length) {
            *offset -= s * length;
            farthest = farthest.max(offset.abs());
        }
        (s, farthest)
    }

    /// Writes values and slopes between `elements` at the positions `places` into the matrices over `m` elements; entries
    /// between them and other elements are not needed. Returns false if the path is not set or a wheel is farther than
    /// `reach` from it.
    pub fn follow(
        &mut self,
        places: &[f64],
        reach: f64,
        elements: &Candidates,
        (m, matrices): (usize, &mut RailMatrices),
    ) -> bool {
        if !self.is_set {
            return false;
        }
        let (s, farthest) = self.project(places);
        if farthest > reach {
            return false;
        }
        let RailMatrices { value: sums, slope: rates, tangential } = matrices;
        self.rows.clear();
        for (number, group) in self.groups.iter().enumerate().filter(|(_, group)| elements.has(group.element))
        {
            self.rows.push(number);
            sums[group.element * m..(group.element + 1) * m].fill(0.0);
            rates[group.element * m..(group.element + 1) * m].fill(0.0);
            if let Some(own) = group.tangential {
                tangential[own * m..(own + 1) * m].fill(0.0);
            }
        }
        for (place, &i) in self.rows.iter().enumerate() {
            let (row, offset) = (&self.groups[i], self.offset[i]);
            let (first, last) = (row.element * m, row.element);
            let pairs = &self.pairs[i * (i + 1) / 2..][..=i];
            for &j in &self.rows[..place] {
                let (column, [value, slope, back]) =
                    (&self.groups[j], pairs[j].at(s, [offset, self.offset[j]]));
                let (there, mirrored) = (first + column.element, column.element * m + last);
                sums[there] += value;
                sums[mirrored] += value;
                rates[there] += slope;
                rates[mirrored] += back;
                if let Some(own) = row.tangential {
                    tangential[own * m + column.element] += slope;
                }
                if let Some(own) = column.tangential {
                    tangential[own * m + last] += back;
                }
            }
            let [value, slope, _] = pairs[i].at(s, [offset; 2]);
            sums[first + last] += value;
            rates[first + last] += slope;
            if let Some(own) = row.tangential {
                tangential[own * m + last] += slope;
            }
        }
        true
    }
}
