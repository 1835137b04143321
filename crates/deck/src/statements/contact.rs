//! Contacts of wheels and rails: VARIABLE, DIFF and GFORCE statements.
//!
//! For each wheel the statements define its rail coordinate x, the displacements of the rail at x as functions of all
//! forces, the penetration p = r - (height of the wheel centre above the displaced rail), the vertical force k p^e +
//! c p', the lateral overlap of the flange with the rail and the flange force, the friction as a function of the
//! sliding speed, and the components of these forces along the rail due to its slope. The penetration is a DIFF where
//! a damper acts on a flexible rail, because only then does the rate of the displacement of the rail enter. The
//! GFORCE of the wheel has all six components.

use adams::Statement;
use sim::{FrictionLaw, NormalLaw};
use splines::Axis;

use crate::model::compliance::LoadedMarker;
use crate::model::plan::DeckPlan;
use crate::words::form::DeckForm;
use crate::words::ids::{self, VariableSlot, variable};
use crate::words::remark;
use crate::words::text::{TermList, mean, number, plain, value};

/// All statements of the contacts.
pub(crate) fn statements(plan: &DeckPlan<'_>) -> Vec<Statement> {
    let mut written = WrittenRemarks::default();
    let mut out = Vec::new();
    for (s, compliance) in plan.compliances.iter().enumerate() {
        out.extend(compliance.products(&loads(plan, s)));
    }
    for c in 0..plan.contacts.len() {
        for w in plan.contacts[c].wheels.clone() {
            place(plan, w, &mut written, &mut out);
        }
        vertical(plan, c, &mut written, &mut out);
        for w in plan.contacts[c].wheels.clone() {
            flange(plan, w, &mut out);
            friction(plan, w, &mut written, &mut out);
            slope(plan, w, &mut written, &mut out);
        }
    }
    for w in 0..plan.wheels.len() {
        out.push(force(plan, w));
    }
    out
}

/// Which remarks have been written.
#[derive(Default)]
struct WrittenRemarks {
    cross: bool,
    start: bool,
    gap: bool,
    velocity: bool,
    law: bool,
    slope: bool,
}

/// Adds the remark `text` to the statement unless it has been written before.
fn once(written: &mut bool, statement: Statement, text: &str) -> Statement {
    if std::mem::replace(written, true) {
        statement
    } else {
        statement.remark(text)
    }
}

/// Forces on the rails of structure `s`.
pub(crate) fn loads(plan: &DeckPlan<'_>, s: usize) -> Vec<LoadedMarker> {
    let mut out = Vec::new();
    for (w, wheel) in plan
        .wheels
        .iter()
        .enumerate()
        .filter(|(_, wheel)| wheel.structure == s)
    {
        let at = value(variable(w, VariableSlot::Place));
        let first = plan.contacts[wheel.contact].wheels.start;
        let load = |axis, slot, owner, negative| LoadedMarker {
            direction: plan.direction(w, axis),
            place: at.clone(),
            force: value(variable(owner, slot)),
            negative,
        };
        out.push(load(Axis::Vertical, VariableSlot::Press, first, true));
        if plan.kind(w).flange.is_some() {
            out.push(load(Axis::Lateral, VariableSlot::Flange, w, false));
        }
    }
    out
}

/// A VARIABLE of wheel `w`, named after the wheel.
fn named(plan: &DeckPlan<'_>, w: usize, slot: VariableSlot, what: &str) -> Statement {
    Statement::new("VARIABLE", variable(w, slot))
        .named(plain(&format!("{}_{what}", plan.wheels[w].name)))
}

/// Adds the initial value `at` to the statement; it is 0 in the form of the paper.
fn starting(plan: &DeckPlan<'_>, statement: Statement, at: f64) -> Statement {
    statement.numbers(
        "IC",
        &[if plan.form == DeckForm::Paper {
            0.0
        } else {
            at
        }],
    )
}

