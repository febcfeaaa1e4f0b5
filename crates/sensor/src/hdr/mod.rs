//! High dynamic range: several captures of one frame, merged, and put into fewer bits.
//!
//! A capture may differ from the first in its time, in the sensitivity of its photodiode, and in its conversion gain:
//!
//! | way | what differs |
//! | --- | --- |
//! | multiple exposures | time |
//! | split pixel | sensitivity, full well |
//! | dual conversion gain | gain and read noise; the same charge is read again |
//!
//! and these may be combined (a split pixel read at two gains each is four captures). Captures see the same light, each with its
//! own shot and read noise; a second reading has its own read noise only. Captures are listed by falling sensitivity.
//!
//! - [`merge`]: the first capture that is not saturated, scaled ([`merge`](mod@merge)).
//! - [`companding`]: fewer bits by straight lines ([`companding`](mod@companding)).
//!
//! Left out: motion between captures, dark current that differs by photodiode, leakage between photodiodes.

pub mod companding;
pub mod merge;

use crate::check::Checks;
use crate::effects::response::Response;
use crate::effects::{NOT_DESCRIBED, Verdict};
use crate::operation::Operation;
use crate::parameters::SensorParameters;
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
    /// Whether it reads the charge of the capture before it once more.
    pub dual_conversion_gain: bool,
}

/// The first capture once more.
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

/// Several captures a frame, and fewer bits by a curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HighDynamicRange {
    /// Captures after the first.
    pub captures: Vec<Capture>,
    /// Share of a capture's range above which the next one is taken, (0, 1); `None`: 0.9.
    pub transition_level: Option<f64>,
    /// Bits of the merged number, the converter's to 24; `None` without captures.
    pub bits: Option<u32>,
    /// Fewer bits by a curve.
    pub companding: Option<Companding>,
}

impl Capture {
    /// Numbers of the first capture a number of this one.
    #[must_use]
    pub fn scale(&self) -> f64 {
        1.0 / (self.exposure_ratio * self.sensitivity_ratio * self.gain_ratio)
    }

    /// How this capture is taken, where `first` is how the first one is.
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
        checks.share_above_0("hdr.captures.exposure_ratio", self.exposure_ratio);
        checks.share_above_0("hdr.captures.sensitivity_ratio", self.sensitivity_ratio);
        checks.share_above_0("hdr.captures.gain_ratio", self.gain_ratio);
        if let Some(e) = self.full_well_e {
            checks.positive("hdr.captures.full_well_e", e);
        }
        if let Some(e) = self.read_noise_e {
            checks.not_negative("hdr.captures.read_noise_e", e);
        }
        let read_only = self.exposure_ratio == 1.0 && self.sensitivity_ratio == 1.0 && self.full_well_e.is_none();
        checks.agree("hdr.captures.dual_conversion_gain", !self.dual_conversion_gain || read_only, || {
            format!("entry {number} (from 0): charge that is read again has the exposure, photodiode and full well it had: remove those, or \"dual_conversion_gain\"")
        });
    }
}

impl HighDynamicRange {
    /// The share of a capture's range above which the next one is taken.
    pub(crate) fn switch(&self) -> f64 {
        self.transition_level.unwrap_or(0.9)
    }

    /// Numbers of the first capture a number of capture `k`; a second reading is relative to the charge it reads.
    pub(crate) fn scale(&self, k: usize) -> f64 {
        match k.checked_sub(1) {
            None => 1.0,
            Some(i) if self.captures[i].dual_conversion_gain => self.charge_scale(i) / self.captures[i].gain_ratio,
            Some(i) => self.captures[i].scale(),
        }
    }

    /// The scale, but for the gain, of the charge that capture `k` holds.
    fn charge_scale(&self, k: usize) -> f64 {
        match k.checked_sub(1).map(|i| &self.captures[i]) {
            None => 1.0,
            Some(c) if c.dual_conversion_gain => self.charge_scale(k - 1),
            Some(c) => 1.0 / (c.exposure_ratio * c.sensitivity_ratio),
        }
    }

    /// How all captures are taken.
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

    /// Merged white level, DN, where the first capture is `first`.
    pub(crate) fn white_level_dn(&self, p: &SensorParameters, first: Operation) -> f64 {
        let last = self.captures.len();
        p.read_out.black_level_dn + self.range_dn(p, last, &self.operations(first)[last])
    }

    /// Merged numbers from black to where capture `k` is saturated.
    fn range_dn(&self, p: &SensorParameters, k: usize, operation: &Operation) -> f64 {
        self.scale(k) * (p.capture_white_dn(operation) - p.read_out.black_level_dn)
    }

    pub(crate) fn check(&self, p: &SensorParameters, checks: &mut Checks) {
        self.captures.iter().enumerate().for_each(|(i, capture)| capture.check(i, checks));
        if let Some(share) = self.transition_level {
            checks.legal("hdr.transition_level", share, share > 0.0 && share < 1.0, "a share between 0 and 1");
            checks.agree("hdr.transition_level", !self.captures.is_empty(), || {
                "there are no captures to switch between".to_owned()
            });
        }
        self.check_captures(p, checks);
        if checks.errors.is_empty() {
            self.check_bits(p, checks);
        }
        if let Some(companding) = &self.companding {
            companding.check(self.bits.unwrap_or(p.read_out.bits), checks);
        }
    }

