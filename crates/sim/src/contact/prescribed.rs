//! Compliance of wheels that move together as prescribed: polynomials of their way between two breaks of the rails.
//!
//! Where the places of wheels on their rail elements enter G by cubic polynomials ([`Compliance::is_cubic`]), G between wheels
//! that keep their distances is a polynomial of the sixth degree in their common way between two breaks of the rails, and
//! each of its slopes dG(i, j)/dx_i one of the fifth. Such a piece is fitted by divided differences over seven places as soon
//! as its evaluations so far show that many more will follow. The slopes confirm the fit: their sums dG(i, j)/dx_i + dG(j,
//! i)/dx_j are the derivatives of the values at the seven places, and their differences of the sixth order vanish. A compliance
//! that does not meet this is always evaluated.

use std::sync::Arc;

use splines::{Compliance, Influence, Probe};

use super::matrices::RailMatrices;
use super::probes::Entry;
use crate::Foundation;
use crate::mechanics::assembly::Mechanics;

/// Number of coefficients of a polynomial of the sixth degree.
const TERMS: usize = 7;

/// Places in the piece, on [-1, 1]: the zeros of the Chebyshev polynomial of the seventh degree.
const PLACES: [f64; TERMS] = [
    -0.974_927_912_181_823_6,
    -0.781_831_482_468_029_8,
    -0.433_883_739_117_558_1,
    0.0,
    0.433_883_739_117_558_1,
    0.781_831_482_468_029_8,
    0.974_927_912_181_823_6,
];

/// Number of evaluations in a piece that show its rate, and the number of those to come from which it is fitted.
const RATED: usize = 3;
const WORTH: f64 = 12.0;

/// Number of wheels up to which the coefficients fit the cache of a core.
const MOST: usize = 64;

/// Error of the fit, relative to the largest value or slope, up to which it is rounding.
const ROUNDING: f64 = 1e-11;

/// Coefficients of four polynomials by divided differences.
type Polynomials<const N: usize> = [[f64; 4]; N];

/// The way of the wheels on one structure, all of whose motions along the rails are prescribed.
#[derive(Clone)]
pub(crate) struct PrescribedPath {
    piece: Option<Arc<Piece>>,
    /// Breaks before and behind each wheel around the place of the latest evaluation, the place of the first wheel at the first
    /// evaluation between them, and the number of evaluations since.
    bounds: Vec<[f64; 2]>,
    begun: f64,
    evaluations: usize,
    /// Whether no piece was found that is no polynomial.
    is_polynomial: bool,
}

/// G between two breaks.
struct Piece {
    /// Breaks before and behind each wheel; a piece does not contain its ends, where slopes may jump.
    bounds: Vec<[f64; 2]>,
    /// Middle and half length of the way of the first wheel.
    middle: f64,
    half: f64,
    /// Values and slopes, row by row, four at a time.
    values: Vec<Polynomials<TERMS>>,
    slopes: Vec<Polynomials<{ TERMS - 1 }>>,
}

impl PrescribedPath {
    /// The path of the probes `entries`, whose compliance is that between the elements. `None` where the wheels are not moved
    /// by one prescribed motion, where they are too many, or where the compliance is no polynomial.
    pub fn new(
        mechanics: &Mechanics,
        foundation: &Foundation,
        entries: &[Entry],
    ) -> Option<PrescribedPath> {
        if !foundation.compliance.as_ref()?.is_cubic() {
            return None;
        }
        let driven = mechanics.coordinates[entries.first()?.wheel].driven?;
        let is_moved = |entry: &Entry| {
            let coordinate = &mechanics.coordinates[entry.wheel];
            coordinate.driven == Some(driven) && coordinate.terms.is_empty()
        };
        (entries.len() <= MOST && entries.iter().all(is_moved)).then(|| PrescribedPath {
            piece: None,
            bounds: Vec::new(),
            begun: 0.0,
            evaluations: 0,
            is_polynomial: true,
        })
    }

