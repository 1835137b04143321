//! Animations: an SVG picture and the variation of its elements over time.

use serde_json::json;

use crate::chart::Svg;
use crate::coded;

/// Track of an element of the picture: the property that varies, with one value for each frame.
#[derive(Clone, Debug, PartialEq)]
pub enum AnimationTrack {
    /// Displacement (x, y) of the element, pixels.
    Displacement(Vec<[f64; 2]>),
    /// An attribute of the element with its values.
    Attribute(&'static str, Vec<f64>),
    /// Number of decimals and values of a number that the element shows.
    Number(usize, Vec<f64>),
    /// Points of a polyline: their fixed abscissas, and the ordinates of each over time, pixels.
    Curve(Vec<f64>, Vec<Vec<f64>>),
}

/// An animated picture. Without scripts it shows one of its frames.
///
/// ```
/// use report::chart::Svg;
/// use report::document::animated::{Animation, AnimationTrack};
///
/// let picture = Svg::new(100.0, 20.0, "<circle data-m=\"0\" cy=\"100\" r=\"50\"/>");
/// let places = vec![[0.0, 0.0], [80.0, 0.0]];
/// let tracks = vec![(0, AnimationTrack::Displacement(places))];
/// let animation = Animation { svg: picture, still_time: 0.0, times: vec![0.0, 1.0], tracks };
/// assert!(animation.data().is_some_and(|data| data.contains("transform")));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// The picture at one frame. Element `i` of the tracks has the attribute `data-m="i"`.
    pub svg: Svg,
    /// Time of the frame at which the picture is drawn, s.
    pub still_time: f64,
    /// Increasing times of the frames, s.
    pub times: Vec<f64>,
    /// Tracks with the numbers of their elements.
    pub tracks: Vec<(usize, AnimationTrack)>,
}

/// Power of ten to which displacements are rounded, pixels: a hundredth of a pixel is invisible.
const PIXEL: i32 = -2;
/// The same for the points of curves, whose neighbours move with them.
const CURVE_PIXEL: i32 = -1;
/// Power of ten to which times are rounded, s.
const INSTANT: i32 = -6;

impl Animation {
    /// Times and tracks as JSON; `None` if a number is not finite.
    #[must_use]
    pub fn data(&self) -> Option<String> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let mut tracks = Vec::new();
        for (element, track) in &self.tracks {
            let is_finite = match track {
                AnimationTrack::Displacement(places) => places.iter().all(|place| finite(place)),
                AnimationTrack::Attribute(_, values) | AnimationTrack::Number(_, values) => {
                    finite(values)
                }
                AnimationTrack::Curve(x, y) => finite(x) && y.iter().all(|values| finite(values)),
            };
            if !is_finite {
                return None;
            }
            tracks.push(match track {
                AnimationTrack::Displacement(places) => {
                    let [x, y] = [0, 1].map(|k| places.iter().map(|place| place[k]).collect::<Vec<f64>>());
                    json!({"e": element, "a": "transform", "x": coded(&x, PIXEL), "y": coded(&y, PIXEL)})
                }
                AnimationTrack::Attribute(name, values) => {
                    json!({"e": element, "a": name, "v": coded(values, PIXEL)})
                }
                AnimationTrack::Number(digits, values) => {
                    let power = i32::try_from(*digits).unwrap_or(0);
                    json!({"e": element, "a": "text", "d": digits, "v": coded(values, -power)})
                }
                AnimationTrack::Curve(x, y) => {
                    let y: Vec<_> = y.iter().map(|values| coded(values, CURVE_PIXEL)).collect();
                    json!({"e": element, "a": "points", "x": coded(x, CURVE_PIXEL), "y": y})
                }
            });
        }
        let data = json!({"time": coded(&self.times, INSTANT), "tracks": tracks});
        Some(data.to_string().replace('<', "\\u003c"))
    }
}
