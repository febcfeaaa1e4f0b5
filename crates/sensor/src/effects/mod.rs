//! The effects of a sensor, by the quantity on which they act.
//!
//! Each file is an effect: its physics, its own parameters, its checks (`check`), its status for a capture with the reason (`status`; its sentence
//! appears in the plan), and its action, prepared for a capture. An absent effect costs nothing: a strength of zero is never run. Light, charge and
//! voltage have a list each, below, in physical order; checks, plan and execution are generated from it.
//!
//! Steps between or outside the lists are named explicitly, twice: exposure control, shot noise, layout, response, converter, merging and companding
//! are in `SensorParameters::show`, which generates all checks and the plan, and in `Sensor::frame` and its callees, which run them. Checks that need
//! the whole sensor or the image's size are elsewhere: captures and companding in `validity`, the layout where the size is known.
//!
//! | effect | on | acts on |
//! | --- | --- | --- |
//! | [angle response](angle_response) | mean electrons | rows |
//! | [optical crosstalk](neighbours::Crosstalk) | mean electrons | plane |
//! | [photo-response non-uniformity](photo_response) | mean electrons | rows |
//! | [smear] | adds to mean electrons | plane |
//! | [shot noise](shot_noise) | mean electrons → charge | rows |
//! | [dark current](dark_current) with its pattern | charge: adds its own electrons | rows |
//! | [lag] | charge: exchanged with traps | plane |
//! | [brighter-fatter](brighter_fatter) | charge: moved | plane |
//! | [full well](full_well), blooming | charge: cut and moved | rows; plane |
//! | [dead pixels](dead_pixels) | charge: emptied | rows |
//! | binning of charge ([`layout`](crate::layout)) | charge: pixels are added | plane |
//! | [response] | charge → voltage | rows |
//! | [inter-pixel capacitance](neighbours::InterPixelCapacitance) | voltage: moved | plane |
//! | [offset non-uniformity](offset_pattern) | voltage: added | rows |
//! | [read noise](offset_pattern::ReadNoise) | voltage: added | rows |
//! | [RTS noise](two_level::RtsNoise) | voltage: added | rows |
//! | [converter] | voltage → DN: gain, black level, rounding, range | rows |
//! | merging and companding ([`hdr`](crate::hdr)) | DN | plane |
//!
//! Shot noise and dark current commute: both are independent counts that are added.

pub mod angle_response;
mod bloom_around;
mod bloom_column;
pub mod brighter_fatter;
pub mod converter;
pub mod dark_current;
pub mod dead_pixels;
pub mod full_well;
pub mod lag;
pub mod neighbours;
pub mod offset_pattern;
pub mod photo_response;
pub mod response;
pub mod shot_noise;
pub mod smear;
pub mod temperature;
pub mod two_level;

use etendue_core::quantity::{Charge, MeanElectrons, Voltage};

use crate::effect::domain;
use angle_response::AngleResponse;
use brighter_fatter::BrighterFatter;
use dark_current::DarkCurrent;
use dead_pixels::DeadPixels;
use full_well::FullWell;
use lag::Lag;
use neighbours::{Crosstalk, InterPixelCapacitance};
use offset_pattern::{OffsetPattern, ReadNoise};
use photo_response::PhotoResponse;
use smear::Smear;
use two_level::RtsNoise;

domain! {
    /// Effects on light before it is counted.
    pub struct LightEffects on MeanElectrons {
        /// Response of the micro-lenses over the angle of the light.
        angle_response: Option<AngleResponse>,
        /// Light exchanged between neighbours.
        crosstalk: Option<Crosstalk>,
        /// Differences in response to light (PRNU).
        photo_response: PhotoResponse,
        /// Light collected while charge moves down its column.
        smear: Option<Smear>,
    }
}

domain! {
    /// Effects on charge in its pixel.
    pub struct ChargeEffects on Charge {
        /// Thermally generated electrons.
        dark: DarkCurrent,
        /// Traps that hold charge from frame to frame.
        lag: Lag,
        /// Pixel borders shifted by charge.
        brighter_fatter: BrighterFatter,
        /// The maximum charge of a pixel, and its overflow.
        full_well: FullWell,
        /// Pixels that hold no charge.
        dead_pixels: DeadPixels,
    }
}

domain! {
    /// Effects on voltage between the sense node and the ADC.
    pub struct VoltageEffects on Voltage {
        /// Voltage coupled between neighbours.
        capacitance: Option<InterPixelCapacitance>,
        /// Differences without light that do not grow with time (DSNU).
        offset: OffsetPattern,
        /// Noise of the read-out chain.
        noise: ReadNoise,
        /// Pixels with random telegraph noise.
        rts_noise: Option<RtsNoise>,
    }
}

#[cfg(test)]
mod tests {
    use crate::effect::SignalLevels;
    use crate::parameters::SensorParameters;
    use crate::parameters::tests::ideal;

    #[test]
    fn what_has_no_strength_is_absent_and_says_why() {
        let mut p = ideal();
        let remaining = |p: &SensorParameters| -> Vec<_> {
            let effects = p.effects(SignalLevels::default());
            assert!(effects.iter().all(|effect| !effect.status.reason().is_empty()));
            effects.into_iter().filter(|effect| effect.status.is_modelled()).map(|effect| effect.name).collect()
        };
        p.noise = false;
        assert_eq!(remaining(&p), ["full well", "ADC"]);
        p.noise = true;
        p.charge.dark.current_e_s = 3.0;
        assert_eq!(remaining(&p), ["shot noise", "dark current", "full well", "read noise", "ADC"]);
        p.exposure.exposure_s = 0.0;
        p.voltage.noise.white_e = 0.0;
        assert_eq!(remaining(&p), ["full well", "ADC"]);
    }
}
