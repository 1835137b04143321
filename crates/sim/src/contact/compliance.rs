//! Compliance of the massless rails at the wheels, evaluated only as often as the accuracy requires.
//!
//! For each structure, the first applicable rule is used. 1. If the wheels move together as prescribed, and G is known as
//! polynomials of their way, these are evaluated ([`PrescribedPath`]). 2. If a path has been set for the next steps and the
//! wheels are near it, G is interpolated along it ([`CompliancePath`]). 3. If every wheel is within a tolerance distance of
//! its position at the last evaluation, G is extrapolated by its slope, G + dG/dx dx. 4. Otherwise G is evaluated.
//! Both tolerance distances are zero until an accuracy is set.
//!
//! A drive or a brake may act on several structures that are loaded along their rails. Its row of G is then the sum of what
//! each of them contributes: these structures are extrapolated or evaluated together, and have no path.

use splines::{Influence, Probe};

use super::candidates::Candidates;
use super::matrices::RailMatrices;
use super::path::{CompliancePath, PathLimits, between};
use super::prescribed::PrescribedPath;
use super::probes::{Entry, Probes};
use crate::Error;
use crate::mechanics::assembly::Mechanics;

/// Distance a wheel may move, in radii per unit of step tolerance, before the compliance is evaluated again instead
/// of extrapolated by its slope.
const NEAR: f64 = 1e-3;

/// Square of the distance a wheel may be beside the path, in radii per unit of step tolerance. G is extrapolated to it, with an
/// error in proportion to its square.
const BESIDE: f64 = 1e-2;

/// Error of the compliance by interpolation along the path, relative to the largest at each wheel, per unit of step tolerance.
const ALONG: f64 = 1e-3;

/// Distance past the break of a rail, relative to 1 + |x|, up to which a path serves: a step may begin or end by so much before the
/// break of its rail or behind it. The first constant is the minimum, the second the value per unit of step tolerance.
const PAST_BREAK: f64 = 1e-9;
const PAST_BREAK_BY_ERROR: f64 = 1e-3;

/// The compliance between all elements.
#[derive(Clone)]
pub(crate) struct RailCompliance {
    matrices: RailMatrices,
    providers: Vec<Provider>,
    /// Whether some element acts on several compliant structures.
    has_shared_rows: bool,
    /// Largest distance from the last evaluation, in wheel radii, for which G is extrapolated.
    near: f64,
    /// What is allowed of paths.
    path: PathLimits,
}

/// The latest evaluation of the compliance of one structure.
#[derive(Clone)]
struct Provider {
    influence: Influence,
    /// Probes of the last evaluation, and the distance that each wheel has moved since.
    probes: Vec<Probe>,
    moved: Vec<f64>,
    /// The path along which G is interpolated, or the prescribed way, in which it is a polynomial.
    path: Option<CompliancePath>,
    /// The path before the last joint that a wheel has passed, which serves inside the step that ended there.
    path_before: Option<CompliancePath>,
    prescribed: Option<PrescribedPath>,
    /// Whether the matrices were interpolated along a path.
    is_on_path: bool,
    is_evaluated: bool,
}

impl RailCompliance {
    pub fn new(mechanics: &Mechanics, probes: &Probes, elements: usize) -> Self {
        let complies = |s: usize| mechanics.foundations[s].compliance.is_some();
        let compliant = probes
            .entries
            .iter()
            .enumerate()
            .filter(|(s, _)| complies(*s));
        let mut bears = vec![None; elements];
        let has_shared_rows = compliant
            .flat_map(|(s, entries)| entries.iter().map(move |entry| (s, entry.element)))
            .any(|(s, element)| bears[element].replace(s).is_some_and(|other| other != s));
        let own = mechanics
            .foundations
            .iter()
            .zip(&probes.entries)
            .zip(&probes.is_direct);
        let providers = own.map(|((foundation, entries), is_direct)| {
            let prescribed = if *is_direct {
                PrescribedPath::new(mechanics, foundation, entries)
            } else {
                None
            };
            let has_other_rule = has_shared_rows || prescribed.is_some();
            let path = if has_other_rule {
                None
            } else {
                CompliancePath::new(mechanics, foundation, entries)
            };
            Provider {
                influence: Influence::zeros(entries.len()),
                probes: entries.iter().map(|entry| entry.probe).collect(),
                moved: vec![0.0; entries.len()],
                path_before: path.clone(),
                path,
                prescribed,
                is_on_path: false,
                is_evaluated: false,
            }
        });
        RailCompliance {
            matrices: RailMatrices::zeros(elements, probes, complies),
            providers: providers.collect(),
            has_shared_rows,
            near: 0.0,
            path: PathLimits::default(),
        }
    }

