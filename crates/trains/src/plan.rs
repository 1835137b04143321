//! The ways in which the trains of a case may stand, and the best of them for one response.
//!
//! For one train this is the largest value over the pieces of each stance. Several trains that share rails stand in
//! some order with least distances c between their positions. With f_j(p) the response to train j at position p,
//!
//! F_1 = f_1,    F_(j+1)(q) = f_(j+1)(q) + max over p <= q - c of F_j(p),
//!
//! and the running maximum of piecewise cubics is piecewise cubic or constant, so that the result is exact. Orders and
//! turns are enumerated; f_j is the larger of all signs. Trains that share no rail do not hinder each other; each such
//! group is treated by itself. A train may follow several others that do not share rails with each other, and their running
//! maxima are added; where one is followed by several, positions are counted backwards.

use std::borrow::Cow;

use crate::error::Error;
use crate::pieces::ResponsePiece;
use crate::running::{PiecewiseFunction, larger_of, running_maximum, sum_of};
use crate::structure::Structure;
use crate::train::{COMPONENTS, PlacedTrain, Train, TrainCase};

/// Values closer than this, relative to their size, count as equal.
pub(crate) const TIE: f64 = 1e-12;

/// A response to each train of a case: stances, each with its pieces by position.
pub(crate) type Responses = Vec<Vec<(usize, Vec<ResponsePiece>)>>;

/// A case with its trains in every stance.
#[derive(Clone, Debug)]
pub(crate) struct CasePlan {
    /// By train and stance.
    pub trains: Vec<Vec<PlacedTrain>>,
    /// Groups of trains that share rails, each with its orders.
    pub groups: Vec<Group>,
    /// Least distance from the position of train a in stance i to that of train b in stance j behind it: `[a][i][b][j]`;
    /// minus infinity where they share no rail.
    distances: Vec<Vec<Vec<Vec<f64>>>>,
    /// Factor of the dead load.
    pub dead: f64,
}

/// Trains that hinder each other, in every order.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub orders: Vec<Order>,
}

/// Trains in an order in which each is followed by at most one other.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    pub trains: Vec<usize>,
    /// Places in the order of the trains that each one follows directly.
    before: Vec<Vec<usize>>,
    /// Whether positions are counted backwards.
    mirrored: bool,
}

/// A train one way round: its response, the largest of all signs of its forces.
pub(crate) struct Way {
    /// The first stance of this way round.
    pub stance: usize,
    /// As a function of the position, and of the position counted backwards where an order needs it.
    function: PiecewiseFunction,
    mirrored: Option<PiecewiseFunction>,
    /// What the response nowhere exceeds.
    most: f64,
}

/// Value, and train, stance and position of each train of a group.
type Chain = (f64, Vec<(usize, usize, f64)>);

