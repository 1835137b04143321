//! A picture, and what changes in it over time.

use serde_json::json;

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

/// To a hundredth: a pixel has no finer parts.
fn round(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

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
                    let values: Vec<[f64; 2]> = places.iter().map(|place| place.map(round)).collect();
                    json!({"e": element, "a": "transform", "v": values})
                }
                Track::Set(name, values) => {
                    let values: Vec<f64> = values.iter().copied().map(round).collect();
                    json!({"e": element, "a": name, "v": values})
                }
                Track::Say(digits, values) => {
                    let power = 10.0_f64.powi(i32::try_from(*digits).unwrap_or(0));
                    let values: Vec<f64> =
                        values.iter().map(|value| (value * power).round() / power + 0.0).collect();
                    json!({"e": element, "a": "text", "d": digits, "v": values})
                }
            });
        }
        let data = json!({"time": self.times, "tracks": tracks});
        Some(data.to_string().replace('<', "\\u003c"))
    }
}