    /// G and its slopes at the positions of the last update.
    #[inline]
    pub fn matrices(&self) -> &RailMatrices {
        &self.matrices
    }

    /// Replaces the values of G; its slopes are unchanged.
    pub fn set_value(&mut self, rows: impl Iterator<Item = impl AsRef<[f64]>>) {
        self.matrices.set_value(rows);
    }

    /// Sets the tolerance distances of extrapolation for steps with the relative error `tolerance`; `radius` is the
    /// radius of the smallest wheel.
    pub fn set_accuracy(&mut self, tolerance: f64, radius: f64) {
        self.near = NEAR * tolerance;
        let beside = (BESIDE * tolerance).sqrt() * radius;
        self.path = PathLimits {
            beside,
            error: ALONG * tolerance,
            past_break: PAST_BREAK.max(PAST_BREAK_BY_ERROR * tolerance),
        };
    }

    /// Whether interpolation along paths is useful.
    pub fn wants_paths(&self) -> bool {
        self.path.beside != 0.0
            && self
                .providers
                .iter()
                .any(|provider| provider.path.is_some())
    }

    /// Takes the polynomials along the prescribed ways of the wheels that `other` has found.
    pub fn take_paths(&mut self, other: &RailCompliance) {
        for (own, other) in self.providers.iter_mut().zip(&other.providers) {
            if let (Some(own), Some(other)) = (&mut own.prescribed, &other.prescribed) {
                own.take(other);
            }
        }
    }

    /// Updates the rows of G of the `elements` to the rail coordinates `x` of all wheels. The columns of other elements
    /// are not needed.
    ///
    /// # Errors
    /// Errors of the compliance of a structure.
    pub fn update(
        &mut self,
        mechanics: &Mechanics,
        probes: &Probes,
        x: &[f64],
        elements: &Candidates,
    ) -> Result<(), Error> {
        let m = probes.slots.len();
        let RailCompliance {
            matrices,
            providers,
            has_shared_rows,
            near,
            path: limits,
        } = self;
        let mut has_stale_sums = false;
        for (s, (provider, entries)) in providers.iter_mut().zip(&probes.entries).enumerate() {
            let Some(compliance) = &mechanics.foundations[s].compliance else {
                continue;
            };
            if provider
                .prescribed
                .as_ref()
                .is_some_and(|path| path.follow(entries, x, matrices))
            {
                provider.is_on_path = true;
                continue;
            }
            if let Some(path) = &mut provider.path
                && path.follow(x, *limits, elements, (m, matrices))
            {
                provider.is_on_path = true;
                continue;
            }
            let (farthest, has_changed) = provider.move_to(mechanics, entries, x);
            let allowed = if compliance.is_symmetric() {
                *near
            } else {
                0.0
            };
            let is_near = provider.is_evaluated && farthest <= allowed;
            if is_near && !has_changed {
                continue;
            }
            if !is_near {
                provider.moved.fill(0.0);
                for (probe, entry) in provider.probes.iter_mut().zip(entries) {
                    probe.x = x[entry.wheel];
                }
                compliance
                    .fill(&provider.probes, &mut provider.influence)
                    .map_err(|source| Error::Compliance {
                        structure: s,
                        source,
                    })?;
                provider.is_evaluated = true;
                if let Some(path) = &mut provider.prescribed {
                    path.note(mechanics, s, compliance.as_ref(), entries, x);
                }
            }
            if *has_shared_rows {
                has_stale_sums = true;
            } else if !is_near && probes.is_direct[s] {
                transpose(provider.influence.value.as_slice(), &mut matrices.value, m);
                transpose(provider.influence.slope.as_slice(), &mut matrices.slope, m);
            } else {
                clear(entries, m, matrices);
                provider.add_extrapolated(entries, m, matrices);
            }
        }
        if has_stale_sums {
            let evaluated = || {
                providers
                    .iter()
                    .zip(&probes.entries)
                    .filter(|(own, _)| own.is_evaluated)
            };
            evaluated().for_each(|(_, entries)| clear(entries, m, matrices));
            evaluated().for_each(|(own, entries)| own.add_extrapolated(entries, m, matrices));
        }
        Ok(())
    }

