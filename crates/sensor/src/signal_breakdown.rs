//! Signal breakdown of each pixel's digital number: one layer per component, in electrons at the ADC input.
//!
//! Every effect's layer is its change of the pixel (negative where it removed charge). Their sum is the digital number less the black level, over the
//! gain. The layers are recorded with the raw and never change it. For several captures they are those of the capture from which the pixel's number
//! was taken, in electrons of the first; companding comes after them.

use etendue_core::Plane;
use etendue_core::quantity::{Quantity, SignalPart};

/// A component of a pixel's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalComponent {
    /// The mean electrons of the light.
    Signal,
    /// Photon shot noise (smear's included).
    Shot,
    /// Dark electrons: their mean, their shot noise, hot pixels and random telegraph signals.
    Dark,
    /// Read noise of all kinds.
    Read,
    /// Photo-response and offset non-uniformity, dead pixels.
    FixedPattern,
    /// Rounding, digital gain and the ADC's limit.
    Quantisation,
    /// Charge removed by the full well or added by overflow.
    Blooming,
    /// Mean electrons collected during charge transfer.
    Smear,
    /// Crosstalk, angle response, lag, brighter-fatter, response, capacitance.
    Transfer,
    /// 1 where the digital number is at the white level, else 0. Not part of the sum.
    Saturated,
}

impl SignalComponent {
    /// All components.
    pub const ALL: [Self; 10] = [
        Self::Signal,
        Self::Shot,
        Self::Dark,
        Self::Read,
        Self::FixedPattern,
        Self::Quantisation,
        Self::Blooming,
        Self::Smear,
        Self::Transfer,
        Self::Saturated,
    ];

    /// The layer's name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Signal => "signal",
            Self::Shot => "shot",
            Self::Dark => "dark",
            Self::Read => "read",
            Self::FixedPattern => "fixed_pattern",
            Self::Quantisation => "quantisation",
            Self::Blooming => "blooming",
            Self::Smear => "smear",
            Self::Transfer => "transfer",
            Self::Saturated => "saturated",
        }
    }
}

/// The layers of a raw image.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalBreakdown {
    layers: Vec<Plane<SignalPart>>,
}

impl SignalBreakdown {
    pub(crate) fn new(width: usize, height: usize) -> Self {
        Self { layers: SignalComponent::ALL.iter().map(|_| Plane::new(width, height)).collect() }
    }

    /// The layer of a component.
    #[must_use]
    pub fn layer(&self, component: SignalComponent) -> &Plane<SignalPart> {
        &self.layers[component as usize]
    }

    /// Adds the difference of a plane after and before an effect.
    pub(crate) fn add_change<Q: Quantity<Sample = f32>>(
        &mut self,
        component: SignalComponent,
        before: &Plane<Q>,
        after: &Plane<Q>,
    ) {
        let pairs = before.samples().iter().zip(after.samples());
        for (layer, (before, after)) in self.layers[component as usize].samples_mut().iter_mut().zip(pairs) {
            *layer += after - before;
        }
    }

    /// Replaces the layers of some pixels by those of another capture, times a factor.
    pub(crate) fn replace(&mut self, pixels: &[bool], by: &Self, factor: f64) {
        for (component, (own, by)) in SignalComponent::ALL.into_iter().zip(self.layers.iter_mut().zip(&by.layers)) {
            let factor = if component == SignalComponent::Saturated { 1.0 } else { factor };
            for ((own, by), _) in own.samples_mut().iter_mut().zip(by.samples()).zip(pixels).filter(|(_, here)| **here)
            {
                *own = (factor * f64::from(*by)) as f32;
            }
        }
    }

    /// The same, of planes of another layout.
    pub(crate) fn mapped(self, f: impl Fn(&Plane<SignalPart>) -> Plane<SignalPart>) -> Self {
        Self { layers: self.layers.iter().map(f).collect() }
    }

    /// The rows of all layers.
    pub(crate) fn rows(&mut self) -> Vec<SignalComponentRow<'_>> {
        let (width, height) = (self.layers[0].width(), self.layers[0].height());
        let mut rows: Vec<SignalComponentRow<'_>> =
            (0..height).map(|_| SignalComponentRow { layers: Vec::new() }).collect();
        for layer in &mut self.layers {
            let chunks = layer.samples_mut().chunks_mut(width.max(1));
            rows.iter_mut().zip(chunks).for_each(|(row, chunk)| row.layers.push(chunk));
        }
        rows
    }
}

/// One row of all layers.
pub(crate) struct SignalComponentRow<'a> {
    layers: Vec<&'a mut [f32]>,
}

impl SignalComponentRow<'_> {
    /// Adds the difference of a row after and before an effect.
    pub(crate) fn add_change(&mut self, component: SignalComponent, before: &[f64], after: &[f64]) {
        for (layer, (before, after)) in self.layers[component as usize].iter_mut().zip(before.iter().zip(after)) {
            *layer += (after - before) as f32;
        }
    }

    /// Adds to one pixel.
    pub(crate) fn add(&mut self, component: SignalComponent, x: usize, value: f64) {
        self.layers[component as usize][x] += value as f32;
    }
}

/// Sums over the array, e⁻: `generated` = `collected` + `drained` + `spilt` + `clipped`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChargeAccount {
    /// Charge before the full well.
    pub generated_e: f64,
    /// Charge held by pixels afterwards.
    pub collected_e: f64,
    /// Charge removed by the overflow drains.
    pub drained_e: f64,
    /// Charge that left the array at its edge.
    pub spilt_e: f64,
    /// Charge above the well that could not be moved.
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
    pub(crate) fn from_rows(rows: &[RowTally]) -> Self {
        let sum = |of: fn(&RowTally) -> f64| rows.iter().map(of).sum();
        Self {
            generated_e: sum(|row| row.generated_e),
            collected_e: sum(|row| row.collected_e),
            clipped_e: sum(|row| row.clipped_e),
            ..Self::default()
        }
    }

    /// Imbalance, e⁻.
    #[must_use]
    pub fn imbalance_e(&self) -> f64 {
        self.generated_e - self.collected_e - self.drained_e - self.spilt_e - self.clipped_e
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use etendue_core::{Plane, quantity::Charge};

    use super::ChargeAccount;

    /// Applies an effect that moves charge to a plane; returns its account.
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
