//! Rounding error of beam elements in double precision, against the number and the length of elements.
//!
//! A simply supported Euler-Bernoulli beam of unit length carries a unit force. Its elements are exact at nodes, so
//! every difference from the closed form x^2 (1 - x)^2 / 3 is a rounding error: the condition number of the stiffness
//! matrix grows with the fourth power of the number of elements, and with the ratio of lengths. A banded Cholesky
//! factorisation in doubles is compared with the library, which certifies a bound of its own error.

use fea::{FactoredFrame, Member, Model, Rail, RailSegment, Support};
use splines::{Axis, Probe};

use super::map::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::subject::MapSubject;
use report::chart::{Series, Style};

/// Largest relative error that counts as right.
const ALLOWED: f64 = 1e-6;
/// Smallest relative error that a user certainly notices.
const OBVIOUS: f64 = 0.5;
/// Smallest error that is drawn: the axis is logarithmic.
const LEAST: f64 = 1e-17;

/// Stiffness matrix, 4 x 4, of an Euler-Bernoulli element of length h and bending stiffness 1, over the displacement
/// and the slope of its first and its second end.
pub(super) fn bending(h: f64) -> [[f64; 4]; 4] {
    [
        [
            12.0 / (h * h * h),
            6.0 / (h * h),
            -12.0 / (h * h * h),
            6.0 / (h * h),
        ],
        [6.0 / (h * h), 4.0 / h, -6.0 / (h * h), 2.0 / h],
        [
            -12.0 / (h * h * h),
            -6.0 / (h * h),
            12.0 / (h * h * h),
            -6.0 / (h * h),
        ],
        [6.0 / (h * h), 2.0 / h, -6.0 / (h * h), 4.0 / h],
    ]
}

/// Rows of the lower half of a matrix of half bandwidth 3: entry (i, j) is `band[i][3 + j - i]`.
type Band = Vec<[f64; 4]>;

/// Stiffness matrix of a simply supported beam in elements of the given lengths.
fn assembled(lengths: &[f64]) -> Band {
    let count = lengths.len();
    let n = 2 * (count + 1);
    let mut band = vec![[0.0_f64; 4]; n];
    for (e, &h) in lengths.iter().enumerate() {
        for (i, row) in bending(h).iter().enumerate() {
            for (j, value) in row.iter().enumerate().take(i + 1) {
                band[2 * e + i][3 + j - i] += value;
            }
        }
    }
    // a restrained degree of freedom has a unit row
    for restrained in [0, n - 2] {
        for (offset, entry) in band[restrained].iter_mut().enumerate() {
            *entry = if offset == 3 { 1.0 } else { 0.0 };
        }
        for below in 1..4 {
            if restrained + below < n {
                band[restrained + below][3 - below] = 0.0;
            }
        }
    }
    band
}

/// Cholesky factor of a band in place, and whether the matrix is positive definite.
fn factored(mut band: Band) -> Option<Band> {
    for i in 0..band.len() {
        for j in i.saturating_sub(3)..=i {
            let from = i.saturating_sub(3).max(j.saturating_sub(3));
            let sum: f64 = (from..j)
                .map(|m| band[i][3 + m - i] * band[j][3 + m - j])
                .sum();
            let value = band[i][3 + j - i] - sum;
            if i == j {
                if value <= 0.0 {
                    return None;
                }
                band[i][3] = value.sqrt();
            } else {
                band[i][3 + j - i] = value / band[j][3];
            }
        }
    }
    Some(band)
}

/// Deflection of a simply supported beam of unit length and stiffness at `node` under a unit force there, by banded
/// Cholesky factorisation in doubles; `None` where rounding has made the matrix indefinite.
fn banded(lengths: &[f64], node: usize) -> Option<f64> {
    let band = factored(assembled(lengths))?;
    let n = band.len();
    let mut w = vec![0.0; n];
    w[2 * node] = 1.0;
    for i in 0..n {
        let sum: f64 = (i.saturating_sub(3)..i)
            .map(|m| band[i][3 + m - i] * w[m])
            .sum();
        w[i] = (w[i] - sum) / band[i][3];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..(i + 4).min(n))
            .map(|m| band[m][3 + i - m] * w[m])
            .sum();
        w[i] = (w[i] - sum) / band[i][3];
    }
    Some(w[2 * node])
}