/// Where one train stands in the best arrangement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Standing {
    pub stance: usize,
    pub position: f64,
    /// The piece of the train's positions that holds the position, and the part of it between passages of the section.
    pub origin: [usize; 2],
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
        let mut trains: Vec<Vec<PlacedTrain>> = Vec::new();
        for (number, train) in case.trains.iter().enumerate() {
            let rails = structure.rail_count();
            for (wheel, given) in train.wheels.iter().enumerate() {
                let numbers = [
                    given.x,
                    given.vertical,
                    given.lateral,
                    given.longitudinal,
                    given.eccentricity,
                ];
                if given.rail >= rails || !numbers.iter().all(|value| value.is_finite()) {
                    return Err(Error::Wheel {
                        train: number,
                        wheel,
                    });
                }
            }
            let first = train.wheels.first().ok_or(Error::Wheel {
                train: number,
                wheel: 0,
            })?;
            let shifts = structure.shifts(first.rail);
            let mut placed = Vec::new();
            for stance in train.stances() {
                let wheels = train.placed(stance, &shifts);
                for (wheel, of) in wheels.iter().enumerate() {
                    let stiff = |k: usize| of.load[k] == 0.0 || structure.resists(of.rail, k);
                    if let Some(k) = (0..COMPONENTS).find(|&k| !stiff(k)) {
                        return Err(Error::NoStiffness {
                            train: number,
                            wheel,
                            axis: crate::train::axis(k),
                        });
                    }
                }
                let ends = |wheel: &crate::train::PlacedWheel| {
                    structure.range(wheel.rail).map(|x| x - wheel.offset)
                };
                let all = wheels.iter().map(ends);
                let mut range = if train.enters {
                    all.fold([f64::INFINITY, f64::NEG_INFINITY], |r, [a, b]| {
                        [r[0].min(a), r[1].max(b)]
                    })
                } else {
                    all.fold([f64::NEG_INFINITY, f64::INFINITY], |r, [a, b]| {
                        [r[0].max(a), r[1].min(b)]
                    })
                };
                if range[0] > range[1] + structure.slack() {
                    return Err(Error::TooLong {
                        train: number,
                        lowest: range[0],
                        highest: range[1],
                    });
                }
                if train.enters {
                    // A little beyond, where nothing is loaded.
                    let margin = 1e-3 * (range[1] - range[0]);
                    range = [range[0] - margin, range[1] + margin];
                }
                range[1] = range[1].max(range[0]);
                placed.push(PlacedTrain {
                    stance,
                    wheels,
                    extents: train.extents(stance, &shifts),
                    range,
                });
            }
            trains.push(placed);
        }
        let distance = |a: &[Option<[f64; 2]>], b: &[Option<[f64; 2]>]| {
            let shared = a
                .iter()
                .zip(b)
                .filter_map(|(a, b)| Some((*a)?[1] - (*b)?[0]));
            shared.fold(f64::NEG_INFINITY, f64::max) + case.gap
        };
        let distances: Vec<Vec<Vec<Vec<f64>>>> = trains
            .iter()
            .map(|a| {
                a.iter()
                    .map(|a| {
                        let behind = |b: &PlacedTrain| distance(&a.extents, &b.extents);
                        trains
                            .iter()
                            .map(|b| b.iter().map(behind).collect())
                            .collect()
                    })
                    .collect()
            })
            .collect();
        make_way(&case.trains, &mut trains, &distances);
        let share = |a: usize, b: usize| distances[a][0][b][0] > f64::NEG_INFINITY;
        let equal = |a: usize, b: usize| case.trains[a] == case.trains[b];
        // Whether two trains cannot hinder each other while a third between them hinders neither.
        let implied = |j: usize, m: usize, k: usize| {
            share(j, m)
                && share(m, k)
                && distances[j].iter().all(|from| {
                    (0..distances[m].len()).all(|way| {
                        let onward = distances[m][way][k].iter();
                        let both = onward
                            .zip(&from[k])
                            .map(|(onward, direct)| (from[m][way] + onward, direct));
                        both.into_iter()
                            .all(|(sum, direct)| sum >= direct - structure.slack())
                    })
                })
        };
        let orders = groups(trains.len(), share, equal, case.ordered);
        let mut groups = Vec::with_capacity(orders.len());
        for group in orders {
            let orders: Option<Vec<Order>> = group
                .into_iter()
                .map(|order| Order::new(order, &share, &implied))
                .collect();
            groups.push(Group {
                orders: orders.ok_or(Error::Ring { case: index })?,
            });
        }
        let plan = CasePlan {
            trains,
            groups,
            distances,
            dead: case.dead,
        };
        let room = plan.groups.iter().all(|group| {
            group
                .orders
                .iter()
                .any(|order| plan.fits(order, structure.slack()))
        });
        if room {
            Ok(plan)
        } else {
            Err(Error::NoRoom { case: index })
        }
    }

    /// Whether the trains fit in an order in some stances.
    fn fits(&self, order: &Order, slack: f64) -> bool {
        let mut ok = false;
        let all: Vec<Vec<usize>> = self
            .trains
            .iter()
            .map(|stances| (0..stances.len()).collect())
            .collect();
        choices(&order.trains, &all, &mut |stances| {
            let mut lowest: Vec<f64> = Vec::with_capacity(stances.len());
            ok |= order.trains.iter().enumerate().all(|(k, &train)| {
                let [a, b] = self.trains[train][stances[k]].range;
                let [first, last] = if order.mirrored { [-b, -a] } else { [a, b] };
                let before = order.before[k]
                    .iter()
                    .map(|&j| lowest[j] + self.step(order, stances, j, k));
                let least = before.fold(first, f64::max);
                lowest.push(least);
                least <= last + slack
            });
        });
        ok
    }

    /// Calls `each` with every order of the trains of each group, by increasing position, and every choice among their
    /// listed stances.
    pub fn for_each_arrangement(
        &self,
        listed: &[Vec<usize>],
        each: &mut dyn FnMut(&[usize], &[usize]),
    ) {
        for order in self.groups.iter().flat_map(|group| &group.orders) {
            let mut trains = order.trains.clone();
            if order.mirrored {
                trains.reverse();
            }
            choices(&trains, listed, &mut |stances| each(&trains, stances));
        }
    }

    /// Least distance from a train in a stance to one behind it; minus infinity where they share no rail.
    pub fn distance(&self, (train, stance): (usize, usize), (next, other): (usize, usize)) -> f64 {
        self.distances[train][stance][next][other]
    }

    /// Least distance from the train at place j of an order to the one at place k that follows it.
    fn step(&self, order: &Order, stances: &[usize], j: usize, k: usize) -> f64 {
        let [first, second] = [j, k].map(|at| (order.trains[at], stances[at]));
        if order.mirrored {
            self.distance(second, first)
        } else {
            self.distance(first, second)
        }
    }

    /// The arrangement with the largest value of sign times a response. It is known to reach `floor`: what cannot is left
    /// out. `None` where nothing reaches it, which for a floor that is reached happens by rounding only.
    pub fn best(&self, responses: &Responses, sign: f64, floor: f64) -> Option<Arrangement> {
        if let [own] = &responses[..] {
            let (signed, standing) = best_of_one(own, sign)?;
            return Some(Arrangement {
                signed,
                trains: vec![standing],
            });
        }
        let mut out = Arrangement {
            signed: 0.0,
            trains: vec![Standing::default(); responses.len()],
        };
        let mut ways: Vec<Vec<Way>> = responses.iter().map(|_| Vec::new()).collect();
        let bound = |own: &Vec<(usize, Vec<ResponsePiece>)>| {
            own.iter()
                .flat_map(|(_, pieces)| pieces)
                .map(|p| p.bound(sign))
                .fold(f64::NEG_INFINITY, f64::max)
        };
        let bounds: Vec<f64> = responses.iter().map(bound).collect();
        let all: f64 = bounds.iter().sum();
        let floor = floor - TIE * bounds.iter().map(|bound| bound.abs()).sum::<f64>();
        for group in &self.groups {
            if let [train] = group.orders[0].trains[..] {
                let (signed, standing) = best_of_one(&responses[train], sign)?;
                out.signed += signed;
                out.trains[train] = standing;
                continue;
            }
            for &train in &group.orders[0].trains {
                let least = floor - (all - bounds[train]);
                let own = responses[train].iter().map(|(stance, pieces)| {
                    (*stance, PiecewiseFunction::of(pieces, sign, *stance, least))
                });
                ways[train] = self.ways(train, own);
            }
            if group.orders[0]
                .trains
                .iter()
                .any(|&train| ways[train].is_empty())
            {
                return None;
            }
            let listed: Vec<Vec<usize>> =
                ways.iter().map(|ways| (0..ways.len()).collect()).collect();
            let mut best: Option<Chain> = None;
            for order in &group.orders {
                choices(&order.trains, &listed, &mut |chosen| {
                    let of: Vec<&Way> = order
                        .trains
                        .iter()
                        .zip(chosen)
                        .map(|(&train, &way)| &ways[train][way])
                        .collect();
                    self.improve(order, &of, &mut best);
                });
            }
            let (signed, trains) = best?;
            out.signed += signed;
            for (train, stance, position) in trains {
                let own = responses[train].iter().find(|(known, _)| *known == stance);
                let (_, list) = own.expect("the stance is one of those that were given");
                out.trains[train] = Standing {
                    stance,
                    position,
                    origin: piece_at(list, position).origin,
                };
            }
        }
        Some(out)
    }

    /// The best positions for a train whose response is known only where one of its wheels is at the section, with the
    /// others entirely before it or entirely behind it: `following`, `passed` and `ahead` are their responses by way, and
    /// all trains are of one group.
    pub fn best_around(
        &self,
        train: usize,
        following: &[Way],
        passed: &[Vec<Way>],
        ahead: &[Vec<Way>],
    ) -> Option<Arrangement> {
        if following.is_empty() {
            return None;
        }
        let group = self
            .groups
            .iter()
            .find(|group| group.orders[0].trains.contains(&train))?;
        let listed: Vec<Vec<usize>> = (0..passed.len())
            .map(|other| {
                let count = if other == train {
                    following.len()
                } else {
                    passed[other].len()
                };
                (0..count).collect()
            })
            .collect();
        let mut best: Option<Chain> = None;
        for order in &group.orders {
            let at = order.trains.iter().position(|&other| other == train)?;
            choices(&order.trains, &listed, &mut |chosen| {
                let of = |(k, (&other, &way)): (usize, (&usize, &usize))| {
                    let is_passed = (k < at) != order.mirrored;
                    match k == at {
                        true => &following[way],
                        false if is_passed => &passed[other][way],
                        false => &ahead[other][way],
                    }
                };
                let ways: Vec<&Way> = order
                    .trains
                    .iter()
                    .zip(chosen)
                    .enumerate()
                    .map(of)
                    .collect();
                self.improve(order, &ways, &mut best);
            });
        }
        let (signed, found) = best?;
        let mut trains = vec![Standing::default(); self.trains.len()];
        for (train, stance, position) in found {
            trains[train] = Standing {
                stance,
                position,
                origin: [0; 2],
            };
        }
        Some(Arrangement { signed, trains })
    }

    /// Whether all trains are of one group, in which each shares a rail with each other.
    pub fn is_one_queue(&self) -> bool {
        self.groups.len() == 1
            && self.groups[0]
                .orders
                .iter()
                .all(|order| order.before.iter().all(|b| b.len() < 2))
            && self.distances.iter().enumerate().all(|(a, from)| {
                from[0]
                    .iter()
                    .enumerate()
                    .all(|(b, to)| a == b || to[0].is_finite())
            })
    }

    /// Takes the best positions in one order and in given ways if they are better.
    fn improve(&self, order: &Order, ways: &[&Way], best: &mut Option<Chain>) {
        let limit = best
            .as_ref()
            .map_or(f64::NEG_INFINITY, |(value, _)| value + TIE * value.abs());
        // trains that stood where each likes best would not reach more than the sum
        if ways.iter().map(|way| way.most).sum::<f64>() <= limit {
            return;
        }
        if let Some(found) = self.chain(order, ways, limit) {
            *best = Some(found);
        }
    }

    /// A response to a train each way round, from that in each of some stances.
    pub fn ways(
        &self,
        train: usize,
        stances: impl IntoIterator<Item = (usize, PiecewiseFunction)>,
    ) -> Vec<Way> {
        let mut out: Vec<(bool, usize, PiecewiseFunction)> = Vec::new();
        for (stance, own) in stances {
            let turned = self.trains[train][stance].stance.turned;
            match out.iter_mut().find(|(known, ..)| *known == turned) {
                Some((_, _, function)) => *function = larger_of(function, &own),
                None => out.push((turned, stance, own)),
            }
        }
        let backwards = self
            .groups
            .iter()
            .flat_map(|group| &group.orders)
            .any(|order| order.mirrored);
        let way = |(_, stance, function): (bool, usize, PiecewiseFunction)| {
            let mirrored = backwards.then(|| function.mirrored());
            let most = function.bound();
            Way {
                stance,
                function,
                mirrored,
                most,
            }
        };
        out.into_iter()
            .map(way)
            .filter(|way| !way.function.is_empty())
            .collect()
    }

    /// The best positions of trains in one order and one way round each, if the value is above `limit`: train, stance and
    /// position.
    fn chain(&self, order: &Order, ways: &[&Way], limit: f64) -> Option<Chain> {
        let stances: Vec<usize> = ways.iter().map(|way| way.stance).collect();
        let mut sums: Vec<Cow<'_, PiecewiseFunction>> = Vec::with_capacity(ways.len());
        for (at, way) in ways.iter().enumerate() {
            let own = if order.mirrored {
                way.mirrored.as_ref()
            } else {
                Some(&way.function)
            };
            let mut sum =
                Cow::Borrowed(own.expect("a plan with mirrored orders mirrors every way"));
            for &j in &order.before[at] {
                let before = running_maximum(&sums[j], self.step(order, &stances, j, at));
                sum = Cow::Owned(sum_of(&sum, &before)?);
            }
            sums.push(sum);
        }
        let followed: Vec<usize> = order.before.iter().flatten().copied().collect();
        let mut value = 0.0;
        let mut found = Vec::with_capacity(ways.len());
        for last in (0..ways.len()).filter(|at| !followed.contains(at)) {
            let largest = sums[last].largest()?;
            value += largest.value;
            let mut open = vec![(last, largest.part, largest.position)];
            while let Some((at, part, position)) = open.pop() {
                let (stance, sources) = sums[at].sources(part);
                found.push((
                    order.trains[at],
                    stance,
                    if order.mirrored { -position } else { position },
                ));
                for (&j, source) in order.before[at].iter().zip(sources) {
                    let along = || position - self.step(order, &stances, j, at);
                    open.push((j, source.part, source.position.unwrap_or_else(along)));
                }
            }
        }
        (value > limit).then_some((value, found))
    }
}

