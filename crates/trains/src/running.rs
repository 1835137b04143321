//! Piecewise cubic functions of a position: running maxima and sums.

use crate::pieces::ResponsePiece;
use crate::polynomial::Polynomial;

/// Distances of positions that count as rounding, relative to the positions.
const ROUNDING: f64 = 1e-13;

/// Half the width of the interval in which bisection follows Newton's method, relative to positions.
const NARROW: f64 = 1e-13;

/// A function that is cubic between increasing positions and may jump at them, where the larger of both limits counts.
#[derive(Clone, Debug, Default)]
pub(crate) struct PiecewiseFunction {
    pieces: Vec<Part>,
}

/// A piece of a function.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// First and last position.
    position: [f64; 2],
    /// In the distance from the first position.
    cubic: Polynomial,
    /// The stance of the train whose response it is.
    stance: usize,
    /// Whether a wheel is at the section at the first and at the last position.
    at_section: [bool; 2],
    /// For each running maximum in it, where the maximum is.
    sources: [Source; MOST_BEFORE],
    count: usize,
}

/// Most running maxima that are added to a function.
const MOST_BEFORE: usize = 4;

/// Where a running maximum has its value: the part of its function, and the position there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Source {
    pub part: usize,
    /// `None` where it moves along with the position.
    pub position: Option<f64>,
}

/// The largest value of a function, and where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Largest {
    pub position: f64,
    pub value: f64,
    pub part: usize,
}

impl Part {
    fn new(position: [f64; 2], cubic: Polynomial, stance: usize) -> Part {
        Part {
            position,
            cubic,
            stance,
            at_section: [false; 2],
            sources: Default::default(),
            count: 0,
        }
    }

    fn with_section(mut self, at_section: [bool; 2]) -> Part {
        self.at_section = at_section;
        self
    }

    fn with_source(mut self, source: Source) -> Part {
        if self.count < MOST_BEFORE {
            self.sources[self.count] = source;
            self.count += 1;
        }
        self
    }

    fn length(&self) -> f64 {
        self.position[1] - self.position[0]
    }

    /// The part between two positions.
    fn between(&self, [from, to]: [f64; 2]) -> Part {
        let by = from - self.position[0];
        let cubic = if by.is_finite() && by != 0.0 {
            self.cubic.shifted(by)
        } else {
            self.cubic
        };
        let [first, last] = self.at_section;
        let at_section = [
            first && from == self.position[0],
            last && to == self.position[1],
        ];
        Part {
            position: [from, to],
            cubic,
            at_section,
            ..*self
        }
    }
}

impl PiecewiseFunction {
    /// A function without pieces, with memory for some.
    fn with_room(pieces: usize) -> PiecewiseFunction {
        PiecewiseFunction {
            pieces: Vec::with_capacity(pieces),
        }
    }

    /// Adds a piece behind the others, with whether a wheel is at the section at its first and at its last position only.
    pub fn push(
        &mut self,
        position: [f64; 2],
        cubic: Polynomial,
        stance: usize,
        at_section: [bool; 2],
    ) {
        self.pieces
            .push(Part::new(position, cubic, stance).with_section(at_section));
    }

    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Sign times a response in a stance, without the pieces that do not reach `floor`.
    pub fn of(pieces: &[ResponsePiece], sign: f64, stance: usize, floor: f64) -> PiecewiseFunction {
        let part = |piece: &ResponsePiece| {
            Part::new(piece.position, piece.times(sign), stance).with_section(piece.at_section)
        };
        let kept = pieces
            .iter()
            .filter(|piece| floor == f64::NEG_INFINITY || piece.bound(sign) >= floor);
        PiecewiseFunction {
            pieces: kept.map(part).collect(),
        }
    }

