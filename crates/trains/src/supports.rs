//! The ends of spans in one plane: where a rail is supported in that plane.
//!
//! A point of a girder to which something is connected need not be a support: the bars of a surge truss hold a girder
//! laterally and sink with it vertically. What a point contributes follows from the compliance of the rail at all
//! such points, in a structure whose rigid supports are springs of [`RIGID`] times its stiffness. Let F be that matrix
//! and K its inverse, the stiffness of the structure condensed to these points. If all points move together by one, the
//! girder itself is not strained, so that the forces k = K 1 are those of the ground alone: k_j is the ground stiffness
//! at point j. K_jj - k_j is the stiffness of the girder at j while its neighbours are held. Points whose ratio
//! k_j/(K_jj - k_j) is below [`MIN_SUPPORT`] are no ends of spans; they are removed (their rows and columns leave F),
//! beginning with the smallest ratio, until none is left.
//!
//! A support that is not rigid deflects with the girder, so that such a girder is judged between its firm ends as well:
//! points of its own with a rigid support or a firm spring in the direction of the plane, where there are two or more,
//! otherwise points whose ratio is at least [`FIRM_SUPPORT`].
//!
//! A girder on an elastic bed has ground stiffness at points that are no ends. Where the removed points of a span
//! together have more than [`MIN_SUPPORT`] of the stiffness of the girder between the ends of that span, spans are not
//! defined. The panel points of a truss that stiffens a girder have such a stiffness too, which the truss carries to its own
//! supports: a girder with two or more rigid supports of its own, and no springs elsewhere, spans between these.

use fea::{Dof, GroundSpring, Model, Rail};
use nalgebra::{DMatrix, DVector, Vector3};
use splines::{Axis, Compliance, Influence, Probe};

use crate::error::Error;
use crate::structure::Structure;

/// Smallest ratio of the ground stiffness at the end of a span to the stiffness of the girder there.
pub const MIN_SUPPORT: f64 = 0.05;

/// Smallest ratio of the ground stiffness at a firm end of a span to the stiffness of the girder there.
pub const FIRM_SUPPORT: f64 = 1.0;

/// Stiffness of a spring in place of a rigid support, over the smallest stiffness of the rail at a connected point.
const RIGID: f64 = 1e6;

/// Difference of directions, and of coordinates as a fraction of the largest one, that counts as none.
const SAME: f64 = 1e-6;

/// The planes in which spans are sought.
const PLANES: [Axis; 2] = [Axis::Vertical, Axis::Lateral];

/// The ends of the spans of a rail in one plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SupportedEnds {
    /// Coordinates of the ends, increasing.
    pub ends: Vec<f64>,
    /// Those of the firm ends.
    pub firm: Vec<f64>,
    /// Whether the rail has supports between these ends that are not stiff enough to end a span, and together are not
    /// negligible.
    pub has_elastic_bed: bool,
}

/// The ends of the spans of each rail in the vertical and in the lateral plane, among the increasing coordinates
/// `candidates` of the rail; all of them in a direction in which the structure has no stiffness. `surface` is that of
/// the structure.
///
/// # Errors
/// A structure without solution, or a candidate beyond its rail.
///
/// # Example
/// ```
/// use fea::Girder;
/// use trains::{Structure, supported_ends};
///
/// // A girder of two spans whose middle support holds it laterally only.
/// let girder = Girder { spans: vec![6.0, 6.0], e: 2.1e8, g: Some(8.1e7), area: Some(0.02), i_vertical: 5e-4,
///     i_lateral: Some(1e-4), j: Some(1e-5), ..Girder::default() };
/// let (mut model, rail) = girder.model_and_rail()?;
/// model.supports[1].fixed = [false, false, true, false, false, false];
/// let rails = [rail];
/// let structure = Structure::new(&model, &rails, false)?;
/// let surface = structure.frame().surface()?.surface;
/// let [vertical, lateral] = &supported_ends(&model, &rails, &surface, &[vec![0.0, 6.0, 12.0]])?[0];
/// assert_eq!(vertical.ends, [0.0, 12.0]);
/// assert_eq!(lateral.ends, [0.0, 6.0, 12.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn supported_ends(
    model: &Model,
    rails: &[Rail],
    surface: &dyn Compliance,
    candidates: &[Vec<f64>],
) -> Result<Vec<[SupportedEnds; 2]>, Error> {
    let largest = |rail: usize, axis: Axis| {
        let found = compliance(surface, rail, axis, &candidates[rail]);
        found.map_or(0.0, |found| {
            found.diagonal().iter().copied().fold(0.0, f64::max)
        })
    };
    let largest = (0..candidates.len())
        .flat_map(|rail| PLANES.map(|axis| largest(rail, axis)))
        .fold(0.0, f64::max);
    let all = |rail: usize| SupportedEnds::all_firm(&candidates[rail]);
    if largest == 0.0 {
        return Ok((0..candidates.len())
            .map(|rail| [all(rail), all(rail)])
            .collect());
    }
    let original = model;
    let model = on_springs(original, RIGID / largest);
    let structure = Structure::new(&model, rails, false)?;
    let surface = structure.frame().surface()?.surface;
    let in_plane = |rail: usize, axis: Axis| {
        let Some(found) = compliance(&surface, rail, axis, &candidates[rail]) else {
            return all(rail);
        };
        let mut ends = ends(&candidates[rail], &found);
        let own = OwnSupports::new(original, &rails[rail], axis, &candidates[rail]);
        let is_sprung = own.springs.iter().any(|x| !ends.ends.contains(x));
        if ends.has_elastic_bed && own.rigid.len() >= 2 && !is_sprung {
            return SupportedEnds::all_firm(&own.rigid);
        }
        let firm = own.firm(&ends);
        if firm.len() >= 2 {
            ends.firm = firm;
        }
        ends
    };
    Ok((0..candidates.len())
        .map(|rail| PLANES.map(|axis| in_plane(rail, axis)))
        .collect())
}

