//! Compliance of three or more wheels of one structure, interpolated along their path.
//!
//! For structures with a symmetric G, the compliance is evaluated at two nodes of a path of some steps, which lie a seventh
//! of it inside its ends. The wheels of one contact move together; a group consists of the wheels of one contact that act
//! on one element. With s = 0 and s = 1 at the nodes, G(s) is the cubic defined by the values and the slopes there; its
//! error, in proportion to s^2 (1 - s)^2, is no larger at the ends than between the nodes. A path that goes on begins at the
//! second node of the last one. There the difference between the new values and the last cubics is q s^2 (s - 1)^2 with the
//! coefficient q of s^4, from which the error of the new cubics follows: where it is larger than allowed, the new path is
//! shortened, and so are those after it. The slopes of single groups are the quadratics of least curvature that satisfy dG/ds =
//! G_x x' + G_y y', so that the work of forces along the rail equals the change of the elastic energy in the rail. At
//! a distance from the path, G is extrapolated by its slopes.

use std::ops::Range;

use splines::{Compliance, GroupMember, Influence, KeptProducts, Probe, ProbeGroups};

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

/// Part of the length of a path with the allowed error to which it is limited.
const CAUTIOUS: f64 = 0.9;

/// Least part of its length to which a path is shortened.
const LEAST: f64 = 0.1;

/// What is allowed of a path.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PathLimits {
    /// Largest distance of a wheel from the path.
    pub beside: f64,
    /// Largest error of the interpolation, relative to the compliance of an element under its own force.
    pub error: f64,
    /// Distance past the break of a rail, relative to 1 + |x|, up to which a wheel is at the break.
    pub past_break: f64,
}

/// The wheels of one contact that act on one element.
#[derive(Clone)]
struct Group {
    /// Place of its element among those of the path.
    element: usize,
    /// One of its wheels.
    wheel: usize,
    tangential: Option<usize>,
}

/// The compliance over the groups at one node of the path.
#[derive(Clone)]
struct PathNode {
    /// Rail coordinate of each group's wheel.
    x: Vec<f64>,
    /// Values, and derivatives with respect to the position of the row's group.
    influence: Influence,
}

/// Four columns of a row of polynomials in s: coefficients of s^0 to s^(N - 1).
type Polynomials<const N: usize> = [[f64; 4]; N];

/// The path of the wheels of a structure.
#[derive(Clone)]
pub(crate) struct CompliancePath {
    /// Elements of the groups, in increasing order.
    elements: Vec<usize>,
    /// Ordered by element.
    groups: Vec<Group>,
    /// Groups of each element.
    groups_of: Vec<Range<usize>>,
    /// The probes of each group. A drive and a brake on the same wheel have a common probe.
    loads: ProbeGroups,
    /// The wheel of each probe.
    wheels: Vec<usize>,
    kept: KeptProducts,
    nodes: [PathNode; 2],
    /// Rail coordinates of all wheels at the second node.
    last: Vec<f64>,
    /// For each group, the breaks of its rail between which the path lies. Beyond them the compliance is another function.
    bounds: Vec<[f64; 2]>,
    /// Distance between the nodes for each group, and the distance of each group from the path at the latest position.
    length: Vec<f64>,
    offset: Vec<f64>,
    /// Columns of the matrices from the first to the last of the elements. The rows of what follows are over these,
    /// four at a time, filled up with zeros; `width` is the number of times.
    columns: Range<usize>,
    width: usize,
    /// G between elements, row by row.
    values: Vec<Polynomials<4>>,
    /// Derivatives of G between groups and elements with respect to the position of the group, row by row.
    slopes: Vec<Polynomials<3>>,
    /// Largest compliance of each element under its own force so far.
    largest: Vec<f64>,
    /// Distance between the nodes up to which the error is taken to be allowed.
    longest: f64,
    /// Scratch: places of the elements that are wanted among those of the path, one row, and for each element the
    /// derivatives of its groups times their distances from the path.
    wanted: Vec<usize>,
    line: Vec<[f64; 4]>,
    beside: Vec<[f64; 4]>,
    is_set: bool,
}

