//! Names of the points at which the ground supports a structure.

use fea::{Dof, Model};

use super::structure::{Form, Spec};
use super::words::DOF_WORDS;

/// A point restrained by supports or springs.
#[derive(Clone, Debug, PartialEq)]
pub struct SupportedPoint {
    /// Index of the point.
    pub point: usize,
    /// Its name. The points of a girder are `support1`, `support2`, ... along it. A point of the general form has the
    /// name of its point set, followed by a number if the set has several points; without a set it is `point<index>`.
    pub name: String,
    /// The restrained degrees of freedom, each once, in the order ux, uy, uz, rx, ry, rz.
    pub dofs: Vec<Dof>,
}

impl Spec {
    /// All points restrained by the ground: for a girder along it, otherwise in the order of the file, supports
    /// first.
    ///
    /// `model` is that of [`Spec::model`].
    #[must_use]
    pub fn supported_points(&self, model: &Model) -> Vec<SupportedPoint> {
        let mut all: Vec<SupportedPoint> = Vec::new();
        let supports = model.supports.iter().flat_map(|support| {
            let fixed = Dof::ALL
                .into_iter()
                .filter(|dof| support.fixed[*dof as usize]);
            fixed.map(|dof| (support.point, dof))
        });
        let springs = model
            .springs
            .iter()
            .map(|spring| (spring.point, spring.dof));
        for (point, dof) in supports.chain(springs) {
            match all.iter_mut().find(|ground| ground.point == point) {
                Some(ground) if ground.dofs.contains(&dof) => {}
                Some(ground) => ground.dofs.push(dof),
                None => all.push(SupportedPoint {
                    point,
                    name: String::new(),
                    dofs: vec![dof],
                }),
            }
        }
        if let Form::Girder(_) = self.form {
            all.sort_by(|a, b| model.points[a.point][0].total_cmp(&model.points[b.point][0]));
        }
        for index in 0..all.len() {
            let name = self.ground_name(all[index].point, index);
            let taken = all[..index].iter().any(|ground| ground.name == name);
            all[index].name = if taken {
                format!("point{}", all[index].point)
            } else {
                name
            };
            all[index].dofs.sort();
        }
        all
    }

    /// Name of a point. `index` is its position among the supported points.
    fn ground_name(&self, point: usize, index: usize) -> String {
        let Form::Frame(frame) = &self.form else {
            return format!("support{}", index + 1);
        };
        let is_plain = |name: &str| {
            !name.is_empty()
                && name
                    .chars()
                    .all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ' '))
        };
        let sets = || {
            frame
                .point_sets
                .iter()
                .filter(|(name, points)| is_plain(name) && points.contains(&point))
        };
        // a set that contains only this point is the most specific name
        let set = sets()
            .find(|(_, points)| points.len() == 1)
            .or_else(|| sets().next());
        match set {
            Some((name, points)) if points.len() == 1 => name.clone(),
            Some((name, points)) => {
                let number = points
                    .iter()
                    .position(|known| *known == point)
                    .map_or(1, |at| at + 1);
                format!("{name}{number}")
            }
            None => format!("point{point}"),
        }
    }

    /// The name of a degree of freedom in column names. For a girder, `longitudinal`, `vertical`, `lateral` and
    /// `twist` replace `ux`, `uy`, `uz` and `rx`.
    #[must_use]
    pub fn dof_word(&self, dof: Dof) -> &'static str {
        match (&self.form, dof) {
            (Form::Girder(_), Dof::Ux) => "longitudinal",
            (Form::Girder(_), Dof::Uy) => "vertical",
            (Form::Girder(_), Dof::Uz) => "lateral",
            (Form::Girder(_), Dof::Rx) => "twist",
            _ => DOF_WORDS
                .iter()
                .find(|(_, known)| *known == dof)
                .map_or("", |(word, _)| word),
        }
    }
}