impl Order {
    /// Whether each train follows the one before it, and no other one, by increasing position.
    pub fn is_queue(&self) -> bool {
        let follows = |(k, before): (usize, &Vec<usize>)| match k.checked_sub(1) {
            None => before.is_empty(),
            Some(last) => *before == [last],
        };
        !self.mirrored && self.before.iter().enumerate().all(follows)
    }

    /// Finds for each train which ones it follows directly, forwards or backwards; `None` where neither way each is
    /// followed by at most one.
    fn new(
        trains: Vec<usize>,
        share: &impl Fn(usize, usize) -> bool,
        implied: &impl Fn(usize, usize, usize) -> bool,
    ) -> Option<Order> {
        let direct = |trains: &[usize], mirrored: bool| -> Vec<Vec<usize>> {
            let follows = |k: usize, j: usize| {
                let [from, to] = if mirrored { [k, j] } else { [j, k] };
                share(trains[j], trains[k])
                    && !(j + 1..k).any(|m| implied(trains[from], trains[m], trains[to]))
            };
            (0..trains.len())
                .map(|k| (0..k).filter(|&j| follows(k, j)).collect())
                .collect()
        };
        let once = |before: &Vec<Vec<usize>>| {
            let mut all: Vec<usize> = before.iter().flatten().copied().collect();
            let count = all.len();
            all.sort_unstable();
            all.dedup();
            all.len() == count
        };
        let before = direct(&trains, false);
        if once(&before) {
            return Some(Order {
                trains,
                before,
                mirrored: false,
            });
        }
        let trains: Vec<usize> = trains.into_iter().rev().collect();
        let before = direct(&trains, true);
        once(&before).then_some(Order {
            trains,
            before,
            mirrored: true,
        })
    }
}

