//! Properties of cross sections from their dimensions: the shapes of the NASTRAN entries PBARL and PBEAML.
//!
//! In the usual drawings of the shapes, y points upwards and z is horizontal. Areas and second moments are those of
//! the exact rectangles and circles, about the centroid: A = sum b h, I1 = sum (b h^3/12 + b h y^2), I2 = sum (h
//! b^3/12 + b h z^2).
//!
//! The torsion constants are, for circles, pi r^4/2; for rectangles, a b^3 (1/3 - 0.21 b/a (1 - b^4/(12 a^4)))
//! where a >= b; for thin open shapes, sum s t^3/3 over walls with centre line s and thickness t; and for thin closed
//! shapes, 4 Am^2 / sum (s/t), where Am is the area enclosed by the centre line.
//!
//! The shear factors (shear area / A) are 5/6 for rectangles, 9/10 for circles and 1/2 for thin tubes. For other
//! shapes the shear area is the area of the walls parallel to the force, measured between the walls perpendicular to
//! it. For flanges of I, H and T and the bars of a cross it is 5/6 of that area.
//!
//! Shapes whose product of inertia I12 = sum b h y z is not zero, such as L and Z, have their principal second moments,
//! about axes turned by the angle a with tan 2a = 2 I12 / (I1 - I2), and for both directions the mean of the two shear
//! factors.
//!
//! # Source
//! W. C. Young, R. G. Budynas: Roark's Formulas for Stress and Strain, 7th ed., table 10.1 (torsion). The meaning
//! of DIM1, DIM2, ... is that of the NASTRAN quick reference guides, entry PBARL. Shear factors differ between
//! programs; these are the usual ones.

use std::f64::consts::PI;

/// Properties of a cross section, in powers of the unit of its dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// Area.
    pub area: f64,
    /// Second moment for bending in plane 1, the integral of y^2; of an oblique shape the larger principal one.
    pub i1: f64,
    /// Second moment for bending in plane 2, the integral of z^2; of an oblique shape the smaller principal one.
    pub i2: f64,
    /// Angle from y to the axis of the larger principal second moment, radians, positive towards z; 0 for shapes whose
    /// principal axes are y and z.
    pub turn: f64,
    /// Torsion constant.
    pub j: f64,
    /// Shear factor of forces along y.
    pub k1: f64,
    /// Shear factor of forces along z.
    pub k2: f64,
}

/// The reason why a shape has no valid section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeError {
    /// The shape is unknown.
    Unknown,
    /// The walls overlap, or one of them has no thickness.
    Dimensions,
}

/// The known shapes and the number of dimensions of each.
pub const SHAPES: [(&str, usize); 19] = [
    ("ROD", 1),
    ("TUBE", 2),
    ("TUBE2", 2),
    ("BAR", 2),
    ("BOX", 4),
    ("BOX1", 6),
    ("I", 6),
    ("I1", 4),
    ("H", 4),
    ("T", 4),
    ("T1", 4),
    ("T2", 4),
    ("CHAN", 4),
    ("CHAN1", 4),
    ("CHAN2", 4),
    ("CROSS", 4),
    ("HAT", 4),
    ("L", 4),
    ("Z", 4),
];

/// Number of dimensions of a shape; `None` if the shape is unknown.
#[must_use]
pub fn dimensions(shape: &str) -> Option<usize> {
    SHAPES
        .iter()
        .find(|(name, _)| *name == shape)
        .map(|(_, count)| *count)
}

/// A rectangular wall: its extent (from, to) along y and z.
#[derive(Clone, Copy, Debug)]
struct Wall {
    y: [f64; 2],
    z: [f64; 2],
}

impl Wall {
    /// The wall with this height and width, whose lower edge is at y and whose left edge is at z.
    fn new(y: f64, height: f64, z: f64, width: f64) -> Wall {
        Wall {
            y: [y, y + height],
            z: [z, z + width],
        }
    }

    fn sides(&self) -> [f64; 2] {
        [self.y[1] - self.y[0], self.z[1] - self.z[0]]
    }

    fn area(&self) -> f64 {
        let [h, b] = self.sides();
        h * b
    }
}

/// A shape as a set of walls, with its shear areas and torsion constant.
struct Drawing {
    walls: Vec<Wall>,
    /// Shear areas for forces along y and z.
    shear: [f64; 2],
    j: f64,
}