    /// Sets the paths of all wheels from `from` to `beyond`, or to `to` if a rail element ends before `beyond`. A
    /// path that already contains `from` and `to` is kept.
    pub fn set_paths(
        &mut self,
        mechanics: &Mechanics,
        probes: &Probes,
        [from, to, beyond]: [&[f64]; 3],
    ) {
        let limits = self.path;
        let reach = limits.beside;
        for (s, (provider, entries)) in self.providers.iter_mut().zip(&probes.entries).enumerate() {
            let foundation = &mechanics.foundations[s];
            let Some(path) = &mut provider.path else {
                continue;
            };
            if path.leads_to(from, limits) && path.leads_to(to, limits) {
                continue;
            }
            // Part of the way from `start` to `end` before the first break of a rail.
            let free = |start: &[f64], end: &[f64]| {
                let shares = entries.iter().filter_map(|Entry { wheel, probe, .. }| {
                    let (start, end) = (start[*wheel], end[*wheel]);
                    let place = mechanics.breaks.between(s, probe.rail, start, end).next()?;
                    Some(if end == start {
                        0.0
                    } else {
                        (place - start) / (end - start)
                    })
                });
                shares.fold(1.0, f64::min)
            };
            let is_free = |start: &[f64], end: &[f64]| free(start, end) == 1.0;
            let inner = |end: &[f64]| -> [Vec<f64>; 2] {
                let of = |k: usize| {
                    (0..from.len())
                        .map(|w| within([from[w], end[w]], reach)[k])
                        .collect()
                };
                [of(0), of(1)]
            };
            // The path ends before the break of a rail, where this is beyond the end of the step.
            let [start, last] = inner(beyond);
            let share = free(&start, &last);
            let nearer = between(from, beyond, share);
            // An error of the rail is ignored here, because the step itself reports it.
            let leads_on = |[start, end]: &[Vec<f64>; 2]| is_free(start, end);
            let ends = [&nearer[..], to].map(inner).into_iter().find(leads_on);
            let is_set =
                ends.zip(foundation.compliance.as_ref())
                    .is_some_and(|(ends, compliance)| {
                        let goes_on = is_free(path.second(), &ends[0]);
                        path.set(
                            compliance.as_ref(),
                            ends.each_ref().map(Vec::as_slice),
                            limits,
                            goes_on,
                        )
                        .is_ok()
                    });
            if is_set {
                let contact = |wheel: usize| mechanics.wheels[wheel].contact;
                path.set_bounds(|wheel, x| {
                    let rail = mechanics.scene.contacts[contact(wheel)].rail;
                    mechanics.breaks.about(s, rail, x)
                });
            } else {
                path.clear();
            }
        }
    }

    /// Replaces the path of structure `s` by one that is not set; the present one is kept.
    pub fn begin_path(&mut self, s: usize) {
        self.exchange_paths(s);
        if let Some(path) = &mut self.providers[s].path {
            path.clear();
        }
    }

