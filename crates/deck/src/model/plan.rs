//! The plan of a deck: identifiers of parts, markers, wheels, contacts and tables, before any statement is written.

use std::ops::Range;

use sim::Foundation;
use splines::Axis;

use crate::Error;
use crate::model::compliance::{RailAxis, RailCompliance};
use crate::model::refuse::unsupported;
use crate::model::start::Start;
use crate::words::form::DeckForm;
use crate::words::ids::{NextId, number};
use formats::scene::motion::{SimulationInput, simulation_input};
use formats::scene::{self, Scene};
use formats::text::diagnostic::Diagnostic;
use foundations::{SolvedStructure, solution_of};

/// Identifier of the ground part.
pub const GROUND: u32 = 1;

/// A scene with the identifiers of its statements.
pub struct DeckPlan<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// How the deck reads tables.
    pub form: DeckForm,
    /// The simulation input made from the scene.
    pub input: SimulationInput,
    /// The compliance of each structure.
    pub compliances: Vec<RailCompliance>,
    /// Bodies, in the scene's order.
    pub bodies: Vec<BodyPlan>,
    /// Frames of rails in ground: one per rail, or more where the trucks of two bodies require different positions of
    /// the rail.
    pub datums: Vec<Datum>,
    /// Wheels, in the simulator's order.
    pub wheels: Vec<WheelPlan>,
    /// Contacts, in the simulator's order.
    pub contacts: Vec<ContactPlan>,
    /// The state at time 0.
    pub start: Start,
    /// Next free marker.
    pub markers: NextId,
    /// Next free SPLINE.
    pub splines: NextId,
}

/// The statements of a body.
pub struct BodyPlan {
    /// PART.
    pub part: u32,
    /// Height and lateral coordinate of its origin in ground at which its wheels touch their rails without load.
    pub position: [f64; 2],
    /// MARKER at its origin.
    pub origin: u32,
    /// MARKER at its centre of mass.
    pub cm: u32,
    /// MARKER in ground at rail coordinate 0, from which its y, z and rotations are measured.
    pub track: u32,
}

/// The frame of a rail.
pub struct Datum {
    /// MARKER in ground.
    pub marker: u32,
    /// The scene's rail.
    pub rail: usize,
    /// Height and lateral coordinate in ground.
    pub at: [f64; 2],
}

/// The statements of a wheel.
pub struct WheelPlan {
    /// `<truck>.wheel<n>`.
    pub name: String,
    /// Its body.
    pub body: usize,
    /// Its contact.
    pub contact: usize,
    /// Index of its kind.
    pub kind: usize,
    /// Its structure.
    pub structure: usize,
    /// Its rail within the structure.
    pub rail: usize,
    /// Index of the frame of its rail in the datums.
    pub datum: usize,
    /// Vector from the body's origin to its centre.
    pub hub: [f64; 3],
    /// MARKER on the body at its centre.
    pub marker: u32,
    /// Its own PART and the MARKER at the centre of this PART, if its spin is a degree of freedom.
    pub spin: Option<(u32, u32)>,
    /// MARKER on the body at the tread below its centre, if the body can roll and the wheel has a flange.
    pub tread: Option<u32>,
    /// FLOATING MARKER on ground.
    pub float: u32,
}

impl WheelPlan {
    /// The marker on which the contact force acts.
    #[must_use]
    pub fn centre(&self) -> u32 {
        self.spin.map_or(self.marker, |(_, marker)| marker)
    }
}

/// The statements of a contact of one wheel, or of several wheels on equalisers, whose forces are equal.
pub struct ContactPlan {
    /// Its wheels.
    pub wheels: Range<usize>,
    /// DIFF of its penetration, if a damper acts between a wheel and a flexible rail.
    pub diff: Option<u32>,
}

