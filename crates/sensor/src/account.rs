//! Where the charge of a frame went.

/// Sums over the array, e⁻: `generated` = `collected` + `drained` + `spilt` + `clipped`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChargeAccount {
    /// Charge before the full well.
    pub generated_e: f64,
    /// Charge that pixels hold afterwards.
    pub collected_e: f64,
    /// Charge that the overflow drains took.
    pub drained_e: f64,
    /// Charge that left the array at its edge.
    pub spilt_e: f64,
    /// Charge that had nowhere to go.
    pub clipped_e: f64,
}

impl ChargeAccount {
    /// What is missing in the balance, e⁻.
    #[must_use]
    pub fn imbalance_e(&self) -> f64 {
        self.generated_e - self.collected_e - self.drained_e - self.spilt_e - self.clipped_e
    }
}