/// Properties of a shape of dimensions `d`, in the order of DIM1, DIM2, ...
///
/// # Errors
/// An unknown shape, or a wrong number of dimensions; walls that overlap.
pub fn section_properties(shape: &str, d: &[f64]) -> Result<Properties, ShapeError> {
    let circle = |r: f64, inner: f64, k: f64| {
        // a negative inner radius would be squared and treated as a positive one
        let inner = if inner < 0.0 { r } else { inner };
        let [two, four] =
            [r.powi(2) - inner.powi(2), r.powi(4) - inner.powi(4)].map(|value| PI * value);
        Properties {
            area: two,
            i1: four / 4.0,
            i2: four / 4.0,
            turn: 0.0,
            j: four / 2.0,
            k1: k,
            k2: k,
        }
    };
    let found = match (shape, d) {
        ("ROD", &[r]) => circle(r, 0.0, 0.9),
        ("TUBE", &[r, inner]) => circle(r, inner, 0.5),
        ("TUBE2", &[r, wall]) => circle(r, r - wall, 0.5),
        ("BAR", &[b, h]) => of_drawing(&bar(b, h))?,
        ("BOX", &[b, h, t1, t2]) => of_drawing(&boxed(b, h, [t1, t1], [t2, t2]))?,
        ("BOX1", &[b, h, top, bottom, left, right]) => {
            of_drawing(&boxed(b, h, [bottom, top], [left, right]))?
        }
        ("I", &[h, lower, upper, web, t_lower, t_upper]) => {
            of_drawing(&flanged(h, [lower, upper], web, [t_lower, t_upper]))?
        }
        ("I1", &[sides, web, inner, h]) => {
            let t = 0.5 * (h - inner);
            of_drawing(&flanged(h, [sides + web; 2], web, [t; 2]))?
        }
        ("H", &[inner, walls, h, web]) => {
            let t = 0.5 * walls;
            of_drawing(&turned(flanged(inner + walls, [h; 2], web, [t; 2])))?
        }
        ("T", &[b, h, flange, web]) | ("T2", &[b, h, flange, web]) => {
            of_drawing(&tee(b, h, flange, web))?
        }
        ("T1", &[h, reach, flange, web]) => {
            of_drawing(&turned(tee(h, reach + flange, flange, web)))?
        }
        ("CHAN", &[b, h, web, flange]) => of_drawing(&channel(b, h, web, flange))?,
        ("CHAN1", &[reach, web, inner, h]) => {
            of_drawing(&channel(reach + web, h, web, 0.5 * (h - inner)))?
        }
        ("CHAN2", &[leg, web, h, b]) => of_drawing(&turned(channel(h, b, web, leg)))?,
        ("CROSS", &[reach, upright, h, level]) => of_drawing(&crossed(reach, upright, h, level))?,
        ("HAT", &[h, t, top, brim]) => of_drawing(&hat(h, t, top, brim))?,
        ("L", &[b, h, level, upright]) => of_drawing(&angle(b, h, level, upright))?,
        ("Z", &[reach, web, inner, h]) => of_drawing(&zed(reach, web, inner, h))?,
        _ => return Err(ShapeError::Unknown),
    };
    let numbers = [found.area, found.i1, found.i2, found.j, found.k1, found.k2];
    if numbers
        .iter()
        .all(|value| value.is_finite() && *value > 0.0)
    {
        Ok(found)
    } else {
        Err(ShapeError::Dimensions)
    }
}

