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

/// Charge of a row at the full well, e⁻.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RowTally {
    pub(crate) generated_e: f64,
    pub(crate) collected_e: f64,
    pub(crate) clipped_e: f64,
}

impl ChargeAccount {
    /// The sums over rows, in their order.
    pub(crate) fn of_rows(rows: &[RowTally]) -> Self {
        let sum = |of: fn(&RowTally) -> f64| rows.iter().map(of).sum();
        Self {
            generated_e: sum(|row| row.generated_e),
            collected_e: sum(|row| row.collected_e),
            clipped_e: sum(|row| row.clipped_e),
            ..Self::default()
        }
    }

    /// What is missing in the balance, e⁻.
    #[must_use]
    pub fn imbalance_e(&self) -> f64 {
        self.generated_e - self.collected_e - self.drained_e - self.spilt_e - self.clipped_e
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::ChargeAccount;
    use etendue_core::Plane;
    use etendue_core::quantity::Charge;

    /// What an effect that moves charge makes of a plane, and the account of it.
    pub(crate) fn accounted(
        plane: &Plane<Charge>,
        effect: impl Fn(&mut Plane<Charge>, &mut ChargeAccount),
    ) -> (Plane<Charge>, ChargeAccount) {
        let sum = |p: &Plane<Charge>| p.samples().iter().map(|q| f64::from(*q)).sum::<f64>();
        let mut out = plane.clone();
        let mut account = ChargeAccount { generated_e: sum(plane), ..ChargeAccount::default() };
        effect(&mut out, &mut account);
        account.collected_e = sum(&out);
        (out, account)
    }
}
