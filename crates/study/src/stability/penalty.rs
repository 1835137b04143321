//! Rigid offsets modelled by stiff members (a penalty), against exact kinematics.
//!
//! The rail of a girder runs at the height h above its axis. The closed form of the lateral compliance of the rail at
//! midspan is L^3 / 48 E I + h^2 L / (4 G J). A post of s times the bending stiffness of the girder adds its own h^3
//! / (3 s), which is large if the post is soft; if it is stiff, the factorisation loses digits. The smallest error
//! lies between these limits and grows with the number of elements. An exact offset has neither error.

use fea::{CrossSection, FactoredFrame, Member, Model, Rail, RailSegment, Support};
use nalgebra::{DMatrix, DVector};
use splines::{Axis, Probe};

use super::elements::bending;
use super::map::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steps::spread;
use super::subject::MapSubject;

/// Largest relative error that counts as right.
const ALLOWED: f64 = 1e-6;
/// Smallest relative error that a user certainly notices.
const OBVIOUS: f64 = 0.5;
/// Offset of the rail relative to the span where the scene's girder has none.
const USUAL: f64 = 0.06;
/// Smallest error that is drawn: the axis is logarithmic.
const LEAST: f64 = 1e-17;

/// A girder of unit length, simply supported and restrained against twist at both ends, with lateral bending
/// stiffness 1, torsional stiffness `twist` and its rail at the height `offset`.
#[derive(Clone, Copy)]
struct Beam {
    twist: f64,
    offset: f64,
}

impl Beam {
    /// Lateral compliance of the rail at midspan: L^3 / 48 + h^2 L / (4 G J).
    fn exact(self) -> f64 {
        1.0 / 48.0 + self.offset * self.offset / (4.0 * self.twist)
    }

    /// The same in doubles by `count` elements and a post at midspan of `stiff` times the bending stiffness of the
    /// girder; `None` where rounding has made the matrix indefinite.
    fn penalty(self, count: usize, stiff: f64) -> Option<f64> {
        let nodes = count + 1;
        // displacement, slope and twist of each node; then displacement and rotation of the top of the post
        let n = 3 * nodes + 2;
        let mut k = DMatrix::zeros(n, n);
        let mut add = |at: [usize; 4], h: f64, stiffness: f64| {
            for (i, row) in bending(h).iter().enumerate() {
                for (j, value) in row.iter().enumerate() {
                    k[(at[i], at[j])] += stiffness * value;
                }
            }
        };
        let h = 1.0 / count as f64;
        for e in 0..count {
            add([3 * e, 3 * e + 1, 3 * e + 3, 3 * e + 4], h, 1.0);
        }
        let post = 3 * (count / 2);
        add([post, post + 2, n - 2, n - 1], self.offset, stiff);
        for e in 0..count {
            let (a, b) = (3 * e + 2, 3 * e + 5);
            let value = self.twist / h;
            for (i, j, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                k[(i, j)] += sign * value;
            }
        }
        let restrained = [0, 2, 3 * count, 3 * count + 2];
        let free: Vec<usize> = (0..n).filter(|i| !restrained.contains(i)).collect();
        let reduced = DMatrix::from_fn(free.len(), free.len(), |i, j| k[(free[i], free[j])]);
        let mut load = DVector::zeros(free.len());
        let top = free.len() - 2;
        load[top] = 1.0;
        reduced.cholesky().map(|factor| factor.solve(&load)[top])
    }

    /// The same by the library, whose rail has the offset in its kinematics.
    fn by_offset(self, count: usize) -> Result<f64, String> {
        let section = CrossSection {
            e: 1.0,
            g: 1.0,
            area: 1.0,
            iy: 1.0,
            iz: 1.0,
            j: self.twist,
            ..CrossSection::default()
        };
        let mut model = Model {
            up: [0.0, 1.0, 0.0],
            sections: vec![section],
            ..Model::default()
        };
        model.points = (0..=count)
            .map(|i| [i as f64 / count as f64, 0.0, 0.0])
            .collect();
        model.members = (0..count)
            .map(|e| Member::beam([e, e + 1], 0, model.up))
            .collect();
        model.supports.push(Support {
            point: 0,
            fixed: [true, true, true, true, false, false],
        });
        model.supports.push(Support {
            point: count,
            fixed: [false, true, true, true, false, false],
        });
        let segments = (0..count).map(|member| RailSegment {
            member,
            offset: [0.0, self.offset, 0.0],
        });
        let rail = Rail {
            origin: [0.0; 3],
            axis: [1.0, 0.0, 0.0],
            segments: segments.collect(),
            stations: vec![0.5],
        };
        let frame = FactoredFrame::new(&model, &[rail]).map_err(|error| error.to_string())?;
        let grid = frame.grid(&[Probe {
            rail: 0,
            x: 0.5,
            axis: Axis::Lateral,
        }]);
        grid.map(|grid| grid.value[(0, 0)])
            .map_err(|error| error.to_string())
    }
}

