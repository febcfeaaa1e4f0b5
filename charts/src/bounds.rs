//! What the bench must show: how far what is recovered may be from what is declared.

/// A bound on one kind of quantity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bound {
    /// The largest error.
    pub(crate) largest: f64,
    /// Of the error.
    pub(crate) unit: &'static str,
    /// Whether three standard uncertainties are enough where they are more.
    pub(crate) allows_three_u: bool,
}

const fn within(largest: f64, unit: &'static str) -> Bound {
    Bound { largest, unit, allows_three_u: false }
}

pub(crate) const FOCAL_LENGTH: Bound = within(0.1, "%");
pub(crate) const DISTORTION: Bound = within(0.1, "% of the field");
pub(crate) const VIGNETTING: Bound = within(0.5, "%");
pub(crate) const TONE: Bound = within(0.5, "% of full scale");
pub(crate) const RESPONSE: Bound = within(0.005, "");
/// Gain, quantum efficiency, noise, fixed patterns, dark current.
pub(crate) const ELECTRONICS: Bound = Bound { allows_three_u: true, ..within(1.0, "%") };

impl Bound {
    /// Whether an error (where what is declared is not 0) or an E_n keeps it. E_n has two standard uncertainties for its unit.
    pub(crate) fn holds(&self, error: Option<f64>, e_n: Option<f64>) -> bool {
        error.is_some_and(|e| e.abs() <= self.largest) || (self.allows_three_u && e_n.is_some_and(|e| e.abs() <= 1.5))
    }

    pub(crate) fn text(&self) -> String {
        format!("{}{}{}", self.largest, unit(self.unit), if self.allows_three_u { " or 3 u" } else { "" })
    }
}

/// With the space before it, where there is one.
pub(crate) fn unit(name: &str) -> String {
    if name.is_empty() { String::new() } else { format!(" {name}") }
}
