//! Frames for a comparison with other solvers: writes them as CSV, with our times and grids.
//!
//! `cargo run --release -p girderway-fea --example frames -- DIR NAME...` makes `DIR/NAME/` for each of the names
//! `runway-11`, `runway-112`, `runway-1122` (bays) and `building-12`, `building-26` (points a side).
//! `fea/bench_frames.py` calls it, reads the folders and prints the ratios.
//!
//! | file | a line |
//! |---|---|
//! | `points.csv` | x, y, z |
//! | `members.csv` | first point, last point, section, orientation |
//! | `sections.csv` | E, G, A, Iy, Iz, J |
//! | `supports.csv` | a point, wholly fixed |
//! | `loads-N.csv` | member, place on it by its length, offset of the rail, direction of the unit load |
//! | `grid-N.csv` | two loads on different members, their coefficient (at most 41 loads) |
//! | `times-N.csv` | milliseconds to factor, and for the grid of the factored frame; least of three |

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;
use std::{env, fs};

use fea::{CrossSection, FactoredFrame, Member, Model, Rail, RailSegment, Support};
use splines::{Axis, Probe};

/// Numbers of unit loads.
const LOADS: [usize; 2] = [41, 400];
/// Repetitions; the least time counts.
const TIMES: usize = 3;

/// A load on a member, for programs without rails.
struct Load {
    member: usize,
    place: f64,
    offset: [f64; 3],
}

/// A frame, its rails, and where along each rail the members lie.
struct Case {
    model: Model,
    rails: Vec<Rail>,
    /// Length of each member along its rail; rails start at their origin.
    step: f64,
}

impl Case {
    /// Probes spread evenly over all rails, with the same loads on members.
    fn loads(&self, count: usize) -> (Vec<Probe>, Vec<Load>) {
        let total: usize = self.rails.iter().map(|rail| rail.segments.len()).sum();
        let each = total as f64 / count as f64;
        let place = |k: usize| {
            let mut along = each * (k as f64 + 0.5);
            for (rail, data) in self.rails.iter().enumerate() {
                let length = data.segments.len() as f64;
                if along < length {
                    let segment = data.segments[along as usize];
                    let load = Load {
                        member: segment.member,
                        place: along.fract(),
                        offset: segment.offset,
                    };
                    return Some((
                        Probe {
                            rail,
                            x: self.step * along,
                            axis: Axis::Vertical,
                        },
                        load,
                    ));
                }
                along -= length;
            }
            None
        };
        (0..count).filter_map(place).unzip()
    }
}

fn section(i: f64) -> CrossSection {
    CrossSection {
        e: 4.32e9,
        g: 1.66e9,
        area: 0.6,
        iy: 0.3 * i,
        iz: i,
        j: 0.02,
        ..CrossSection::default()
    }
}

fn member(points: [usize; 2], section: usize, orientation: [f64; 3]) -> Member {
    Member::beam(points, section, orientation)
}

fn empty() -> Model {
    Model {
        sections: vec![section(4.0), section(1.5)],
        up: [0.0, 1.0, 0.0],
        ..Model::default()
    }
}

/// A runway with ten members in each bay, on columns of four members.
fn runway(bays: usize) -> Case {
    let mut model = empty();
    let mut rail = Rail {
        axis: [1.0, 0.0, 0.0],
        ..Rail::default()
    };
    for k in 0..=10 * bays {
        model.points.push([4.0 * k as f64, 40.0, 0.0]);
        if k > 0 {
            rail.segments.push(RailSegment {
                member: model.members.len(),
                offset: [0.0, 3.0, 0.2],
            });
            model.members.push(member([k - 1, k], 0, [0.0, 1.0, 0.0]));
        }
    }
    for bay in 0..=bays {
        let mut above = 10 * bay;
        for level in (0..4).rev() {
            model
                .points
                .push([40.0 * bay as f64, 10.0 * f64::from(level), 0.0]);
            let below = model.points.len() - 1;
            model
                .members
                .push(member([below, above], 1, [0.0, 0.0, 1.0]));
            above = below;
        }
        model.supports.push(Support {
            point: above,
            fixed: [true; 6],
        });
    }
    Case {
        model,
        rails: vec![rail],
        step: 4.0,
    }
}

