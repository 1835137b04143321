//! Whether a displacement at i from a load at j is that at j from i.

use super::{Extreme, Strip, climb};
use crate::{Error, Table};

/// Largest |T_ij - T_ji| of a table, at its first such pair; `None` where its stations along z are not those
/// along x. A symmetric table has exactly 0, at its first station.
#[must_use]
pub fn station_asymmetry(table: &Table) -> Option<Extreme> {
    let x = table.x();
    if table.z() != x {
        return None;
    }
    let mut worst = Extreme { value: 0.0, x: x[0], z: x[0] };
    for i in 0..x.len() {
        for j in 0..i {
            let value = (table.values()[(i, j)] - table.values()[(j, i)]).abs();
            if value > worst.value {
                worst = Extreme { value, x: x[j], z: x[i] };
            }
        }
    }
    Some(worst)
}

/// Largest |G(x, z) - G(z, x)| of a direct strip over all pairs of `places` (increasing), refined.
///
/// # Errors
/// What the compliance refuses.
pub fn asymmetry(strip: &Strip<'_>, places: &[f64]) -> Result<Extreme, Error> {
    let (Some(&first), Some(&last)) = (places.first(), places.last()) else {
        return Ok(Extreme::default());
    };
    let g = strip.block(places, places)?;
    let mut worst = Extreme { value: 0.0, x: first, z: first };
    for i in 0..places.len() {
        for j in 0..i {
            let value = (g[(i, j)] - g[(j, i)]).abs();
            if value > worst.value {
                worst = Extreme { value, x: places[j], z: places[i] };
            }
        }
    }
    if worst.value == 0.0 {
        return Ok(worst);
    }
    let mut at = [worst.x, worst.z];
    let skew = |p: &[f64]| Ok((strip.at(p[0], p[1])? - strip.at(p[1], p[0])?).abs());
    let step = (last - first) / places.len() as f64;
    let value = climb(skew, &mut at, step, [first, last])?;
    Ok(Extreme { value, x: at[0], z: at[1] })
}
