//! The state of a spec under its preload, and warnings about it in the words of the file.

use std::sync::Arc;

use fea::{CriticalFactor, PreloadedState};

use super::structure::{Form, Spec};

/// Factor on a preload below which the second order should not be neglected.
pub const SMALL_FACTOR: f64 = 10.0;

impl Spec {
    /// The state under the preload; `None` without one.
    ///
    /// # Errors
    /// As [`fea::preloaded`], and those of [`Spec::model`].
    pub fn preloaded(&self) -> Result<Option<Arc<PreloadedState>>, fea::Error> {
        let Some(preload) = &self.preload else {
            return Ok(None);
        };
        let (model, rails) = self.unloaded_model()?;
        preload.state(&model, &rails).map(Some)
    }

    /// Warnings about what the state of the preload leaves out, and about a small critical factor.
    pub(super) fn preload_warnings(&self) -> Vec<String> {
        let Ok(Some(state)) = self.preloaded() else {
            return Vec::new();
        };
        let mut all = Vec::new();
        if let CriticalFactor::At(factor, mode) = &state.critical
            && *factor < SMALL_FACTOR
        {
            all.push(format!(
                "the critical factor of the preload ({}) is {factor:.4}, below 10: {}. EN 1993-1-1, 5.2.1(3), then \
                 requires a second-order analysis under the design loads; this factor is for the preloaded state and \
                 axial forces only, without lateral-torsional buckling",
                self.preload_words(),
                self.buckling_words(&mode.most)
            ));
        }
        for caution in &state.cautions {
            let member = self.member_words(caution.member);
            let ratio = format!("{:.2}", caution.ratio);
            all.push(match caution.kind {
                fea::CautionKind::Moments => format!(
                    "{member}: its largest moment under the preload is {ratio} of pi sqrt(EI GJ)/L; lateral-torsional \
                     buckling is not included"
                ),
                fea::CautionKind::Twist => format!(
                    "{member}: N i_p^2/GJ is {ratio} under the preload; the effect of axial forces on torsion is not \
                     included"
                ),
                fea::CautionKind::TrussBuckles => format!(
                    "{member}: its compression under the preload is {ratio} of its Euler load; buckling of trusses \
                     between their ends is not included: define it as a beam with releases"
                ),
                fea::CautionKind::Shear => format!(
                    "{member}: its axial force under the preload is {ratio} of its shear stiffness, for which \
                     theories of columns with shear deformation differ"
                ),
                fea::CautionKind::Slender => format!(
                    "{member}: L sqrt(N/EI) is {:.0} under the preload; the tension is so large that values between \
                     its ends are accurate to only about {:.0} digits; divide it into {:.0} members",
                    caution.ratio,
                    (15.5 - 0.5 * caution.ratio * std::f64::consts::LOG10_E).max(0.0),
                    (caution.ratio / 12.0).ceil()
                ),
            });
        }
        all
    }

    /// The loads of the preload in words.
    fn preload_words(&self) -> String {
        let Some(preload) = &self.preload else {
            return String::new();
        };
        let mut words = Vec::new();
        if preload.weight {
            words.push("self-weight".to_owned());
        }
        match preload.loads.len() {
            0 => {}
            1 => words.push("a force on a point".to_owned()),
            count => words.push(format!("forces on {count} points")),
        }
        if !preload.wheels.is_empty() {
            words.push("wheels at rest".to_owned());
        }
        words.join(", ")
    }

    /// A buckling motion in the words of the file.
    pub(crate) fn buckling_words(&self, most: &fea::Buckling) -> String {
        let member = self.member_words(most.member);
        if most.between_ends {
            format!("{member} buckles between its ends")
        } else {
            format!(
                "{} moves in {}, due to the axial force of {member}",
                self.point_words(most.point),
                most.dof
            )
        }
    }

    /// A member in the words of the file.
    #[must_use]
    pub fn member_words(&self, member: usize) -> String {
        match &self.form {
            Form::Girder(_) => format!("span or overhang {}", member + 1),
            Form::Frame(frame) => match frame.cells.get(member) {
                Some([block, cell]) => format!("cell [{block}, {cell}]"),
                None => "a tie".to_owned(),
            },
        }
    }
}