    /// Whether captures can be taken and merged together.
    fn check_captures(&self, p: &SensorParameters, checks: &mut Checks) {
        let linear = p.read_out.response == Response::Linear;
        checks.agree("hdr.captures", linear || self.captures.is_empty(), || {
            "captures are merged in proportion to the light, which \"response\" bends: remove one of both".to_owned()
        });
        let operations = self.operations(Operation::described(p));
        for (k, pair) in operations.windows(2).enumerate() {
            let same = self.scale(k + 1) == self.scale(k) && pair[1].full_well_e == pair[0].full_well_e;
            checks.agree("hdr.captures", !same, || {
                format!("entry {k} (from 0) reaches no further than the capture before it and is never used: remove it")
            });
        }
        if let Some(period_s) = p.exposure.frame_period_s {
            let sum_s = self.longest_s(p.exposure.exposure_s);
            checks.agree("hdr.captures", sum_s <= period_s, || {
                format!("the exposures of a photodiode follow each other and take {sum_s} s together, more than frame_period_s, {period_s} s")
            });
        }
    }

    /// The time that the exposures of one photodiode take one after the other, s, the greatest of all photodiodes; those of one
    /// sensitivity are of one photodiode.
    fn longest_s(&self, exposure_s: f64) -> f64 {
        let exposed =
            self.captures.iter().filter(|c| !c.dual_conversion_gain).map(|c| (c.sensitivity_ratio, c.exposure_ratio));
        let all: Vec<(f64, f64)> = core::iter::once((1.0, 1.0)).chain(exposed).collect();
        let sum = |sensitivity: f64| all.iter().filter(|(s, _)| *s == sensitivity).map(|(_, share)| share).sum::<f64>();
        exposure_s * all.iter().map(|(sensitivity, _)| sum(*sensitivity)).fold(0.0, f64::max)
    }

    fn check_bits(&self, p: &SensorParameters, checks: &mut Checks) {
        let Some(bits) = self.bits else {
            checks.agree("hdr.merged_bits", self.captures.is_empty(), || {
                "several captures need \"merged_bits\"".to_owned()
            });
            return;
        };
        checks.agree("hdr.merged_bits", !self.captures.is_empty(), || {
            "there are no captures to merge: remove it".to_owned()
        });
        let legal = (p.read_out.bits..=24).contains(&bits);
        checks.legal("hdr.merged_bits", f64::from(bits), legal, "a whole number from the converter's bits to 24");
        let more_sensitive = (1..=self.captures.len()).find(|k| self.scale(*k) < self.scale(*k - 1));
        checks.agree("hdr.captures", more_sensitive.is_none(), || {
            let number = more_sensitive.unwrap_or(1) - 1;
            format!(
                "entry {number} (from 0) is more sensitive than the one before it: list them by falling sensitivity"
            )
        });
        self.check_ranges(p, checks);
        if checks.errors.is_empty() {
            let white = self.white_level_dn(p, Operation::described(p));
            checks.agree("hdr.merged_bits", white < f64::from(1_u32 << bits), || {
                format!("the merged range reaches {white:.0} DN, and {bits} bits end at {}: give more bits or fewer captures", (1_u32 << bits) - 1)
            });
        }
    }

    /// Each capture has to reach beyond what the one before is used for. At a larger gain, where the converter ends before the
    /// well, it does so all the more.
    fn check_ranges(&self, p: &SensorParameters, checks: &mut Checks) {
        let operations = self.operations(Operation::base(p, p.least_point()));
        let ranges: Vec<f64> = (0..).zip(&operations).map(|(k, operation)| self.range_dn(p, k, operation)).collect();
        for (k, pair) in ranges.windows(2).enumerate() {
            let used = self.switch() * pair[0];
            checks.agree("hdr.captures", pair[1] > used, || {
                format!(
                    "entry {k} (from 0) is saturated {:.0} merged DN above black, and the one before it is used up to {used:.0}: give it \
                     a larger \"full_well_e\" or a smaller share",
                    pair[1]
                )
            });
        }
    }
}

pub(crate) fn need_merge(p: &SensorParameters) -> (Verdict, String) {
    let hdr = &p.hdr;
    let Some(bits) = hdr.bits else { return (Verdict::Skipped, NOT_DESCRIBED.into()) };
    let scales: Vec<String> = (0..=hdr.captures.len()).map(|k| format!("{}", hdr.scale(k))).collect();
    let switch = hdr.switch();
    (
        Verdict::Required,
        format!(
            "{} captures of scales {}, each used up to {switch} of its range, merged to {bits} bits",
            scales.len(),
            scales.join(", ")
        ),
    )
}

pub(crate) fn need_companding(p: &SensorParameters) -> (Verdict, String) {
    match &p.hdr.companding {
        None => (Verdict::Skipped, NOT_DESCRIBED.into()),
        Some(c) => (Verdict::Required, format!("{} straight lines to {} bits", c.knees.len(), c.bits)),
    }
}