/// Lets trains that enter stand so far beyond their rails that they hinder no other one: beyond all positions of the others
/// by more than any row of trains takes.
fn make_way(given: &[Train], trains: &mut [Vec<PlacedTrain>], distances: &[Vec<Vec<Vec<f64>>>]) {
    if given.len() < 2 {
        return;
    }
    let longest = |from: &Vec<Vec<Vec<f64>>>| {
        let all = from.iter().flatten().flatten();
        all.filter(|distance| distance.is_finite())
            .fold(0.0, |most: f64, distance| most.max(distance.abs()))
    };
    let row: f64 = distances.iter().map(longest).sum();
    let all = trains.iter().flatten().map(|train| train.range);
    let [first, last] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| {
        [low.min(a), high.max(b)]
    });
    for (_, stances) in given.iter().zip(trains).filter(|(train, _)| train.enters) {
        for train in stances {
            train.range = [first - row, last + row];
        }
    }
}

/// Calls `each` for every choice among the listed stances of the trains of an order.
fn choices(order: &[usize], listed: &[Vec<usize>], each: &mut dyn FnMut(&[usize])) {
    let mut at = vec![0; order.len()];
    loop {
        let chosen: Vec<usize> = order
            .iter()
            .zip(&at)
            .map(|(&train, &k)| listed[train][k])
            .collect();
        each(&chosen);
        let Some(k) = (0..order.len())
            .rev()
            .find(|&k| at[k] + 1 < listed[order[k]].len())
        else {
            return;
        };
        at[k] += 1;
        at[k + 1..].fill(0);
    }
}

