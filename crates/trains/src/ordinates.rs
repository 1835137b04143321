//! Influence lines for reading: the response to a unit load as a function of its place along a rail.

use fea::{Effect, ForceComponent};

use crate::error::Error;
use crate::extremes::TrainPosition;
use crate::follow::SectionSide;
use crate::line::{LineCell, Lines, value_of_cubic};
use crate::structure::{GirderResponse, QUANTITIES, Structure};
use crate::train::{COMPONENTS, Train};

/// Only vertical loads.
const VERTICAL: [bool; COMPONENTS] = [false, true, false, false, false];
/// Differences of coordinates that count as rounding, relative to the length of a rail.
const ROUNDING: f64 = 1e-9;

/// The response to a unit load that presses on a rail, as a function of the rail coordinate of the load: piecewise
/// cubic, with jumps where the section of a shear force lies.
///
/// Its unit is that of the response per unit of force: length for moments, 1 for forces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InfluenceLine {
    /// Ends of each piece, and its cubic in the distance from the first one.
    pieces: Vec<([f64; 2], [f64; 4])>,
}

impl InfluenceLine {
    /// The response to a unit load at x. At a jump the side says where the load is: just before or just behind x; at x
    /// itself counts as just behind. 0 beyond the ends of the rail.
    #[must_use]
    pub fn value(&self, x: f64, side: SectionSide) -> f64 {
        let Some([from, to]) = self.range() else {
            return 0.0;
        };
        let near = ROUNDING * (to - from);
        if x < from - near || x > to + near {
            return 0.0;
        }
        let is_before = |piece: &&([f64; 2], [f64; 4])| match side {
            SectionSide::Before => piece.0[0] < x - near,
            SectionSide::At | SectionSide::Behind => piece.0[0] <= x + near,
        };
        let count = self.pieces.iter().take_while(is_before).count();
        let (ends, cubic) = &self.pieces[count.saturating_sub(1)];
        value_of_cubic(cubic, x.clamp(ends[0], ends[1]) - ends[0])
    }

    /// First and last coordinate; `None` for a rail without length.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        Some([self.pieces.first()?.0[0], self.pieces.last()?.0[1]])
    }

    /// Coordinates and values by increasing coordinate, no farther apart than `step`; two with the same coordinate where
    /// the line jumps.
    #[must_use]
    pub fn points(&self, step: f64) -> Vec<[f64; 2]> {
        let size = self
            .pieces
            .iter()
            .map(|(_, cubic)| cubic[0].abs())
            .fold(0.0, f64::max);
        let mut out: Vec<[f64; 2]> = Vec::new();
        for ([from, to], cubic) in &self.pieces {
            let parts = ((to - from) / step).ceil().clamp(1.0, 1e4) as usize;
            for k in 0..=parts {
                let t = (to - from) * k as f64 / parts as f64;
                let value = value_of_cubic(cubic, t);
                let point = [if k == parts { *to } else { from + t }, value];
                let is_repeated =
                    |last: &[f64; 2]| k == 0 && (last[1] - value).abs() <= ROUNDING * size;
                if !out.last().is_some_and(is_repeated) {
                    out.push(point);
                }
            }
        }
        out
    }

    /// Largest magnitude at the ends of the pieces and at a few places within each.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.points(f64::INFINITY)
            .iter()
            .map(|point| point[1].abs())
            .fold(0.0, f64::max)
    }

    fn of(cells: &[LineCell<1>]) -> InfluenceLine {
        let own = cells
            .iter()
            .map(|cell| (cell.x, cell.cubics[1][0].map(|c| -c)));
        InfluenceLine {
            pieces: own.collect(),
        }
    }
}

