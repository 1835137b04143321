//! The ways in which the trains of a case may stand, and the best of them for one response.
//!
//! For one train this is the largest value over the pieces of each stance. Several trains that share rails stand in
//! some order with least distances c between their positions. With f_j(p) the response to train j at position p,
//!
//! F_1 = f_1,    F_(j+1)(q) = f_(j+1)(q) + max over p <= q - c of F_j(p),
//!
//! and the running maximum of piecewise cubics is piecewise cubic or constant, so that the result is exact. Orders and
//! stances are enumerated. Trains that share no rail do not hinder each other; each such group is treated by itself.

use crate::error::Error;
use crate::pieces::Piece;
use crate::running::{PiecewiseFunction, running_maximum, sum_of};
use crate::structure::Structure;
use crate::train::{COMPONENTS, PlacedTrain, TrainCase};

/// Values closer than this, relative to their size, count as equal.
pub(crate) const TIE: f64 = 1e-12;
/// Responses that differ by no more than this, relative to the largest, are those of one stance.
const EQUAL: f64 = 1e-14;

/// A case with its trains in every stance.
#[derive(Clone, Debug)]
pub(crate) struct CasePlan {
    /// By train and stance.
    pub trains: Vec<Vec<PlacedTrain>>,
    /// Groups of trains that share rails, each with its orders.
    groups: Vec<Group>,
    /// Least distance from the position of train a in stance i to that of train b in stance j behind it: `[a][i][b][j]`;
    /// minus infinity where they share no rail.
    distances: Vec<Vec<Vec<Vec<f64>>>>,
    /// Factor of the dead load.
    pub dead: f64,
}

/// Trains that hinder each other, in every order.
#[derive(Clone, Debug)]
struct Group {
    orders: Vec<Vec<usize>>,
}

/// Where one train stands in the best arrangement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Standing {
    pub stance: usize,
    pub position: f64,
    /// Index of the piece that holds the position.
    pub piece: usize,
}

/// The best arrangement for a response: sign times its value without dead load, and where each train stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Arrangement {
    pub signed: f64,
    pub trains: Vec<Standing>,
}

impl CasePlan {
    /// Checks the trains of a case and places them in every stance.
    ///
    /// # Errors
    /// A train that is longer than its rails, trains that do not fit beside each other, a load that the structure does
    /// not resist.
    pub fn new(structure: &Structure, case: &TrainCase, index: usize) -> Result<CasePlan, Error> {
        let mut trains = Vec::new();
        let mut extents = Vec::new();
        for (number, train) in case.trains.iter().enumerate() {
            let rails = structure.rail_count();
            for (wheel, given) in train.wheels.iter().enumerate() {
                let numbers =
                    [given.x, given.vertical, given.lateral, given.longitudinal, given.eccentricity];
                if given.rail >= rails || !numbers.iter().all(|value| value.is_finite()) {
                    return Err(Error::Wheel { train: number, wheel });
                }
            }
            let first = train.wheels.first().ok_or(Error::Wheel { train: number, wheel: 0 })?;
            let shifts = structure.shifts(first.rail);
            let mut placed = Vec::new();
            let mut reach = Vec::new();
            for stance in train.stances() {
                let wheels = train.placed(stance, &shifts);
                for (wheel, of) in wheels.iter().enumerate() {
                    let stiff = |k: usize| of.load[k] == 0.0 || structure.resists(of.rail, k);
                    if let Some(k) = (0..COMPONENTS).find(|&k| !stiff(k)) {
                        return Err(Error::NoStiffness { train: number, wheel, axis: crate::train::axis(k) });
                    }
                }
                let ends =
                    |wheel: &crate::train::PlacedWheel| structure.range(wheel.rail).map(|x| x - wheel.offset);
                let all = wheels.iter().map(ends);
                let mut range = if train.enters {
                    all.fold([f64::INFINITY, f64::NEG_INFINITY], |r, [a, b]| [r[0].min(a), r[1].max(b)])
                } else {
                    all.fold([f64::NEG_INFINITY, f64::INFINITY], |r, [a, b]| [r[0].max(a), r[1].min(b)])
                };
                if range[0] > range[1] + structure.slack() {
                    return Err(Error::TooLong { train: number, lowest: range[0], highest: range[1] });
                }
                if train.enters {
                    // A little beyond, where nothing is loaded.
                    let margin = 1e-3 * (range[1] - range[0]);
                    range = [range[0] - margin, range[1] + margin];
                }
                range[1] = range[1].max(range[0]);
                reach.push(train.extents(stance, &shifts));
                placed.push(PlacedTrain { stance, wheels, range });
            }
            trains.push(placed);
            extents.push(reach);
        }
        let distance = |a: &[Option<[f64; 2]>], b: &[Option<[f64; 2]>]| {
            let shared = a.iter().zip(b).filter_map(|(a, b)| Some((*a)?[1] - (*b)?[0]));
            shared.fold(f64::NEG_INFINITY, f64::max) + case.gap
        };
        let distances: Vec<Vec<Vec<Vec<f64>>>> = extents
            .iter()
            .map(|a| {
                a.iter()
                    .map(|a| extents.iter().map(|b| b.iter().map(|b| distance(a, b)).collect()).collect())
                    .collect()
            })
            .collect();
        let share = |a: usize, b: usize| distances[a][0][b][0] > f64::NEG_INFINITY;
        let equal = |a: usize, b: usize| case.trains[a] == case.trains[b];
        let groups = groups(trains.len(), share, equal, case.ordered);
        let plan = CasePlan { trains, groups, distances, dead: case.dead };
        let room = plan
            .groups
            .iter()
            .all(|group| group.orders.iter().any(|order| plan.fits(order, structure.slack())));
        if room { Ok(plan) } else { Err(Error::NoRoom { case: index }) }
    }