    /// Takes the piece of another path of the same wheels.
    pub fn take(&mut self, other: &PrescribedPath) {
        self.is_polynomial &= other.is_polynomial;
        if let Some(piece) = &other.piece
            && !self
                .piece
                .as_ref()
                .is_some_and(|own| Arc::ptr_eq(own, piece))
        {
            self.piece = Some(piece.clone());
        }
    }

    /// Writes values and slopes for the positions `x` of all wheels into the `matrices` of the `entries`; returns false if the
    /// wheels are not in the known piece.
    pub fn follow(&self, entries: &[Entry], x: &[f64], matrices: &mut RailMatrices) -> bool {
        let Some(piece) = self
            .piece
            .as_deref()
            .filter(|piece| are_within(&piece.bounds, entries, x))
        else {
            return false;
        };
        let at = (x[entries[0].wheel] - piece.middle) / piece.half;
        let gaps = PLACES.map(|place| at - place);
        put(&piece.values, gaps, &mut matrices.value);
        put(&piece.slopes, gaps, &mut matrices.slope);
        true
    }

    /// Notes an evaluation of the `compliance` of structure `s` at the positions `x` of all wheels, and fits the piece there if
    /// it is worth it.
    pub fn note(
        &mut self,
        mechanics: &Mechanics,
        s: usize,
        compliance: &dyn Compliance,
        entries: &[Entry],
        x: &[f64],
    ) {
        if !self.is_polynomial {
            return;
        }
        let place = x[entries[0].wheel];
        if self.bounds.is_empty() || !are_within(&self.bounds, entries, x) {
            (self.begun, self.evaluations) = (place, 0);
            self.bounds.clear();
            let around = |Entry { wheel, probe, .. }: &Entry| {
                mechanics.breaks.around(s, probe.rail, x[*wheel])
            };
            self.bounds.extend(entries.iter().map_while(around));
            if self.bounds.len() < entries.len() {
                self.bounds.clear();
            }
            return;
        }
        self.evaluations += 1;
        let (way, [back, ahead]) = (place - self.begun, free_way(&self.bounds, entries, x));
        let to_come = self.evaluations as f64 * (if way < 0.0 { back } else { ahead }) / way;
        if self.evaluations >= RATED && to_come.is_finite() && to_come >= WORTH {
            self.piece =
                Piece::new(compliance, std::mem::take(&mut self.bounds), entries, x).map(Arc::new);
            self.is_polynomial = self.piece.is_some();
        }
    }
}

impl Piece {
    /// Fits the piece between the `bounds` of the wheels, which are at `x`; `None` if the compliance is no polynomial there, or
    /// cannot be evaluated.
    fn new(
        compliance: &dyn Compliance,
        bounds: Vec<[f64; 2]>,
        entries: &[Entry],
        x: &[f64],
    ) -> Option<Piece> {
        let count = entries.len();
        let own = |entry: &Entry| x[entry.wheel];
        let [back, ahead] = free_way(&bounds, entries, x);
        let (middle, half) = (0.5 * (back + ahead), 0.5 * (ahead - back));
        let mut probes: Vec<Probe> = entries.iter().map(|entry| entry.probe).collect();
        let mut at_places = Vec::with_capacity(TERMS);
        for place in PLACES {
            for (probe, entry) in probes.iter_mut().zip(entries) {
                probe.x = own(entry) + middle + half * place;
            }
            let mut influence = Influence::zeros(count);
            compliance.fill(&probes, &mut influence).ok()?;
            at_places.push(influence);
        }
        let values_at = |entry: usize| -> [f64; TERMS] {
            std::array::from_fn(|k| at_places[k].value.as_slice()[entry])
        };
        let slopes_at = |entry: usize| -> [f64; TERMS] {
            std::array::from_fn(|k| at_places[k].slope.as_slice()[entry])
        };
        let size = count * count;
        let mut values = vec![[[0.0; 4]; TERMS]; size.div_ceil(4)];
        let mut slopes = vec![[[0.0; 4]; TERMS - 1]; size.div_ceil(4)];
        let largest = |of: fn(&Influence) -> &[f64]| {
            at_places
                .iter()
                .flat_map(of)
                .fold(0.0_f64, |largest, own| largest.max(own.abs()))
        };
        let allowed = [
            largest(|own| own.value.as_slice()),
            largest(|own| own.slope.as_slice()),
        ]
        .map(|largest| ROUNDING * largest);
        for i in 0..count {
            for j in 0..count {
                let (there, back, out) = (i + count * j, j + count * i, i * count + j);
                let value = differences(values_at(there));
                let [slope @ .., last] = differences(slopes_at(there));
                let rates = slopes_at(there)
                    .into_iter()
                    .zip(slopes_at(back))
                    .zip(PLACES);
                let is_alike = rates.into_iter().all(|((own, other), place)| {
                    ((own + other) * half - derivative(&value, place)).abs() <= allowed[0]
                });
                if !(is_alike && last.abs() <= allowed[1]) {
                    return None;
                }
                (0..TERMS).for_each(|k| values[out / 4][k][out % 4] = value[k]);
                (0..TERMS - 1).for_each(|k| slopes[out / 4][k][out % 4] = slope[k]);
            }
        }
        Some(Piece {
            bounds,
            middle: own(&entries[0]) + middle,
            half,
            values,
            slopes,
        })
    }
}

