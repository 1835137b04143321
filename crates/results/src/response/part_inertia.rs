//! Inertia of rigid parts, on the girder that they stand for.

use fea::{Effect, Frame, Girder};
use nalgebra::DMatrix;
use splines::{Axis, Effects, Probe};

use foundations::{RigidParts, roll_inertia};

/// Places and weights on -1..1, exact to degree five.
const GAUSS: [[f64; 2]; 3] =
    [[-0.774_596_669_241_483_4, 5.0 / 9.0], [0.0, 8.0 / 9.0], [0.774_596_669_241_483_4, 5.0 / 9.0]];

/// Effects of M a, a one of the parts' freedoms: effects x freedoms.
///
/// A part of length l and mass m per length that moves with u at its centre and turns with theta loads the girder by
/// m (u + theta cross x) along it, which has the inertia m l^3/12 of a part, and by a torque m r^2 theta_x with its
/// radius of gyration r. The girder carries that as it carries the wheels, by its own influence lines.
pub fn part_inertia(
    girder: &Girder,
    parts: &RigidParts,
    effects: &[Effect],
) -> Result<DMatrix<f64>, fea::Error> {
    // lateral forces at the elastic axis, and a length above it: their difference is a torque
    let raised = |height: f64| -> Result<Effects, fea::Error> {
        let (model, rail) = Girder { rail_height: height, ..girder.clone() }.frame()?;
        Frame::new(&model, &[rail])?.influence_lines(&model, effects)
    };
    let [low, high] = [raised(0.0)?, raised(1.0)?];
    let mass = girder.mass_per_length.unwrap_or_default();
    let breaks = low.line().breaks(0);
    let n = effects.len();
    let mut out = DMatrix::zeros(n, parts.basis.ncols());
    let unit = |lines: &Effects, x: f64, axis: Axis| {
        let mut line = vec![0.0; n];
        // what the girder does not resist, its parts do not move in
        let resists = lines.fill(Probe { rail: 0, x, axis }, &mut line).is_ok();
        resists.then_some(line)
    };
    for (j, ends) in parts.ends.windows(2).enumerate() {
        let (centre, length) = (0.5 * (ends[0] + ends[1]), ends[1] - ends[0]);
        let roll = roll_inertia(girder, length);
        let mut cuts = vec![ends[0]];
        cuts.extend(breaks.iter().copied().filter(|x| *x > ends[0] && *x < ends[1]));
        cuts.push(ends[1]);
        for (cut, [place, weight]) in cuts.windows(2).flat_map(|cut| GAUSS.iter().map(move |g| (cut, *g))) {
            let half = 0.5 * (cut[1] - cut[0]);
            let x = cut[0] + half * (1.0 + place);
            let vertical = unit(&low, x, Axis::Vertical);
            let lateral = unit(&low, x, Axis::Lateral);
            let above = unit(&high, x, Axis::Lateral);
            for k in 0..parts.basis.ncols() {
                let part = |i: usize| parts.basis[(6 * j + i, k)];
                let [y, z] = [part(1) + part(5) * (x - centre), part(2) - part(4) * (x - centre)];
                let size = mass * half * weight;
                for e in 0..n {
                    let own = |line: &Option<Vec<f64>>| line.as_ref().map_or(0.0, |line| line[e]);
                    let torque = own(&above) - own(&lateral);
                    out[(e, k)] += size * (own(&vertical) * y + own(&lateral) * z + torque * roll * part(3));
                }
            }
        }
    }
    Ok(out)
}
