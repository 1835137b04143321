//! A picture, and what changes in it over time.

use serde_json::json;

use crate::coded;

/// What an element of the picture does, frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Track {
    /// Is moved by these pixels.
    Move(Vec<[f64; 2]>),
    /// Has these values of an attribute.
    Set(&'static str, Vec<f64>),
    /// Says these numbers with so many digits after the point.
    Say(usize, Vec<f64>),
}

/// A picture that moves; it is drawn as at one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The picture, a finished SVG file. Element `i` of the tracks has the attribute `data-m="i"`.
    pub svg: String,
    /// Time of the frame that it is drawn at.
    pub still: f64,
    /// Times of the frames.
    pub times: Vec<f64>,
    /// Element and track.
    pub tracks: Vec<(usize, Track)>,
}

/// Power of ten of a hundredth: a pixel has no finer parts.
const PIXEL: i32 = -2;
/// Power of ten of a millionth of a second.
const INSTANT: i32 = -6;

impl Film {
    /// Times and tracks as JSON; `None` where a number is not finite.
    #[must_use]
    pub fn data(&self) -> Option<String> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let mut tracks = Vec::new();
        for (element, track) in &self.tracks {
            let is_finite = match track {
                Track::Move(places) => places.iter().all(|place| finite(place)),
                Track::Set(_, values) | Track::Say(_, values) => finite(values),
            };
            if !is_finite {
                return None;
            }
            tracks.push(match track {
                Track::Move(places) => {
                    let [x, y] = [0, 1].map(|k| places.iter().map(|place| place[k]).collect::<Vec<f64>>());
                    json!({"e": element, "a": "transform", "x": coded(&x, PIXEL), "y": coded(&y, PIXEL)})
                }
                Track::Set(name, values) => json!({"e": element, "a": name, "v": coded(values, PIXEL)}),
                Track::Say(digits, values) => {
                    let power = i32::try_from(*digits).unwrap_or(0);
                    json!({"e": element, "a": "text", "d": digits, "v": coded(values, -power)})
                }
            });
        }
        let data = json!({"time": coded(&self.times, INSTANT), "tracks": tracks});
        Some(data.to_string().replace('<', "\\u003c"))
    }
}