/// The first piece at a position; pieces may have been left out, and rounding may place a position just outside its own.
fn piece_at(list: &[ResponsePiece], position: f64) -> &ResponsePiece {
    let distance = |piece: &ResponsePiece| {
        let [first, last] = piece.position;
        (first - position).max(position - last).max(0.0)
    };
    let next = list.partition_point(|piece| piece.position[1] < position);
    let near = [next.checked_sub(1), Some(next)]
        .into_iter()
        .flatten()
        .filter_map(|k| list.get(k));
    near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .expect("a train stands in one of its pieces")
}

/// The largest value for one train in some stances.
fn best_of_one(stances: &[(usize, Vec<ResponsePiece>)], sign: f64) -> Option<(f64, Standing)> {
    let mut best = None;
    for (stance, pieces) in stances {
        pieces
            .iter()
            .for_each(|piece| offer_part(&mut best, piece, *stance, sign, f64::NEG_INFINITY));
    }
    best
}

/// Takes the largest value of a part if it is better than the best, or the first to reach the floor.
pub(crate) fn offer_part(
    best: &mut Option<(f64, Standing)>,
    part: &ResponsePiece,
    stance: usize,
    sign: f64,
    floor: f64,
) {
    if !can_exceed(best, part.bound(sign), floor) {
        return;
    }
    let (position, value) = part.largest(sign);
    let limit = best.map_or(floor, |(value, _)| value + TIE * value.abs());
    if value > limit || best.is_none() && value >= floor {
        *best = Some((
            value,
            Standing {
                stance,
                position,
                origin: part.origin,
            },
        ));
    }
}

