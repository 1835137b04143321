//! Filled contours of values on a rectangular grid.

use smallvec::SmallVec;

/// The part of a cell at or above a level: at most all corners and two cuts, of a saddle four.
type CellPart = SmallVec<[[f64; 2]; 8]>;

/// Region of a grid where the values are at least a level, and the contour line of this level.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Region {
    /// Polygons that cover the region without overlap.
    pub polygons: Vec<Vec<[f64; 2]>>,
    /// Pieces of the contour line, one for each cell.
    pub chords: Vec<[[f64; 2]; 2]>,
    /// The pieces of every second cell, which draw the line dashed.
    pub dashes: Vec<[[f64; 2]; 2]>,
}

/// Region where the values, linear along the edges of the grid's cells, are at least `level`.
///
/// `x` are the coordinates of the columns, `y` those of the rows, both increasing, and `values[row][column]` the values
/// there. Each cell is clipped to the part at or above the level (marching squares). The parts in neighbouring cells of
/// a row are joined to one polygon; neighbours that are whole are one rectangle. A cell whose largest value equals the level
/// is omitted.
pub(super) fn region(x: &[f64], y: &[f64], values: &[Vec<f64>], level: f64) -> Region {
    let mut found = Region::default();
    for row in 1..y.len() {
        let mut strip = Strip::default();
        let [lower, upper] = [&values[row - 1], &values[row]];
        let corners_of = |column: usize| {
            [
                lower[column - 1],
                lower[column],
                upper[column],
                upper[column - 1],
            ]
        };
        let is_above = |column: usize| corners_of(column).iter().any(|value| *value > level);
        let is_whole = |column: usize| corners_of(column).iter().all(|value| *value >= level);
        let mut column = 1;
        while column < x.len() {
            if !is_above(column) {
                column += 1;
                continue;
            }
            let first = column;
            while is_whole(column)
                && column + 1 < x.len()
                && is_whole(column + 1)
                && is_above(column + 1)
            {
                column += 1;
            }
            if !strip.ends_at(x[first - 1]) {
                found.polygons.extend(std::mem::take(&mut strip).polygon());
            }
            let places = [
                [first - 1, row - 1],
                [column, row - 1],
                [column, row],
                [first - 1, row],
            ];
            let places = places.map(|[j, i]| [x[j], y[i]]);
            if is_whole(column) {
                strip.join(&places);
            } else {
                let values = corners_of(column);
                let from = found.chords.len();
                let corners = std::array::from_fn(|k| (places[k], values[k]));
                let part = clip(&corners, level, &mut found.chords);
                if (row + column).is_multiple_of(2) {
                    found.dashes.extend_from_slice(&found.chords[from..]);
                }
                strip.join(&part);
            }
            column += 1;
        }
        found.polygons.extend(strip.polygon());
    }
    found
}

/// Neighbouring parts of a row of cells as one polygon: its lower and its upper side, both from left to right.
#[derive(Default)]
struct Strip {
    sides: [Vec<[f64; 2]>; 2],
}

impl Strip {
    /// Whether the strip reaches the vertical edge at `x`.
    fn ends_at(&self, x: f64) -> bool {
        self.sides[0].last().is_some_and(|last| last[0] >= x)
    }

    /// Adds a convex polygon, counterclockwise, that shares its left edge with the strip.
    fn join(&mut self, part: &[[f64; 2]]) {
        let left = part
            .iter()
            .map(|point| point[0])
            .fold(f64::INFINITY, f64::min);
        let right = part
            .iter()
            .map(|point| point[0])
            .fold(f64::NEG_INFINITY, f64::max);
        let first = (0..part.len()).find(|&k| {
            let before = part[(k + part.len() - 1) % part.len()];
            part[k][0] == left && (before[0] > left || before[1] > part[k][1])
        });
        let around = |k: usize| part[(first.unwrap_or_default() + k) % part.len()];
        let turn = (0..part.len())
            .find(|&k| around(k)[0] == right)
            .unwrap_or_default();
        (0..=turn).for_each(|k| push(&mut self.sides[0], around(k)));
        let is_pointed = around(turn + 1)[0] < right;
        let start = if is_pointed { turn } else { turn + 1 };
        if around(part.len() - 1)[0] > left {
            // the left end is a single point, which belongs to both sides
            push(&mut self.sides[1], around(0));
        }
        (start..part.len())
            .rev()
            .for_each(|k| push(&mut self.sides[1], around(k)));
    }

    /// The polygon; `None` of an empty strip.
    fn polygon(self) -> Option<Vec<[f64; 2]>> {
        let [mut lower, upper] = self.sides;
        for point in upper.into_iter().rev() {
            if lower.last() != Some(&point) && lower.first() != Some(&point) {
                lower.push(point);
            }
        }
        (lower.len() > 2).then_some(lower)
    }
}

/// Adds a point to a side: neither twice, nor between two others on a horizontal line.
fn push(side: &mut Vec<[f64; 2]>, point: [f64; 2]) {
    let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
    match side[..] {
        [.., last] if is_near(last[0], point[0]) && is_near(last[1], point[1]) => {}
        [.., before, last] if before[1] == last[1] && last[1] == point[1] => {
            side.pop();
            side.push(point);
        }
        _ => side.push(point),
    }
}

/// The part of one cell at or above the level; its contour line is added to `chords`.
fn clip(corners: &[([f64; 2], f64); 4], level: f64, chords: &mut Vec<[[f64; 2]; 2]>) -> CellPart {
    let mut polygon = CellPart::new();
    let mut leaving = None;
    let mut entering = None;
    for (i, (point, value)) in corners.iter().enumerate() {
        let (next, after) = corners[(i + 1) % 4];
        if *value >= level {
            polygon.push(*point);
        }
        if (*value >= level) != (after >= level) {
            let t = (level - value) / (after - value);
            let cut = [
                point[0] + t * (next[0] - point[0]),
                point[1] + t * (next[1] - point[1]),
            ];
            polygon.push(cut);
            if *value >= level {
                leaving = Some(cut);
            } else {
                match leaving.take() {
                    Some(from) => chords.push([from, cut]),
                    None => entering = entering.or(Some(cut)),
                }
            }
        }
    }
    if let (Some(from), Some(to)) = (leaving, entering) {
        chords.push([from, to]);
    }
    polygon
}