/// Whether every wheel is between its bounds.
#[inline]
fn are_within(bounds: &[[f64; 2]], entries: &[Entry], x: &[f64]) -> bool {
    bounds.iter().zip(entries).all(|([before, behind], entry)| {
        let x = x[entry.wheel];
        *before < x && x < *behind
    })
}

/// The ways, one negative and one positive, in which no wheel at `x` reaches its bounds.
fn free_way(bounds: &[[f64; 2]], entries: &[Entry], x: &[f64]) -> [f64; 2] {
    let ways = bounds
        .iter()
        .zip(entries)
        .map(|(bounds, entry)| bounds.map(|bound| bound - x[entry.wheel]));
    ways.fold([f64::NEG_INFINITY, f64::INFINITY], |[back, ahead], way| {
        [back.max(way[0]), ahead.min(way[1])]
    })
}

/// Divided differences of the `values` at [`PLACES`].
fn differences(mut values: [f64; TERMS]) -> [f64; TERMS] {
    for order in 1..TERMS {
        for k in (order..TERMS).rev() {
            values[k] = (values[k] - values[k - 1]) / (PLACES[k] - PLACES[k - order]);
        }
    }
    values
}

/// Derivative at `at` of the polynomial with these divided differences.
fn derivative(differences: &[f64; TERMS], at: f64) -> f64 {
    let (mut value, mut slope) = (0.0, 0.0);
    for (own, place) in differences.iter().zip(PLACES).rev() {
        slope = slope * (at - place) + value;
        value = value * (at - place) + own;
    }
    slope
}

/// Writes the polynomials into `out`, four at a time, where `gaps` are the distances from [`PLACES`].
#[inline]
fn put<const N: usize>(terms: &[Polynomials<N>], gaps: [f64; TERMS], out: &mut [f64]) {
    let at = |terms: &Polynomials<N>| {
        let mut sum = terms[N - 1];
        for n in (0..N - 1).rev() {
            for (sum, own) in sum.iter_mut().zip(&terms[n]) {
                *sum = *sum * gaps[n] + own;
            }
        }
        sum
    };
    let (fours, rest) = out.as_chunks_mut::<4>();
    let (whole, last) = terms.split_at(fours.len());
    fours
        .iter_mut()
        .zip(whole)
        .for_each(|(four, terms)| *four = at(terms));
    if let Some(terms) = last.first() {
        rest.copy_from_slice(&at(terms)[..rest.len()]);
    }
}

#[cfg(test)]
mod tests {
    use splines::{Axis, ExactSurface, Flexibility, RailElement, Rails};

    use super::*;
    use crate::contact::probes::Probes;