/// Area and second moments of the walls about their common centroid.
fn of_drawing(drawing: &Drawing) -> Result<Properties, ShapeError> {
    // a wall with a negative side does not fit between the others
    if drawing
        .walls
        .iter()
        .flat_map(Wall::sides)
        .any(|side| side.is_nan() || side <= 0.0)
    {
        return Err(ShapeError::Dimensions);
    }
    let area: f64 = drawing.walls.iter().map(Wall::area).sum();
    let middle = |range: [f64; 2]| 0.5 * (range[0] + range[1]);
    let centre = [|wall: &Wall| wall.y, |wall: &Wall| wall.z].map(|of| {
        drawing
            .walls
            .iter()
            .map(|wall| wall.area() * middle(of(wall)))
            .sum::<f64>()
            / area
    });
    let (mut i1, mut i2, mut i12) = (0.0, 0.0, 0.0);
    for wall in &drawing.walls {
        let [h, b] = wall.sides();
        let [y, z] = [middle(wall.y) - centre[0], middle(wall.z) - centre[1]];
        i1 += b * h.powi(3) / 12.0 + b * h * y * y;
        i2 += h * b.powi(3) / 12.0 + b * h * z * z;
        i12 += b * h * y * z;
    }
    let [k1, k2] = drawing.shear.map(|shear| shear / area);
    let plain = Properties {
        area,
        i1,
        i2,
        turn: 0.0,
        j: drawing.j,
        k1,
        k2,
    };
    if i12.abs() <= 1e-9 * (i1 * i2).sqrt() {
        return Ok(plain);
    }
    let (mean, radius) = (0.5 * (i1 + i2), (0.5 * (i1 - i2)).hypot(i12));
    let turn = 0.5 * (2.0 * i12).atan2(i1 - i2);
    let k = 0.5 * (k1 + k2);
    Ok(Properties {
        i1: mean + radius,
        i2: mean - radius,
        turn,
        k1: k,
        k2: k,
        ..plain
    })
}

/// Exchanges y and z.
fn turned(drawing: Drawing) -> Drawing {
    let walls = drawing
        .walls
        .iter()
        .map(|wall| Wall {
            y: wall.z,
            z: wall.y,
        })
        .collect();
    let [y, z] = drawing.shear;
    Drawing {
        walls,
        shear: [z, y],
        j: drawing.j,
    }
}

/// A solid rectangle.
fn bar(b: f64, h: f64) -> Drawing {
    let [long, short] = [b.max(h), b.min(h)];
    let ratio = short / long;
    let j = long * short.powi(3) * (1.0 / 3.0 - 0.21 * ratio * (1.0 - ratio.powi(4) / 12.0));
    Drawing {
        walls: vec![Wall::new(0.0, h, 0.0, b)],
        shear: [5.0 / 6.0 * b * h; 2],
        j,
    }
}

/// A box of two horizontal walls (lower, upper) over the full width and two vertical ones (left, right) between them.
fn boxed(b: f64, h: f64, level: [f64; 2], upright: [f64; 2]) -> Drawing {
    let clear = [h - level[0] - level[1], b - upright[0] - upright[1]];
    let walls = vec![
        Wall::new(0.0, level[0], 0.0, b),
        Wall::new(h - level[1], level[1], 0.0, b),
        Wall::new(level[0], clear[0], 0.0, upright[0]),
        Wall::new(level[0], clear[0], b - upright[1], upright[1]),
        // the hollow space, which must have positive sides
        Wall::new(level[0], clear[0], upright[0], clear[1]),
    ];
    let [height, width] = [
        h - 0.5 * (level[0] + level[1]),
        b - 0.5 * (upright[0] + upright[1]),
    ];
    let around =
        height * (1.0 / upright[0] + 1.0 / upright[1]) + width * (1.0 / level[0] + 1.0 / level[1]);
    let shear = [
        clear[0] * (upright[0] + upright[1]),
        clear[1] * (level[0] + level[1]),
    ];
    let fits = walls[4].sides().iter().all(|side| *side > 0.0);
    let walls = if fits { walls[..4].to_vec() } else { walls };
    Drawing {
        walls,
        shear,
        j: 4.0 * (height * width).powi(2) / around,
    }
}

/// A web between a lower and an upper flange, symmetric about a vertical line.
fn flanged(h: f64, width: [f64; 2], web: f64, flange: [f64; 2]) -> Drawing {
    let clear = h - flange[0] - flange[1];
    let walls = vec![
        Wall::new(0.0, flange[0], -0.5 * width[0], width[0]),
        Wall::new(h - flange[1], flange[1], -0.5 * width[1], width[1]),
        Wall::new(flange[0], clear, -0.5 * web, web),
    ];
    let flanges = width[0] * flange[0] + width[1] * flange[1];
    let depth = h - 0.5 * (flange[0] + flange[1]);
    let j =
        (width[0] * flange[0].powi(3) + width[1] * flange[1].powi(3) + depth * web.powi(3)) / 3.0;
    Drawing {
        walls,
        shear: [clear * web, 5.0 / 6.0 * flanges],
        j,
    }
}

