//! Results: envelopes at chosen places, extremes over whole spans, reactions and named sections.

use fea::Effect;

use crate::follow::SectionSide;
use crate::structure::GirderResponse;
use crate::train::Orientation;

/// What is asked of a structure beside the envelopes along its rails.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    /// By rail: increasing coordinates between which its spans lie. What is before the first and behind the last are
    /// overhangs.
    pub spans: Vec<Vec<f64>>,
    /// By plane (vertical, lateral) and rail: increasing coordinates between which the chords of deflections lie. Where
    /// a plane is empty, its chords are those of `spans`.
    pub chords: [Vec<Vec<f64>>; 2],
    /// By rail: coordinates at which envelopes are wanted, beside those of the extremes.
    pub places: Vec<Vec<f64>>,
    /// Sums of effects elsewhere: reactions, and internal forces of named sections.
    pub effects: Vec<Vec<Effect>>,
}

impl Request {
    /// By rail: coordinates between which the chords of a plane lie, vertical (0) or lateral (1).
    pub(crate) fn chords(&self, plane: usize) -> &[Vec<f64>] {
        let own = &self.chords[plane];
        if own.is_empty() { &self.spans } else { own }
    }
}

/// Where a train stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainPosition {
    /// Coordinate of its first wheel.
    pub position: f64,
    /// Which way round it stands, and the signs of its horizontal forces.
    pub stance: Orientation,
}

/// An extreme value with the loads that cause it.
#[derive(Clone, Debug, PartialEq)]
pub struct Governing {
    /// The value, dead load included.
    pub value: f64,
    /// The part of it that is due to the dead load.
    pub dead: f64,
    /// Coordinate of the section along the rail; 0 for an effect elsewhere.
    pub x: f64,
    /// Side of the section at which the value is reached.
    pub side: SectionSide,
    /// Where the trains of the case stand.
    pub trains: Vec<TrainPosition>,
    /// Moment, shear and deflection of the same section in the same state and plane, dead load included; zeros for an
    /// effect elsewhere.
    pub coincident: [f64; 3],
}

/// The envelope of one quantity at one coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvelopeValue {
    /// Index of the rail.
    pub rail: usize,
    /// The quantity.
    pub quantity: GirderResponse,
    /// Whether it is the largest value; otherwise the smallest.
    pub is_max: bool,
    /// The value.
    pub governing: Governing,
}

/// The extreme of one quantity over a span.
#[derive(Clone, Debug, PartialEq)]
pub struct SpanExtreme {
    /// Index of the rail.
    pub rail: usize,
    /// Number of the span from 1; 0 and one more than the last for overhangs.
    pub span: usize,
    /// The quantity.
    pub quantity: GirderResponse,
    /// Whether it is the largest value; otherwise the smallest.
    pub is_max: bool,
    /// The value.
    pub governing: Governing,
    /// No value in the span is proved to exceed this (or, for a smallest value, to be below it); equal to the value where
    /// it follows from roots of polynomials.
    pub bound: f64,
}

/// Largest deflection of a span from the chord between its ends, under the trains alone.
#[derive(Clone, Debug, PartialEq)]
pub struct SpanDeflection {
    /// Index of the rail.
    pub rail: usize,
    /// Number of the span of its plane, from 1.
    pub span: usize,
    /// Coordinates of its ends.
    pub ends: [f64; 2],
    /// Vertical or lateral deflection.
    pub quantity: GirderResponse,
    /// The value of largest size, with the place and the position; `dead` is 0.
    pub governing: Governing,
}

/// The results of one case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseEnvelopes {
    /// Envelopes by rail and coordinate; where the two sides of a place differ, the more extreme one.
    pub envelopes: Vec<EnvelopeValue>,
    /// Of places at which two members meet: an index among the envelopes, and the value at the other side of that place.
    pub other_sides: Vec<(usize, Governing)>,
    /// Extremes by rail, span, quantity, largest first.
    pub extremes: Vec<SpanExtreme>,
    /// Deflections from chords.
    pub deflections: Vec<SpanDeflection>,
    /// Largest and smallest value of each effect of the request.
    pub effects: Vec<[Governing; 2]>,
}