impl DeckPlan<'_> {
    /// Rail and axis of the forces of wheel `w` along `axis`.
    #[must_use]
    pub fn direction(&self, w: usize, axis: Axis) -> RailAxis {
        (self.wheels[w].rail, axis)
    }

    /// The properties of wheel `w` in the simulator.
    #[must_use]
    pub fn kind(&self, w: usize) -> &sim::Wheel {
        &self.input.scene.wheels[self.wheels[w].kind]
    }

    /// MARKER of the frame of the rail of wheel `w`.
    #[must_use]
    pub fn datum(&self, w: usize) -> u32 {
        self.datums[self.wheels[w].datum].marker
    }

    /// Foundations of the simulator that interpolate the tables of the deck by the same method as the deck.
    ///
    /// # Errors
    /// [`Error::Tables`] for tables that cannot be interpolated.
    pub fn foundations(&self) -> Result<Vec<Foundation>, Error> {
        self.compliances
            .iter()
            .map(|one| one.foundation(true))
            .collect()
    }

    /// The same with the forces along the rails that the deck has: none where it reads families.
    ///
    /// # Errors
    /// [`Error::Tables`] for tables that cannot be interpolated.
    pub fn foundations_in_statics(&self) -> Result<Vec<Foundation>, Error> {
        let slopes = self.form == DeckForm::Factored;
        self.compliances
            .iter()
            .map(|one| one.foundation(slopes))
            .collect()
    }
}

/// The plan of the deck of `scene` in the given `form`; `known` has the solutions of its specs, and `file` names the
/// scene in errors.
///
/// The function refuses items that decks do not support, lists the tables of every structure, computes the state at
/// time 0 with these tables, and numbers bodies, frames of rails, contacts and wheels.
///
/// # Errors
/// [`Error::Refused`] for a scene with unsupported items or unsuitable tables; [`Error::Start`] for a scene that
/// cannot start.
pub fn plan<'a>(
    scene: &'a Scene,
    known: &[SolvedStructure],
    form: DeckForm,
    file: &str,
) -> Result<DeckPlan<'a>, Error> {
    refuse_unsupported(scene, file)?;
    let input = simulation_input(scene)?;
    let mut splines = NextId::from(6);
    let compliances = compliances(scene, &input, known, form, file, &mut splines)?;
    let mut foundations = Vec::new();
    for compliance in &compliances {
        foundations.push(compliance.foundation(form == DeckForm::Factored)?);
    }
    let start = Start::of(&input.scene, &foundations)?;
    let mut markers = NextId::from(1);
    let mut bodies: Vec<BodyPlan> = (0..scene.bodies.len())
        .map(|b| BodyPlan {
            part: number(b) + GROUND,
            position: [0.0; 2],
            origin: markers.take(),
            cm: markers.take(),
            track: markers.take(),
        })
        .collect();
    let (datums, of_truck) = datums(scene, &mut bodies, &mut markers);
    let contacts: Vec<ContactPlan> = contacts(&input, &compliances);
    let wheels = wheels(scene, &input, &contacts, &of_truck, &mut markers);
    Ok(DeckPlan {
        scene,
        form,
        input,
        compliances,
        bodies,
        datums,
        wheels,
        contacts,
        start,
        markers,
        splines,
    })
}

/// The wheels of all contacts; `of_truck` has the index of the rail frame of each truck.
fn wheels(
    scene: &Scene,
    input: &SimulationInput,
    contacts: &[ContactPlan],
    of_truck: &[usize],
    markers: &mut NextId,
) -> Vec<WheelPlan> {
    let mut parts = NextId::from(number(scene.bodies.len()) + GROUND);
    let mut wheels = Vec::new();
    let mut trucks = scene
        .trucks
        .iter()
        .zip(of_truck)
        .flat_map(|(truck, &datum)| {
            let count: usize = truck.tree.iter().map(|node| node.wheels().len()).sum();
            std::iter::repeat_n(datum, count)
        });
    for (c, contact) in contacts.iter().enumerate() {
        let given = &input.scene.contacts[c];
        for (w, offset) in contact.wheels.clone().zip(&given.offsets) {
            let kind = &input.scene.wheels[given.wheel];
            let [x, y, z] = given.at;
            let rolls = input.scene.bodies[given.body].free[3];
            wheels.push(WheelPlan {
                name: input.wheels[w].name.clone(),
                body: given.body,
                contact: c,
                kind: given.wheel,
                structure: given.structure,
                rail: given.rail,
                datum: trucks.next().unwrap_or_default(),
                hub: [x + offset, y, z],
                marker: markers.take(),
                spin: input.wheels[w]
                    .spins
                    .then(|| (parts.take(), markers.take())),
                tread: (rolls && kind.flange.is_some()).then(|| markers.take()),
                float: markers.take(),
            });
        }
    }
    wheels
}

/// Refuses a scene by the first item that decks do not support.
fn refuse_unsupported(scene: &Scene, file: &str) -> Result<(), Error> {
    match unsupported(scene).0.into_iter().next() {
        Some(fault) => Err(refusal(
            file,
            fault.expected,
            fault.hint.as_deref().unwrap_or_default(),
        )),
        None => Ok(()),
    }
}