/// A beam of the proportions of the scene's girder; usual ones where it has no torsional stiffness or no offset.
fn beam_of(subject: &MapSubject<'_>) -> Beam {
    let girder = subject.girder;
    let twist = match (girder.g.zip(girder.j), girder.i_lateral) {
        (Some((g, j)), Some(i)) if g * j > 0.0 && i > 0.0 => g * j / (girder.e * i),
        _ => 0.3,
    };
    let height = (girder.rail_height / subject.length()).abs();
    Beam {
        twist,
        offset: if height > 0.0 { height } else { USUAL },
    }
}

/// Relative error of a compliance, at least [`LEAST`].
fn error_of(beam: Beam, value: f64) -> f64 {
    (value / beam.exact() - 1.0).abs().max(LEAST)
}

/// The points of a post over its stiffnesses `stiffs`, and the smallest error with its stiffness.
fn post(beam: Beam, count: usize, stiffs: &[f64]) -> (Vec<MapPoint>, (f64, f64)) {
    let mut map_points = Vec::new();
    let mut best = (f64::INFINITY, 0.0);
    for &stiff in stiffs {
        let (value, verdict) = match beam
            .penalty(count, stiff)
            .map(|value| error_of(beam, value))
        {
            Some(error) => (error, MapVerdict::of(error, ALLOWED, OBVIOUS)),
            None => (
                1.0,
                MapVerdict::Refused("the matrix is not positive definite".to_owned()),
            ),
        };
        if value < best.0 {
            best = (value, stiff);
        }
        map_points.push(MapPoint {
            at: [stiff, value],
            value,
            verdict,
        });
    }
    (map_points, best)
}

/// The map of the error against the stiffness of the post.
#[must_use]
pub fn map(subject: &MapSubject<'_>, points: usize) -> StabilityMap {
    let beam = beam_of(subject);
    let axes = [
        MapScale::new("stiffness of the post / that of the girder", "", true),
        MapScale::new(
            "relative error of the lateral compliance of the rail",
            "",
            true,
        ),
    ];
    let mut map = StabilityMap::new(
        "penalty",
        "A rail with an offset from the axis of its girder: stiff members or exact kinematics",
        axes,
        "A soft post deflects, a stiff one loses digits; wrong if the error exceeds 1e-6. In girderway the offset is \
         part of the kinematics, without a stiffness to choose.",
    );
    map.note(
        "torsional stiffness / lateral bending stiffness",
        beam.twist,
    );
    map.note("height of the rail / span", beam.offset);
    let stiffs = spread(1.0, 1e16, points);
    for count in [4, 16, 64] {
        let (map_points, best) = post(beam, count, &stiffs);
        map.note(format!("{count} elements: smallest error"), best.0);
        map.note(
            format!("{count} elements: stiffness of smallest error"),
            best.1,
        );
        for stiff in [1e3, 1e5, 1e7] {
            if let Some(value) = beam.penalty(count, stiff) {
                map.note(
                    format!("{count} elements: error at the stiffness {stiff:e}"),
                    error_of(beam, value),
                );
            }
        }
        map.layers
            .push(MapLayer::new(format!("stiff post, {count} elements"), false).with(map_points));
    }
    let mut map_points = Vec::new();
    for count in [4, 16, 64] {
        let (value, verdict) = match beam.by_offset(count).map(|value| error_of(beam, value)) {
            Ok(error) => (error, MapVerdict::of(error, ALLOWED, OBVIOUS)),
            Err(why) => (1.0, MapVerdict::Refused(why)),
        };
        map.note(format!("girderway, {count} elements: error"), value);
        // there is no stiffness to choose: the error is drawn over the whole axis
        map_points.extend(stiffs.iter().map(|stiff| MapPoint {
            at: [*stiff, value],
            value,
            verdict: verdict.clone(),
        }));
    }
    map.layers
        .push(MapLayer::new("girderway, 4, 16 and 64 elements", true).with(map_points));
    map
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_of_a_post_is_its_own_bending() {
        // the post adds h^3 / (3 s); the rest is exact
        let beam = Beam {
            twist: 0.3,
            offset: 0.06,
        };
        for stiff in [1.0, 10.0, 1e3] {
            let value = beam.penalty(8, stiff).expect("a stable beam");
            let expected = beam.exact() + 0.06_f64.powi(3) / (3.0 * stiff);
            assert!(
                (value / expected - 1.0).abs() < 1e-10,
                "{stiff}: {value} {expected}"
            );
        }
        let value = beam.by_offset(8).expect("a stable beam");
        assert!((value / beam.exact() - 1.0).abs() < 1e-13, "{value}");
    }
}