    /// Exchanges the path of structure `s` and the one before the last joint.
    pub fn exchange_paths(&mut self, s: usize) {
        let Provider {
            path, path_before, ..
        } = &mut self.providers[s];
        std::mem::swap(path, path_before);
    }
}

impl Provider {
    /// Updates the distances of the wheels at `x` from the last evaluation. Returns the largest distance in wheel
    /// radii, and whether the matrices are out of date.
    fn move_to(&mut self, mechanics: &Mechanics, entries: &[Entry], x: &[f64]) -> (f64, bool) {
        let (mut farthest, mut has_changed) = (0.0_f64, std::mem::take(&mut self.is_on_path));
        for ((moved, probe), entry) in self.moved.iter_mut().zip(&self.probes).zip(entries) {
            let now = x[entry.wheel] - probe.x;
            has_changed |= now != *moved;
            *moved = now;
            let radius = mechanics.scene.wheels[mechanics.wheels[entry.wheel].kind].radius;
            farthest = farthest.max(now.abs() / radius);
        }
        (farthest, has_changed)
    }

    /// Adds the compliance between the probes of each two elements, extrapolated by the slopes: G + dG/dx dx.
    fn add_extrapolated(&self, entries: &[Entry], m: usize, matrices: &mut RailMatrices) {
        let RailMatrices {
            value: sums,
            slope: rates,
            tangential,
            ..
        } = matrices;
        let (count, moved) = (entries.len(), &self.moved);
        let (values, slopes) = (
            self.influence.value.as_slice(),
            self.influence.slope.as_slice(),
        );
        for (i, row) in entries.iter().enumerate() {
            let span = row.element * m..(row.element + 1) * m;
            let (sums, rates) = (&mut sums[span.clone()], &mut rates[span]);
            // The values are symmetric, so the derivative by the position of the column is the slope of the
            // transposed entry.
            let mirrored = &slopes[i * count..(i + 1) * count];
            for (j, column) in entries.iter().enumerate() {
                let weight = row.weight * column.weight;
                let (value, slope) = (values[i + j * count], slopes[i + j * count]);
                sums[column.element] +=
                    weight * (value + slope * moved[i] + mirrored[j] * moved[j]);
                rates[column.element] += weight * slope;
                if let Some(own) = row.tangential {
                    tangential[own * m + column.element] += weight * slope;
                }
            }
        }
    }
}

/// Sets the rows of the elements of a structure to zero.
fn clear(entries: &[Entry], m: usize, matrices: &mut RailMatrices) {
    let RailMatrices {
        value,
        slope,
        tangential,
        ..
    } = matrices;
    for row in entries {
        value[row.element * m..(row.element + 1) * m].fill(0.0);
        slope[row.element * m..(row.element + 1) * m].fill(0.0);
        if let Some(own) = row.tangential {
            tangential[own * m..(own + 1) * m].fill(0.0);
        }
    }
}

/// The interval without its ends, which may be at the end of a rail element: a quarter of `reach` is removed at both
/// ends, or a quarter of the interval if that is shorter than `reach`.
fn within([from, to]: [f64; 2], reach: f64) -> [f64; 2] {
    let off = 0.25 * (to - from).clamp(-reach, reach);
    [from + off, to - off]
}

/// Copies the leading rows and columns of a column-major square matrix into a row-major matrix with `m` columns, in
/// tiles that fit in the cache.
fn transpose(from: &[f64], to: &mut [f64], m: usize) {
    const TILE: usize = 16;
    let size = from.len().isqrt();
    for first in (0..size).step_by(TILE) {
        let rows = first..(first + TILE).min(size);
        for left in (0..size).step_by(TILE) {
            for i in rows.clone() {
                let row = &mut to[i * m + left..i * m + (left + TILE).min(size)];
                row.iter_mut()
                    .enumerate()
                    .for_each(|(j, to)| *to = from[(left + j) * size + i]);
            }
        }
    }
}