    /// Whether the trains fit in an order in some stances.
    fn fits(&self, order: &[usize], slack: f64) -> bool {
        let mut ok = false;
        let all: Vec<Vec<usize>> = self.trains.iter().map(|stances| (0..stances.len()).collect()).collect();
        choices(order, &all, &mut |stances| {
            let mut lowest = f64::NEG_INFINITY;
            let fits = order.iter().enumerate().all(|(k, &train)| {
                let [first, last] = self.trains[train][stances[k]].range;
                let least = if k == 0 { first } else { first.max(lowest + self.distance(order, stances, k)) };
                lowest = least;
                least <= last + slack
            });
            ok |= fits;
        });
        ok
    }

    /// Calls `each` with every order of the trains of each group and every choice among their listed stances.
    pub fn for_each_arrangement(&self, listed: &[Vec<usize>], each: &mut dyn FnMut(&[usize], &[usize])) {
        for order in self.groups.iter().flat_map(|group| &group.orders) {
            choices(order, listed, &mut |stances| each(order, stances));
        }
    }

    /// Least distance from train k - 1 of an order to train k.
    pub fn distance(&self, order: &[usize], stances: &[usize], k: usize) -> f64 {
        self.distances[order[k - 1]][stances[k - 1]][order[k]][stances[k]]
    }

    /// The arrangement with the largest value of sign times response `k`; `pieces[train][stance]` are the responses to
    /// each train. `None` where nothing reaches `floor`, for a case of one train.
    pub fn best<const N: usize>(
        &self,
        pieces: &[Vec<Vec<Piece<N>>>],
        k: usize,
        sign: f64,
        floor: f64,
    ) -> Option<Arrangement> {
        let distinct: Vec<Vec<usize>> = pieces.iter().map(|stances| distinct_stances(stances, k)).collect();
        if let ([stances], [distinct]) = (pieces, &distinct[..]) {
            return best_of_one(stances, distinct, k, sign, floor);
        }
        let mut out = Arrangement { signed: 0.0, trains: vec![Standing::default(); pieces.len()] };
        for group in &self.groups {
            if let [train] = group.orders[0][..] {
                let one = best_of_one(&pieces[train], &distinct[train], k, sign, f64::NEG_INFINITY)?;
                out.signed += one.signed;
                out.trains[train] = one.trains[0];
                continue;
            }
            let mut best: Option<(f64, Vec<(usize, Standing)>)> = None;
            for order in &group.orders {
                choices(order, &distinct, &mut |stances| {
                    let limit =
                        best.as_ref().map_or(f64::NEG_INFINITY, |(value, _)| value + TIE * value.abs());
                    if let Some(found) = self.chain(pieces, order, stances, k, sign, limit) {
                        best = Some(found);
                    }
                });
            }
            let (signed, trains) = best?;
            out.signed += signed;
            trains.into_iter().for_each(|(train, standing)| out.trains[train] = standing);
        }
        (out.signed >= floor).then_some(out)
    }

    /// The best positions of trains in one order and in given stances, if the value is above `limit`.
    fn chain<const N: usize>(
        &self,
        pieces: &[Vec<Vec<Piece<N>>>],
        order: &[usize],
        stances: &[usize],
        k: usize,
        sign: f64,
        limit: f64,
    ) -> Option<(f64, Vec<(usize, Standing)>)> {
        let own = |at: usize| PiecewiseFunction::of(&pieces[order[at]][stances[at]], k, sign);
        let mut sums = vec![own(0)];
        for at in 1..order.len() {
            let before = running_maximum(&sums[at - 1], self.distance(order, stances, at));
            sums.push(sum_of(&own(at), &before)?);
        }
        let last = order.len() - 1;
        let (mut position, value) = sums[last].largest(f64::INFINITY)?;
        if value <= limit {
            return None;
        }
        let mut out = Vec::with_capacity(order.len());
        for at in (0..=last).rev() {
            let list = &pieces[order[at]][stances[at]];
            let piece = list.partition_point(|piece| piece.position[1] < position).min(list.len() - 1);
            out.push((order[at], Standing { stance: stances[at], position, piece }));
            if at > 0 {
                let distance = self.distance(order, stances, at);
                // A train that touches the next may stand exactly where its response jumps.
                let rounding =
                    if distance.is_finite() { TIE * position.abs().max(distance.abs()) } else { 0.0 };
                position = sums[at - 1].largest(position - distance + rounding)?.0;
            }
        }
        Some((value, out))
    }
}