/// Coordinates, among the candidates, at which a point of the girder itself is supported in the direction of a plane.
struct OwnSupports {
    /// By rigid supports.
    rigid: Vec<f64>,
    /// By springs to ground.
    springs: Vec<f64>,
}

impl OwnSupports {
    fn new(model: &Model, rail: &Rail, axis: Axis, candidates: &[f64]) -> OwnSupports {
        let along = Vector3::from(rail.axis).normalize();
        let up = Vector3::from(model.up);
        let up = (up - along * up.dot(&along)).normalize();
        let direction = if axis == Axis::Lateral {
            along.cross(&up)
        } else {
            up
        };
        let slack = SAME * candidates.iter().fold(1.0, |far: f64, x| far.max(x.abs()));
        let members = rail.segments.iter().map(|segment| segment.member);
        let points: Vec<usize> = members
            .flat_map(|member| model.members[member].points)
            .collect();
        let is_at = |point: usize, x: f64| {
            let at = Vector3::from(model.points[point]) - Vector3::from(rail.origin);
            points.contains(&point) && (at.dot(&along) - x).abs() <= slack
        };
        let acts = |dof: usize| dof < 3 && direction[dof].abs() > 1.0 - SAME;
        let is_rigid = |x: f64| {
            model.supports.iter().any(|support| {
                is_at(support.point, x) && (0..3).any(|dof| support.fixed[dof] && acts(dof))
            })
        };
        let is_sprung = |x: f64| {
            let mut springs = model.springs.iter();
            springs.any(|spring| is_at(spring.point, x) && acts(spring.dof as usize))
        };
        let places = |holds: &dyn Fn(f64) -> bool| {
            let all = candidates.iter().copied();
            all.filter(|x| holds(*x)).collect()
        };
        OwnSupports {
            rigid: places(&is_rigid),
            springs: places(&is_sprung),
        }
    }

    /// Ends of spans with a rigid support, or a spring that makes them firm.
    fn firm(&self, found: &SupportedEnds) -> Vec<f64> {
        let holds =
            |x: &f64| self.rigid.contains(x) || self.springs.contains(x) && found.firm.contains(x);
        found.ends.iter().copied().filter(holds).collect()
    }
}

/// The model with springs in place of the translations that its supports fix.
fn on_springs(model: &Model, stiffness: f64) -> Model {
    let mut model = model.clone();
    let springs = model.supports.iter_mut().flat_map(|support| {
        let fixed = [Dof::Ux, Dof::Uy, Dof::Uz]
            .into_iter()
            .filter(|dof| std::mem::take(&mut support.fixed[*dof as usize]));
        let point = support.point;
        let springs = fixed.map(|dof| GroundSpring {
            point,
            dof,
            stiffness,
        });
        springs.collect::<Vec<_>>()
    });
    let springs: Vec<GroundSpring> = springs.collect();
    model.springs.extend(springs);
    model
}

