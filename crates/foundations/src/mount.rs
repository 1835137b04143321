//! Structures carried by bodies, such as the rails of a trolley on its bridge: the lines of their rails relative to
//! the body, their mass, and the inertial coupling of their modes with the motion of the body.

use fea::Modes;
use sim::{CarriedRail, Carrier};
use splines::Axis;

use crate::error::Error;
use formats::scene::{CarriedBy, Origin, Structure};

/// The lines of a structure's rails relative to the body that carries it, and the rigid mass matrix of the structure,
/// 6 x 6 about the body's origin; `None` for a structure on the ground.
///
/// # Errors
/// [`Error::Frame`] for a spec that no model can be made of.
pub fn mount(structure: &Structure) -> Result<Option<Carrier>, Error> {
    let (Some(CarriedBy { body, at, .. }), Origin::Spec { spec, .. }) =
        (structure.carrier, &structure.origin)
    else {
        return Ok(None);
    };
    let refused = Error::frame(&structure.name);
    let (model, rails) = spec.model().map_err(&refused)?;
    let rail_line = |rail: &fea::Rail| {
        let size = rail.axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let along = rail.axis.map(|a| a / size);
        // the rail lies at its offset from the member; only the component across the rail displaces the line of the
        // rail
        let across = rail.segments.first().and_then(|segment| {
            let member = model.members.get(segment.member)?;
            let point = model.points.get(member.points[0])?;
            let offset = member.offsets[0];
            Some([0, 1, 2].map(|k| point[k] + offset[k] + segment.offset[k] - rail.origin[k]))
        });
        let across = across.unwrap_or_default();
        let ahead: f64 = across.iter().zip(along).map(|(a, e)| a * e).sum();
        CarriedRail {
            origin: [0, 1, 2].map(|k| at[k] + rail.origin[k] + across[k] - ahead * along[k]),
            along,
        }
    };
    let mass = Carrier::mass_about_origin(&fea::rigid_mass(&model).map_err(&refused)?, at);
    Ok(Some(Carrier {
        body,
        rails: rails.iter().map(rail_line).collect(),
        mass,
        coupling: Vec::new(),
    }))
}

/// Excitation of a structure: vertical wheel forces, lateral and longitudinal forces where wheels exert them, and the
/// motion of the body that carries the structure.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Excitation {
    pub lateral: bool,
    pub longitudinal: bool,
    pub carrier: Option<CarriedBy>,
}

impl Excitation {
    /// Vertical wheel forces on a structure on the ground.
    pub const VERTICAL: Excitation = Excitation {
        lateral: false,
        longitudinal: false,
        carrier: None,
    };

    /// That of a structure of a scene; `lateral` is whether its wheels have flanges or other lateral forces.
    pub fn of(structure: &Structure, lateral: bool) -> Excitation {
        Excitation {
            lateral,
            longitudinal: structure.longitudinal,
            carrier: structure.carrier,
        }
    }

    /// Directions of the wheel forces.
    pub fn axes(self) -> Vec<Axis> {
        let loaded = [
            (Axis::Vertical, true),
            (Axis::Lateral, self.lateral),
            (Axis::Longitudinal, self.longitudinal),
        ];
        loaded
            .into_iter()
            .filter(|(_, is_loaded)| *is_loaded)
            .map(|(axis, _)| axis)
            .collect()
    }

    /// The forces on the FE model: on its rails, and of inertia in the free motions of the carrier.
    pub fn forces(self) -> fea::ExcitingForces {
        let unit = |k: usize| std::array::from_fn(|i| f64::from(u8::from(i == k)));
        let motions = self.carrier.map_or_else(Vec::new, |on| {
            let of_origin: [[f64; 6]; 6] =
                std::array::from_fn(|k| Carrier::load_about_origin(&unit(k), on.at));
            // load_about_origin is linear: row i has the factors of the six loads about the global origin
            let rows = (0..6).map(|i| of_origin.map(|column| column[i]));
            rows.zip(on.may_move)
                .filter(|(_, moves)| *moves)
                .map(|(row, _)| row)
                .collect()
        });
        fea::ExcitingForces {
            axes: self.axes(),
            motions,
        }
    }
}

/// Coupling of every mode with each free motion of its carrier, divided by sqrt(m_i m), where m_i is the carried mass
/// (or moment of inertia) in that motion and m the total mass. There is one row of modes for each motion. The scaling
/// makes the values comparable with the motion of a mode in which the total mass moves as one rigid body.
pub(super) fn coupled_momentum(modes: &Modes, on: CarriedBy) -> Vec<f64> {
    let total = Carrier::mass_about_origin(&modes.rigid_mass, on.at);
    let couplings: Vec<[f64; 6]> = modes
        .modes
        .iter()
        .map(|mode| Carrier::load_about_origin(&mode.coupling, on.at))
        .collect();
    let moving = (0..6).filter(|&i| on.may_move[i] && total[i][i] > 0.0);
    moving
        .flat_map(|i| {
            let scale = (total[i][i] * modes.rigid_mass[0][0]).sqrt();
            couplings.iter().map(move |coupling| coupling[i] / scale)
        })
        .collect()
}

/// Rigid mass matrix of a modal structure and the coupling of `modes` with its carrier, both about the origin of the
/// carrier; the list of rails is empty.
pub(super) fn inertia(modes: &Modes, on: CarriedBy) -> Carrier {
    let coupling = modes
        .modes
        .iter()
        .map(|mode| Carrier::load_about_origin(&mode.coupling, on.at))
        .collect();
    Carrier {
        body: on.body,
        rails: Vec::new(),
        mass: Carrier::mass_about_origin(&modes.rigid_mass, on.at),
        coupling,
    }
}
