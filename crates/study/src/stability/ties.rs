//! Deflection under a moving constant force on a rail on ties, against speed.
//!
//! A beam on a Winkler bed of the stiffness u per length has the critical speed v_cr = (4 u E I / m^2)^(1/4). A
//! constant force at the speed v deflects it by 1 / sqrt(1 - (v / v_cr)^2) times the static deflection. A rail
//! without mass has the static deflection at any speed, which is silently wrong; a rail on ties with mass agrees with
//! the formula.

use std::ops::ControlFlow;

use fea::CrossSection;
use sim::{Channel, Damper, Foundation, NormalLaw};

use super::map::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::subject::crossing;
use formats::spec::ties::{Ties, on_ground};
use formats::units::{Force, Length, Units};
use foundations::{full_mesh_foundation, solve};
use report::chart::{Series, Style};

/// Largest relative error of the deflection that counts as right.
const ALLOWED: f64 = 1e-2;
/// Smallest relative error that a user certainly notices.
const OBVIOUS: f64 = 10.0;
/// Length of the rail relative to its characteristic length (4 E I / u)^(1/4).
const LENGTH: f64 = 100.0;
/// Highest speed relative to the critical one. At higher speeds, the motion is not steady within a rail of this
/// length.
const FASTEST: f64 = 0.7;
/// Stiffness of the wheel relative to that of the rail: so low that the force of the wheel is practically constant.
const SOFT: f64 = 1e-4;
/// Fraction of the rail at which the wheel starts.
const START: f64 = 0.2;
/// Fraction of the rail from which the deflection is evaluated.
const EVALUATED: f64 = 0.6;
/// Fraction of the rail at which the run ends.
const STOP: f64 = 0.7;

/// A rail of 136 lb/yd on ties at 24 in with a track modulus of 3,000 psi, with and without its mass; inches, pounds,
/// seconds.
struct Track {
    length: f64,
    /// Static deflection on a Winkler bed per unit force.
    static_flexibility: f64,
    critical_speed: f64,
    with_mass: Foundation,
    massless: Foundation,
}

impl Track {
    fn new() -> Result<Track, String> {
        let rail = CrossSection {
            e: 30e6,
            iz: 94.9,
            mass: 9.785e-3,
            ..CrossSection::default()
        };
        let ties = Ties {
            spacing: 24.0,
            k: 72e3,
            mass: 0.5,
            rail,
            elements: 1,
            ..Ties::default()
        };
        let (bending, bed) = (rail.e * rail.iz, ties.k / ties.spacing);
        let mass = rail.mass + ties.mass / ties.spacing;
        let beta = (bed / (4.0 * bending)).powf(0.25);
        let length = (LENGTH / beta / ties.spacing).round() * ties.spacing;
        let units = Units {
            length: Length::Inch,
            force: Force::Pound,
        };
        let spec =
            on_ground("track", units, &ties, [0.0, length]).map_err(|error| error.to_string())?;
        let solved = solve(&spec).map_err(|error| error.to_string())?;
        let with_mass = full_mesh_foundation(&solved, 1).map_err(|failure| failure.to_string())?;
        let surface = solved
            .surface
            .ok_or("the surface of the track is not known")?;
        Ok(Track {
            length,
            static_flexibility: 1.0 / (8.0 * bending * beta * beta * beta),
            critical_speed: (4.0 * bed * bending / (mass * mass)).powf(0.25),
            with_mass,
            massless: Foundation::massless(Box::new(surface), 1),
        })
    }

    /// Mean deflection under the wheel at a `fraction` of the critical speed, relative to the static one on a Winkler
    /// bed.
    fn amplification(&self, fraction: f64, foundation: &Foundation) -> Result<f64, String> {
        let speed = fraction * self.critical_speed;
        let stiffness = SOFT / self.static_flexibility;
        let [x0, end] = [START * self.length, (STOP - START) * self.length / speed];
        let (weight, gravity) = (1e4, 386.0886);
        let law = NormalLaw {
            bilateral: true,
            ..NormalLaw::linear(stiffness, 0.0, Damper::Rail)
        };
        let scene = crossing(gravity, weight / gravity, &[0.0], law, [x0, speed, end]);
        let mut scene = scene.map_err(|error| error.to_string())?;
        (scene.output_dt, scene.accuracy) = (end / 500.0, 1e-4);
        let run = sim::run(&scene, std::slice::from_ref(foundation), &mut |_| {
            ControlFlow::Continue(())
        });
        let run = run.map_err(|error| error.to_string())?;
        if !run.status.is_complete() {
            return Err(results::run_error::status(&run.status)
                .1
                .unwrap_or_default());
        }
        let (deflections, forces) = (
            run.history.column(Channel::Deflection(0)),
            run.history.column(Channel::Vertical(0)),
        );
        let from = ((EVALUATED - START) / (STOP - START) * deflections.len() as f64) as usize;
        let pairs = deflections.iter().zip(&forces).skip(from);
        let ratios: Vec<f64> = pairs
            .map(|(deflection, force)| deflection / (force * self.static_flexibility))
            .collect();
        Ok(ratios.iter().sum::<f64>() / ratios.len().max(1) as f64)
    }
}

/// The map of the deflection against speed.
///
/// # Errors
/// A track that cannot be solved.
pub fn map(points: usize) -> Result<StabilityMap, String> {
    let track = Track::new()?;
    let axes = [
        MapScale::new("speed / critical speed", "", false),
        MapScale::new("deflection under the wheel / static deflection", "", true),
    ];
    let mut map = StabilityMap::new(
        "ties",
        "A constant force on a rail on ties",
        axes,
        "Mean over a tenth of a rail of 184 ties, 136 lb/yd on 3,000 psi. The line is 1 / sqrt(1 - (v / v_cr)^2), \
         the solution for a Winkler bed. Wrong if the error exceeds 1e-2.",
    );
    map.note("critical speed, in/s", track.critical_speed);
    let mut layers = [
        ("rail without mass", false),
        ("girderway, ties with mass", true),
    ]
    .map(|(method, ours)| MapLayer::new(method, ours));
    let mut line = Vec::new();
    for i in 0..points {
        let fraction = 0.05 + (FASTEST - 0.05) * i as f64 / (points - 1).max(1) as f64;
        let expected = 1.0 / (1.0 - fraction * fraction).sqrt();
        line.push([fraction, expected]);
        for (layer, foundation) in layers.iter_mut().zip([&track.massless, &track.with_mass]) {
            let (at, value, verdict) = match track.amplification(fraction, foundation) {
                Ok(value) => {
                    let error = (value / expected - 1.0).abs();
                    (value, error, MapVerdict::of(error, ALLOWED, OBVIOUS))
                }
                Err(why) => (expected, 0.0, MapVerdict::Refused(why)),
            };
            if layer.is_ours {
                map.note(
                    format!("deflection at {fraction:.3} of the critical speed"),
                    at,
                );
            }
            layer.points.push(MapPoint {
                at: [fraction, at],
                value,
                verdict,
            });
        }
    }
    let line = Series::new("rail on a Winkler bed", Style::Line, line);
    layers
        .iter_mut()
        .for_each(|layer| layer.lines.push(line.clone()));
    map.layers.extend(layers);
    Ok(map)
}
