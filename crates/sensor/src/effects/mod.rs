//! Effects on charge and the converter, in physical order.
//!
//! Each member says whether a sensor needs it and why (`need`), is prepared for a capture (`new`), and acts (`apply`): on a row
//! of pixels where each is on its own, or on the whole plane where neighbours matter. What is not needed is absent: a
//! strength of zero is never run.
//!
//! | order | effect | on | acts on |
//! | --- | --- | --- | --- |
//! | 1 | [angle response](angle_response) | mean electrons | rows |
//! | 2 | [optical crosstalk](crosstalk) | mean electrons | plane |
//! | 3 | [photo-response non-uniformity](photo_response) | mean electrons | rows |
//! | 4 | [smear] | adds to mean electrons | plane |
//! | 5 | [shot noise](shot_noise) | mean electrons → collected electrons | rows |
//! | 6 | [dark current](dark_current) with its pattern | adds its own electrons | rows |
//! | 7 | [lag] | exchanges charge with traps | plane |
//! | 8 | [brighter-fatter](brighter_fatter) | moves charge | plane |
//! | 9 | [full well](full_well), blooming | cuts and moves charge | rows; plane |
//! | 10 | [dead pixels](dead_pixels) | empties | rows |
//! | 11 | binning of charge ([`layout`](crate::layout)) | adds charge of pixels | plane |
//! | 12 | [response] | charge → voltage | rows |
//! | 13 | [inter-pixel capacitance](inter_pixel_capacitance) | moves voltage | plane |
//! | 14 | [offset non-uniformity](offset_pattern) | adds voltage | rows |
//! | 15 | [read noise](read_noise) | adds voltage | rows |
//! | 16 | [RTS noise](rts_noise) | adds voltage | rows |
//! | 17 | [converter] | gain, black level, rounding, range → DN | rows |
//! | 18 | merging and companding ([`hdr`](crate::hdr)) | DN | plane |
//!
//! Shot noise and dark current commute: both are independent counts that are added.

pub mod angle_response;
pub mod bloom_around;
pub mod bloom_column;
pub mod brighter_fatter;
pub mod converter;
pub mod crosstalk;
pub mod dark_current;
pub mod dead_pixels;
pub mod full_well;
pub mod inter_pixel_capacitance;
pub mod lag;
pub mod neighbours;
pub mod offset_pattern;
pub mod photo_response;
pub mod read_noise;
pub mod response;
pub mod rts_noise;
pub mod shot_noise;
pub mod smear;
pub mod temperature;
pub mod two_level;

pub use etendue_core::Verdict;

use crate::operation::Operation;
use crate::parameters::SensorParameters;
use crate::signal_breakdown::SignalComponent;

/// The effects a sensor can have, in physical order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// What exposure control does to the next frame.
    ExposureControl,
    /// Response of the micro-lenses over the angle.
    AngleResponse,
    /// Light that neighbours exchange.
    Crosstalk,
    /// Differences in response to light.
    PhotoResponse,
    /// Light that charge meets on its way down the column.
    Smear,
    /// Fluctuation of the number of photo-electrons.
    ShotNoise,
    /// Electrons without light.
    DarkCurrent,
    /// Traps that keep charge from frame to frame.
    Lag,
    /// Borders that charge moves.
    BrighterFatter,
    /// The most electrons a pixel holds, and where the rest goes.
    FullWell,
    /// Pixels that hold nothing.
    DeadPixels,
    /// Pixels that are read together, and which are read.
    Layout,
    /// Voltage over charge.
    Response,
    /// Voltage that neighbours exchange.
    InterPixelCapacitance,
    /// Offsets that differ.
    OffsetPattern,
    /// Noise of the read-out chain.
    ReadNoise,
    /// Pixels whose voltage jumps.
    RtsNoise,
    /// Gain, black level, rounding and range.
    Converter,
    /// Several captures become one.
    Merge,
    /// Fewer bits by a curve.
    Companding,
}

impl Effect {
    /// All effects, in physical order.
    pub const ALL: [Self; 20] = [
        Self::ExposureControl,
        Self::AngleResponse,
        Self::Crosstalk,
        Self::PhotoResponse,
        Self::Smear,
        Self::ShotNoise,
        Self::DarkCurrent,
        Self::Lag,
        Self::BrighterFatter,
        Self::FullWell,
        Self::DeadPixels,
        Self::Layout,
        Self::Response,
        Self::InterPixelCapacitance,
        Self::OffsetPattern,
        Self::ReadNoise,
        Self::RtsNoise,
        Self::Converter,
        Self::Merge,
        Self::Companding,
    ];