impl CompliancePath {
    /// Creates the path of the probes `entries`, which is not set yet. Returns `None` if direct evaluation of the
    /// compliance is as fast, if the compliance is not symmetric, or if the structure consists of rigid parts.
    pub fn new(
        mechanics: &Mechanics,
        foundation: &Foundation,
        entries: &[Entry],
    ) -> Option<CompliancePath> {
        let compliance = foundation.compliance.as_ref()?;
        if entries.len() < MANY || !compliance.is_symmetric() || foundation.parts.is_some() {
            return None;
        }
        let mut elements: Vec<usize> = entries.iter().map(|entry| entry.element).collect();
        elements.sort_unstable();
        elements.dedup();
        let contact = |wheel: usize| mechanics.wheels[wheel].contact;
        let mut groups: Vec<Group> = Vec::new();
        for (place, element) in elements.iter().enumerate() {
            let known = groups.len();
            for entry in entries.iter().filter(|entry| entry.element == *element) {
                if !groups[known..]
                    .iter()
                    .any(|group| contact(group.wheel) == contact(entry.wheel))
                {
                    let Entry {
                        wheel, tangential, ..
                    } = *entry;
                    groups.push(Group {
                        element: place,
                        wheel,
                        tangential,
                    });
                }
            }
        }
        let groups_of = (0..elements.len())
            .map(|place| {
                let at = |place: usize| groups.partition_point(|group| group.element < place);
                at(place)..at(place + 1)
            })
            .collect();
        let (mut members, mut probes, mut wheels) = (Vec::new(), Vec::<Probe>::new(), Vec::new());
        for Entry {
            element,
            weight,
            wheel,
            probe,
            ..
        } in entries
        {
            let same = |known: &Group| {
                elements[known.element] == *element && contact(known.wheel) == contact(*wheel)
            };
            let group = groups
                .iter()
                .position(same)
                .expect("every entry has a group");
            let own = |(at, of): (&Probe, &usize)| {
                at.rail == probe.rail && at.axis == probe.axis && of == wheel
            };
            let place = probes
                .iter()
                .zip(&wheels)
                .position(own)
                .unwrap_or(probes.len());
            if place == probes.len() {
                probes.push(*probe);
                wheels.push(*wheel);
            }
            members.push(GroupMember {
                group,
                probe: place,
                weight: *weight,
            });
        }
        let columns = elements[0]..elements[elements.len() - 1] + 1;
        let (count, width) = (groups.len(), columns.len().div_ceil(4));
        let node = || PathNode {
            x: vec![0.0; count],
            influence: Influence::zeros(count),
        };
        Some(CompliancePath {
            loads: ProbeGroups {
                count,
                probes,
                members,
            },
            kept: KeptProducts::default(),
            wheels,
            nodes: [node(), node()],
            last: vec![0.0; mechanics.wheels.len()],
            bounds: vec![[f64::NEG_INFINITY, f64::INFINITY]; count],
            length: vec![0.0; count],
            offset: vec![0.0; count],
            columns,
            width,
            values: vec![[[0.0; 4]; 4]; elements.len() * width],
            slopes: vec![[[0.0; 4]; 3]; count * width],
            largest: vec![0.0; elements.len()],
            longest: f64::INFINITY,
            wanted: Vec::with_capacity(elements.len()),
            line: vec![[0.0; 4]; width],
            beside: vec![[0.0; 4]; elements.len() * width],
            elements,
            groups,
            groups_of,
            is_set: false,
        })
    }

    /// Sets the path between the positions `from` and `to` of all wheels, or to a place before `to` where its error would be
    /// larger than the limit; no rail element may end between them. If `goes_on` is true and `from` is near enough to the path
    /// from the second node of the last path to `to`, that node is the first of the new path; no rail element may then end
    /// between that node and `from`.
    ///
    /// # Errors
    /// Errors of the compliance.
    pub fn set(
        &mut self,
        compliance: &dyn Compliance,
        [from, to]: [&[f64]; 2],
        limits: PathLimits,
        goes_on: bool,
    ) -> Result<(), splines::Error> {
        let was_set = std::mem::replace(&mut self.is_set, false);
        let mut second = self.limited(
            &self.last,
            &between(&self.last, to, 1.0 / (1.0 + BEYOND)),
            self.longest,
        );
        let before = norm(&self.length);
        let expected = (goes_on && was_set).then(|| self.continued(&second));
        self.nodes.swap(0, 1);
        self.set_length(&second);
        if let Some(expected) = expected
            && self.project(from).1 <= limits.beside
        {
            self.evaluate(1, compliance, &second)?;
            let length = norm(&self.length);
            if before > 0.0 && length > 0.0 {
                let fits = CAUTIOUS * (limits.error / self.error(before, &expected)).sqrt().sqrt();
                self.longest = length * fits.max(LEAST);
                if fits < CAUTIOUS {
                    second = between(&self.last, &second, fits.max(LEAST));
                    self.set_length(&second);
                    self.evaluate(1, compliance, &second)?;
                }
            }
        } else {
            let inside = BEYOND / (1.0 + 2.0 * BEYOND);
            let [first, last] = [inside, 1.0 - inside].map(|share| between(from, to, share));
            self.evaluate(0, compliance, &first)?;
            second = self.limited(&first, &last, self.longest);
            self.set_length(&second);
            self.evaluate(1, compliance, &second)?;
        }
        self.last.copy_from_slice(&second);
        self.fit();
        self.is_set = true;
        Ok(())
    }

