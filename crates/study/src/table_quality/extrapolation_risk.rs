//! Risks that follow from the stations of a table rather than from its values.

use std::fmt;

use splines::SplineTable;
use splines::quality::support_stations;

use super::digits::short;

/// Relative difference above which spacings are unequal.
const EVEN: f64 = 1e-6;
/// Smallest number of x values that all documents of AKISPL accept.
const PORTABLE: usize = 6;

/// Largest number of breaks that a message lists.
const LISTED: usize = 6;

/// A risk that a user of the table should know.
#[derive(Clone, Debug, PartialEq)]
pub enum ExtrapolationRisk {
    /// Few x values.
    Few {
        /// Their number.
        found: usize,
    },
    /// Stations at unequal distances.
    Uneven {
        /// Shortest and longest distance.
        spacing: [f64; 2],
    },
    /// Supports with stations on both sides.
    Inside {
        /// Where.
        at: Vec<f64>,
    },
    /// Stations along z that differ from those along x.
    Rectangle {
        /// Number of curves, and of values of each curve.
        shape: [usize; 2],
    },
    /// A rail that extends beyond the table.
    Short {
        /// First and last place of the rail.
        rail: [f64; 2],
    },
    /// Ends of rail elements (supports, hinges, changes of section) without a station.
    Breaks {
        /// Where.
        at: Vec<f64>,
    },
    /// No LINEAR_EXTRAPOLATE.
    NotLinear,
    /// A deflection against the direction of its own load.
    Negative {
        /// Where.
        at: f64,
        /// The entry.
        value: f64,
    },
    /// All values are zero.
    Zero,
}

impl ExtrapolationRisk {
    /// All risks of a table. `direct`: whether deflections and loads are of one path and direction, so that the
    /// diagonal must be positive; `linear`: whether the file asks for linear extrapolation; `breaks`: ends of the
    /// elements of the loaded rail, empty where they are unknown.
    #[must_use]
    pub fn of(
        table: &SplineTable,
        direct: bool,
        linear: Option<bool>,
        breaks: &[f64],
    ) -> Vec<ExtrapolationRisk> {
        let mut out = Vec::new();
        let (x, z) = (table.x(), table.z());
        if table.values().amax() == 0.0 {
            out.push(ExtrapolationRisk::Zero);
        }
        if z != x {
            out.push(ExtrapolationRisk::Rectangle {
                shape: [z.len(), x.len()],
            });
        }
        if x.len() < PORTABLE {
            out.push(ExtrapolationRisk::Few { found: x.len() });
        }
        let spacing = |f: fn(f64, f64) -> f64, start| {
            x.windows(2).fold(start, |a, pair| f(a, pair[1] - pair[0]))
        };
        let spacing = [spacing(f64::min, f64::INFINITY), spacing(f64::max, 0.0)];
        if spacing[1] > spacing[0] * (1.0 + EVEN) {
            out.push(ExtrapolationRisk::Uneven { spacing });
        }
        if direct {
            let inside = |at: &f64| *at > z[0] && *at < z[z.len() - 1];
            let at: Vec<f64> = support_stations(table).into_iter().filter(inside).collect();
            if !at.is_empty() && table.values().amax() > 0.0 {
                out.push(ExtrapolationRisk::Inside { at });
            }
            if z == x {
                let worst = (0..x.len())
                    .min_by(|&i, &j| table.values()[(i, i)].total_cmp(&table.values()[(j, j)]));
                let negative = worst
                    .map(|i| (x[i], table.values()[(i, i)]))
                    .filter(|(_, value)| *value < 0.0);
                out.extend(negative.map(|(at, value)| ExtrapolationRisk::Negative { at, value }));
            }
        }
        if linear == Some(false) {
            out.push(ExtrapolationRisk::NotLinear);
        }
        let slack = EVEN * (x[x.len() - 1] - x[0]);
        let (first, last) = (x[0], x[x.len() - 1]);
        if let (Some(&from), Some(&to)) = (breaks.first(), breaks.last())
            && (from < first - slack || to > last + slack)
        {
            out.push(ExtrapolationRisk::Short { rail: [from, to] });
        }
        let missing =
            |b: &&f64| **b > first && **b < last && x.iter().all(|x| (x - **b).abs() > slack);
        let at: Vec<f64> = breaks.iter().filter(missing).copied().collect();
        if !at.is_empty() {
            out.push(ExtrapolationRisk::Breaks { at });
        }
        out
    }

    /// The word of the risk in results.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            ExtrapolationRisk::Few { .. } => "few-stations",
            ExtrapolationRisk::Uneven { .. } => "uneven-stations",
            ExtrapolationRisk::Inside { .. } => "supports-inside",
            ExtrapolationRisk::Rectangle { .. } => "rectangle",
            ExtrapolationRisk::Short { .. } => "rail-goes-on",
            ExtrapolationRisk::Breaks { .. } => "breaks-without-station",
            ExtrapolationRisk::NotLinear => "not-linear",
            ExtrapolationRisk::Negative { .. } => "negative",
            ExtrapolationRisk::Zero => "zero",
        }
    }
}

impl fmt::Display for ExtrapolationRisk {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ExtrapolationRisk::Few { found } => write!(
                f,
                "{found} x values: four are the minimum, but some documents of AKISPL require {PORTABLE}"
            ),
            ExtrapolationRisk::Uneven { spacing: [low, high] } => write!(
                f,
                "stations at unequal distances, {} to {}: ADAMS guarantees derivatives of AKISPL for equal distances \
                 only",
                short(*low),
                short(*high)
            ),
            ExtrapolationRisk::Inside { at } => write!(
                f,
                "rigid supports inside the table, at {}: one curve covers spans and overhangs",
                list(at)
            ),
            ExtrapolationRisk::Rectangle { shape: [rows, columns] } => write!(
                f,
                "{rows} curves of {columns} values: deflections and loads have different stations, so that the table \
                 cannot be symmetric"
            ),
            ExtrapolationRisk::Short { rail: [from, to] } => {
                let [from, to] = [from, to].map(|x| short(*x));
                write!(f, "the rail runs from {from} to {to}: a wheel beyond the table is extrapolated")
            }
            ExtrapolationRisk::Breaks { at } => {
                let more = if at.len() > LISTED { ", ..." } else { "" };
                write!(
                    f,
                    "supports, hinges or changes of section without a station: {}, at {}{more}",
                    at.len(),
                    list(&at[..at.len().min(LISTED)])
                )
            }
            ExtrapolationRisk::NotLinear => f.write_str(
                "no LINEAR_EXTRAPOLATE: beyond its ends the table is extrapolated by a parabola or a cubic",
            ),
            ExtrapolationRisk::Negative { at, value } => write!(
                f,
                "{value:e} on the diagonal, at {at}: the deflection under a load is opposite to the load (check the \
                 signs of z and of the load)"
            ),
            ExtrapolationRisk::Zero => f.write_str("all values are zero"),
        }
    }
}

fn list(places: &[f64]) -> String {
    places
        .iter()
        .map(|x| short(*x))
        .collect::<Vec<_>>()
        .join(", ")
}