/// Calls `each` for every choice among the listed stances of the trains of an order.
fn choices(order: &[usize], listed: &[Vec<usize>], each: &mut dyn FnMut(&[usize])) {
    let mut at = vec![0; order.len()];
    loop {
        let chosen: Vec<usize> = order.iter().zip(&at).map(|(&train, &k)| listed[train][k]).collect();
        each(&chosen);
        let Some(k) = (0..order.len()).rev().find(|&k| at[k] + 1 < listed[order[k]].len()) else { return };
        at[k] += 1;
        at[k + 1..].fill(0);
    }
}

/// The stances of a train that differ in a response: of those with equal pieces the first. A lateral force, for
/// instance, does not change a vertical moment, whatever its sign.
fn distinct_stances<const N: usize>(stances: &[Vec<Piece<N>>], k: usize) -> Vec<usize> {
    let size = |pieces: &Vec<Piece<N>>| {
        let value = |piece: &Piece<N>| {
            let h = piece.length();
            let [a, b, c, d] = piece.cubics[k].map(f64::abs);
            a + h * (b + h * (c + h * d))
        };
        pieces.iter().map(value).fold(0.0, f64::max)
    };
    let slack = EQUAL * stances.iter().map(size).fold(0.0, f64::max);
    let same = |a: &Piece<N>, b: &Piece<N>| {
        let h = a.length();
        let powers = [1.0, h, h * h, h * h * h];
        a.position == b.position
            && (0..4).all(|p| (a.cubics[k][p] - b.cubics[k][p]).abs() * powers[p] <= slack)
    };
    let equal =
        |a: &Vec<Piece<N>>, b: &Vec<Piece<N>>| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b));
    let mut out: Vec<usize> = Vec::new();
    for (stance, pieces) in stances.iter().enumerate() {
        if !out.iter().any(|&known| equal(&stances[known], pieces)) {
            out.push(stance);
        }
    }
    out
}

/// The largest value for one train in the listed stances.
fn best_of_one<const N: usize>(
    stances: &[Vec<Piece<N>>],
    listed: &[usize],
    k: usize,
    sign: f64,
    floor: f64,
) -> Option<Arrangement> {
    let mut best: Option<(f64, Standing)> = None;
    for &stance in listed {
        for (index, piece) in stances[stance].iter().enumerate() {
            let limit = best.map_or(floor, |(value, _)| value + TIE * value.abs());
            let signed = crate::polynomial::Polynomial::default().plus(&piece.polynomial(k), sign);
            if let Some((t, value)) = signed.largest_above(piece.length(), limit)
                && (value > limit || best.is_none() && value >= floor)
            {
                best = Some((value, Standing { stance, position: piece.position[0] + t, piece: index }));
            }
        }
    }
    best.map(|(signed, standing)| Arrangement { signed, trains: vec![standing] })
}

/// Groups of trains that share rails, directly or through others, with their orders.
fn groups(
    count: usize,
    share: impl Fn(usize, usize) -> bool,
    equal: impl Fn(usize, usize) -> bool,
    ordered: bool,
) -> Vec<Group> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for train in 0..count {
        let (met, apart): (Vec<_>, Vec<_>) =
            groups.into_iter().partition(|group: &Vec<usize>| group.iter().any(|&other| share(train, other)));
        groups = apart;
        let mut joined: Vec<usize> = met.into_iter().flatten().chain([train]).collect();
        joined.sort_unstable();
        groups.push(joined);
    }
    groups.sort();
    // Equal trains need not be exchanged: of two of them the first stands before the second.
    let increasing = |order: &Vec<usize>| {
        (0..order.len()).all(|i| (0..i).all(|j| order[j] < order[i] || !equal(order[i], order[j])))
    };
    let orders = |group: Vec<usize>| {
        let all = if ordered { vec![group] } else { permutations(&group) };
        Group { orders: all.into_iter().filter(|order| ordered || increasing(order)).collect() }
    };
    groups.into_iter().map(orders).collect()
}

/// All orders of a list, the given one first.
fn permutations(list: &[usize]) -> Vec<Vec<usize>> {
    if list.len() < 2 {
        return vec![list.to_vec()];
    }
    let mut out = Vec::new();
    for first in 0..list.len() {
        let rest: Vec<usize> =
            list.iter().enumerate().filter(|(k, _)| *k != first).map(|(_, v)| *v).collect();
        out.extend(permutations(&rest).into_iter().map(|rest| [vec![list[first]], rest].concat()));
    }
    out
}
