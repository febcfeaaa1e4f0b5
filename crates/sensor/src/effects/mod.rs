//! Charge effects and the converter, in physical order.
//!
//! Each member says whether a sensor needs it and why (`need`), and acts on a row of pixels (`apply`). What is not needed
//! is absent: a strength of zero is never run.
//!
//! | order | effect | on |
//! | --- | --- | --- |
//! | 1 | [shot noise](shot_noise) | mean electrons → collected electrons |
//! | 2 | [dark current](dark_current) | adds its own electrons |
//! | 3 | [full well](full_well) | clips |
//! | 4 | [read noise](read_noise) | adds electrons' worth of volts |
//! | 5 | [converter] | gain, black level, rounding, range → DN |
//!
//! Shot noise and dark current commute: both are independent counts that are added.

pub mod converter;
pub mod dark_current;
pub mod full_well;
pub mod read_noise;
pub mod shot_noise;

use crate::sensor::SensorParameters;
use crate::step::FrameAddress;
use converter::Converter;
use dark_current::DarkCurrent;
use full_well::FullWell;
use read_noise::ReadNoise;
use shot_noise::ShotNoise;

/// The effects a sensor can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Fluctuation of the number of photo-electrons.
    ShotNoise,
    /// Electrons without light.
    DarkCurrent,
    /// The most electrons a pixel holds.
    FullWell,
    /// Noise of the read-out chain.
    ReadNoise,
    /// Gain, black level, rounding and range.
    Converter,
}

impl Effect {
    /// All effects, in physical order.
    pub const ALL: [Self; 5] = [Self::ShotNoise, Self::DarkCurrent, Self::FullWell, Self::ReadNoise, Self::Converter];

    /// The effect's name in a plan.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ShotNoise => "shot noise",
            Self::DarkCurrent => "dark current",
            Self::FullWell => "full well",
            Self::ReadNoise => "read noise",
            Self::Converter => "converter",
        }
    }

    fn need(self, p: &SensorParameters) -> (Verdict, String) {
        match self {
            Self::ShotNoise => shot_noise::need(p),
            Self::DarkCurrent => dark_current::need(p),
            Self::FullWell => full_well::need(p),
            Self::ReadNoise => read_noise::need(p),
            Self::Converter => converter::need(p),
        }
    }
}

/// Whether an effect is modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Always run.
    Required,
    /// A cheap test of the data decides.
    Guarded,
    /// Absent.
    Skipped,
}

/// What a plan says about an effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// The effect.
    pub effect: Effect,
    /// Whether it is modelled.
    pub verdict: Verdict,
    /// Why, in words.
    pub reason: String,
}

/// The needs of a sensor, in physical order.
#[must_use]
pub(crate) fn needs(p: &SensorParameters) -> Vec<Need> {
    let need = |effect: Effect| {
        let (verdict, reason) = effect.need(p);
        Need { effect, verdict, reason }
    };
    Effect::ALL.into_iter().map(need).collect()
}

/// Where a row of pixels is, for its random addresses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) address: FrameAddress,
    pub(crate) y: u32,
}

/// An effect on charge, prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ChargeEffect {
    ShotNoise(ShotNoise),
    DarkCurrent(DarkCurrent),
    FullWell(FullWell),
    ReadNoise(ReadNoise),
}

impl ChargeEffect {
    pub(crate) fn apply(&self, electrons: &mut [f64], row: Row) {
        match self {
            Self::ShotNoise(effect) => effect.apply(electrons, row),
            Self::DarkCurrent(effect) => effect.apply(electrons, row),
            Self::FullWell(effect) => effect.apply(electrons),
            Self::ReadNoise(effect) => effect.apply(electrons, row),
        }
    }
}

/// The needed effects of a sensor: those on charge in physical order, then the converter.
pub(crate) fn chain(p: &SensorParameters) -> (Vec<ChargeEffect>, Converter) {
    let needed = Effect::ALL.into_iter().filter(|e| e.need(p).0 != Verdict::Skipped);
    let charge = needed.filter_map(|effect| match effect {
        Effect::ShotNoise => Some(ChargeEffect::ShotNoise(ShotNoise)),
        Effect::DarkCurrent => Some(ChargeEffect::DarkCurrent(DarkCurrent::new(p))),
        Effect::FullWell => Some(ChargeEffect::FullWell(FullWell::new(p))),
        Effect::ReadNoise => Some(ChargeEffect::ReadNoise(ReadNoise::new(p))),
        Effect::Converter => None,
    });
    (charge.collect(), Converter::new(p))
}

/// Why randomness is absent.
const NOISE_OFF: &str = "noise is switched off for this sensor";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::tests::ideal;

    #[test]
    fn what_has_no_strength_is_absent_and_says_why() {
        let mut p = ideal();
        p.noise = false;
        let verdicts: Vec<_> = needs(&p).iter().map(|n| n.verdict).collect();
        use Verdict::{Guarded, Required, Skipped};
        assert_eq!(verdicts, [Skipped, Skipped, Guarded, Skipped, Required]);
        assert!(needs(&p).iter().all(|n| !n.reason.is_empty()));
        assert_eq!(chain(&p).0.len(), 1);
        p.noise = true;
        p.dark_current_e_s = 3.0;
        assert_eq!(chain(&p).0.len(), 4);
        p.exposure_s = 0.0;
        p.read_noise_e = 0.0;
        let kept: Vec<_> = needs(&p).into_iter().filter(|n| n.verdict != Skipped).map(|n| n.effect.name()).collect();
        assert_eq!(kept, ["full well", "converter"]);
    }
}