    /// What the function nowhere exceeds: the largest of the bounds of its pieces.
    pub fn bound(&self) -> f64 {
        self.pieces
            .iter()
            .map(|part| part.cubic.bound(part.length()))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The largest value, at the first position that has it.
    pub fn largest(&self) -> Option<Largest> {
        let mut best: Option<Largest> = None;
        for (index, part) in self.pieces.iter().enumerate() {
            let floor = best.map_or(f64::NEG_INFINITY, |best| best.value);
            if let Some((t, value)) = part.cubic.largest_above(part.length(), floor)
                && value > floor
            {
                best = Some(Largest {
                    position: part.position[0] + t,
                    value,
                    part: index,
                });
            }
        }
        best
    }

    /// The stance of a part, and where the running maxima in it are.
    pub fn sources(&self, part: usize) -> (usize, &[Source]) {
        let part = &self.pieces[part];
        (part.stance, &part.sources[..part.count])
    }

    /// p -> f(-p).
    pub fn mirrored(&self) -> PiecewiseFunction {
        let turn = |part: &Part| {
            let back = part.cubic.shifted(part.length()).reversed();
            let [first, last] = part.at_section;
            Part::new([-part.position[1], -part.position[0]], back, part.stance)
                .with_section([last, first])
        };
        PiecewiseFunction {
            pieces: self.pieces.iter().rev().map(turn).collect(),
        }
    }
}

/// Calls `each` with the parts of two functions where both are defined. Parts that only touch, to rounding, have a common
/// limit, which counts where one of them has no length, and where `meet` says so of the two.
fn overlaps(
    f: &PiecewiseFunction,
    g: &PiecewiseFunction,
    meet: impl Fn(&Part, &Part) -> bool,
    mut each: impl FnMut(Part, Part),
) {
    let rounding = |x: f64| ROUNDING * x.abs();
    let mut first = 0;
    for a in &f.pieces {
        let [start, end] = a.position;
        first += g.pieces[first..]
            .iter()
            .take_while(|b| b.position[1] < start)
            .count();
        for b in g.pieces[first..]
            .iter()
            .take_while(|b| b.position[0] <= end + rounding(end))
        {
            let both = [start.max(b.position[0]), end.min(b.position[1])];
            let rounding = rounding(both[0]).max(rounding(both[1]));
            let touch =
                both[1] - both[0] <= rounding && a.length() > rounding && b.length() > rounding;
            if touch && meet(a, b) {
                each(a.between([both[0]; 2]), b.between([both[0]; 2]));
            } else if !touch && both[0] <= both[1] {
                each(a.between(both), b.between(both));
            }
        }
    }
}

/// The parts of a function where another is not defined.
fn outside(f: &PiecewiseFunction, g: &PiecewiseFunction, out: &mut Vec<Part>) {
    let mut first = 0;
    for a in &f.pieces {
        let [start, end] = a.position;
        first += g.pieces[first..]
            .iter()
            .take_while(|b| b.position[1] < start)
            .count();
        let mut from = start;
        let mut is_covered = false;
        for b in g.pieces[first..]
            .iter()
            .take_while(|b| b.position[0] <= end)
        {
            if b.position[0] > from {
                out.push(a.between([from, b.position[0]]));
            }
            from = from.max(b.position[1]);
            is_covered = true;
        }
        if from < end || !is_covered {
            out.push(a.between([from, end]));
        }
    }
}

/// The larger of two functions; where only one of them is defined, that one.
pub(crate) fn larger_of(f: &PiecewiseFunction, g: &PiecewiseFunction) -> PiecewiseFunction {
    let mut out = PiecewiseFunction::with_room(2 * (f.pieces.len() + g.pieces.len()));
    let never = |_: &Part, _: &Part| false;
    overlaps(f, g, never, |a, b| {
        let difference = a.cubic.plus(&b.cubic, -1.0);
        let roots = difference.roots(a.length());
        let mut from = 0.0;
        for &to in roots.list().iter().chain(&[a.length()]) {
            if to > from || a.length() == 0.0 {
                let more = if difference.at(0.5 * (from + to)) >= 0.0 {
                    &a
                } else {
                    &b
                };
                let end = if to >= a.length() {
                    a.position[1]
                } else {
                    a.position[0] + to
                };
                out.pieces.push(more.between([a.position[0] + from, end]));
                from = to;
            }
        }
    });
    outside(f, g, &mut out.pieces);
    outside(g, f, &mut out.pieces);
    out.pieces.sort_by(|a, b| {
        a.position[0]
            .total_cmp(&b.position[0])
            .then(a.position[1].total_cmp(&b.position[1]))
    });
    out
}

/// q -> max over p <= q - distance of f(p), for q from the first position of f on; where f is not defined, and beyond its
/// last position up to infinity, it is constant.
pub(crate) fn running_maximum(f: &PiecewiseFunction, distance: f64) -> PiecewiseFunction {
    let mut out = PiecewiseFunction::with_room(f.pieces.len() + 1);
    let mut most = f64::NEG_INFINITY;
    let mut source = Source::default();
    let mut add = |ends: [f64; 2], cubic: Polynomial, source: Source| {
        let position = ends.map(|x| x + distance);
        // where the source begins, f may jump
        let own = &f.pieces[source.part];
        let begins_at_section = own.at_section[0] && own.position[0] == ends[0];
        // A level that goes on is one part, however many parts of f are below it.
        let goes_on = |last: &&mut Part| source.position.is_some() && last.sources[0] == source;
        match out.pieces.last_mut().filter(goes_on) {
            Some(last) => last.position[1] = position[1],
            None => out.pieces.push(
                Part::new(position, cubic, 0)
                    .with_section([begins_at_section, false])
                    .with_source(source),
            ),
        }
    };
    let mut reached_to = f64::INFINITY;
    for (
        part,
        Part {
            position: [start, end],
            cubic,
            ..
        },
    ) in f.pieces.iter().enumerate()
    {
        if *start > reached_to {
            add([reached_to, *start], Polynomial::new(&[most]), source);
        }
        reached_to = *end;
        if cubic.bound(end - start) <= most {
            add([*start, *end], Polynomial::new(&[most]), source);
            continue;
        }
        let places = cubic.candidates(end - start);
        if cubic.at(0.0) > most {
            most = cubic.at(0.0);
            source = Source {
                part,
                position: Some(*start),
            };
        }
        for ends in places.list().windows(2) {
            let (from, to) = (start + ends[0], start + ends[1]);
            let value = cubic.at(ends[1]);
            if value <= most {
                add([from, to], Polynomial::new(&[most]), source);
                continue;
            }
            let reached = if cubic.at(ends[0]) >= most {
                ends[0]
            } else {
                crossing(cubic, most, ends)
            };
            if reached > ends[0] {
                add([from, start + reached], Polynomial::new(&[most]), source);
            }
            add(
                [start + reached, to],
                cubic.shifted(reached),
                Source {
                    part,
                    position: None,
                },
            );
            most = value;
            source = Source {
                part,
                position: Some(to),
            };
        }
        if places.list().len() < 2 {
            add([*start, *end], Polynomial::new(&[most]), source);
        }
    }
    add(
        [reached_to, f64::INFINITY],
        Polynomial::new(&[most]),
        source,
    );
    out
}

/// Where an increasing stretch of a cubic reaches a level: the first number at which it does. Steps of Newton's method lead
/// near it and bisection to the number itself.
fn crossing(cubic: &Polynomial, level: f64, ends: &[f64]) -> f64 {
    let above = cubic.plus(&Polynomial::new(&[level]), -1.0);
    let [mut a, mut b] = around(&above, [ends[0], ends[1]]);
    for _ in 0..100 {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            break;
        }
        if above.at(middle) < 0.0 {
            a = middle
        } else {
            b = middle
        }
    }
    b
}