/// A building of n columns a side and n storeys; rails on all beams of its middle floor along x.
fn building(n: usize) -> Case {
    let mut model = empty();
    let mut rails = Vec::new();
    let at = |i: usize, level: usize, k: usize| (level * n + k) * n + i;
    for level in 0..=n {
        for k in 0..n {
            for i in 0..n {
                model
                    .points
                    .push([20.0 * i as f64, 12.0 * level as f64, 25.0 * k as f64]);
                if level == 0 {
                    model.supports.push(Support {
                        point: at(i, level, k),
                        fixed: [true; 6],
                    });
                }
            }
        }
    }
    for level in 1..=n {
        for k in 0..n {
            let origin = [0.0, 12.0 * level as f64, 25.0 * k as f64];
            let mut rail = Rail {
                origin,
                axis: [1.0, 0.0, 0.0],
                ..Rail::default()
            };
            for i in 0..n {
                model.members.push(member(
                    [at(i, level - 1, k), at(i, level, k)],
                    1,
                    [0.0, 0.0, 1.0],
                ));
                if i > 0 {
                    rail.segments.push(RailSegment {
                        member: model.members.len(),
                        offset: [0.0, 1.5, 0.1],
                    });
                    model.members.push(member(
                        [at(i - 1, level, k), at(i, level, k)],
                        0,
                        [0.0, 1.0, 0.0],
                    ));
                }
                if k > 0 {
                    model.members.push(member(
                        [at(i, level, k - 1), at(i, level, k)],
                        0,
                        [0.0, 1.0, 0.0],
                    ));
                }
            }
            if level == n / 2 {
                rails.push(rail);
            }
        }
    }
    Case {
        model,
        rails,
        step: 20.0,
    }
}

fn csv<const N: usize>(rows: impl Iterator<Item = [f64; N]>) -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for row in rows {
        for (k, value) in row.iter().enumerate() {
            write!(text, "{}{value}", if k > 0 { "," } else { "" })?;
        }
        text.push('\n');
    }
    Ok(text)
}

fn write(folder: &Path, case: &Case) -> Result<(), Box<dyn Error>> {
    let m = &case.model;
    fs::create_dir_all(folder)?;
    fs::write(folder.join("points.csv"), csv(m.points.iter().copied())?)?;
    let members = m.members.iter().map(|member| {
        let [a, b, s] = [member.points[0], member.points[1], member.section].map(|k| k as f64);
        let [x, y, z] = member.orientation;
        [a, b, s, x, y, z]
    });
    fs::write(folder.join("members.csv"), csv(members)?)?;
    let sections = m
        .sections
        .iter()
        .map(|s| [s.e, s.g, s.area, s.iy, s.iz, s.j]);
    fs::write(folder.join("sections.csv"), csv(sections)?)?;
    fs::write(
        folder.join("supports.csv"),
        csv(m.supports.iter().map(|s| [s.point as f64]))?,
    )?;
    for count in LOADS {
        let (probes, loads) = case.loads(count);
        let rows = loads.iter().map(|load| {
            let [x, y, z] = load.offset;
            [load.member as f64, load.place, x, y, z, 0.0, 1.0, 0.0]
        });
        fs::write(folder.join(format!("loads-{count}.csv")), csv(rows)?)?;
        let [mut factor, mut solve] = [f64::INFINITY; 2];
        let mut value = None;
        for _ in 0..TIMES {
            let start = Instant::now();
            let frame = FactoredFrame::new(m, &case.rails)?;
            factor = factor.min(start.elapsed().as_secs_f64());
            let start = Instant::now();
            let grid = frame.grid(&probes)?;
            solve = solve.min(start.elapsed().as_secs_f64());
            value = Some(grid.value);
        }
        fs::write(
            folder.join(format!("times-{count}.csv")),
            csv([[1e3 * factor, 1e3 * solve]].into_iter())?,
        )?;
        let Some(value) = value.filter(|_| count == LOADS[0]) else {
            continue;
        };
        let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
        let apart = pairs.filter(|&(i, j)| loads[i].member != loads[j].member);
        let rows = apart.map(|(i, j)| [i as f64, j as f64, value[(i, j)]]);
        fs::write(folder.join(format!("grid-{count}.csv")), csv(rows)?)?;
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = env::args().skip(1);
    let folder = args.next().ok_or("usage: frames DIR NAME...")?;
    for name in args {
        let (kind, size) = name
            .split_once('-')
            .ok_or("a name is runway-N or building-N")?;
        let size: usize = size.parse()?;
        let case = match kind {
            "runway" => runway(size),
            "building" => building(size),
            _ => return Err("a name is runway-N or building-N".into()),
        };
        write(&Path::new(&folder).join(&name), &case)?;
    }
    Ok(())
}