/// The refusal of the scene `file`.
fn refusal(file: &str, why: String, hint: &str) -> Error {
    Error::from(Diagnostic::of_file(file, why).hint(hint))
}

/// The compliance of each structure; refuses foundations that decks do not support.
fn compliances(
    scene: &Scene,
    input: &SimulationInput,
    known: &[SolvedStructure],
    form: DeckForm,
    file: &str,
    splines: &mut NextId,
) -> Result<Vec<RailCompliance>, Error> {
    let mut out = Vec::new();
    let mut factors = 0;
    for (s, structure) in scene.structures.iter().enumerate() {
        let refuse = |why: String, hint: &str| {
            refusal(
                file,
                format!("structure \"{}\": {why}", structure.name),
                hint,
            )
        };
        let mut directions: Vec<RailAxis> = Vec::new();
        for contact in input
            .scene
            .contacts
            .iter()
            .filter(|contact| contact.structure == s)
        {
            directions.push((contact.rail, Axis::Vertical));
            if input.scene.wheels[contact.wheel].flange.is_some() {
                directions.push((contact.rail, Axis::Lateral));
            }
        }
        match structure.foundation {
            scene::Foundation::Influence if !directions.is_empty() => {
                let blocks = foundations::influence_blocks(
                    structure,
                    solution_of(known, &structure.origin),
                )?;
                let compliance = RailCompliance::new(
                    structure,
                    directions,
                    &blocks,
                    form,
                    splines,
                    &mut factors,
                )
                .map_err(|why| {
                    refuse(
                        why,
                        "a deck needs tables of at least four stations in every direction of its wheels",
                    )
                })?;
                out.push(compliance);
            }
            // the others have been refused
            _ => out.push(RailCompliance::rigid(structure, form)),
        }
    }
    Ok(out)
}

/// Determines the positions of rails and bodies in ground. The first truck of a body whose rail already has a frame
/// fixes the position of the body. A rail that another body requires at a different position has an additional frame.
/// Returns the frames and the index of the frame of each truck.
fn datums(
    scene: &Scene,
    bodies: &mut [BodyPlan],
    markers: &mut NextId,
) -> (Vec<Datum>, Vec<usize>) {
    let mut datums: Vec<Datum> = Vec::new();
    let mut of_truck = vec![0; scene.trucks.len()];
    for (b, body) in bodies.iter_mut().enumerate() {
        let trucks = || {
            scene
                .trucks
                .iter()
                .enumerate()
                .filter(move |(_, truck)| truck.body == b)
        };
        let below =
            |truck: &scene::Truck| [truck.at[1] - scene.wheels[truck.wheel].radius, truck.at[2]];
        let fixed = trucks().find_map(|(_, truck)| {
            let datum = datums.iter().find(|datum| datum.rail == truck.rail)?;
            let [y, z] = below(truck);
            Some([datum.at[0] - y, datum.at[1] - z])
        });
        let free = || {
            trucks()
                .next()
                .map(|(_, truck)| below(truck).map(|value| 0.0 - value))
        };
        body.position = fixed.or_else(free).unwrap_or_default();
        for (t, truck) in trucks() {
            let [y, z] = below(truck);
            let at = [body.position[0] + y, body.position[1] + z];
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs());
            let same = |datum: &Datum| {
                datum.rail == truck.rail && near(datum.at[0], at[0]) && near(datum.at[1], at[1])
            };
            of_truck[t] = datums.iter().position(same).unwrap_or_else(|| {
                datums.push(Datum {
                    marker: markers.take(),
                    rail: truck.rail,
                    at,
                });
                datums.len() - 1
            });
        }
    }
    (datums, of_truck)
}

/// The contacts of the simulator; a contact whose damper acts on a flexible rail has a DIFF.
fn contacts(input: &SimulationInput, compliances: &[RailCompliance]) -> Vec<ContactPlan> {
    let mut first = 0;
    let mut out = Vec::new();
    for (c, contact) in input.scene.contacts.iter().enumerate() {
        let wheels = first..first + contact.offsets.len();
        first = wheels.end;
        let has_memory = input.scene.wheels[contact.wheel].normal.has_memory();
        let diff = (has_memory && compliances[contact.structure].is_flexible()).then(|| number(c));
        out.push(ContactPlan { wheels, diff });
    }
    out
}
