//! Names of the places where the ground holds a structure.

use fea::{Freedom, Model};

use super::frame::FREEDOMS;
use super::{Form, Spec};

/// A point that supports or springs hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// Index of the point.
    pub point: usize,
    /// Its name: of a girder `support1`, counted along it; of a frame that of its point set (with a number where the set
    /// has more points), else `point<index>`.
    pub name: String,
    /// What is held, each once.
    pub freedoms: Vec<Freedom>,
}

impl Spec {
    /// All points that the ground holds; along a girder, else in the order of the file, supports first.
    ///
    /// `model`: that of [`Spec::model`].
    #[must_use]
    pub fn grounds(&self, model: &Model) -> Vec<Ground> {
        let mut all: Vec<Ground> = Vec::new();
        let supports = model.supports.iter().flat_map(|support| {
            let held = Freedom::ALL.into_iter().filter(|freedom| support.fix[*freedom as usize]);
            held.map(|freedom| (support.point, freedom))
        });
        let springs = model.springs.iter().map(|spring| (spring.point, spring.freedom));
        for (point, freedom) in supports.chain(springs) {
            match all.iter_mut().find(|ground| ground.point == point) {
                Some(ground) if ground.freedoms.contains(&freedom) => {}
                Some(ground) => ground.freedoms.push(freedom),
                None => all.push(Ground { point, name: String::new(), freedoms: vec![freedom] }),
            }
        }
        if let Form::Girder(_) = self.form {
            all.sort_by(|a, b| model.points[a.point][0].total_cmp(&model.points[b.point][0]));
        }
        for index in 0..all.len() {
            let name = self.ground_name(all[index].point, index);
            let taken = all[..index].iter().any(|ground| ground.name == name);
            all[index].name = if taken { format!("point{}", all[index].point) } else { name };
            all[index].freedoms.sort();
        }
        all
    }

    fn ground_name(&self, point: usize, index: usize) -> String {
        let Form::Frame(frame) = &self.form else { return format!("support{}", index + 1) };
        let fits = |name: &str| {
            !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ' '))
        };
        let sets = || frame.point_sets.iter().filter(|(name, points)| fits(name) && points.contains(&point));
        // a set of this point alone says most
        let set = sets().find(|(_, points)| points.len() == 1).or_else(|| sets().next());
        match set {
            Some((name, points)) if points.len() == 1 => name.clone(),
            Some((name, points)) => {
                let number = points.iter().position(|known| *known == point).map_or(1, |at| at + 1);
                format!("{name}{number}")
            }
            None => format!("point{point}"),
        }
    }

    /// The word of a held freedom in names of columns: of a girder `longitudinal`, `vertical`, `lateral` and `twist`.
    #[must_use]
    pub fn freedom_word(&self, freedom: Freedom) -> &'static str {
        match (&self.form, freedom) {
            (Form::Girder(_), Freedom::Ux) => "longitudinal",
            (Form::Girder(_), Freedom::Uy) => "vertical",
            (Form::Girder(_), Freedom::Uz) => "lateral",
            (Form::Girder(_), Freedom::Rx) => "twist",
            _ => FREEDOMS.iter().find(|(_, known)| *known == freedom).map_or("", |(word, _)| word),
        }
    }
}