    /// The place on the way from `first` to `second` at which a path between these nodes has the length `longest` at most.
    fn limited(&self, first: &[f64], second: &[f64], longest: f64) -> Vec<f64> {
        let way: Vec<f64> = self
            .groups
            .iter()
            .map(|group| second[group.wheel] - first[group.wheel])
            .collect();
        let length = norm(&way);
        between(
            first,
            second,
            if length > longest {
                longest / length
            } else {
                1.0
            },
        )
    }

    /// s at `places`, which may be far beyond the nodes, and the compliance of every element under its own force there by the
    /// present polynomials.
    fn continued(&mut self, places: &[f64]) -> (f64, Vec<f64>) {
        let (s, _) = self.project_within(places, [f64::NEG_INFINITY, f64::INFINITY]);
        let own = |(place, element): (usize, &usize)| {
            let column = element - self.columns.start;
            let (four, lane) = (column / 4, column % 4);
            let [a, b, c, d] = self.values[place * self.width + four].map(|four| four[lane]);
            let beside = self.groups_of[place].clone().map(|group| {
                let [p, q, r] = self.slopes[group * self.width + four].map(|four| four[lane]);
                self.offset[group] * (p + s * (q + s * r))
            });
            a + s * (b + s * (c + s * d)) + 2.0 * beside.sum::<f64>()
        };
        (s, self.elements.iter().enumerate().map(own).collect())
    }

    /// Largest error of the cubics between the nodes, relative to the largest compliance of each element under its own force, if
    /// those of the last path, between nodes at the distance `before`, gave what is `expected` at the second node.
    fn error(&mut self, before: f64, (s, expected): &(f64, Vec<f64>)) -> f64 {
        let (count, values) = (self.groups.len(), self.nodes[1].influence.value.as_slice());
        let of_quartic = (norm(&self.length) / before).powi(4) / (16.0 * (s * (s - 1.0)).powi(2));
        let mut largest_error = 0.0_f64;
        for ((groups, largest), expected) in
            self.groups_of.iter().zip(&mut self.largest).zip(expected)
        {
            let row = |i: usize| {
                groups
                    .clone()
                    .map(move |j| values[i + j * count])
                    .sum::<f64>()
            };
            let own = groups.clone().map(row).sum::<f64>();
            *largest = largest.max(own);
            if *largest > 0.0 {
                largest_error = largest_error.max((own - expected).abs() * of_quartic / *largest);
            }
        }
        largest_error
    }

    /// Whether `places` is near enough to the path, and no wheel is past the break of a rail.
    pub fn leads_to(&mut self, places: &[f64], limits: PathLimits) -> bool {
        self.is_set
            && self.is_between_breaks(places, limits)
            && self.project(places).1 <= limits.beside
    }

    /// Whether no wheel at `places` is past the break of a rail between which the path lies.
    fn is_between_breaks(&self, places: &[f64], limits: PathLimits) -> bool {
        self.groups
            .iter()
            .zip(&self.bounds)
            .all(|(group, [low, high])| {
                let x = places[group.wheel];
                let past = limits.past_break * (1.0 + x.abs());
                x > low - past && x < high + past
            })
    }

    /// Sets the bounds of the path that was just set: `around` gives the breaks of the rail of a wheel next to a coordinate.
    pub fn set_bounds(&mut self, around: impl Fn(usize, f64) -> [f64; 2]) {
        let CompliancePath {
            groups,
            bounds,
            nodes: [from, _],
            last,
            ..
        } = self;
        for ((bounds, group), from) in bounds.iter_mut().zip(&*groups).zip(&from.x) {
            *bounds = around(group.wheel, 0.5 * (from + last[group.wheel]));
        }
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
        for ((length, group), x) in self
            .length
            .iter_mut()
            .zip(&self.groups)
            .zip(&self.nodes[0].x)
        {
            *length = second[group.wheel] - x;
        }
    }

