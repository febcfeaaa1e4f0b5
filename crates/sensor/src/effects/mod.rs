//! The effects of a sensor, by what they act on.
//!
//! Each file is an effect: its physics, its own parameters, what is illegal (`check`), whether a capture has it and why (`status`, whose
//! sentence is the plan's), and what it does, prepared for a capture. What a capture does not have is absent: a strength of zero is never
//! run. Light, charge and voltage have a list each, below, in physical order: checks, plan and run are made of it.
//!
//! What stands between the lists or around them is named by hand, twice: exposure control, shot noise, layout, response, converter, merging
//! and companding stand beside the lists in `SensorParameters::show`, of which all checks and the plan are made, and in `Sensor::frame`
//! and what it calls, which runs them. What needs the whole sensor or the image's size is checked elsewhere: captures and companding in
//! `validity`, the layout where the size is known.
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
    /// What light meets before it is counted.
    pub struct LightEffects on MeanElectrons {
        /// Response of the micro-lenses over the angle of the light.
        angle_response: Option<AngleResponse>,
        /// Light that neighbours exchange.
        crosstalk: Option<Crosstalk>,
        /// Differences in response to light (PRNU).
        photo_response: PhotoResponse,
        /// Light that charge meets on its way down the column.
        smear: Option<Smear>,
    }
}

domain! {
    /// What happens to charge in its pixel.
    pub struct ChargeEffects on Charge {
        /// Electrons that heat sets free.
        dark: DarkCurrent,
        /// Traps that keep charge from frame to frame.
        lag: Lag,
        /// Borders that charge moves.
        brighter_fatter: BrighterFatter,
        /// The most electrons a pixel holds, and where the rest goes.
        full_well: FullWell,
        /// Pixels that hold nothing.
        dead_pixels: DeadPixels,
    }
}

domain! {
    /// What happens to voltage between the sense node and the converter.
    pub struct VoltageEffects on Voltage {
        /// Voltage that neighbours exchange.
        capacitance: Option<InterPixelCapacitance>,
        /// Differences without light that do not grow with time (DSNU).
        offset: OffsetPattern,
        /// Noise of the chain.
        noise: ReadNoise,
        /// Pixels whose noise has two levels.
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
        let kept = |p: &SensorParameters| -> Vec<_> {
            let effects = p.effects(SignalLevels::default());
            assert!(effects.iter().all(|effect| !effect.status.reason().is_empty()));
            effects.into_iter().filter(|effect| effect.status.is_modelled()).map(|effect| effect.name).collect()
        };
        p.noise = false;
        assert_eq!(kept(&p), ["full well", "converter"]);
        p.noise = true;
        p.charge.dark.current_e_s = 3.0;
        assert_eq!(kept(&p), ["shot noise", "dark current", "full well", "read noise", "converter"]);
        p.exposure.exposure_s = 0.0;
        p.voltage.noise.white_e = 0.0;
        assert_eq!(kept(&p), ["full well", "converter"]);
    }
}
