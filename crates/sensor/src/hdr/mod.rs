//! High dynamic range: several captures of one frame, merged and companded to fewer bits.
//!
//! A capture may differ from the first in its time, in the sensitivity of its photodiode, and in its conversion gain:
//!
//! | method | difference |
//! | --- | --- |
//! | multiple exposures | time |
//! | split pixel | sensitivity, full well |
//! | dual conversion gain | gain and read noise; the same charge is read again |
//!
//! These may be combined (a split pixel read at two gains each is four captures). Captures see the same light, each with its own shot and read noise;
//! a second reading has its own read noise only. Captures are listed by decreasing sensitivity.
//!
//! - [`merge`]: the first capture that is not saturated, scaled ([`merge`](mod@merge)).
//! - [`companding`]: fewer bits by straight lines ([`companding`](mod@companding)).
//!
//! Left out: motion between captures, dark current that differs by photodiode, leakage between photodiodes.

pub mod companding;
pub mod merge;

use etendue_core::{EffectStatus, KeyChange};

use crate::effect::{Effect, SensorFacts};
use crate::{capture::Operation, check::Checks};
use companding::Companding;

/// A capture after the first, relative to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capture {
    /// Its exposure time over the first's, (0, 1].
    pub exposure_ratio: f64,
    /// Its photodiode's sensitivity over the first's, (0, 1].
    pub sensitivity_ratio: f64,
    /// Its conversion gain over the first's, (0, 1].
    pub gain_ratio: f64,
    /// Its full well, e⁻; `None`: the first's.
    pub full_well_e: Option<f64>,
    /// Its read noise, e⁻; `None`: the first's.
    pub read_noise_e: Option<f64>,
    /// True if it reads the charge of the previous capture again.
    pub dual_conversion_gain: bool,
}

/// Equal to the first capture.
impl Default for Capture {
    fn default() -> Self {
        Self {
            exposure_ratio: 1.0,
            sensitivity_ratio: 1.0,
            gain_ratio: 1.0,
            full_well_e: None,
            read_noise_e: None,
            dual_conversion_gain: false,
        }
    }
}

/// Several captures per frame, and fewer bits by a curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HighDynamicRange {
    /// Captures after the first.
    pub captures: Vec<Capture>,
    /// Fraction of a capture's range above which the next one is used, (0, 1); `None`: 0.9.
    pub transition_level: Option<f64>,
    /// Bits of the merged number, from the ADC's to 24; `None` without captures.
    pub bits: Option<u32>,
    /// Companding to fewer bits.
    pub companding: Option<Companding>,
}

impl Capture {
    /// Numbers of the first capture per number of this one.
    #[must_use]
    pub fn scale(&self) -> f64 {
        1.0 / (self.exposure_ratio * self.sensitivity_ratio * self.gain_ratio)
    }

    /// The operation of this capture, given that of the `first`.
    pub(crate) fn operation(&self, first: &Operation) -> Operation {
        Operation {
            exposure_s: first.exposure_s * self.exposure_ratio,
            light: first.light * self.exposure_ratio * self.sensitivity_ratio,
            full_well_e: self.full_well_e.unwrap_or(first.full_well_e),
            gain_dn_e: first.gain_dn_e * self.gain_ratio,
            read_noise_e: self.read_noise_e.unwrap_or(first.read_noise_e),
        }
    }

    fn check(&self, number: usize, checks: &mut Checks) {
        checks.fraction_above_0("hdr.captures.exposure_ratio", self.exposure_ratio);
        checks.fraction_above_0("hdr.captures.sensitivity_ratio", self.sensitivity_ratio);
        checks.fraction_above_0("hdr.captures.gain_ratio", self.gain_ratio);
        if let Some(e) = self.full_well_e {
            checks.positive("hdr.captures.full_well_e", e);
        }
        if let Some(e) = self.read_noise_e {
            checks.not_negative("hdr.captures.read_noise_e", e);
        }
        let read_only = self.exposure_ratio == 1.0 && self.sensitivity_ratio == 1.0 && self.full_well_e.is_none();
        checks.agree("hdr.captures.dual_conversion_gain", !self.dual_conversion_gain || read_only, || {
            format!("entry {number} (from 0): the second readout of a charge has the exposure, photodiode and full well of the first: remove these keys, or \
                     \"dual_conversion_gain\"")
        });
    }
}

impl HighDynamicRange {
    /// The fraction of a capture's range above which the next one is used.
    pub(crate) fn transition_level_or_default(&self) -> f64 {
        self.transition_level.unwrap_or(0.9)
    }

    /// Numbers of the first capture per number of capture `k`; a second reading is relative to the charge it reads.
    pub(crate) fn scale(&self, k: usize) -> f64 {
        match k.checked_sub(1) {
            None => 1.0,
            Some(i) if self.captures[i].dual_conversion_gain => self.charge_scale(i) / self.captures[i].gain_ratio,
            Some(i) => self.captures[i].scale(),
        }
    }

    /// The scale, without the gain, of the charge that capture `k` holds.
    fn charge_scale(&self, k: usize) -> f64 {
        match k.checked_sub(1).map(|i| &self.captures[i]) {
            None => 1.0,
            Some(c) if c.dual_conversion_gain => self.charge_scale(k - 1),
            Some(c) => 1.0 / (c.exposure_ratio * c.sensitivity_ratio),
        }
    }

    /// The operations of all captures.
    pub(crate) fn operations(&self, first: Operation) -> Vec<Operation> {
        let mut all = vec![first];
        for capture in &self.captures {
            let own = capture.operation(&first);
            let before = all[all.len() - 1];
            all.push(match capture.dual_conversion_gain {
                false => own,
                true => Operation { gain_dn_e: own.gain_dn_e, read_noise_e: own.read_noise_e, ..before },
            });
        }
        all
    }

    /// Refuses captures that are illegal individually.
    pub(crate) fn check_each(&self, checks: &mut Checks) {
        self.captures.iter().enumerate().for_each(|(i, capture)| capture.check(i, checks));
        if let Some(level) = self.transition_level {
            checks.legal("hdr.transition_level", level, level > 0.0 && level < 1.0, "a fraction between 0 and 1");
            checks.agree("hdr.transition_level", !self.captures.is_empty(), || {
                "there are no captures to switch between: remove it, or add captures".to_owned()
            });
        }
    }
}

impl Effect for HighDynamicRange {
    const NAME: &'static str = "HDR merging";
    const KEY: &'static str = "sensor.hdr";

    /// Captures are checked with the whole sensor, once its own values are legal.
    fn check(&self, _: &SensorFacts, _: &mut Checks) {}

    fn status(&self, _: &SensorFacts, _: &Operation) -> EffectStatus {
        let Some(bits) = self.bits else { return EffectStatus::NotDescribed };
        let scales: Vec<String> = (0..=self.captures.len()).map(|k| format!("{}", self.scale(k))).collect();
        EffectStatus::Modelled(format!(
            "{} captures with relative signals {}, each used up to {} of its range, merged to {bits} bits",
            scales.len(),
            scales.join(", "),
            self.transition_level_or_default()
        ))
    }

    fn left_out_by(&self) -> Vec<KeyChange> {
        let companding = self.companding.as_ref().map(|_| KeyChange::removed(Companding::KEY));
        std::iter::once(KeyChange::removed(Self::KEY)).chain(companding).collect()
    }
}