    /// Evaluates the compliance between the groups at one node.
    fn evaluate(
        &mut self,
        number: usize,
        compliance: &dyn Compliance,
        places: &[f64],
    ) -> Result<(), splines::Error> {
        for (probe, &wheel) in self.loads.probes.iter_mut().zip(&self.wheels) {
            probe.x = places[wheel];
        }
        let node = &mut self.nodes[number];
        for (x, group) in node.x.iter_mut().zip(&self.groups) {
            *x = places[group.wheel];
        }
        compliance.fill_groups(&self.loads, &mut self.kept, &mut node.influence)
    }

    /// Sets the polynomials of all pairs of groups, summed over the groups of an element: of both for values, of the
    /// second for slopes.
    fn fit(&mut self) {
        let CompliancePath {
            elements,
            groups,
            nodes: [from, to],
            length,
            columns,
            width,
            values,
            slopes,
            ..
        } = self;
        let count = groups.len();
        let [from_values, to_values] = [&*from, to].map(|node| node.influence.value.as_slice());
        let [from_slopes, to_slopes] = [&*from, to].map(|node| node.influence.slope.as_slice());
        values.fill([[0.0; 4]; 4]);
        slopes.fill([[0.0; 4]; 3]);
        for i in 0..count {
            for j in 0..=i {
                let (there, back) = (i + count * j, j + count * i);
                let (x, y) = (length[i], length[j]);
                let along = |slopes: &[f64]| slopes[there] * x + slopes[back] * y;
                let value = cubic(
                    [from_values[there], to_values[there]],
                    [along(from_slopes), along(to_slopes)],
                );
                // dG/ds minus the part of linearly varying group slopes equals bend (x^2 + y^2) s (1 - s).
                let squares = x * x + y * y;
                let bend = if squares > 0.0 {
                    -3.0 * value[3] / squares
                } else {
                    0.0
                };
                let slope = |pair: usize, length: f64| {
                    let (line, by) = (to_slopes[pair] - from_slopes[pair], bend * length);
                    [from_slopes[pair], line + by, -by]
                };
                let (row, other) = (groups[i].element, groups[j].element);
                let [own, column] = [row, other].map(|place| elements[place] - columns.start);
                add(&mut values[row * *width..], column, value);
                add(&mut slopes[i * *width..], column, slope(there, x));
                if i != j {
                    add(&mut values[other * *width..], own, value);
                    add(&mut slopes[j * *width..], own, slope(back, y));
                }
            }
        }
    }

    /// The s of the point of the path nearest to `places`, and the largest distance of a wheel from that point.
    /// The distances of all groups are stored in `offset`.
    fn project(&mut self, places: &[f64]) -> (f64, f64) {
        self.project_within(places, [-BEYOND, 1.0 + BEYOND])
    }

    /// The same for s from `least` to `most`.
    fn project_within(&mut self, places: &[f64], [least, most]: [f64; 2]) -> (f64, f64) {
        let (mut along, mut squares) = (0.0, 0.0);
        for ((group, offset), (start, length)) in self
            .groups
            .iter()
            .zip(&mut self.offset)
            .zip(self.nodes[0].x.iter().zip(&self.length))
        {
            *offset = places[group.wheel] - start;
            along += *offset * length;
            squares += length * length;
        }
        let s = if squares > 0.0 {
            (along / squares).clamp(least, most)
        } else {
            0.0
        };
        let mut farthest = 0.0_f64;
        for (offset, length) in self.offset.iter_mut().zip(&self.length) {
            *offset -= s * length;
            farthest = farthest.max(offset.abs());
        }
        (s, farthest)
    }

