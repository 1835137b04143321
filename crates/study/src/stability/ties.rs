//! Speed against the critical speed of a rail on ties.

use std::ops::ControlFlow;

use fea::Section;
use sim::{Channel, Damper, Foundation, NormalLaw};

use super::map::{Layer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::subject::crossing;
use formats::track::{Ties, on_ground};
use formats::units::{Force, Length, Units};
use foundations::{full_mesh, solve};
use report::chart::{Series, Style};

/// Error of the deflection that is none, and one that nobody overlooks.
const ALLOWED: f64 = 1e-2;
const OBVIOUS: f64 = 10.0;
/// Length of the rail by that of its bending, (4 E I / u)^(1/4).
const LENGTH: f64 = 100.0;
/// Highest speed by the critical one: beyond it, waves are too slow to leave a wheel on a rail of this length.
const FASTEST: f64 = 0.7;
/// Stiffness of the wheel by that of the rail: its force is as good as constant.
const SOFT: f64 = 1e-4;
/// Where the wheel starts, and from where on it is looked at, as shares of the rail.
const START: f64 = 0.2;
const LOOK: f64 = 0.6;
const STOP: f64 = 0.7;

/// A rail of 136 lb/yd on ties of 3,000 lb/in a 24 in of track, with and without its mass; inches, pounds, seconds.
struct Track {
    /// Its length, deflection at rest by force, critical speed.
    length: f64,
    give: f64,
    critical: f64,
    moving: Foundation,
    still: Foundation,
}

impl Track {
    fn new() -> Result<Track, String> {
        let rail = Section { e: 30e6, iz: 94.9, mass: 9.785e-3, ..Section::default() };
        let ties = Ties { spacing: 24.0, k: 72e3, mass: 0.5, rail, elements: 1, ..Ties::default() };
        let (bending, bed) = (rail.e * rail.iz, ties.k / ties.spacing);
        let mass = rail.mass + ties.mass / ties.spacing;
        let beta = (bed / (4.0 * bending)).powf(0.25);
        let length = (LENGTH / beta / ties.spacing).round() * ties.spacing;
        let units = Units { length: Length::Inch, force: Force::Pound };
        let spec = on_ground("track", units, &ties, [0.0, length]).map_err(|error| error.to_string())?;
        let solved = solve(&spec).map_err(|error| error.to_string())?;
        let moving = full_mesh(&solved, 1).map_err(|failure| failure.to_string())?;
        let surface = solved.surface.ok_or("the surface of the track is not known")?;
        Ok(Track {
            length,
            give: 1.0 / (8.0 * bending * beta * beta * beta),
            critical: (4.0 * bed * bending / (mass * mass)).powf(0.25),
            moving,
            still: Foundation::influence(Box::new(surface), 1),
        })
    }

    /// Mean deflection under the wheel by that at rest on a Winkler bed.
    fn amplified(&self, share: f64, foundation: &Foundation) -> Result<f64, String> {
        let speed = share * self.critical;
        let stiffness = SOFT / self.give;
        let [x0, end] = [START * self.length, (STOP - START) * self.length / speed];
        let (weight, gravity) = (1e4, 386.0886);
        let law = NormalLaw { bilateral: true, ..NormalLaw::linear(stiffness, 0.0, Damper::Rail) };
        let scene = crossing(gravity, weight / gravity, &[0.0], law, [x0, speed, end]);
        let mut scene = scene.map_err(|error| error.to_string())?;
        (scene.output_dt, scene.accuracy) = (end / 500.0, 1e-4);
        let run = sim::run(&scene, std::slice::from_ref(foundation), &mut |_| ControlFlow::Continue(()));
        let run = run.map_err(|error| error.to_string())?;
        if !run.status.is_complete() {
            return Err(results::run_error::status(&run.status).1.unwrap_or_default());
        }
        let (gives, forces) =
            (run.history.column(Channel::Give(0)), run.history.column(Channel::Vertical(0)));
        let from = ((LOOK - START) / (STOP - START) * gives.len() as f64) as usize;
        let shares: Vec<f64> =
            gives.iter().zip(&forces).skip(from).map(|(give, force)| give / (force * self.give)).collect();
        Ok(shares.iter().sum::<f64>() / shares.len().max(1) as f64)
    }
}

/// The map.
///
/// # Errors
/// A track that cannot be solved.
pub fn map(points: usize) -> Result<StabilityMap, String> {
    let track = Track::new()?;
    let axes = [
        MapScale::new("speed / critical speed", "", false),
        MapScale::new("deflection under the wheel / that at rest", "", true),
    ];
    let mut map = StabilityMap::new(
        "ties",
        "A constant force on a rail on ties",
        axes,
        "Mean over a tenth of a rail of 184 ties, 136 lb/yd on 3,000 psi; the line is 1 / sqrt(1 - (v / v_cr)^2) of a rail on a bed. Wrong from 1e-2 on.",
    );
    map.find("critical speed, in/s", track.critical);
    let mut layers = [("rail without mass", false), ("girderway, ties with mass", true)]
        .map(|(method, ours)| Layer::new(method, ours));
    let mut line = Vec::new();
    for i in 0..points {
        let share = 0.05 + (FASTEST - 0.05) * i as f64 / (points - 1).max(1) as f64;
        let wanted = 1.0 / (1.0 - share * share).sqrt();
        line.push([share, wanted]);
        for (layer, foundation) in layers.iter_mut().zip([&track.still, &track.moving]) {
            let (at, value, verdict) = match track.amplified(share, foundation) {
                Ok(found) => {
                    let error = (found / wanted - 1.0).abs();
                    (found, error, MapVerdict::of(error, ALLOWED, OBVIOUS))
                }
                Err(why) => (wanted, 0.0, MapVerdict::Refused(why)),
            };
            if layer.is_ours {
                map.find(format!("deflection at {share:.3} of it"), at);
            }
            layer.cells.push(MapPoint { at: [share, at], value, verdict });
        }
    }
    let line = Series::new("rail on a bed", Style::Line, line);
    layers.iter_mut().for_each(|layer| layer.lines.push(line.clone()));
    map.layers.extend(layers);
    Ok(map)
}