/// A narrow interval within `ends` at whose first end a function is negative and at whose last it is not, where `ends` have
/// that property or nearly so.
fn around(function: &Polynomial, ends: [f64; 2]) -> [f64; 2] {
    let near = function.root_from(0.5 * (ends[0] + ends[1]));
    let width = NARROW * (ends[1].abs() + ends[0].abs());
    let narrow = [(near - width).max(ends[0]), (near + width).min(ends[1])];
    let holds =
        narrow[0] < narrow[1] && function.at(narrow[0]) < 0.0 && function.at(narrow[1]) >= 0.0;
    if holds { narrow } else { ends }
}

/// The sum of a function and a running maximum where both are defined, with the stances of the first; `None` where they
/// nowhere are.
///
/// Where one part of f ends at the very position at which a part of g begins, the trains touch. What f is up to there and
/// what g is from there on are limits of one arrangement where a wheel of one of them is at the section: the section may be
/// on either side of it while no train moves. Elsewhere, and where wheels of both are at the section, the one is a limit from
/// before and the other from behind, which trains that touch do not have at once.
pub(crate) fn sum_of(f: &PiecewiseFunction, g: &PiecewiseFunction) -> Option<PiecewiseFunction> {
    let mut out = PiecewiseFunction::with_room(f.pieces.len() + g.pieces.len());
    let meet =
        |a: &Part, b: &Part| a.position[0] < b.position[0] && a.at_section[1] != b.at_section[0];
    overlaps(f, g, meet, |a, b| {
        let at_section = match a.length() == 0.0 {
            true => [true; 2],
            false => [0, 1].map(|end| a.at_section[end] || b.at_section[end]),
        };
        let sum = Part {
            cubic: a.cubic.plus(&b.cubic, 1.0),
            at_section,
            ..a
        };
        out.pieces.push(sum.with_source(b.sources[0]));
    });
    (!out.pieces.is_empty()).then_some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value_of(f: &PiecewiseFunction, at: f64) -> f64 {
        let part = f
            .pieces
            .iter()
            .find(|part| part.position[0] <= at && at <= part.position[1]);
        let part = part.expect("the function is defined there");
        part.cubic.at(at - part.position[0])
    }

    fn random(random: &mut fastrand::Rng, breaks: &[f64]) -> PiecewiseFunction {
        let mut f = PiecewiseFunction::default();
        for ends in breaks.windows(2) {
            let c: [f64; 4] = std::array::from_fn(|_| 2.0 * random.f64() - 1.0);
            f.pieces
                .push(Part::new([ends[0], ends[1]], Polynomial::new(&c), 0));
        }
        f
    }

    /// The larger of two functions, their sum, and a mirrored one against samples.
    #[test]
    fn combined_functions_against_samples() {
        let mut dice = fastrand::Rng::with_seed(12);
        for _ in 0..50 {
            let f = random(&mut dice, &[0.0, 1.0, 2.5, 4.0]);
            let g = random(&mut dice, &[0.0, 0.7, 2.5, 3.0, 4.0]);
            let (larger, sum, mirrored) = (
                larger_of(&f, &g),
                sum_of(&f, &g).expect("both are defined"),
                f.mirrored(),
            );
            for k in 0..400 {
                let p = f64::from(k) / 100.0 + 0.003;
                let (a, b) = (value_of(&f, p), value_of(&g, p));
                assert!((value_of(&larger, p) - a.max(b)).abs() < 1e-11, "at {p}");
                assert!((value_of(&sum, p) - (a + b)).abs() < 1e-11, "at {p}");
                assert!((value_of(&mirrored, -p) - a).abs() < 1e-11, "at {p}");
            }
        }
    }

    /// The running maximum of a random piecewise cubic against samples.
    #[test]
    fn running_maximum_against_samples() {
        let mut dice = fastrand::Rng::with_seed(11);
        for _ in 0..50 {
            let f = random(&mut dice, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
            let running = running_maximum(&f, 0.5);
            for k in 0..600 {
                let p = f64::from(k) / 100.0 + 0.003;
                let before = PiecewiseFunction {
                    pieces: f
                        .pieces
                        .iter()
                        .filter(|part| part.position[0] <= p)
                        .map(|part| part.between([part.position[0], part.position[1].min(p)]))
                        .collect(),
                };
                let known = before.largest().expect("p is within f").value;
                assert!(
                    (value_of(&running, p + 0.5) - known).abs() < 1e-13,
                    "at {p}"
                );
            }
        }
    }

    /// However many parts of a function are below a level that it has reached, its running maximum is one part there.
    #[test]
    fn a_level_is_one_part() {
        let mut f = PiecewiseFunction::default();
        f.push([0.0, 1.0], Polynomial::new(&[0.0, 1.0]), 0, [false; 2]);
        for k in 1..6 {
            let ends = [f64::from(k), f64::from(k + 1)];
            f.push(ends, Polynomial::new(&[0.5, -0.1, 0.2]), 0, [false; 2]);
        }
        let running = running_maximum(&f, 2.0);
        let ends: Vec<_> = running.pieces.iter().map(|part| part.position).collect();
        assert_eq!(ends, [[2.0, 3.0], [3.0, f64::INFINITY]]);
        let value = value_of(&running, 5.0);
        assert!((value - 1.0).abs() < 1e-15, "{value}");
    }
}