    /// Writes values and slopes between `elements` at the positions `places` into the matrices over `m` elements; entries
    /// between them and other elements are not needed. Returns false if the path is not set, or does not lead there within the
    /// `limits`.
    ///
    /// At the distances d of the groups from the path, the value of a pair is G(i, j) + B(i, j) + B(j, i), where B(i,
    /// j) is the sum of dG(g, j)/dx_g d_g over the groups g of element i.
    pub fn follow(
        &mut self,
        places: &[f64],
        limits: PathLimits,
        elements: &Candidates,
        (m, matrices): (usize, &mut RailMatrices),
    ) -> bool {
        if !(self.is_set && self.is_between_breaks(places, limits)) {
            return false;
        }
        let (s, farthest) = self.project(places);
        if farthest > limits.beside {
            return false;
        }
        let RailMatrices {
            value,
            slope,
            tangential,
            ..
        } = matrices;
        let CompliancePath {
            elements: own,
            groups,
            groups_of,
            columns,
            width,
            ..
        } = self;
        let CompliancePath {
            values,
            slopes,
            offset,
            wanted,
            line,
            beside,
            ..
        } = self;
        wanted.clear();
        wanted.extend((0..own.len()).filter(|&i| elements.has(own[i])));
        let span = |row: usize| row * m + columns.start..row * m + columns.end;
        for &i in &*wanted {
            let beside = &mut beside[i * *width..(i + 1) * *width];
            for (number, group) in groups_of[i].clone().enumerate() {
                let (terms, offset) =
                    (&slopes[group * *width..(group + 1) * *width], offset[group]);
                let rates = &mut slope[span(own[i])];
                // The first group of an element sets the row, the others add to it.
                if number == 0 {
                    put_slopes(
                        terms,
                        s,
                        rates,
                        |_, slopes| slopes,
                        |four, slopes| {
                            beside[four] = slopes.map(|slope| offset * slope);
                        },
                    );
                } else {
                    put_slopes(
                        terms,
                        s,
                        rates,
                        |sum, slopes| std::array::from_fn(|k| sum[k] + slopes[k]),
                        |four, slopes| {
                            beside[four] =
                                std::array::from_fn(|k| beside[four][k] + offset * slopes[k]);
                        },
                    );
                }
                if let Some(contact) = groups[group].tangential {
                    put_slopes(
                        terms,
                        s,
                        &mut tangential[span(contact)],
                        |_, slopes| slopes,
                        |_, _| {},
                    );
                }
            }
        }
        let beside = beside.as_flattened();
        for (number, &i) in wanted.iter().enumerate() {
            // The matrix is symmetric: columns up to the diagonal.
            let (row, column) = (own[i], own[i] - columns.start);
            let terms = &values[i * *width..i * *width + column / 4 + 1];
            for (values, [a, b, c, d]) in line.iter_mut().zip(terms) {
                *values = std::array::from_fn(|k| a[k] + s * (b[k] + s * (c[k] + s * d[k])));
            }
            let (values, own_beside) = (line.as_flattened(), &beside[4 * *width * i..]);
            for &j in &wanted[..=number] {
                let other = own[j] - columns.start;
                let entry = values[other] + (own_beside[other] + beside[4 * *width * j + column]);
                value[row * m + own[j]] = entry;
                value[own[j] * m + row] = entry;
            }
        }
        true
    }
}

/// The places of all wheels at a part of their way from `a` to `b`.
pub(super) fn between(a: &[f64], b: &[f64], share: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect()
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// Puts the values at `s` of a row of polynomials into `row`, four at a time, as `with` combines what is there with them. `each`
/// receives each four of them with its number. They go to their place from registers: a copy would wait for them to be stored.
#[inline]
fn put_slopes(
    terms: &[Polynomials<3>],
    s: f64,
    row: &mut [f64],
    with: impl Fn([f64; 4], [f64; 4]) -> [f64; 4],
    mut each: impl FnMut(usize, [f64; 4]),
) {
    let at = |[p, q, r]: &Polynomials<3>| -> [f64; 4] {
        std::array::from_fn(|k| p[k] + s * (q[k] + s * r[k]))
    };
    let (fours, rest) = row.as_chunks_mut::<4>();
    for (four, (there, terms)) in fours.iter_mut().zip(terms).enumerate() {
        let slopes = at(terms);
        *there = with(*there, slopes);
        each(four, slopes);
    }
    if let Some(terms) = terms.get(fours.len()) {
        let slopes = at(terms);
        let mut there = [0.0; 4];
        there[..rest.len()].copy_from_slice(rest);
        rest.copy_from_slice(&with(there, slopes)[..rest.len()]);
        each(fours.len(), slopes);
    }
}

/// Adds the coefficients of a polynomial to column `column` of a row.
fn add<const N: usize>(row: &mut [Polynomials<N>], column: usize, coefficients: [f64; N]) {
    let sums = &mut row[column / 4];
    sums.iter_mut()
        .zip(coefficients)
        .for_each(|(sum, own)| sum[column % 4] += own);
}