/// Whether something with a bound can be better than the best, or the first to reach the floor.
pub(crate) fn can_exceed(best: &Option<(f64, Standing)>, bound: f64, floor: f64) -> bool {
    best.map_or(bound >= floor, |(value, _)| {
        bound > value + TIE * value.abs()
    })
}

/// Groups of trains that share rails, directly or through others, with their orders.
fn groups(
    count: usize,
    share: impl Fn(usize, usize) -> bool,
    equal: impl Fn(usize, usize) -> bool,
    ordered: bool,
) -> Vec<Vec<Vec<usize>>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for train in 0..count {
        let (met, apart): (Vec<_>, Vec<_>) = groups
            .into_iter()
            .partition(|group: &Vec<usize>| group.iter().any(|&other| share(train, other)));
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
    let orders = |group: Vec<usize>| -> Vec<Vec<usize>> {
        let all = if ordered {
            vec![group]
        } else {
            permutations(&group)
        };
        all.into_iter()
            .filter(|order| ordered || increasing(order))
            .collect()
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
        let rest: Vec<usize> = list
            .iter()
            .enumerate()
            .filter(|(k, _)| *k != first)
            .map(|(_, v)| *v)
            .collect();
        out.extend(
            permutations(&rest)
                .into_iter()
                .map(|rest| [vec![list[first]], rest].concat()),
        );
    }
    out
}
