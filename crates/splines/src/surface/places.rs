//! Displacements of fixed places of an exact surface under loads that change from call to call.

use std::sync::OnceLock;

use nalgebra::DMatrix;
use smallvec::SmallVec;

use crate::compliance::PlaceDisplacements;
use crate::error::Error;
use crate::probe::Probe;
use crate::rail::{MemberPlace, Rails, ShapeRow};

/// Displacements u = N C f + b of n fixed places: f are the nodal forces of the loads, C the compliance of the node states,
/// N the shape rows of the places, and b sums Green's function of the member over the loads on it, its ends held.
///
/// The shape rows are evaluated once. Green's function between a place and a load is a cubic of the load's place on either
/// side; these cubics are made for an element and a direction when a load first stands there.
pub(super) struct SurfacePlaces<'s> {
    rails: &'s Rails,
    nodal: &'s DMatrix<f64>,
    places: Vec<ShapeRow>,
    /// Degree of freedom and shape function of the entries of all rows that are not zero, and for each place the number of
    /// those up to it.
    entries: Vec<(usize, f64)>,
    ends: Vec<usize>,
    /// By element and direction of a load.
    members: Vec<[OnceLock<Vec<OnMember>>; 3]>,
}

/// A value for each degree of freedom of the node states; those of a girder of a few spans need no allocation.
pub(super) type NodalValues<T> = SmallVec<[T; 36]>;

/// Loads on the rails: their forces on the node states, and their places.
pub(super) struct AppliedLoads {
    /// By degree of freedom of the node states.
    pub forces: NodalValues<f64>,
    loads: SmallVec<[(ShapeRow, f64); 4]>,
}

impl AppliedLoads {
    /// No loads on a structure with `size` degrees of freedom of its node states.
    pub fn new(size: usize) -> AppliedLoads {
        AppliedLoads {
            forces: NodalValues::from_elem(0.0, size),
            loads: SmallVec::new(),
        }
    }

    /// Adds a force at the place and in the direction of `row`.
    pub fn add(&mut self, row: &ShapeRow, force: f64) {
        let entries = row.indices().iter().zip(row.values());
        entries.for_each(|(&dof, shape)| self.forces[dof] += shape * force);
        self.loads.push((*row, force));
    }

    /// The displacement of the place of `at` by the loads on its member, whose ends are held.
    pub fn on_member(&self, rails: &Rails, at: &ShapeRow) -> f64 {
        self.loads
            .iter()
            .map(|(load, force)| force * rails.clamped_between(at, load))
            .sum()
    }
}

/// Green's function of a clamped member between a place and a load in one direction.
struct OnMember {
    /// Index of the place.
    index: usize,
    /// Its distance from the first end of the member.
    place: f64,
    /// Coefficients of the first three powers of the load's distance from the first end, for loads before the place, and of
    /// the distance from the last end, for loads behind it. At the ends of the member Green's function is zero. `None` under
    /// an axial force, where it is no cubic.
    cubics: Option<[[f64; 3]; 2]>,
}

/// The shape row of a probe in whose direction the structure has stiffness.
pub(super) fn restrained_row(
    rails: &Rails,
    nodal: &DMatrix<f64>,
    at: Probe,
) -> Result<ShapeRow, Error> {
    let mut row = ShapeRow::EMPTY;
    restrained_row_into(rails, nodal, at, &mut row)?;
    Ok(row)
}

/// [`restrained_row`] into memory that the caller has.
pub(super) fn restrained_row_into(
    rails: &Rails,
    nodal: &DMatrix<f64>,
    at: Probe,
    row: &mut ShapeRow,
) -> Result<(), Error> {
    rails.row_into(at, row)?;
    let is_free =
        |(&dof, value): (&usize, &f64)| *value != 0.0 && nodal[(dof, dof)] == f64::INFINITY;
    if row.indices().iter().zip(row.values()).any(is_free) {
        return Err(Error::NoStiffness {
            rail: at.rail,
            x: at.x,
            axis: at.axis,
        });
    }
    Ok(())
}