/// The rail coordinate of a wheel, and the displacements of the rail under it.
fn place(plan: &DeckPlan<'_>, w: usize, written: &mut WrittenRemarks, out: &mut Vec<Statement>) {
    let wheel = &plan.wheels[w];
    let rail = plan.datum(w);
    let statement =
        named(plan, w, VariableSlot::Place, "place").numbers("IC", &[plan.start.place[w]]);
    out.push(statement.function("FUNCTION", format!("DX({},{rail},{rail})", wheel.marker)));
    let at = value(variable(w, VariableSlot::Place));
    let compliance = &plan.compliances[wheel.structure];
    let loads = loads(plan, wheel.structure);
    if !compliance.is_flexible() {
        return;
    }
    if let Some(text) =
        compliance.displacement(plan.direction(w, Axis::Vertical), &at, &loads, false)
    {
        let statement = starting(
            plan,
            named(plan, w, VariableSlot::Rise, "rise"),
            -plan.start.deflection[w],
        );
        out.push(once(&mut written.cross, statement, remark::CROSS).function("FUNCTION", text));
    }
    if plan.kind(w).flange.is_some()
        && let Some(text) =
            compliance.displacement(plan.direction(w, Axis::Lateral), &at, &loads, false)
    {
        out.push(named(plan, w, VariableSlot::Shift, "shift").function("FUNCTION", text));
    }
}

/// Height of the centre of a wheel above its displaced rail; the radius minus this height is the penetration.
fn height(plan: &DeckPlan<'_>, w: usize) -> String {
    let rail = plan.datum(w);
    let mut text = format!("DY({},{rail},{rail})", plan.wheels[w].marker);
    if plan.compliances[plan.wheels[w].structure].is_flexible() {
        text.push_str(&format!("-{}", value(variable(w, VariableSlot::Rise))));
    }
    text
}

/// The penetration of contact `c` as it enters the force law.
fn depth(plan: &DeckPlan<'_>, c: usize) -> String {
    let contact = &plan.contacts[c];
    match contact.diff.filter(|_| plan.form != DeckForm::Paper) {
        Some(id) => format!("DIF({id})"),
        None => value(variable(contact.wheels.start, VariableSlot::Penetration)),
    }
}

/// Penetration and vertical force of contact `c`.
fn vertical(plan: &DeckPlan<'_>, c: usize, written: &mut WrittenRemarks, out: &mut Vec<Statement>) {
    let contact = &plan.contacts[c];
    let first = contact.wheels.start;
    let kind = plan.kind(first);
    let heights = mean_height(plan, c);
    let statement = starting(
        plan,
        named(plan, first, VariableSlot::Penetration, "penetration"),
        plan.start.penetration[first],
    );
    let text = format!("{}-{heights}", number(kind.radius));
    out.push(once(&mut written.start, statement, remark::START).function("FUNCTION", text));
    if let Some(id) = contact.diff.filter(|_| plan.form != DeckForm::Paper) {
        let statement = Statement::new("DIFF", id)
            .named(plain(&format!("{}_gap", plan.wheels[first].name)))
            .numbers("IC", &[plan.start.penetration[first], 0.0])
            .flag("IMPLICIT");
        let text = format!(
            "DIF({id})-{}",
            value(variable(first, VariableSlot::Penetration))
        );
        out.push(once(&mut written.gap, statement, remark::GAP).function("FUNCTION", text));
    }
    let statement = starting(
        plan,
        named(plan, first, VariableSlot::Press, "press"),
        plan.start.vertical[first],
    );
    let law = &kind.normal;
    let mut statement = if plan.form == DeckForm::Paper {
        once(&mut written.law, statement, remark::PAPER)
    } else if law.exponent == 1.0 {
        once(&mut written.law, statement, remark::LINEAR)
    } else {
        once(&mut written.law, statement, remark::EXPONENT)
    };
    if law.bilateral && plan.form != DeckForm::Paper {
        statement = statement.remark(remark::BILATERAL);
    }
    let text = press(plan, c);
    if contact.diff.is_none() && law.damping > 0.0 && plan.form != DeckForm::Paper {
        statement = once(&mut written.velocity, statement, remark::VELOCITY);
    }
    out.push(statement.function("FUNCTION", text));
}

/// Mean height of the wheels of a contact above their displaced rail, in brackets.
fn mean_height(plan: &DeckPlan<'_>, c: usize) -> String {
    let wheels = plan.contacts[c].wheels.clone();
    let mut sum = TermList::default();
    for w in wheels.clone() {
        sum.add(false, &height(plan, w));
    }
    let text = sum.text();
    if wheels.len() == 1 {
        format!("({text})")
    } else {
        mean(text, wheels.len())
    }
}

/// Mean upward velocity of the wheels of a contact, which is the negative rate of penetration on a rigid rail.
fn speed(plan: &DeckPlan<'_>, c: usize) -> String {
    let wheels = plan.contacts[c].wheels.clone();
    let mut sum = TermList::default();
    for w in wheels.clone() {
        let (hub, rail) = (plan.wheels[w].marker, plan.datum(w));
        if plan.form == DeckForm::Paper {
            sum.add(false, &format!("VY({hub},{rail},{rail})"));
        } else {
            sum.add(false, &format!("VY({hub},{rail},{rail},{rail})"));
        }
    }
    mean(sum.text(), wheels.len())
}