/// The same by the library, with the relative error bound that it certifies.
fn certified(lengths: &[f64], node: usize) -> Result<(f64, f64), String> {
    let section = fea::CrossSection {
        e: 1.0,
        iz: 1.0,
        ..fea::CrossSection::default()
    };
    let mut model = Model {
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    };
    model.sections.push(section);
    let mut x = 0.0;
    model.points.push([x, 0.0, 0.0]);
    let mut segments = Vec::new();
    for (e, h) in lengths.iter().enumerate() {
        x += h;
        model.points.push([x, 0.0, 0.0]);
        model.members.push(Member::beam([e, e + 1], 0, model.up));
        segments.push(RailSegment {
            member: e,
            offset: [0.0; 3],
        });
    }
    let last = lengths.len();
    model.supports.push(Support {
        point: 0,
        fixed: [true, true, true, true, false, false],
    });
    model.supports.push(Support {
        point: last,
        fixed: [false, true, true, true, false, false],
    });
    let place = model.points[node][0];
    let rail = Rail {
        origin: [0.0; 3],
        axis: [1.0, 0.0, 0.0],
        segments,
        stations: vec![place],
    };
    let frame = FactoredFrame::new(&model, &[rail]).map_err(|error| error.to_string())?;
    let probe = Probe {
        rail: 0,
        x: place,
        axis: Axis::Vertical,
    };
    let grid = frame.grid(&[probe]).map_err(|error| error.to_string())?;
    Ok((grid.value[(0, 0)], grid.certificate.error_bound))
}

/// Exact deflection at x, 0 to 1, under a unit force there: x^2 (1 - x)^2 / 3.
fn exact(x: f64) -> f64 {
    x * x * (1.0 - x) * (1.0 - x) / 3.0
}

/// Both maps: 2 to 2^`most` equal elements, and one short element between two long ones.
#[must_use]
pub fn maps(subject: &MapSubject<'_>, most: u32) -> Vec<StabilityMap> {
    let title = format!(
        "{}: error in double precision over the number of elements",
        subject.name
    );
    let axes = |label: &str| {
        [
            MapScale::new(label, "", true),
            MapScale::new("relative error at midspan", "", true),
        ]
    };
    let mut equal = StabilityMap::new(
        "elements",
        &title,
        axes("equal elements of a simply supported span"),
        "Euler-Bernoulli elements, exact except for rounding; wrong if the error exceeds 1e-6. The line is the bound \
         that girderway certifies.",
    );
    let many: Vec<Vec<f64>> = (1..=most)
        .map(|i| vec![1.0 / f64::from(1 << i); 1 << i])
        .collect();
    fill(
        &mut equal,
        many.iter()
            .map(|own| (own.len() as f64, own.clone(), own.len() / 2)),
    );
    let mut short = StabilityMap::new(
        "short-element",
        "One short element between two long ones: error in double precision",
        axes("length of the short element / span"),
        "Two halves of a span and one short element between them; wrong if the error exceeds 1e-6. The line is the \
         bound that girderway certifies.",
    );
    let ratios = super::steps::spread(1e-9, 1e-1, 65);
    let few = ratios
        .into_iter()
        .map(|ratio| (ratio, vec![0.5 - 0.5 * ratio, ratio, 0.5 - 0.5 * ratio], 1));
    fill(&mut short, few);
    vec![equal, short]
}

/// Adds both methods and the certified bound over `meshes`: abscissa of the map, lengths of elements, loaded node.
fn fill(map: &mut StabilityMap, meshes: impl Iterator<Item = (f64, Vec<f64>, usize)>) {
    let mut layers = [("doubles, banded Cholesky", false), ("girderway", true)]
        .map(|(method, ours)| MapLayer::new(method, ours));
    let mut bounds = Vec::new();
    for (x, lengths, node) in meshes {
        let place: f64 = lengths.iter().take(node).sum();
        let expected = exact(place);
        let relative = |value: f64| (value / expected - 1.0).abs().max(LEAST);
        let (value, verdict) = match banded(&lengths, node) {
            Some(value) => (
                relative(value),
                MapVerdict::of(relative(value), ALLOWED, OBVIOUS),
            ),
            None => (
                1.0,
                MapVerdict::Refused("the matrix is not positive definite".to_owned()),
            ),
        };
        map.note(format!("doubles: relative error at {x}"), value);
        layers[0].points.push(MapPoint {
            at: [x, value],
            value,
            verdict,
        });
        let (value, verdict) = match certified(&lengths, node) {
            Ok((value, bound)) => {
                bounds.push([x, bound.max(LEAST)]);
                // a value that exceeds its own bound is wrong as well
                let error = relative(value);
                let is_right = error <= ALLOWED && error <= bound.max(4.0 * f64::EPSILON);
                (
                    error,
                    if is_right {
                        MapVerdict::Right
                    } else {
                        MapVerdict::of(error.max(2.0 * ALLOWED), ALLOWED, OBVIOUS)
                    },
                )
            }
            Err(why) => (1.0, MapVerdict::Refused(why)),
        };
        layers[1].points.push(MapPoint {
            at: [x, value],
            value,
            verdict,
        });
    }
    layers[1].lines.push(Series::new(
        "girderway's certified bound",
        Style::Line,
        bounds,
    ));
    map.layers.extend(layers);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn banded_solver_gives_the_closed_form() {
        for lengths in [vec![0.5, 0.5], vec![0.25; 4], vec![0.1, 0.3, 0.2, 0.4]] {
            let node = 2.min(lengths.len() - 1);
            let place: f64 = lengths.iter().take(node).sum();
            let value = banded(&lengths, node).expect("a stable beam");
            assert!(
                (value / exact(place) - 1.0).abs() < 1e-12,
                "{lengths:?}: {value}"
            );
        }
    }
}