/// A flange perpendicular to the end of a web.
fn tee(b: f64, h: f64, flange: f64, web: f64) -> Drawing {
    let clear = h - flange;
    let walls = vec![
        Wall::new(0.0, clear, -0.5 * web, web),
        Wall::new(clear, flange, -0.5 * b, b),
    ];
    let j = (b * flange.powi(3) + (h - 0.5 * flange) * web.powi(3)) / 3.0;
    Drawing {
        walls,
        shear: [clear * web, 5.0 / 6.0 * b * flange],
        j,
    }
}

/// A vertical web with two flanges on the same side.
fn channel(b: f64, h: f64, web: f64, flange: f64) -> Drawing {
    let [clear, reach] = [h - 2.0 * flange, b - web];
    let walls = vec![
        Wall::new(0.0, h, 0.0, web),
        Wall::new(0.0, flange, web, reach),
        Wall::new(h - flange, flange, web, reach),
        Wall::new(flange, clear, 0.0, web),
    ];
    let fits = clear > 0.0;
    let walls = if fits { walls[..3].to_vec() } else { walls };
    let j = (2.0 * (b - 0.5 * web) * flange.powi(3) + (h - flange) * web.powi(3)) / 3.0;
    Drawing {
        walls,
        shear: [clear * web, 2.0 * reach * flange],
        j,
    }
}

/// A vertical bar with two horizontal arms.
fn crossed(reach: f64, upright: f64, h: f64, level: f64) -> Drawing {
    let [low, arm] = [0.5 * (h - level), 0.5 * reach];
    let walls = vec![
        Wall::new(0.0, h, 0.0, upright),
        Wall::new(low, level, -arm, arm),
        Wall::new(low, level, upright, arm),
    ];
    let fits = low >= 0.0;
    let walls = if fits {
        walls
    } else {
        vec![Wall::new(0.0, low, 0.0, arm)]
    };
    let j = (h * upright.powi(3) + reach * level.powi(3)) / 3.0;
    let shear = [h * upright, (reach + upright) * level].map(|area| 5.0 / 6.0 * area);
    Drawing { walls, shear, j }
}

/// A hat of one thickness, open below: a top between two webs, and two brims beside their feet.
fn hat(h: f64, t: f64, top: f64, brim: f64) -> Drawing {
    let [clear, inner] = [h - 2.0 * t, top - 2.0 * t];
    let walls = vec![
        Wall::new(h - t, t, 0.0, top),
        Wall::new(t, clear, 0.0, t),
        Wall::new(t, clear, top - t, t),
        Wall::new(0.0, t, -brim, brim + t),
        Wall::new(0.0, t, top - t, brim + t),
    ];
    // a wall of negative width marks a hat without a hollow
    let walls = if inner > 0.0 && brim >= 0.0 {
        walls
    } else {
        vec![Wall::new(0.0, -1.0, 0.0, -1.0)]
    };
    let j = ((top - t) + 2.0 * (h - t) + 2.0 * (brim + 0.5 * t)) * t.powi(3) / 3.0;
    Drawing {
        walls,
        shear: [2.0 * clear * t, (inner + 2.0 * brim) * t],
        j,
    }
}

/// A horizontal leg below and a vertical leg at its left end.
fn angle(b: f64, h: f64, level: f64, upright: f64) -> Drawing {
    let [clear, reach] = [h - level, b - upright];
    let walls = vec![
        Wall::new(0.0, level, 0.0, upright),
        Wall::new(0.0, level, upright, reach),
        Wall::new(level, clear, 0.0, upright),
    ];
    let j = ((b - 0.5 * upright) * level.powi(3) + (h - 0.5 * level) * upright.powi(3)) / 3.0;
    Drawing {
        walls,
        shear: [clear * upright, reach * level],
        j,
    }
}

/// A vertical web with an upper flange to the left and a lower flange to the right.
fn zed(reach: f64, web: f64, inner: f64, h: f64) -> Drawing {
    let flange = 0.5 * (h - inner);
    let walls = vec![
        Wall::new(0.0, h, 0.0, web),
        Wall::new(h - flange, flange, -reach, reach),
        Wall::new(0.0, flange, web, reach),
    ];
    let fits = inner > 0.0;
    let walls = if fits {
        walls
    } else {
        vec![Wall::new(0.0, inner, 0.0, web)]
    };
    let j = (2.0 * (reach + 0.5 * web) * flange.powi(3) + (h - flange) * web.powi(3)) / 3.0;
    Drawing {
        walls,
        shear: [inner * web, 2.0 * reach * flange],
        j,
    }
}

#[cfg(test)]
mod tests;
