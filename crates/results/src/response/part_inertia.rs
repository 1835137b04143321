//! Effects of the inertia forces of rigid parts on the girder that they represent.

use fea::{Effect, FactoredFrame, Girder};
use nalgebra::DMatrix;
use splines::{Axis, InfluenceLines, Probe};

use foundations::{RigidParts, roll_inertia};

/// Abscissas and weights of the three-point Gauss rule on -1..1. It is exact for polynomials of degree five;
/// influence lines are cubic between breaks, and inertia forces are linear along a part.
const GAUSS: [[f64; 2]; 3] = [
    [-0.774_596_669_241_483_4, 5.0 / 9.0],
    [0.0, 8.0 / 9.0],
    [0.774_596_669_241_483_4, 5.0 / 9.0],
];

/// Effects of the inertia force at unit acceleration of each degree of freedom: effects x degrees of freedom.
///
/// A part of length l and mass m per length whose centre has the acceleration u'' and the angular acceleration
/// theta'' exerts on the girder the distributed force m (u'' + theta'' x r), with r measured from the centre, and the
/// distributed torque m i^2 theta_x'' with the radius of gyration i. The moment of the distributed force corresponds
/// to the moment of inertia m l^3/12. The effects of these loads are integrals of the influence lines of the girder
/// over the part, evaluated by Gauss's rule between the breaks of the lines. The influence line of a torque is the
/// difference between those of lateral forces at heights 1 and 0 above the elastic axis.
///
/// # Errors
/// The errors of the frame solver for the girder.
pub fn part_inertia(
    girder: &Girder,
    parts: &RigidParts,
    effects: &[Effect],
) -> Result<DMatrix<f64>, fea::Error> {
    let lines_at = |height: f64| -> Result<InfluenceLines, fea::Error> {
        let (model, rail) = Girder {
            rail_height: height,
            ..girder.clone()
        }
        .model_and_rail()?;
        FactoredFrame::new(&model, &[rail])?.influence_lines(&model, effects)
    };
    let [low, high] = [lines_at(0.0)?, lines_at(1.0)?];
    let mass = girder.mass_per_length.unwrap_or_default();
    let breaks = low.rails().breaks(0);
    let n = effects.len();
    let mut out = DMatrix::zeros(n, parts.basis.ncols());
    let unit = |lines: &InfluenceLines, x: f64, axis: Axis| {
        let mut line = vec![0.0; n];
        // parts do not move in a direction in which the girder is unrestrained
        let resists = lines.fill(Probe { rail: 0, x, axis }, &mut line).is_ok();
        resists.then_some(line)
    };
    for (j, ends) in parts.ends.windows(2).enumerate() {
        let (centre, length) = (0.5 * (ends[0] + ends[1]), ends[1] - ends[0]);
        let roll = roll_inertia(girder, length);
        let mut bounds = vec![ends[0]];
        bounds.extend(
            breaks
                .iter()
                .copied()
                .filter(|x| *x > ends[0] && *x < ends[1]),
        );
        bounds.push(ends[1]);
        for (span, [place, weight]) in bounds
            .windows(2)
            .flat_map(|span| GAUSS.iter().map(move |g| (span, *g)))
        {
            let half = 0.5 * (span[1] - span[0]);
            let x = span[0] + half * (1.0 + place);
            let vertical = unit(&low, x, Axis::Vertical);
            let lateral = unit(&low, x, Axis::Lateral);
            let above = unit(&high, x, Axis::Lateral);
            for k in 0..parts.basis.ncols() {
                let part = |i: usize| parts.basis[(6 * j + i, k)];
                let [y, z] = [
                    part(1) + part(5) * (x - centre),
                    part(2) - part(4) * (x - centre),
                ];
                let element_mass = mass * half * weight;
                for e in 0..n {
                    let own = |line: &Option<Vec<f64>>| line.as_ref().map_or(0.0, |line| line[e]);
                    let torque = own(&above) - own(&lateral);
                    let sum = own(&vertical) * y + own(&lateral) * z + torque * roll * part(3);
                    out[(e, k)] += element_mass * sum;
                }
            }
        }
    }
    Ok(out)
}
