//! Conversion of light to digital numbers.

use super::cfa::{CfaSource, cfa};
use super::charge::{Blooming, Dark, NonUniformity, Smear, Trap};
use super::efficiency::{QuantumEfficiency, check_channels, quantum_efficiency};
use super::exposure::{AngleResponse, AutoExposure, Exchange};
use super::hdr::{Companding, Hdr};
use super::read_out::{Binning, OpticalBlack, Response, RtsNoise, Skipping};
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{flag, list, number, record, vector, whole};

record! {
    /// Conversion of light to digital numbers.
    pub struct Electronics {
        /// Exposure time, s, 0 or more. At 0 only signals that need no time remain.
        required exposure_s: Placed<f64> = number("s").at_least(0.0);
        /// Colour filter array: a name that lists the first two rows from the top-left pixel, or `{ columns = …, channels = […] }`.
        required cfa: CfaSource = cfa();
        /// Electrons per photon on the sensitive area, filter included, 0 … 1: a number, `{ spectrum = file }`, a list of three of these for red,
        /// green and blue, `{ camera = name, peak = … }` for measured relative sensitivities, or `{ channels = { name = …, … } }` with one for each
        /// channel of the filter array.
        required quantum_efficiency: QuantumEfficiency = quantum_efficiency();
        /// Full well: charge that a pixel can hold, e⁻, above 0.
        required full_well_e: Placed<f64> = number("e⁻").above(0.0);
        /// Standard deviation of the read noise, e⁻, 0 or more.
        required read_noise_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Mean dark current, e⁻/s, 0 or more. Default: 0.
        optional dark_current_e_s: Placed<f64> = number("e⁻/s").at_least(0.0);
        /// Conversion gain at an analogue gain of 1, DN/e⁻, above 0.
        required gain_dn_per_e: Placed<f64> = number("DN/e⁻").above(0.0);
        /// Digital number without signal, DN, 0 or more and below the ADC's maximum.
        required black_level_dn: Placed<f64> = number("DN").at_least(0.0);
        /// Bits of the ADC, 1 … 24.
        required bits: Placed<u64> = whole(1, 24);
        /// Adds temporal noise. Default: true.
        optional noise: Placed<bool> = flag();
        /// Time between frames, s, at least the exposure; needed by "smear" (interline) and "lag".
        optional frame_period_s: Placed<f64> = number("s").above(0.0);
        /// Factor on the voltage before the ADC, above 0. Default: 1.
        optional analogue_gain: Placed<f64> = number("").above(0.0);
        /// Factor on digital numbers above black, above 0. Default: 1.
        optional digital_gain: Placed<f64> = number("").above(0.0);
        /// Automatic exposure and gain over the frames. Default: both are constant.
        optional auto_exposure: AutoExposure = record();
        /// Angular response of the micro-lenses. Default: 1.
        optional angle_response: AngleResponse = record();
        /// Fractions of a pixel's light that its neighbours receive. Default: none.
        optional crosstalk: Exchange = record();
        /// Fixed differences between pixels. Default: none.
        optional non_uniformity: NonUniformity = record();
        /// Temperature of the dark current and its variation between pixels. Default: the stated current in all pixels.
        optional dark: Dark = record();
        /// Light that a CCD's charge collects while it moves down the column. Default: none.
        optional smear: Smear = record();
        /// Traps that carry charge over to later frames. Default: none.
        many lag: Trap = list(record(), 1);
        /// Brighter-fatter effect: shift of the border between two pixels, in pixels, per electron of difference, 1/e⁻, above 0. Default: 0.
        optional brighter_fatter_per_e: Placed<f64> = number("1/e⁻").above(0.0);
        /// Overflow of charge above the full well. Default: it is lost.
        optional blooming: Blooming = record();
        /// Voltage as a function of charge. Default: proportional.
        optional response: Response = record();
        /// Fractions of a pixel's voltage that couple to its neighbours. Default: none.
        optional inter_pixel_capacitance: Exchange = record();
        /// Noise common to all pixels of a row, e⁻, above 0. Default: none.
        optional row_noise_e: Placed<f64> = number("e⁻").above(0.0);
        /// Noise common to all pixels of a column, e⁻, above 0. Default: none.
        optional column_noise_e: Placed<f64> = number("e⁻").above(0.0);
        /// Pixels whose voltage jumps between two levels. Default: none.
        optional rts_noise: RtsNoise = record();
        /// Pixels next to the image that receive no light; they are part of the raw. Default: none.
        optional optical_black: OpticalBlack = record();
        /// Region of interest that is read out: first column, first row, columns, rows, px. Default: the whole image.
        optional roi_px: Placed<[f64; 4]> = vector::<4>(number("px").at_least(0.0));
        /// Pixels that are read out together. Default: none.
        optional binning: Binning = record();
        /// Pixels that are not read out, which gives a smaller image. Default: none.
        optional skipping: Skipping = record();
        /// Several captures per frame. Default: one.
        optional hdr: Hdr = record();
        /// Piecewise linear compression to fewer bits. Default: none.
        optional companding: Companding = record();
    }
}

pub(super) fn check(electronics: &Electronics, faults: &mut Faults) {
    check_black_level(electronics, faults);
    check_channels(&electronics.quantum_efficiency, &electronics.cfa.channels(), &electronics.place, faults);
    check_region(electronics, faults);
}

fn check_black_level(electronics: &Electronics, faults: &mut Faults) {
    let (black, bits) = (&electronics.black_level_dn, electronics.bits.value);
    let largest = ((1_u32 << bits) - 1).into();
    if black.value >= largest {
        let problem = format!("found {}, but an ADC of {bits} bits ends at {largest} DN", black.value);
        faults.add(ErrorCode::OutOfRange, &black.place, problem, format!("give a number below {largest}"));
    }
}

fn check_region(electronics: &Electronics, faults: &mut Faults) {
    let Some(region) = &electronics.roi_px else { return };
    if region.value.iter().any(|v| v.fract() != 0.0) {
        faults.add(
            ErrorCode::WrongType,
            &region.place,
            format!("{:?} contains a fraction of a pixel", region.value),
            "give whole numbers",
        );
    }
}
