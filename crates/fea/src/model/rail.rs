//! Rails as given: a straight coordinate over the members that carry it.

use crate::error::{EntryAttribute, EntryFault, Error, ModelEntry, finite};

/// A stretch of rail on one member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailSegment {
    /// Index of the member.
    pub member: usize,
    /// Global vector from the member's axis to the rail, length. The rail is rigidly attached to the axis.
    pub offset: [f64; 3],
}

/// A rail: a straight coordinate over the members that carry it.
///
/// The coordinate x of a place is its distance from `origin` along `axis`. A segment covers the projection
/// of its member's flexible part onto the axis. In a gap between two segments the rail moves rigidly with
/// the nearer member end. Where two segments meet, the one listed first carries the place.
///
/// # Example
/// ```
/// use fea::{Rail, RailSegment};
///
/// // A rail along x, 0.4 m above members 0 and 1.
/// let offset = [0.0, 0.4, 0.0];
/// let segments = vec![RailSegment { member: 0, offset }, RailSegment { member: 1, offset }];
/// let rail = Rail { axis: [1.0, 0.0, 0.0], segments, ..Rail::default() };
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rail {
    /// Place where the coordinate is zero, global.
    pub origin: [f64; 3],
    /// Direction of increasing coordinate, global, any length.
    pub axis: [f64; 3],
    /// Members that carry the rail, in any order.
    pub segments: Vec<RailSegment>,
    /// Coordinates of output, increasing. They do not influence the solution.
    pub stations: Vec<f64>,
}

impl Rail {
    /// Checks that the axes are finite and that there is a segment; `rail` is the index for the error.
    pub(crate) fn check(&self, rail: usize) -> Result<(), Error> {
        let invalid = |fault| Error::Invalid {
            entry: ModelEntry::Rail(rail),
            fault,
        };
        finite(EntryAttribute::Coordinate, &self.origin).map_err(invalid)?;
        finite(EntryAttribute::Coordinate, &self.axis).map_err(invalid)?;
        if self.segments.is_empty() {
            return Err(invalid(EntryFault::Empty {
                quantity: EntryAttribute::Segments,
            }));
        }
        Ok(())
    }

    /// Checks that the stations are finite and increase; `rail` is the index for the error.
    pub(crate) fn check_stations(&self, rail: usize) -> Result<(), Error> {
        for (station, &value) in self.stations.iter().enumerate() {
            let invalid = |fault| Error::Invalid {
                entry: ModelEntry::Station { rail, station },
                fault,
            };
            finite(EntryAttribute::Station, &[value]).map_err(invalid)?;
            if station > 0 && value <= self.stations[station - 1] {
                return Err(invalid(EntryFault::Unsorted { value }));
            }
        }
        Ok(())
    }
}
