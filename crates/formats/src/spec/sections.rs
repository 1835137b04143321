//! Materials and sections of the general form.

use std::collections::BTreeMap;

use fea::{BeamTheory, CrossSection, MemberKind, Model, Taper};

use super::raw::{RawMaterial, RawSection, SectionTables};
use crate::check::Check;
use crate::text::fault::{Fault, nearest};
use crate::text::names::check_free_name;
use crate::text::place::Place;
use crate::units::Dimension;

/// Young's modulus, shear modulus and mass per volume.
struct Material {
    e: f64,
    g: Option<f64>,
    density: f64,
}

/// Reads materials and sections into the model and returns the names of the sections.
pub(super) fn read(
    tables: SectionTables<'_>,
    root: &Place<'_>,
    model: &mut Model,
    check: &mut Check<'_>,
) -> Vec<String> {
    let mut materials = BTreeMap::new();
    let list = root.key("materials");
    for (index, raw) in check
        .faults
        .require(tables.materials, root, "materials")
        .into_iter()
        .flatten()
        .enumerate()
    {
        let at = list.index(index);
        let material = read_material(raw, &at, check);
        let Some(name) = check.faults.require(&raw.name, &at, "name") else {
            continue;
        };
        check_free_name(name, &at.key("name"), check.faults);
        if materials.insert(name.as_str(), material).is_some() {
            check.faults.add(
                Fault::new(&at.key("name"), "must differ from the other materials")
                    .got(format!("\"{name}\"")),
            );
        }
    }
    let list = root.key("sections");
    let mut names: Vec<String> = Vec::new();
    for (index, raw) in check
        .faults
        .require(tables.sections, root, "sections")
        .into_iter()
        .flatten()
        .enumerate()
    {
        let at = list.index(index);
        let name = check
            .faults
            .require(&raw.name, &at, "name")
            .cloned()
            .unwrap_or_default();
        check_free_name(&name, &at.key("name"), check.faults);
        if !name.is_empty() && names.contains(&name) {
            check.faults.add(
                Fault::new(&at.key("name"), "must differ from the other sections")
                    .got(format!("\"{name}\"")),
            );
        }
        names.push(name);
        let filled = super::shape::filled(raw, &at, check);
        model
            .sections
            .push(read_section(&filled, &materials, &at, check));
    }
    names
}

fn read_material(raw: &RawMaterial, at: &Place<'_>, check: &mut Check<'_>) -> Material {
    let e = check.required_positive(raw.e, at, "E", Dimension::STRESS, "");
    let g = check.optional_positive(raw.g, &at.key("G"), Dimension::STRESS, "");
    let density = raw.density.unwrap_or_default();
    let density = check.not_negative(
        density,
        &at.key("density"),
        Dimension::DENSITY,
        "mass per volume",
    );
    Material { e, g, density }
}

fn read_section(
    raw: &RawSection,
    materials: &BTreeMap<&str, Material>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> CrossSection {
    let place = at.key("material");
    let mut material = None;
    if let Some(name) = check.faults.require(&raw.material, at, "material") {
        material = materials.get(name.as_str());
        if material.is_none() {
            let known: Vec<&str> = materials.keys().copied().collect();
            let hint = match nearest(name, &known) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("known: {}", known.join(", ")),
            };
            let fault =
                Fault::new(&place, "must be the name of a material").got(format!("\"{name}\""));
            check.faults.add(fault.hint(hint));
        }
    }
    let mut plain = |value: Option<f64>, key: &str, dimension| {
        check
            .optional_positive(value, &at.key(key), dimension, "")
            .unwrap_or_default()
    };
    let area = plain(raw.area, "A", Dimension::AREA);
    let (e, g) = material.map_or((1.0, 1.0), |material| {
        (material.e, material.g.unwrap_or_default())
    });
    CrossSection {
        e,
        g,
        area,
        iy: plain(raw.iy, "Iy", Dimension::SECOND_MOMENT),
        iz: plain(raw.iz, "Iz", Dimension::SECOND_MOMENT),
        j: raw.j.map_or(0.0, |j| {
            let hint = "0 for a section without torsional stiffness";
            check.not_negative(j, &at.key("J"), Dimension::SECOND_MOMENT, hint)
        }),
        shear_y: check.optional_positive(
            raw.asy,
            &at.key("Asy"),
            Dimension::AREA,
            "leave it out for a section that is rigid in shear",
        ),
        shear_z: check.optional_positive(
            raw.asz,
            &at.key("Asz"),
            Dimension::AREA,
            "leave it out for a section that is rigid in shear",
        ),
        mass: material.map_or(0.0, |material| material.density * area),
    }
}

/// Checks that sections have the properties that their members require: an area, for rods also a torsion constant, and
/// for beams the second moments of area and a torsion constant, which may be 0. Sections that no member uses are not checked.
/// `advice` follows the hint that beams use a section.
pub(super) fn check_complete(
    tables: SectionTables<'_>,
    root: &Place<'_>,
    model: &Model,
    tapers: &[Option<Taper>],
    advice: &str,
    check: &mut Check<'_>,
) {
    let list = root.key("sections");
    for (index, (section, raw)) in model
        .sections
        .iter()
        .zip(tables.sections.iter().flatten())
        .enumerate()
    {
        let at = list.index(index);
        let ends = |taper: &Option<Taper>| taper.is_some_and(|taper| taper.section == index);
        let pairs = model.members.iter().zip(tapers);
        let users = pairs.filter(|(member, taper)| member.section == index || ends(taper));
        let kinds: Vec<MemberKind> = users.map(|(member, _)| member.kind).collect();
        if kinds.is_empty() {
            continue;
        }
        let [beams, rods] = [MemberKind::Beam, MemberKind::Rod].map(|kind| kinds.contains(&kind));
        for (key, value) in [
            ("A", raw.area),
            ("Iy", raw.iy),
            ("Iz", raw.iz),
            ("J", raw.j),
        ] {
            if value.is_none()
                && raw.shape.is_none()
                && (beams || key == "A" || (rods && key == "J"))
            {
                let user: String = match (beams, rods) {
                    (true, _) => format!("beams use this section{advice}"),
                    (false, true) => "rods use this section".to_owned(),
                    (false, false) => "members use this section".to_owned(),
                };
                check
                    .faults
                    .add(Fault::new(&at, format!("missing key `{key}`")).hint(user));
            }
        }
        let sheared = model.theory == BeamTheory::Timoshenko
            && (section.shear_y.is_some() || section.shear_z.is_some());
        let needs = (beams && (section.j > 0.0 || sheared)) || (rods && section.j > 0.0);
        if needs && section.g == 0.0 {
            let fault = Fault::new(&at, "its material needs `G`");
            check
                .faults
                .add(fault.hint("torsion and shear depend on the shear modulus"));
        }
    }
}
