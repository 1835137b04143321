//! Compliance of many wheels along their way in one step: found where the step starts and where it is about to end, and
//! carried between these two places.
//!
//! Wheels of one contact move alike: a strand is what they do to one component. With s the share of the way, G(s) is the
//! cubic by the values and the slopes at both ends; the slopes of single strands are the quadratics of least bend that
//! agree with it, dG/ds = G_x x' + G_y y', so that forces along the rail do the work that the rail stores. Off the way
//! G goes on by its slopes.

use splines::{Compliance, Influence, Probe};

use crate::Foundation;
use crate::contact::system::{Entry, System};

/// Number of probes from which it pays.
const MANY: usize = 3;

/// What one contact does to one component.
#[derive(Clone)]
struct Strand {
    component: usize,
    /// A wheel of it.
    wheel: usize,
    tread: Option<usize>,
}

/// What one wheel has in a strand.
#[derive(Clone, Copy)]
struct Thread {
    strand: usize,
    probe: usize,
    weight: f64,
}

/// The compliance over the strands at one place of each.
#[derive(Clone, Default)]
struct Node {
    /// Rail coordinate of each strand's wheel.
    x: Vec<f64>,
    value: Vec<f64>,
    /// By the row's place.
    slope: Vec<f64>,
}

/// The way of a structure's wheels.
#[derive(Clone)]
pub(crate) struct Way {
    strands: Vec<Strand>,
    /// Of each entry: its strand, its probe and its weight. A drive and a brake of one wheel probe the same.
    threads: Vec<Thread>,
    probes: Vec<Probe>,
    /// The wheel of each probe.
    wheels: Vec<usize>,
    influence: Influence,
    ends: [Node; 2],
    /// Rail coordinates of all wheels at the end.
    last: Vec<f64>,
    /// Of each strand from end to end, and how far it is from there at the share of now.
    length: Vec<f64>,
    aside: Vec<f64>,
    /// Coefficients of s^0 to s^3 of the values, of s^0 to s^2 of the slopes; over pairs of strands, row-major.
    value: [Vec<f64>; 4],
    slope: [Vec<f64>; 3],
    /// Both at the last place.
    now: [Vec<f64>; 2],
    is_laid: bool,
}

impl Way {
    /// The ways of all structures.
    pub fn all(system: &System) -> Vec<Option<Way>> {
        let own = std::iter::zip(system.foundations, &system.entries);
        own.map(|(foundation, entries)| Way::new(system, foundation, entries)).collect()
    }

    /// `None` where the compliance itself is as quick, or not symmetric.
    fn new(system: &System, foundation: &Foundation, entries: &[Entry]) -> Option<Way> {
        let compliance = foundation.compliance.as_ref()?;
        if entries.len() < MANY || !compliance.is_symmetric() || foundation.parts.is_some() {
            return None;
        }
        let mut strands: Vec<Strand> = Vec::new();
        let (mut threads, mut probes, mut wheels) = (Vec::new(), Vec::<Probe>::new(), Vec::new());
        for Entry { component, weight, wheel, probe, tread } in entries {
            let contact = |wheel: usize| system.mechanics.wheels[wheel].contact;
            let same =
                |known: &Strand| known.component == *component && contact(known.wheel) == contact(*wheel);
            let strand = strands.iter().position(same).unwrap_or(strands.len());
            if strand == strands.len() {
                strands.push(Strand { component: *component, wheel: *wheel, tread: *tread });
            }
            let own =
                |(at, of): (&Probe, &usize)| at.rail == probe.rail && at.axis == probe.axis && of == wheel;
            let place = probes.iter().zip(&wheels).position(own).unwrap_or(probes.len());
            if place == probes.len() {
                probes.push(*probe);
                wheels.push(*wheel);
            }
            threads.push(Thread { strand, probe: place, weight: *weight });
        }
        let count = strands.len();
        let square = || vec![0.0; count * count];
        let node = || Node { x: vec![0.0; count], value: square(), slope: square() };
        Some(Way {
            influence: Influence::zeros(probes.len()),
            threads,
            probes,
            wheels,
            ends: [node(), node()],
            last: vec![0.0; system.mechanics.wheels.len()],
            length: vec![0.0; count],
            aside: vec![0.0; count],
            value: std::array::from_fn(|_| square()),
            slope: std::array::from_fn(|_| square()),
            now: [square(), square()],
            strands,
            is_laid: false,
        })
    }

    /// Lays the way between two places of all wheels, `from` and `to`; no cell of a rail ends between them. The end of
    /// the way before is where this one begins, if `goes_on` and that is within `reach`.
    ///
    /// # Errors
    /// What the compliance refuses.
    pub fn lay(
        &mut self,
        compliance: &dyn Compliance,
        [from, to]: [&[f64]; 2],
        reach: f64,
        goes_on: bool,
    ) -> Result<(), splines::Error> {
        let is_near = goes_on
            && self.is_laid
            && self.strands.iter().zip(&self.ends[1].x).all(|(s, x)| (from[s.wheel] - x).abs() <= reach);
        self.is_laid = false;
        self.ends.swap(0, 1);
        if !is_near {
            self.find(0, compliance, from)?;
        }
        self.find(1, compliance, to)?;
        self.last.copy_from_slice(to);
        self.fit();
        self.is_laid = true;
        Ok(())
    }

