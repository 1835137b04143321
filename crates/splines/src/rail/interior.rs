//! Displacement of a rail between fixed ends of its member under uniform loads on the member.

use super::beam_column::BeamColumn;
use super::element::RailElement;
use super::load::AxisLoad;

/// Displacement of the rail along the direction of `load` at the place `s` of the member, and its derivative by s, under
/// a uniform load of intensity one along the local y axis of the member, then along its local z axis, with both ends
/// of the member clamped:
///
/// w = s^2 (l - s)^2/(24 EI) + s (l - s)/(2 GAs),    rotation = s (l - s) (l - 2 s)/(12 EI)
///
/// without axial force, otherwise as the beam-column has them. Zero in planes without stiffness.
pub(crate) fn uniform_load(element: &RailElement, load: &AxisLoad, s: f64) -> [[f64; 2]; 2] {
    let f = &element.flexibility;
    let l = element.length;
    let (rest, middle) = (l - s, l - 2.0 * s);
    let without_stiffness = element.without_stiffness();
    let planes = [
        (f.bending_z, f.shear_y, load.xy),
        (f.bending_y, f.shear_z, load.xz),
    ];
    let mut out = [[0.0; 2]; 2];
    for (k, (c, g, [force, moment])) in planes.into_iter().enumerate() {
        if without_stiffness[2 + k] {
            continue;
        }
        if f.tension != 0.0 {
            let column = BeamColumn::new(c, g, f.tension, l);
            let [deflection, slope, rotation, curvature] = column.clamped_under_load(s.min(rest));
            // seen from the last end slopes and rotations have the other sign
            let sign = if s <= rest { 1.0 } else { -1.0 };
            out[k] = [
                force * deflection + moment * sign * rotation,
                force * sign * slope + moment * curvature,
            ];
            continue;
        }
        let product = s * rest;
        let (deflection, rotation) = (
            product * (c * product / 24.0 + 0.5 * g),
            c * product * middle / 12.0,
        );
        let (slope, curvature) = (
            rotation + 0.5 * g * middle,
            c * (middle * middle - 2.0 * product) / 12.0,
        );
        out[k] = [
            force * deflection + moment * rotation,
            force * slope + moment * curvature,
        ];
    }
    out
}