/// Vertical force of each wheel of contact `c`.
fn press(plan: &DeckPlan<'_>, c: usize) -> String {
    let contact = &plan.contacts[c];
    let kind = plan.kind(contact.wheels.start);
    let law = &kind.normal;
    let p = depth(plan, c);
    let (k, damping) = (number(law.stiffness), number(law.damping));
    if plan.form == DeckForm::Paper {
        return format!("{k}*{p}-{damping}*({})", speed(plan, c));
    }
    let ramped = law.depth > 0.0 && law.damping > 0.0;
    if ramped && !law.bilateral {
        let (radius, exponent) = (number(kind.radius), number(law.exponent));
        let rate = contact
            .diff
            .map_or_else(|| speed(plan, c), |id| format!("-DIF1({id})"));
        let depth = number(law.depth);
        return format!("IMPACT({radius}-{p},{rate},{radius},{k},{exponent},{damping},{depth})");
    }
    let spring = spring(law, &p);
    let damper = if ramped {
        format!("STEP({p},0,0,{},{damping})", number(law.depth))
    } else {
        damping
    };
    let force = match contact.diff {
        Some(id) => format!("{spring}+{damper}*DIF1({id})"),
        None if law.damping > 0.0 => format!("{spring}-{damper}*({})", speed(plan, c)),
        None => spring,
    };
    if law.bilateral {
        force
    } else if contact.diff.is_some() || law.damping == 0.0 {
        format!("MAX(0,{force})")
    } else {
        // a damper to ground or on a rigid rail acts only while wheel and rail are in contact
        format!("IF({p}:0,0,MAX(0,{force}))")
    }
}

/// The spring force k p^e; an odd function of p if the contact is bilateral.
fn spring(law: &NormalLaw, p: &str) -> String {
    let k = number(law.stiffness);
    if law.exponent == 1.0 {
        format!("{k}*{p}")
    } else if law.bilateral {
        format!("{k}*{p}*ABS({p})**{}", number(law.exponent - 1.0))
    } else {
        format!("{k}*MAX(0,{p})**{}", number(law.exponent))
    }
}

/// Height of the centre of wheel `w` above the rail, which is the lever arm of friction and flange force.
fn arm(plan: &DeckPlan<'_>, w: usize) -> String {
    let radius = number(plan.kind(w).radius);
    format!("({radius}-{})", depth(plan, plan.wheels[w].contact))
}

/// Lateral displacement and flange force of wheel `w`.
fn flange(plan: &DeckPlan<'_>, w: usize, out: &mut Vec<Statement>) {
    let Some(flange) = &plan.kind(w).flange else {
        return;
    };
    let wheel = &plan.wheels[w];
    let rail = plan.datum(w);
    let mut text = format!("DZ({},{rail},{rail})", wheel.marker);
    if let Some(tread) = wheel.tread {
        let radius = number(plan.kind(w).radius);
        text.push_str(&format!(
            "+{}/{radius}*DZ({tread},{},{rail})",
            arm(plan, w),
            wheel.marker
        ));
    }
    if plan.compliances[wheel.structure].is_flexible() {
        text.push_str(&format!("-{}", value(variable(w, VariableSlot::Shift))));
    }
    out.push(named(plan, w, VariableSlot::Sideways, "sideways").function("FUNCTION", text));
    let side = value(variable(w, VariableSlot::Sideways));
    let gap = number(flange.clearance);
    let release = flange.release.map_or(String::new(), |[from, to]| {
        format!(
            "*STEP({},{},1,{},0)",
            arm(plan, w),
            number(from),
            number(to)
        )
    });
    let overlap = format!("(MAX(0,{side}-{gap})+MIN(0,{side}+{gap}))");
    let statement = starting(
        plan,
        named(plan, w, VariableSlot::Flange, "flange"),
        plan.start.lateral[w],
    );
    out.push(statement.function(
        "FUNCTION",
        format!("{}{release}*{overlap}", number(flange.stiffness)),
    ));
}

