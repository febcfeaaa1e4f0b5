//! Conversion of light to digital numbers.

use super::cfa::{CfaSource, cfa};
use super::charge::{Blooming, Dark, NonUniformity, Smear, Trap};
use super::efficiency::{QuantumEfficiency, check_channels, quantum_efficiency};
use super::exposure::{AngleResponse, AutoExposure, Exchange};
use super::hdr::{Companding, Hdr};
use super::read_out::{Binning, OpticalBlack, Response, RtsNoise, Skipping};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{flag, integer, list, number, record, vector};

record! {
    /// Conversion of light to digital numbers.
    pub struct Electronics {
        /// Exposure time; at 0 only signals that need no time remain.
        required exposure_s: Placed<f64> = number("s").at_least(0.0);
        /// Colour filter array: first two rows from the top-left pixel, or a table.
        required cfa: CfaSource = cfa();
        /// Electrons per photon on the sensitive area, filter included; lists are red, green and blue.
        required quantum_efficiency: QuantumEfficiency = quantum_efficiency();
        /// Charge that a pixel can hold.
        required full_well_e: Placed<f64> = number("e⁻").above(0.0);
        /// Standard deviation of the read noise.
        required read_noise_e: Placed<f64> = number("e⁻").at_least(0.0);
        /// Mean dark current. Default: 0.
        optional dark_current_e_s: Placed<f64> = number("e⁻/s").at_least(0.0);
        /// Conversion gain at an analogue gain of 1.
        required gain_dn_per_e: Placed<f64> = number("DN/e⁻").above(0.0);
        /// Digital number without signal, below the ADC's maximum.
        required black_level_dn: Placed<f64> = number("DN").at_least(0.0);
        /// Bits of the ADC.
        required bits: Placed<u64> = integer(1, 24);
        /// Adds temporal noise. Default: true.
        optional noise: Placed<bool> = flag();
        /// Time between frames, at least the exposure; for "smear" (interline) and "lag".
        optional frame_period_s: Placed<f64> = number("s").above(0.0);
        /// Factor on the voltage. Default: 1.
        optional analogue_gain: Placed<f64> = number("").above(0.0);
        /// Factor on digital numbers above black. Default: 1.
        optional digital_gain: Placed<f64> = number("").above(0.0);
        /// Automatic exposure and gain. Default: constant.
        optional auto_exposure: AutoExposure = record();
        /// Angular response of the micro-lenses. Default: 1.
        optional angle_response: AngleResponse = record();
        /// Fractions of light that neighbours receive.
        optional crosstalk: Exchange = record();
        /// Fixed differences between pixels.
        optional non_uniformity: NonUniformity = record();
        /// Temperature and spread of the dark current. Default: equal in all pixels.
        optional dark: Dark = record();
        /// Smear of a CCD.
        optional smear: Smear = record();
        /// Traps that carry charge to later frames.
        many lag: Trap = list(record(), 1);
        /// Brighter-fatter effect: shift of a pixel's border, in pixels, per electron of difference. Default: 0.
        optional brighter_fatter_per_e: Placed<f64> = number("1/e⁻").above(0.0);
        /// Overflow above the full well. Default: it is lost.
        optional blooming: Blooming = record();
        /// Voltage over charge. Default: proportional.
        optional response: Response = record();
        /// Fractions of voltage that couple to neighbours.
        optional inter_pixel_capacitance: Exchange = record();
        /// Noise common to a row.
        optional row_noise_e: Placed<f64> = number("e⁻").above(0.0);
        /// Noise common to a column.
        optional column_noise_e: Placed<f64> = number("e⁻").above(0.0);
        /// Pixels with a two-level voltage.
        optional rts_noise: RtsNoise = record();
        /// Shielded pixels next to the image, part of the raw.
        optional optical_black: OpticalBlack = record();
        /// Region of interest: first column, first row, columns, rows. Default: the whole image.
        optional roi_px: Placed<[f64; 4]> = vector::<4>(number("px").at_least(0.0));
        /// Pixels read out together.
        optional binning: Binning = record();
        /// Pixels that are not read out.
        optional skipping: Skipping = record();
        /// Several captures per frame. Default: one.
        optional hdr: Hdr = record();
        /// Piecewise linear compression to fewer bits.
        optional companding: Companding = record();
    }
}

pub(super) fn check(electronics: &Electronics, errors: &mut DescriptionErrors) {
    check_black_level(electronics, errors);
    check_channels(&electronics.quantum_efficiency, &electronics.cfa.channels(), &electronics.place, errors);
    check_region(electronics, errors);
}

fn check_black_level(electronics: &Electronics, errors: &mut DescriptionErrors) {
    let (black, bits) = (&electronics.black_level_dn, electronics.bits.value);
    let largest = ((1_u32 << bits) - 1).into();
    if black.value >= largest {
        let problem = format!("found {}, but an ADC of {bits} bits ends at {largest} DN", black.value);
        errors.add(ErrorCode::OutOfRange, &black.place, problem, format!("give a number below {largest}"));
    }
}

fn check_region(electronics: &Electronics, errors: &mut DescriptionErrors) {
    let Some(region) = &electronics.roi_px else { return };
    if region.value.iter().any(|v| v.fract() != 0.0) {
        errors.add(
            ErrorCode::WrongType,
            &region.place,
            format!("{:?} contains a fraction of a pixel", region.value),
            "give whole numbers",
        );
    }
}
