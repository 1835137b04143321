//! Gauges: points of a structure's rails whose displacement is recorded.

use splines::Axis;

use super::rail::rail_among;
use crate::check::Check;
use crate::scene::raw::RawGauge;
use crate::scene::values::structure::Gauge;
use crate::spec::RailOutline;
use crate::text::entries::Entries;
use crate::text::fault::Fault;
use crate::text::names::check_name;
use crate::text::place::Place;
use crate::units::Dimension;

const DIRECTIONS: [(&str, Axis); 3] = [
    ("vertical", Axis::Vertical),
    ("lateral", Axis::Lateral),
    ("longitudinal", Axis::Longitudinal),
];

pub(super) fn read(
    raw: &Entries<RawGauge>,
    rails: &[RailOutline],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<Gauge> {
    let mut gauges = Vec::new();
    for (name, raw) in &raw.0 {
        let at = at.key(name);
        check_name(name, &at, check.faults);
        let rail = rail_among(raw.rail.as_ref(), rails, &at, check);
        let x = check.faults.require(&raw.x, &at, "x").copied();
        let axis = match &raw.direction {
            Some(word) => check.faults.one_of(word, &at.key("direction"), &DIRECTIONS),
            None => Some(Axis::Vertical),
        };
        let (Some(rail), Some(x), Some(axis)) = (rail, x, axis) else {
            continue;
        };
        let place = at.key("x");
        let x = check.number(x, &place, Dimension::LENGTH);
        let [first, last] = rails[rail].range;
        if x < first || x > last {
            let fault = Fault::new(&place, format!("must lie on rail {}", rails[rail].name)).got(x);
            check
                .faults
                .add(fault.hint(format!("the rail extends from {first} to {last}")));
        }
        gauges.push(Gauge {
            name: name.clone(),
            rail,
            x,
            axis,
        });
    }
    gauges
}
