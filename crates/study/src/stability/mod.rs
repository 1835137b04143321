//! Maps of where methods fail: where the program solves or refuses a problem, and where other methods are silently
//! wrong.
//!
//! The methods that fail exist in this module only; no simulation uses them.

mod contact;
mod data;
mod elements;
mod excitation;
mod figure;
mod liftoff;
mod map;
mod penalty;
mod steppers;
mod steps;
mod subject;
mod ties;

pub use data::{csv, json};
pub use figure::figures;
pub use map::{MapFinding, MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
pub use subject::MapSubject;

use crate::observer::Observer;

/// Maps, and names and reasons of those that could not be made.
pub type Maps = (Vec<StabilityMap>, Vec<(String, String)>);

/// All maps for `subject`; `quick` maps have a third of the points along each axis and leave out the rail on ties.
#[must_use]
pub fn maps(subject: &MapSubject<'_>, quick: bool, observer: &dyn Observer) -> Maps {
    let points = |full: usize| if quick { full / 3 } else { full };
    let (mut maps, mut absent) = (Vec::new(), Vec::new());
    observer.message("mapping contact");
    maps.push(contact::map(subject, points(36)));
    observer.message("mapping self-excitation");
    match excitation::map(subject, points(36)) {
        Ok(map) => maps.push(map),
        Err(why) => absent.push(("excitation".to_owned(), why)),
    }
    observer.message("mapping elements");
    maps.extend(elements::maps(subject, if quick { 11 } else { 15 }));
    maps.push(penalty::map(subject, points(48)));
    observer.message("mapping lift-off");
    maps.push(liftoff::map(subject, points(48)));
    observer.message("mapping steps");
    maps.extend(steps::maps(subject, points(30)));
    observer.message("mapping ties");
    match if quick {
        Err("left out by --quick".to_owned())
    } else {
        ties::map(points(27))
    } {
        Ok(map) => maps.push(map),
        Err(why) => absent.push(("ties".to_owned(), why)),
    }
    (maps, absent)
}
