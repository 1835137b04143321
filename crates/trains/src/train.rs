//! Trains of wheels, cases of trains that stand on the rails at once, and the ways in which a train may stand.

use splines::Axis;

/// Components of a load on a rail: forces along x, y and z of the rail, and the couples that forces along x and y have
/// about the rail when they act at a distance of one length unit from it along +z.
pub const COMPONENTS: usize = 5;

/// A wheel of a train and its forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainWheel {
    /// Index of the rail on which it stands.
    pub rail: usize,
    /// Distance ahead of the train's position, length, for a train that is not turned.
    pub x: f64,
    /// Vertical force, positive pressing on the rail.
    pub vertical: f64,
    /// Lateral force along +z.
    pub lateral: f64,
    /// Longitudinal force along +x.
    pub longitudinal: f64,
    /// Distance of the forces from the line of the rail along +z, length.
    pub eccentricity: f64,
}

/// Wheels at fixed distances from each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Train {
    /// The wheels; the position of the train is the coordinate of the first one.
    pub wheels: Vec<TrainWheel>,
    /// Distances from the outermost wheels to the ends of the train on each side, length: before, behind.
    pub ends: [f64; 2],
    /// Whether the train also stands the other way round (x of a wheel becomes -x; the forces stay with the wheels).
    pub turned: bool,
    /// Whether lateral, longitudinal forces and eccentricities are tried with either sign, each kind as a whole.
    pub reverses: bool,
    /// Whether wheels may stand beyond the ends of their rails, where they carry nothing.
    pub enters: bool,
}

/// Trains that stand on the rails at once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrainCase {
    /// The trains with the forces of this case.
    pub trains: Vec<Train>,
    /// Whether they stand in this order along the rails; otherwise in every order.
    pub ordered: bool,
    /// Least clear distance between the ends of two neighbours, length.
    pub gap: f64,
    /// Factor of the dead load; 0 for none.
    pub dead: f64,
}

/// How a train stands: which way round, and the signs of lateral force, longitudinal force and eccentricity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orientation {
    /// Whether it is turned.
    pub turned: bool,
    /// Signs, +1 or -1, of the lateral forces, the longitudinal forces and the eccentricities.
    pub signs: [f64; 3],
}

/// A wheel of a train in one stance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PlacedWheel {
    pub rail: usize,
    /// Rail coordinate less the train's position.
    pub offset: f64,
    /// The load by components.
    pub load: [f64; COMPONENTS],
}

/// A train in one stance, with the positions in which it fits on the rails.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlacedTrain {
    pub stance: Orientation,
    pub wheels: Vec<PlacedWheel>,
    /// What it covers of each rail ([`Train::extents`]).
    pub extents: Vec<Option<[f64; 2]>>,
    /// Positions from first to last.
    pub range: [f64; 2],
}

impl Train {
    /// The stances to try: unturned first, all signs positive first. A sign is tried only where it changes a load, and
    /// a train is turned only where that changes it.
    #[must_use]
    pub fn stances(&self) -> Vec<Orientation> {
        let any = |of: fn(&TrainWheel) -> f64| {
            self.reverses && self.wheels.iter().any(|wheel| of(wheel) != 0.0)
        };
        let both = |varies: bool| if varies { &[1.0, -1.0][..] } else { &[1.0] };
        let eccentric = any(|wheel| {
            if wheel.vertical == 0.0 && wheel.longitudinal == 0.0 {
                0.0
            } else {
                wheel.eccentricity
            }
        });
        let mut out = Vec::new();
        for turned in [false, true] {
            if turned && !self.turned {
                continue;
            }
            for &lateral in both(any(|wheel| wheel.lateral)) {
                for &longitudinal in both(any(|wheel| wheel.longitudinal)) {
                    for &eccentricity in both(eccentric) {
                        out.push(Orientation {
                            turned,
                            signs: [lateral, longitudinal, eccentricity],
                        });
                    }
                }
            }
        }
        out
    }

    /// The wheels in a stance. A wheel on rail r stands at position + x + shift r, turned at position - x + shift r.
    pub(crate) fn placed(&self, stance: Orientation, shifts: &[f64]) -> Vec<PlacedWheel> {
        let [lateral, longitudinal, side] = stance.signs;
        let place = |wheel: &TrainWheel| {
            let along = longitudinal * wheel.longitudinal;
            let lever = side * wheel.eccentricity;
            PlacedWheel {
                rail: wheel.rail,
                offset: if stance.turned { -wheel.x } else { wheel.x } + shifts[wheel.rail],
                load: [
                    along,
                    -wheel.vertical,
                    lateral * wheel.lateral,
                    lever * along,
                    -lever * wheel.vertical,
                ],
            }
        };
        self.wheels.iter().map(place).collect()
    }

    /// First and last coordinate that the train covers on each of `rails` rails, ends included, less its position;
    /// `None` where it has no wheel.
    pub(crate) fn extents(&self, stance: Orientation, shifts: &[f64]) -> Vec<Option<[f64; 2]>> {
        let mut out: Vec<Option<[f64; 2]>> = vec![None; shifts.len()];
        for wheel in self.placed(stance, shifts) {
            let known = out[wheel.rail].unwrap_or([wheel.offset; 2]);
            out[wheel.rail] = Some([known[0].min(wheel.offset), known[1].max(wheel.offset)]);
        }
        let [before, behind] = if stance.turned {
            [self.ends[1], self.ends[0]]
        } else {
            self.ends
        };
        for extent in out.iter_mut().flatten() {
            *extent = [extent[0] - before, extent[1] + behind];
        }
        out
    }
}

/// The direction of a component of a load.
pub(crate) const fn axis(component: usize) -> Axis {
    match component {
        0 | 3 => Axis::Longitudinal,
        1 | 4 => Axis::Vertical,
        _ => Axis::Lateral,
    }
}