    /// Whether the way goes on to `places`, within `reach`.
    pub fn leads_to(&mut self, places: &[f64], reach: f64) -> bool {
        self.is_laid && self.share(places).1 <= reach
    }

    /// Rail coordinates of all wheels where it ends.
    pub fn end(&self) -> &[f64] {
        &self.last
    }

    /// Forgets the way.
    pub fn leave(&mut self) {
        self.is_laid = false;
    }

    /// The compliance at one end, its entries summed over the strands.
    fn find(
        &mut self,
        end: usize,
        compliance: &dyn Compliance,
        places: &[f64],
    ) -> Result<(), splines::Error> {
        for (probe, &wheel) in self.probes.iter_mut().zip(&self.wheels) {
            probe.x = places[wheel];
        }
        compliance.fill(&self.probes, &mut self.influence)?;
        let (node, count, size) = (&mut self.ends[end], self.strands.len(), self.probes.len());
        node.value.fill(0.0);
        node.slope.fill(0.0);
        for (x, strand) in node.x.iter_mut().zip(&self.strands) {
            *x = places[strand.wheel];
        }
        let (values, slopes) = (self.influence.value.as_slice(), self.influence.slope.as_slice());
        for column in &self.threads {
            let span = column.probe * size..(column.probe + 1) * size;
            let (values, slopes) = (&values[span.clone()], &slopes[span]);
            for row in &self.threads {
                let weight = row.weight * column.weight;
                let place = row.strand * count + column.strand;
                node.value[place] += weight * values[row.probe];
                node.slope[place] += weight * slopes[row.probe];
            }
        }
        Ok(())
    }

    fn fit(&mut self) {
        let count = self.strands.len();
        let [from, to] = &self.ends;
        for (length, (a, b)) in self.length.iter_mut().zip(from.x.iter().zip(&to.x)) {
            *length = b - a;
        }
        for i in 0..count {
            for j in 0..=i {
                let (there, back) = (i * count + j, j * count + i);
                let (x, y) = (self.length[i], self.length[j]);
                let along = |node: &Node| node.slope[there] * x + node.slope[back] * y;
                let (rise, start, end) = (to.value[there] - from.value[there], along(from), along(to));
                let cubic =
                    [from.value[there], start, 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise];
                // dG/ds less what slopes that grow evenly make of it is bend s (1 - s).
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

    /// Share of the way that is nearest to `places`, and how far a wheel is from it at most; `aside` is what each is.
    fn share(&mut self, places: &[f64]) -> (f64, f64) {
        let (mut along, mut squares) = (0.0, 0.0);
        for ((strand, aside), (start, length)) in
            self.strands.iter().zip(&mut self.aside).zip(self.ends[0].x.iter().zip(&self.length))
        {
            *aside = places[strand.wheel] - start;
            along += *aside * length;
            squares += length * length;
        }
        let s = if squares > 0.0 { (along / squares).clamp(0.0, 1.0) } else { 0.0 };
        let mut farthest = 0.0_f64;
        for (aside, length) in self.aside.iter_mut().zip(&self.length) {
            *aside -= s * length;
            farthest = farthest.max(aside.abs());
        }
        (s, farthest)
    }

    /// Brings values and slopes to where the wheels are, if the way is laid and they are within `reach` of it.
    pub fn follow(&mut self, places: &[f64], reach: f64) -> bool {
        if !self.is_laid {
            return false;
        }
        let (s, farthest) = self.share(places);
        if farthest > reach {
            return false;
        }
        let [value, slope] = &mut self.now;
        let [a, b, c, d] = &self.value;
        for ((now, (a, b)), (c, d)) in value.iter_mut().zip(a.iter().zip(b)).zip(c.iter().zip(d)) {
            *now = a + s * (b + s * (c + s * d));
        }
        let [a, b, c] = &self.slope;
        for ((now, a), (b, c)) in slope.iter_mut().zip(a).zip(b.iter().zip(c)) {
            *now = a + s * (b + s * c);
        }
        if farthest > 0.0 {
            let count = self.strands.len();
            for i in 0..count {
                for j in 0..=i {
                    let (there, back) = (i * count + j, j * count + i);
                    let more = slope[there] * self.aside[i] + slope[back] * self.aside[j];
                    value[there] += more;
                    if i != j {
                        value[back] += more;
                    }
                }
            }
        }
        true
    }

    /// Puts the last values and slopes into the matrices of values, slopes and slopes by treads over `m` components.
    pub fn put(&self, m: usize, [compliance, slopes, by_tread]: [&mut [f64]; 3]) {
        for strand in &self.strands {
            let row = strand.component * m..(strand.component + 1) * m;
            compliance[row.clone()].fill(0.0);
            slopes[row].fill(0.0);
        }
        let count = self.strands.len();
        let lines = self.now[0].chunks_exact(count).zip(self.now[1].chunks_exact(count));
        for (row, (value, slope)) in self.strands.iter().zip(lines) {
            let span = row.component * m..(row.component + 1) * m;
            let (sums, rates) = (&mut compliance[span.clone()], &mut slopes[span]);
            for (column, (value, slope)) in self.strands.iter().zip(value.iter().zip(slope)) {
                sums[column.component] += value;
                rates[column.component] += slope;
            }
            if let Some(tread) = row.tread {
                let rates = &mut by_tread[tread * m..(tread + 1) * m];
                rates.fill(0.0);
                for (column, slope) in self.strands.iter().zip(slope) {
                    rates[column.component] += slope;
                }
            }
        }
    }
}