/// Compliance of a rail at some places; `None` where the structure has no stiffness in this direction.
fn compliance(
    surface: &dyn Compliance,
    rail: usize,
    axis: Axis,
    places: &[f64],
) -> Option<DMatrix<f64>> {
    let probes: Vec<Probe> = places.iter().map(|&x| Probe { rail, x, axis }).collect();
    let mut influence = Influence::zeros(probes.len());
    surface.fill(&probes, &mut influence).ok()?;
    Some(influence.value)
}

impl SupportedEnds {
    /// Spans between rigid supports.
    #[must_use]
    pub fn all_firm(ends: &[f64]) -> SupportedEnds {
        SupportedEnds {
            ends: ends.to_vec(),
            firm: ends.to_vec(),
            has_elastic_bed: false,
        }
    }
}

/// The ends of the spans of one rail in one plane.
fn ends(candidates: &[f64], compliance: &DMatrix<f64>) -> SupportedEnds {
    let every: Vec<usize> = (0..candidates.len()).collect();
    let Some(all) = ground_stiffness(compliance, &every) else {
        return SupportedEnds::all_firm(candidates);
    };
    let supports = |least| supports(compliance, every.clone(), &all, least);
    let places = |kept: &[usize]| kept.iter().map(|&index| candidates[index]).collect();
    let kept = supports(MIN_SUPPORT);
    SupportedEnds {
        ends: places(&kept),
        firm: places(&supports(FIRM_SUPPORT)),
        has_elastic_bed: has_elastic_bed(compliance, &kept, &all),
    }
}

/// The points that remain when those whose ratio is below `least` are removed; `all` are the stiffnesses with all points.
fn supports(
    compliance: &DMatrix<f64>,
    mut kept: Vec<usize>,
    all: &[[f64; 2]],
    least: f64,
) -> Vec<usize> {
    let mut now = all.to_vec();
    loop {
        let weak = weakest(&now, least);
        if weak.is_empty() {
            return kept;
        }
        let mut place = 0..;
        kept.retain(|_| !weak.contains(&place.next().expect("the range has no end")));
        match ground_stiffness(compliance, &kept) {
            Some(next) => now = next,
            None => return kept,
        }
    }
}

/// Ground stiffness k_j, and stiffness of the girder K_jj - k_j, at each kept point; `None` where the matrix has no inverse.
fn ground_stiffness(compliance: &DMatrix<f64>, kept: &[usize]) -> Option<Vec<[f64; 2]>> {
    let count = kept.len();
    let of_kept = DMatrix::from_fn(count, count, |i, j| compliance[(kept[i], kept[j])]);
    let factor = of_kept.cholesky()?;
    let ground = factor.solve(&DVector::from_element(count, 1.0));
    let stiffness = factor.inverse();
    Some(
        (0..count)
            .map(|j| [ground[j], stiffness[(j, j)] - ground[j]])
            .collect(),
    )
}

/// Points to remove at once: those of the smallest ratios, no two of them neighbours.
fn weakest(points: &[[f64; 2]], least: f64) -> Vec<usize> {
    let ratio = |j: usize| points[j][0] / points[j][1].max(f64::MIN_POSITIVE);
    let mut order: Vec<usize> = (0..points.len()).filter(|&j| ratio(j) < least).collect();
    order.sort_by(|&a, &b| ratio(a).total_cmp(&ratio(b)).then(a.cmp(&b)));
    let mut chosen: Vec<usize> = Vec::new();
    for j in order {
        if !chosen.iter().any(|&other| other.abs_diff(j) == 1) {
            chosen.push(j);
        }
    }
    chosen
}

/// Whether the removed points between two kept ones together support the girder: the sum of their ground stiffness times
/// the largest compliance of the girder at them while the kept points are held.
fn has_elastic_bed(compliance: &DMatrix<f64>, kept: &[usize], all: &[[f64; 2]]) -> bool {
    let count = kept.len();
    let of_kept = DMatrix::from_fn(count, count, |i, j| compliance[(kept[i], kept[j])]);
    let Some(factor) = of_kept.cholesky() else {
        return false;
    };
    // Between two kept points, before the first and behind the last.
    let span_of = |j: usize| kept.partition_point(|&k| k < j);
    let mut spans = vec![(0.0, 0.0); count + 1];
    for j in (0..all.len()).filter(|j| !kept.contains(j)) {
        let column = DVector::from_fn(count, |i, _| compliance[(kept[i], j)]);
        let held = compliance[(j, j)] - column.dot(&factor.solve(&column));
        let span: &mut (f64, f64) = &mut spans[span_of(j)];
        span.0 += all[j][0].max(0.0);
        span.1 = span.1.max(held);
    }
    spans
        .iter()
        .any(|(ground, compliance)| ground * compliance > MIN_SUPPORT)
}