impl<'s> SurfacePlaces<'s> {
    /// The places `at` of the surface of `rails` with the compliance `nodal` of the node states.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction in which the structure has no stiffness.
    pub fn new(
        rails: &'s Rails,
        nodal: &'s DMatrix<f64>,
        at: &[Probe],
    ) -> Result<SurfacePlaces<'s>, Error> {
        let row = |probe: &Probe| restrained_row(rails, nodal, *probe);
        let places = at.iter().map(row).collect::<Result<Vec<_>, _>>()?;
        let (mut entries, mut ends) = (Vec::new(), Vec::with_capacity(places.len()));
        for row in &places {
            let own = row
                .indices()
                .iter()
                .copied()
                .zip(row.values().iter().copied());
            entries.extend(own.filter(|(_, shape)| *shape != 0.0));
            ends.push(entries.len());
        }
        let members = rails
            .elements()
            .iter()
            .map(|_| Default::default())
            .collect();
        Ok(SurfacePlaces {
            rails,
            nodal,
            places,
            entries,
            ends,
            members,
        })
    }

    /// Green's function between the places and loads like `load`.
    fn on_member(&self, load: &ShapeRow) -> Vec<OnMember> {
        let length = self.rails.elements()[load.element].length;
        let mut out = Vec::new();
        for (index, place) in self.places.iter().enumerate() {
            let Some([own, other]) = self
                .rails
                .clamped_on_one_member(place.element, load.element)
            else {
                continue;
            };
            let value = |s: f64, q: f64| {
                let at = MemberPlace { s, q };
                own.value(place.axis, place.place, other, load.axis, at)
            };
            let MemberPlace { s, q } = place.place;
            if self.rails.elements()[load.element].flexibility.tension != 0.0 {
                out.push(OnMember {
                    index,
                    place: s,
                    cubics: None,
                });
                continue;
            }
            let cubics = [
                cubic(s, |t| value(t, length - t)),
                cubic(q, |t| value(length - t, t)),
            ];
            let cubics = Some(cubics).filter(|cubics| *cubics != [[0.0; 3]; 2]);
            if cubics.is_some() {
                out.push(OnMember {
                    index,
                    place: s,
                    cubics,
                });
            }
        }
        out
    }
}

impl PlaceDisplacements for SurfacePlaces<'_> {
    fn under(&self, loads: &[(Probe, f64)], also: &[Probe], out: &mut [f64]) -> Result<(), Error> {
        let rows = self.places.len() + also.len();
        if out.len() != rows {
            return Err(Error::EffectShape {
                rows: out.len(),
                columns: 1,
                expected: [rows, 1],
            });
        }
        let mut loaded = AppliedLoads::new(self.nodal.nrows());
        let mut moved = NodalValues::from_elem(0.0, self.nodal.nrows());
        let mut row = ShapeRow::EMPTY;
        let (out, others) = out.split_at_mut(self.places.len());
        out.fill(0.0);
        for (probe, force) in loads {
            restrained_row_into(self.rails, self.nodal, *probe, &mut row)?;
            loaded.add(&row, *force);
            let own = self.members[row.element][row.axis].get_or_init(|| self.on_member(&row));
            for OnMember {
                index,
                place,
                cubics,
            } in own
            {
                let Some([before, behind]) = cubics else {
                    out[*index] += force * self.rails.clamped_between(&self.places[*index], &row);
                    continue;
                };
                let MemberPlace { s, q } = row.place;
                let (t, [a, b, c]) = if s <= *place {
                    (s, before)
                } else {
                    (q, behind)
                };
                out[*index] += force * t * (a + t * (b + t * c));
            }
        }
        for (dof, force) in loaded
            .forces
            .iter()
            .enumerate()
            .filter(|(_, force)| **force != 0.0)
        {
            let column = &self.nodal.as_slice()[dof * moved.len()..(dof + 1) * moved.len()];
            moved
                .iter_mut()
                .zip(column)
                .for_each(|(sum, c)| *sum += c * force);
        }
        let mut first = 0;
        for (out, end) in out.iter_mut().zip(&self.ends) {
            let own = &self.entries[first..*end];
            *out += own
                .iter()
                .map(|(dof, shape)| shape * moved[*dof])
                .sum::<f64>();
            first = *end;
        }
        for (probe, out) in also.iter().zip(others) {
            restrained_row_into(self.rails, self.nodal, *probe, &mut row)?;
            let entries = row
                .indices()
                .iter()
                .zip(row.values())
                .filter(|(_, shape)| **shape != 0.0);
            *out = entries.map(|(&dof, shape)| shape * moved[dof]).sum::<f64>();
            *out += loaded.on_member(self.rails, &row);
        }
        Ok(())
    }
}

/// Coefficients of t, t^2 and t^3 of a cubic that vanishes at t = 0, by its values up to `end`; zero where that is 0.
fn cubic(end: f64, value: impl Fn(f64) -> f64) -> [f64; 3] {
    if end <= 0.0 {
        return [0.0; 3];
    }
    // the quadratic value/t by its values at the thirds
    let [f, g, h] = [1.0, 2.0, 3.0].map(|third| value(third / 3.0 * end) / (third / 3.0 * end));
    let c = 4.5 * (f - 2.0 * g + h);
    let b = 3.0 * (g - f) - c;
    [f - b / 3.0 - c / 9.0, b / end, c / (end * end)]
}
