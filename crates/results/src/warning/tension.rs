//! Rails that are restrained lengthwise at both ends: bending stretches them, and the axial tension increases their
//! bending stiffness, which a linear model neglects.

use std::collections::BTreeSet;

use fea::{Dof, Member, MemberKind, Model};

/// Largest relative increase of the bending stiffness by axial tension, A delta^2 / (4 I), among the members that
/// carry `rail` between neighbouring points that are restrained along it; `delta`: deflection of the rail, in the
/// length unit of the model. `None` where no member lies between two such points.
///
/// The members are visited in their order along the rail. A chain of connected members begins at a restrained point,
/// is abandoned at a gap, a truss or an axial release, and is evaluated where it reaches the next restrained point.
///
/// # Source
/// Woinowsky-Krieger, The effect of an axial force on the vibration of hinged bars, Journal of Applied Mechanics 17
/// (1950).
pub(super) fn stiffness_growth(model: &Model, rail: &fea::Rail, delta: f64) -> Option<f64> {
    let translations = [Dof::Ux, Dof::Uy, Dof::Uz];
    let size = rail
        .axis
        .iter()
        .fold(0.0_f64, |most, part| most.max(part.abs()));
    let along = (0..3).find(|&k| rail.axis[k].abs() == size)?;
    let restrained: BTreeSet<usize> = model
        .supports
        .iter()
        .filter(|support| support.fixed[translations[along] as usize])
        .map(|support| support.point)
        .collect();
    let mut members: Vec<&Member> = rail
        .segments
        .iter()
        .map(|segment| &model.members[segment.member])
        .collect();
    let place = |point: usize| model.points[point][along];
    members.sort_by(|a, b| place(a.points[0]).total_cmp(&place(b.points[0])));

    let mut largest: Option<f64> = None;
    let mut chain: Vec<&Member> = Vec::new();
    let mut last = None;
    for member in members {
        let [mut from, mut to] = member.points;
        if place(from) > place(to) {
            std::mem::swap(&mut from, &mut to);
        }
        let is_released = member
            .releases
            .iter()
            .any(|released| released[Dof::Ux as usize]);
        if restrained.contains(&from) {
            chain.clear();
            chain.push(member);
        } else if last == Some(from) && !chain.is_empty() {
            chain.push(member);
        } else {
            chain.clear();
        }
        if is_released || member.kind != MemberKind::Beam {
            chain.clear();
        }
        if restrained.contains(&to) {
            for member in chain.drain(..) {
                let section = &model.sections[member.section];
                let inertia = if is_upright(member, model) {
                    section.iz
                } else {
                    section.iy
                };
                if inertia > 0.0 {
                    let growth = section.area * delta * delta / (4.0 * inertia);
                    largest = Some(largest.map_or(growth, |most| most.max(growth)));
                }
            }
        }
        last = Some(to);
    }
    largest
}

/// Whether the member's local y is nearer to the vertical than its local z.
fn is_upright(member: &Member, model: &Model) -> bool {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [from, to] = member.points.map(|point| model.points[point]);
    let axis = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
    let along = dot(member.orientation, axis) / dot(axis, axis);
    let y: [f64; 3] = std::array::from_fn(|k| member.orientation[k] - along * axis[k]);
    dot(y, model.up).powi(2) > 0.5 * dot(y, y) * dot(model.up, model.up)
}

#[cfg(test)]
mod tests {
    use fea::{CrossSection, Rail, RailSegment, Support};

    use super::*;

    /// Two members over three points; the last point is restrained lengthwise if `is_last_restrained`.
    fn beam(is_last_restrained: bool) -> (Model, Rail) {
        let fixed = [true, true, true, true, false, false];
        let model = Model {
            up: [0.0, 1.0, 0.0],
            points: vec![[0.0; 3], [5.0, 0.0, 0.0], [10.0, 0.0, 0.0]],
            members: vec![
                Member::beam([0, 1], 0, [0.0, 1.0, 0.0]),
                Member::beam([1, 2], 0, [0.0, 0.0, 1.0]),
            ],
            sections: vec![CrossSection {
                area: 0.2,
                iy: 0.01,
                iz: 0.05,
                ..CrossSection::default()
            }],
            supports: vec![
                Support { point: 0, fixed },
                Support {
                    point: 2,
                    fixed: [is_last_restrained, true, true, false, false, false],
                },
            ],
            ..Model::default()
        };
        let segments = (0..2)
            .map(|member| RailSegment {
                member,
                offset: [0.0; 3],
            })
            .collect();
        (
            model,
            Rail {
                axis: [1.0, 0.0, 0.0],
                segments,
                ..Rail::default()
            },
        )
    }

    /// Analytic: 0.2 x 0.1^2 / (4 x 0.01) by the member that lies flat.
    #[test]
    fn ends_restrained_twice_stiffen_by_the_square_of_the_deflection() {
        let (model, rail) = beam(true);
        let growth = stiffness_growth(&model, &rail, 0.1).expect("both ends are restrained");
        assert!((growth - 0.05).abs() < 1e-15, "{growth}");
    }

    #[test]
    fn an_end_that_slides_stiffens_nothing() {
        let (model, rail) = beam(false);
        assert_eq!(stiffness_growth(&model, &rail, 0.1), None);
        let (mut model, rail) = beam(true);
        model.members[1].releases[0][0] = true;
        assert_eq!(stiffness_growth(&model, &rail, 0.1), None);
    }
}