    /// A beam of two spans on three supports, with an axial force that is left out of the compliance of its nodes.
    fn beam(tension: f64) -> ExactSurface {
        let element = |k: usize| RailElement {
            rail: 0,
            x: [10.0 * k as f64, 10.0 * (k + 1) as f64],
            ends: [k, k + 1],
            length: 10.0,
            frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            offset: [0.0; 3],
            flexibility: Flexibility {
                bending_z: 1e-3,
                tension,
                ..Flexibility::default()
            },
            member: None,
        };
        let mut nodal = nalgebra::DMatrix::<f64>::zeros(18, 18);
        // rotations of the three nodes under moments there, EI/l = 100
        let stiffness = nalgebra::Matrix3::<f64>::new(
            400.0, 200.0, 0.0, 200.0, 800.0, 200.0, 0.0, 200.0, 400.0,
        );
        let compliance = stiffness.try_inverse().expect("three supports");
        (0..9).for_each(|k| nodal[(6 * (k / 3) + 5, 6 * (k % 3) + 5)] = compliance[(k / 3, k % 3)]);
        let rails = Rails::new(vec![element(0), element(1)]).expect("two elements");
        ExactSurface::new(Arc::new(rails), nodal).expect("symmetric")
    }

    fn entries(count: usize) -> Vec<Entry> {
        let probe = Probe {
            rail: 0,
            x: 0.0,
            axis: Axis::Vertical,
        };
        let entry = |wheel| Entry {
            element: wheel,
            weight: -1.0,
            wheel,
            probe,
            tangential: None,
        };
        (0..count).map(entry).collect()
    }

    fn probes_of(entries: Vec<Entry>) -> Probes {
        Probes {
            slots: vec![None; entries.len()],
            entries: vec![entries],
            is_direct: vec![true],
            tangential: Vec::new(),
            sliding: Vec::new(),
            states: Vec::new(),
        }
    }

    /// Identity: the polynomials are the compliance everywhere in their piece, and not used beyond it.
    #[test]
    fn polynomials_are_the_compliance_between_two_breaks() {
        let surface = beam(0.0);
        for starts in [&[1.0][..], &[9.0, 6.5], &[17.0, 12.0, 4.0, 3.9, 0.5]] {
            let count = starts.len();
            let on = entries(count);
            let span = |x: f64| if x < 10.0 { [0.0, 10.0] } else { [10.0, 20.0] };
            let bounds: Vec<[f64; 2]> = starts.iter().map(|x| span(*x)).collect();
            let piece = Piece::new(&surface, bounds, &on, starts).expect("a polynomial");
            let path = PrescribedPath {
                piece: Some(Arc::new(piece)),
                bounds: Vec::new(),
                begun: 0.0,
                evaluations: 0,
                is_polynomial: true,
            };
            let mut matrices = RailMatrices::zeros(count, &probes_of(entries(count)), |_| true);
            for way in [-0.49, -0.2, 0.0, 0.31, 0.7, 0.99] {
                let x: Vec<f64> = starts.iter().map(|x| x + way).collect();
                assert!(path.follow(&on, &x, &mut matrices), "{way}");
                let probes: Vec<Probe> = on
                    .iter()
                    .zip(&x)
                    .map(|(entry, x)| Probe {
                        x: *x,
                        ..entry.probe
                    })
                    .collect();
                let mut exact = Influence::zeros(count);
                surface.fill(&probes, &mut exact).expect("on the rail");
                for (found, exact) in [
                    (&matrices.value, exact.value.transpose()),
                    (&matrices.slope, exact.slope.transpose()),
                ] {
                    let largest = exact.amax();
                    for (found, exact) in found.iter().zip(exact.iter()) {
                        assert!(
                            (found - exact).abs() < 2e-14 * largest,
                            "{way}: {found} for {exact}"
                        );
                    }
                }
            }
            for beyond in [-starts[count - 1], 10.0] {
                let x: Vec<f64> = starts.iter().map(|x| x + beyond).collect();
                assert!(!path.follow(&on, &x, &mut matrices), "{beyond}");
            }
        }
    }

    #[test]
    fn another_function_is_no_polynomial() {
        let (bounds, at) = (vec![[0.0, 10.0]; 2], [3.0, 5.0]);
        let [cubic, stretched] = [0.0, 50.0].map(beam);
        assert!(cubic.is_cubic() && !stretched.is_cubic());
        assert!(Piece::new(&cubic, bounds.clone(), &entries(2), &at).is_some());
        assert!(Piece::new(&stretched, bounds, &entries(2), &at).is_none());
    }
}