impl Structure {
    /// The influence lines of a quantity of the girder at a coordinate of a rail, one for loads on each rail. At the end
    /// of a member the section is on the side given; elsewhere both sides have the same lines.
    ///
    /// # Errors
    /// A section at which no member carries the rail, and the errors of the structural solver.
    ///
    /// # Example
    /// ```
    /// use fea::Girder;
    /// use trains::{GirderResponse, SectionSide, Structure};
    ///
    /// // The moment at a third of a simple beam of 9 m, under a load there: a b/L = 3 * 6/9.
    /// let girder = Girder { spans: vec![9.0], e: 2.1e8, i_vertical: 5e-4, ..Girder::default() };
    /// let (model, rail) = girder.model_and_rail()?;
    /// let structure = Structure::new(&model, &[rail], false)?;
    /// let lines = structure.girder_lines(0, 3.0, SectionSide::At, GirderResponse::VerticalMoment)?;
    /// assert!((lines[0].value(3.0, SectionSide::At) - 2.0).abs() < 1e-12);
    /// # Ok::<(), trains::Error>(())
    /// ```
    pub fn girder_lines(
        &self,
        rail: usize,
        x: f64,
        side: SectionSide,
        quantity: GirderResponse,
    ) -> Result<Vec<InfluenceLine>, Error> {
        let index = quantity as usize;
        if index >= QUANTITIES {
            let lines = self.deflection_line(rail, x, quantity, VERTICAL)?;
            return Ok(lines
                .rails
                .iter()
                .map(|cells| InfluenceLine::of(cells))
                .collect());
        }
        let [from, to] = self.range(rail);
        let near = ROUNDING * (to - from);
        let is_on = |ends: [f64; 2]| x >= ends[0] - near && x <= ends[1] + near;
        // Where two members meet, the later one begins and the earlier one ends.
        let mut on = self
            .carriers
            .iter()
            .filter(|carrier| carrier.rail == rail && is_on(carrier.x));
        let found = match side {
            SectionSide::Behind => on.max_by(|a, b| a.x[0].total_cmp(&b.x[0])),
            SectionSide::Before => on.min_by(|a, b| a.x[0].total_cmp(&b.x[0])),
            SectionSide::At => on.next(),
        };
        let carrier = found.ok_or(splines::Error::OffRail { rail, x })?;
        let place = carrier.fraction(carrier.place(x));
        let parts = ForceComponent::ALL.map(|component| {
            let effect = Effect::InternalForce {
                member: carrier.member,
                place,
                component,
            };
            self.effect_line(&[effect], VERTICAL)
        });
        let mut lines: Vec<Lines<1>> = Vec::with_capacity(QUANTITIES);
        for part in parts {
            lines.push(part?);
        }
        let mut out = lines[0].rails.clone();
        for (rail, cells) in out.iter_mut().enumerate() {
            for (c, cell) in cells.iter_mut().enumerate() {
                for p in 0..4 {
                    let own = std::array::from_fn(|k| lines[k].rails[rail][c].cubics[1][0][p]);
                    cell.cubics[1][0][p] = carrier.quantities(own)[index];
                }
            }
        }
        Ok(out.iter().map(|cells| InfluenceLine::of(cells)).collect())
    }

    /// The influence lines of a sum of effects, such as a reaction, one for loads on each rail.
    ///
    /// # Errors
    /// An effect that does not exist, and the errors of the structural solver.
    pub fn effect_lines(&self, effects: &[Effect]) -> Result<Vec<InfluenceLine>, Error> {
        let lines = self.effect_line(effects, VERTICAL)?;
        Ok(lines
            .rails
            .iter()
            .map(|cells| InfluenceLine::of(cells))
            .collect())
    }

    /// Rail and coordinate of each wheel of a train at a position; also beyond the end of a rail.
    #[must_use]
    pub fn wheel_coordinates(&self, train: &Train, at: &TrainPosition) -> Vec<(usize, f64)> {
        let Some(first) = train.wheels.first() else {
            return Vec::new();
        };
        let wheels = train.placed(at.stance, &self.shifts(first.rail));
        wheels
            .iter()
            .map(|wheel| (wheel.rail, at.position + wheel.offset))
            .collect()
    }
}
