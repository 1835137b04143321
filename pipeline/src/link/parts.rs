//! The chain of rigid parts and beams of a straight girder.

use std::sync::Arc;

use fea::{Girder, Kind, Link, Member, Model, Support};
use nalgebra::{DMatrix, DVector};
use sim::{BlendedParts, Extent, Foundation, PartChain, PartShapes, Structure};
use splines::{Cell, Flexibility, Line, Surface};

use super::{untrusted, window};
use crate::exit::Failure;
use crate::scene::Handover;

/// Smallest stiffness kept, relative to the most compliant combination of the parts' freedoms.
const RIGID: f64 = 1e-13;

/// `count` rigid parts of equal length, beams between their centres, supports on the parts above them; where
/// the girder has mass, each part has its share.
///
/// # Errors
/// What the FE model refuses.
pub fn foundation(girder: &Girder, count: usize, handover: Handover) -> Result<Foundation, Failure> {
    let ends = part_ends(girder, count);
    let chain = PartChain::new(ends.clone(), 0, window(handover)).ok_or_else(|| {
        Failure::Untrusted("the hand-over windows of neighbouring parts overlap: shorten `blend`".to_owned())
    })?;
    let centres: Vec<f64> = ends.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let nodal = nodal_compliance(girder, &ends, &centres)?;
    let line = Arc::new(line(girder, &ends, &centres)?);
    let range = chain.range();
    let mut breaks = chain.breaks();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup();
    let mut foundation =
        Foundation { rails: vec![Extent { range: Some(range), breaks }], ..Foundation::default() };
    let separate = matches!(handover, Handover::PerPart { .. });
    if separate {
        foundation.parts = Some(vec![chain.clone()]);
    }
    if let Some(mass) = girder.mass_per_length {
        foundation.structure = Some(with_mass(girder, mass, &ends, &nodal, line, vec![chain], separate));
    } else {
        let surface = Surface::new(line, nodal).map_err(|error| Failure::Untrusted(error.to_string()))?;
        foundation.compliance = Some(if separate {
            Box::new(surface)
        } else {
            Box::new(BlendedParts { surface, chains: vec![chain] })
        });
    }
    Ok(foundation)
}

/// Ends of `count` parts of equal length over the girder with its overhangs.
fn part_ends(girder: &Girder, count: usize) -> Vec<f64> {
    let (from, to) = (-girder.overhangs[0], girder.spans.iter().sum::<f64>() + girder.overhangs[1]);
    (0..=count).map(|j| from + (to - from) * j as f64 / count as f64).collect()
}

/// Compliance of the parts' centres, six freedoms each.
fn nodal_compliance(girder: &Girder, ends: &[f64], centres: &[f64]) -> Result<DMatrix<f64>, Failure> {
    let (whole, _) = girder.frame().map_err(untrusted)?;
    let mut model =
        Model { up: whole.up, theory: whole.theory, sections: whole.sections.clone(), ..Model::default() };
    model.points = centres.iter().map(|&x| [x, 0.0, 0.0]).collect();
    for j in 1..centres.len() {
        model.members.push(Member {
            points: [j - 1, j],
            kind: Kind::Beam,
            section: 0,
            orientation: [0.0, 1.0, 0.0],
            offsets: [[0.0; 3]; 2],
            releases: [[false; 6]; 2],
        });
    }
    for support in &whole.supports {
        let [x, ..] = whole.points[support.point];
        let part = ends[1..ends.len() - 1].partition_point(|&end| end < x);
        model.points.push([x, 0.0, 0.0]);
        let point = model.points.len() - 1;
        model.links.push(Link { from: part, to: point });
        model.supports.push(Support { point, fix: support.fix });
    }
    let points: Vec<usize> = (0..centres.len()).collect();
    let (mut nodal, _) = fea::nodal(&model, &points).map_err(untrusted)?;
    // Freedoms that nothing resists are not the parts' to give.
    for i in 0..nodal.nrows() {
        if !nodal[(i, i)].is_finite() {
            nodal[(i, i)] = 0.0;
        }
    }
    Ok(nodal)
}

/// Every part as a rigid arm on a rail of its own, over the whole length.
fn line(girder: &Girder, ends: &[f64], centres: &[f64]) -> Result<Line, Failure> {
    let [from, to] = [ends[0], ends[ends.len() - 1]];
    let cells = centres.iter().enumerate().map(|(j, centre)| Cell {
        rail: j,
        x: [from, to],
        ends: [j, j],
        length: to - from,
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: [from - centre, girder.rail_height, 0.0],
        flexibility: Flexibility::default(),
    });
    Line::new(cells.collect()).map_err(|error| Failure::Untrusted(error.to_string()))
}

/// Parts with mass: the compliance's principal combinations as freedoms, so that what supports hold is left out.
fn with_mass(
    girder: &Girder,
    mass: f64,
    ends: &[f64],
    nodal: &DMatrix<f64>,
    line: Arc<Line>,
    chains: Vec<PartChain>,
    separate: bool,
) -> Structure {
    // Rotations are scaled by a part's length, so that one eigenproblem measures all freedoms alike.
    let length = ends[1] - ends[0];
    let size = nodal.nrows();
    let scale = DVector::from_fn(size, |i, _| if i % 6 < 3 { 1.0 } else { length });
    let scaled = DMatrix::from_fn(size, size, |i, j| scale[i] * nodal[(i, j)] * scale[j]);
    let eigen = scaled.symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let kept: Vec<usize> = (0..size).filter(|&k| eigen.eigenvalues[k] > RIGID * largest).collect();
    let basis = DMatrix::from_fn(size, kept.len(), |i, k| eigen.eigenvectors[(i, kept[k])] / scale[i]);
    let stiffness =
        DMatrix::from_diagonal(&DVector::from_fn(kept.len(), |k, _| 1.0 / eigen.eigenvalues[kept[k]]));
    let area = girder.area.unwrap_or(f64::INFINITY);
    let polar = (girder.i_vertical + girder.i_lateral.unwrap_or(girder.i_vertical)) / area;
    let lumped = DVector::from_fn(size, |i, _| {
        let part = mass * length;
        match i % 6 {
            0..=2 => part,
            3 => part * polar.max(1e-6 * length * length),
            _ => part * length * length / 12.0,
        }
    });
    let weighted = DMatrix::from_fn(size, kept.len(), |i, k| lumped[i] * basis[(i, k)]);
    let mass = basis.transpose() * weighted;
    let damping = DMatrix::zeros(kept.len(), kept.len());
    Structure { mass, damping, stiffness, shapes: Box::new(PartShapes { line, basis, chains, separate }) }
}