    /// The effect's name in a plan.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ExposureControl => "exposure control",
            Self::AngleResponse => "angle response",
            Self::Crosstalk => "optical crosstalk",
            Self::PhotoResponse => "photo-response non-uniformity",
            Self::Smear => "smear",
            Self::ShotNoise => "shot noise",
            Self::DarkCurrent => "dark current",
            Self::Lag => "lag",
            Self::BrighterFatter => "brighter-fatter",
            Self::FullWell => "full well",
            Self::DeadPixels => "dead pixels",
            Self::Layout => "region and binning",
            Self::Response => "response",
            Self::InterPixelCapacitance => "inter-pixel capacitance",
            Self::OffsetPattern => "offset non-uniformity",
            Self::ReadNoise => "read noise",
            Self::RtsNoise => "RTS noise",
            Self::Converter => "converter",
            Self::Merge => "merging of captures",
            Self::Companding => "companding",
        }
    }

    /// Whether a capture needs the effect, and why.
    pub(crate) fn need(self, p: &SensorParameters, operation: &Operation) -> (Verdict, String) {
        match self {
            Self::ExposureControl => crate::exposure_control::need(p),
            Self::AngleResponse => angle_response::need(p),
            Self::Crosstalk => crosstalk::need(p),
            Self::PhotoResponse => photo_response::need(p),
            Self::Smear => smear::need(p),
            Self::ShotNoise => shot_noise::need(p, operation),
            Self::DarkCurrent => dark_current::need(p, operation),
            Self::Lag => lag::need(p),
            Self::BrighterFatter => brighter_fatter::need(p),
            Self::FullWell => full_well::need(p, operation),
            Self::DeadPixels => dead_pixels::need(p),
            Self::Layout => crate::layout::need(p),
            Self::Response => response::need(p),
            Self::InterPixelCapacitance => inter_pixel_capacitance::need(p),
            Self::OffsetPattern => offset_pattern::need(p),
            Self::ReadNoise => read_noise::need(p, operation),
            Self::RtsNoise => rts_noise::need(p),
            Self::Converter => converter::need(p, operation),
            Self::Merge => crate::hdr::need_merge(p),
            Self::Companding => crate::hdr::need_companding(p),
        }
    }

    /// Under which cause what the effect adds is noted.
    pub(crate) fn cause(self) -> SignalComponent {
        match self {
            Self::PhotoResponse | Self::DeadPixels | Self::OffsetPattern => SignalComponent::FixedPattern,
            Self::Smear => SignalComponent::Smear,
            Self::ShotNoise => SignalComponent::Shot,
            Self::DarkCurrent => SignalComponent::Dark,
            Self::FullWell => SignalComponent::Blooming,
            Self::ReadNoise | Self::RtsNoise => SignalComponent::Read,
            _ => SignalComponent::Transfer,
        }
    }
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

impl Need {
    /// Whether the description says nothing of the effect.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.reason == NOT_DESCRIBED
    }
}

/// The needs of a sensor, in physical order.
#[must_use]
pub(crate) fn needs(p: &SensorParameters) -> Vec<Need> {
    let operation = Operation::described(p);
    let need = |effect: Effect| {
        let (verdict, reason) = effect.need(p, &operation);
        Need { effect, verdict, reason }
    };
    Effect::ALL.into_iter().map(need).collect()
}

/// Why randomness is absent.
const NOISE_OFF: &str = "noise is switched off for this sensor";
/// Why an effect is absent that the description says nothing of.
pub(crate) const NOT_DESCRIBED: &str = "not described";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::tests::ideal;

    #[test]
    fn what_has_no_strength_is_absent_and_says_why() {
        let mut p = ideal();
        let kept = |p: &SensorParameters| -> Vec<_> {
            let needs = needs(p);
            assert!(needs.iter().all(|n| !n.reason.is_empty()));
            needs.into_iter().filter(|n| n.verdict != Verdict::Skipped).map(|n| n.effect.name()).collect()
        };
        p.noise = false;
        assert_eq!(kept(&p), ["full well", "converter"]);
        p.noise = true;
        p.charge.dark.current_e_s = 3.0;
        assert_eq!(kept(&p), ["shot noise", "dark current", "full well", "read noise", "converter"]);
        p.exposure.exposure_s = 0.0;
        p.read_out.noise.white_e = 0.0;
        assert_eq!(kept(&p), ["full well", "converter"]);
    }
}
