//! Lengths as they are stated: known to their last digit.

use etendue_metrology::Estimate;

/// A length above 0 and the unit of its last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatedLength {
    /// The length.
    pub value: f64,
    /// What its last digit counts; 0 where it is exact.
    pub digit: f64,
}

impl StatedLength {
    /// Rounded to its last digit: anywhere within half of it either way (GUM, JCGM 100:2008, F.2.2.1).
    #[must_use]
    pub fn rounded(self) -> Estimate {
        Estimate::new(self.value, self.digit / 12_f64.sqrt())
    }
}