/// Friction force of wheel `w`.
fn friction(plan: &DeckPlan<'_>, w: usize, written: &mut WrittenRemarks, out: &mut Vec<Statement>) {
    let (Some((_, centre)), Some(friction)) = (plan.wheels[w].spin, &plan.kind(w).friction) else {
        return;
    };
    let (hub, rail) = (plan.wheels[w].marker, plan.datum(w));
    let press = value(variable(
        plan.contacts[plan.wheels[w].contact].wheels.start,
        VariableSlot::Press,
    ));
    let fourth = if plan.form == DeckForm::Paper {
        String::new()
    } else {
        format!(",{rail}")
    };
    let slide = format!(
        "VX({hub},{rail},{rail}{fourth})+WZ({centre},{rail},{rail})*{}",
        arm(plan, w)
    );
    let slip = number(friction.slip);
    let saturation = match friction.law {
        FrictionLaw::Step => format!("STEP({slide},-{slip},-1,{slip},1)"),
        FrictionLaw::Coulomb => format!("TANH(({slide})/{slip})"),
    };
    let text = format!("{}*{press}*{saturation}", number(friction.coefficient));
    let mut statement = starting(
        plan,
        named(plan, w, VariableSlot::Traction, "traction"),
        plan.start.traction[w],
    );
    if plan.form != DeckForm::Paper {
        statement = once(&mut written.velocity, statement, remark::VELOCITY);
    }
    out.push(statement.function("FUNCTION", text));
}

/// Components of the forces of wheel `w` along its deflected rail.
fn slope(plan: &DeckPlan<'_>, w: usize, written: &mut WrittenRemarks, out: &mut Vec<Statement>) {
    let wheel = &plan.wheels[w];
    let compliance = &plan.compliances[wheel.structure];
    let at = value(variable(w, VariableSlot::Place));
    let loads = loads(plan, wheel.structure);
    let first = plan.contacts[wheel.contact].wheels.start;
    let lateral = plan.kind(w).flange.is_some();
    // the negative sign arises because vertical displacements are positive upwards and the vertical force acts
    // downwards
    for (axis, slot, press, negative, what, acts) in [
        (
            Axis::Vertical,
            VariableSlot::Slope,
            variable(first, VariableSlot::Press),
            true,
            "slope",
            true,
        ),
        (
            Axis::Lateral,
            VariableSlot::Tilt,
            variable(w, VariableSlot::Flange),
            false,
            "tilt",
            lateral,
        ),
    ] {
        if !acts || !compliance.is_flexible() {
            continue;
        }
        let Some(text) = compliance.displacement(plan.direction(w, axis), &at, &loads, true) else {
            continue;
        };
        let sign = if negative { "-" } else { "" };
        let statement = once(
            &mut written.slope,
            named(plan, w, slot, what),
            remark::SLOPE,
        );
        out.push(statement.function("FUNCTION", format!("{sign}{}*({text})", value(press))));
    }
}

/// The GFORCE of wheel `w`.
fn force(plan: &DeckPlan<'_>, w: usize) -> Statement {
    let wheel = &plan.wheels[w];
    let press = variable(
        plan.contacts[wheel.contact].wheels.start,
        VariableSlot::Press,
    );
    let arm = arm(plan, w);
    let lateral = plan.kind(w).flange.is_some();
    let traction = wheel.spin.is_some();
    let compliance = &plan.compliances[wheel.structure];
    let mut along = TermList::default();
    if traction {
        along.add(true, &value(variable(w, VariableSlot::Traction)));
    }
    let sloped = compliance.is_flexible() && plan.form == DeckForm::Factored;
    if sloped {
        along.add(false, &value(variable(w, VariableSlot::Slope)));
        if lateral {
            along.add(false, &value(variable(w, VariableSlot::Tilt)));
        }
    }
    let side = if lateral {
        format!("-{}", value(variable(w, VariableSlot::Flange)))
    } else {
        "0.0".to_owned()
    };
    let roll = if lateral {
        format!("{arm}*{}", value(variable(w, VariableSlot::Flange)))
    } else {
        "0.0".to_owned()
    };
    let spin = if traction {
        format!("-{arm}*{}", value(variable(w, VariableSlot::Traction)))
    } else {
        "0.0".to_owned()
    };
    let mut statement = Statement::new("GFORCE", ids::number(w)).named(plain(&wheel.name));
    if w == 0 {
        statement = statement.remark(remark::FORCE);
        if !sloped
            && plan
                .compliances
                .iter()
                .any(crate::model::compliance::RailCompliance::is_flexible)
        {
            statement = statement.remark(remark::NO_SLOPE);
        }
    }
    statement
        .reference("I", wheel.centre())
        .reference("JFLOAT", wheel.float)
        .reference("RM", plan.datum(w))
        .function("FX", along.text())
        .function("FY", value(press))
        .function("FZ", side)
        .function("TX", roll)
        .function("TY", "0.0")
        .function("TZ", spin)
}
