//! Filled contours of values on a rectangular grid.

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
/// `x` are the coordinates of the columns, `y` those of the rows, and `values[row][column]` the values there.
/// Each cell is clipped to the part at or above the level (marching squares). Neighbouring cells of a row that
/// are entirely inside are joined. A cell whose largest value equals the level is omitted.
pub(super) fn region(x: &[f64], y: &[f64], values: &[Vec<f64>], level: f64) -> Region {
    let mut found = Region::default();
    for row in 1..y.len() {
        let mut run: Option<usize> = None;
        for column in 1..=x.len() {
            let corners = (column < x.len()).then(|| {
                [(row - 1, column - 1), (row - 1, column), (row, column), (row, column - 1)]
                    .map(|(i, j)| ([x[j], y[i]], values[i][j]))
            });
            let above = corners.iter().flatten().any(|c| c.1 > level);
            let inside = if above { corners.iter().flatten().filter(|c| c.1 >= level).count() } else { 0 };
            if inside == 4 {
                run.get_or_insert(column - 1);
                continue;
            }
            if let Some(start) = run.take() {
                let (a, b, c, d) = (x[start], x[column - 1], y[row - 1], y[row]);
                found.polygons.push(vec![[a, c], [b, c], [b, d], [a, d]]);
            }
            if let (Some(corners), 1..) = (corners, inside) {
                let from = found.chords.len();
                clip(&corners, level, &mut found);
                if (row + column).is_multiple_of(2) {
                    found.dashes.extend_from_slice(&found.chords[from..]);
                }
            }
        }
    }
    found
}

/// Adds the part of one cell at or above the level.
fn clip(corners: &[([f64; 2], f64); 4], level: f64, found: &mut Region) {
    let mut polygon = Vec::with_capacity(6);
    let mut leaving = None;
    let mut entering = Vec::new();
    for (i, (point, value)) in corners.iter().enumerate() {
        let (next, after) = corners[(i + 1) % 4];
        if *value >= level {
            polygon.push(*point);
        }
        if (*value >= level) != (after >= level) {
            let t = (level - value) / (after - value);
            let cut = [point[0] + t * (next[0] - point[0]), point[1] + t * (next[1] - point[1])];
            polygon.push(cut);
            if *value >= level {
                leaving = Some(cut);
            } else {
                match leaving.take() {
                    Some(from) => found.chords.push([from, cut]),
                    None => entering.push(cut),
                }
            }
        }
    }
    if let (Some(from), Some(to)) = (leaving, entering.first()) {
        found.chords.push([from, *to]);
    }
    found.polygons.push(polygon);
}
