//! What a description says about the pupils of a thick lens.
//!
//! Both pupils are images of one stop, so each is the image of the other and one statement fixes all (`thick.rs`).

use crate::error::OpticsError;
use crate::range::finite;

/// Statements about the pupils: none (pupils in the principal planes), one, or several that agree.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PupilStatements {
    /// Position of the entrance pupil, mm.
    pub entrance_pupil_mm: Option<f64>,
    /// Position of the exit pupil, mm.
    pub exit_pupil_mm: Option<f64>,
    /// Exit over entrance diameter.
    pub pupil_magnification: Option<f64>,
}

/// How far two statements of the pupil magnification may part, relative.
const PUPIL_AGREEMENT: f64 = 1e-6;

impl PupilStatements {
    /// The pupil magnification that the statements mean; 1 where there is none.
    pub(super) fn magnification(&self, focal_mm: f64, separation_mm: f64) -> Result<f64, OpticsError> {
        let position = |m: f64| separation_mm + focal_mm * (1.0 - m);
        let entrance = self.entrance_pupil_mm.map(|p| ("entrance_pupil_mm", p, focal_mm / (focal_mm + p)));
        let exit = self.exit_pupil_mm.map(|q| ("exit_pupil_mm", q, 1.0 - (q - separation_mm) / focal_mm));
        let ratio = self.pupil_magnification.map(|m| ("pupil_magnification", m, m));
        let mut stated = [entrance, exit, ratio].into_iter().flatten();
        let Some((first, first_value, m)) = stated.next() else { return Ok(1.0) };
        positive_magnification(first, first_value, m)?;
        for (second, second_value, other) in stated {
            positive_magnification(second, second_value, other)?;
            if (other / m - 1.0).abs() > PUPIL_AGREEMENT {
                let expected = if second == "exit_pupil_mm" { position(m) } else { m };
                return Err(OpticsError::Pupils { first, first_value, second, second_value, expected });
            }
        }
        Ok(m)
    }
}

fn positive_magnification(name: &'static str, value: f64, magnification: f64) -> Result<(), OpticsError> {
    finite(name, value)?;
    if magnification.is_finite() && magnification > 0.0 {
        return Ok(());
    }
    Err(OpticsError::PupilBeyondFocus { name, value, magnification })
}
