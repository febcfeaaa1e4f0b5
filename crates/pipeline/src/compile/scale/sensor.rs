//! The sensor with pixels of k × k. Keys that are not here are unchanged, or are converted where they are compiled; docs/sensor.md has every key, with the
//! reason (`tests/tests/house/sensor_scale.rs`).

use etendue_core::maths::f64::{exp_m1, ln_1p, pow};
use etendue_scene::record::sensor::Shutter;
use etendue_scene::record::sensor::charge::{Blooming, Dark, Direction, Smear};
use etendue_scene::record::sensor::exposure::Exchange;
use etendue_scene::record::sensor::hdr::Hdr;
use etendue_scene::record::sensor::read_out::Response;
use etendue_scene::record::{Electronics, Sensor};

/// Converts the sensor to pixels k times as wide and as high.
pub(super) fn enlarge(sensor: &mut Sensor, k: f64) {
    let Sensor {
        place: _,
        width_px,
        height_px,
        pixel_pitch_um,
        scale: _,
        fill_factor: _,
        principal_point_px,
        shutter,
        electronics,
    } = sensor;
    for pixels in [width_px, height_px] {
        pixels.value /= k as u64;
    }
    pixel_pitch_um.value *= k;
    principal_point_px.iter_mut().for_each(|point| point.value = point.value.map(|px| px / k));
    if let Some(Shutter::Rolling(rows) | Shutter::GlobalReset(rows)) = shutter {
        rows.row_time_us.value *= k;
    }
    electronics.iter_mut().for_each(|electronics| enlarge_electronics(electronics, k));
}

fn enlarge_electronics(electronics: &mut Electronics, k: f64) {
    let Electronics {
        full_well_e,
        dark_current_e_s,
        gain_dn_per_e,
        crosstalk,
        dark,
        smear,
        brighter_fatter_per_e,
        blooming,
        response,
        inter_pixel_capacitance,
        roi_px,
        hdr,
        ..
    } = electronics;
    let area = k * k;
    full_well_e.value *= area;
    gain_dn_per_e.value /= area;
    dark_current_e_s.iter_mut().for_each(|current| current.value *= area);
    dark.iter_mut().for_each(|dark| enlarge_dark(dark, area));
    brighter_fatter_per_e.iter_mut().for_each(|shift| shift.value /= area * k);
    [crosstalk, inter_pixel_capacitance].into_iter().flatten().for_each(|exchange| enlarge_exchange(exchange, k));
    if let Some(Smear::FrameTransfer(transfer)) = smear {
        transfer.line_shift_s.value *= k;
    }
    blooming.iter_mut().for_each(|blooming| enlarge_blooming(blooming, k));
    response.iter_mut().for_each(|response| enlarge_response(response, area));
    roi_px.iter_mut().for_each(|region| region.value = region.value.map(|px| px / k));
    hdr.iter_mut().for_each(|hdr| enlarge_captures(hdr, area));
}

/// Converts the fractions of an exchange with neighbouring pixels to those of pixels of k × k.
///
/// Each of the k² parts of a pixel exchanges with its own neighbours as before, and all parts have the same signal. Only the k parts next to a border give
/// signal to the pixel beyond it: the fraction h across the side and the fraction c across both corners of each part, except at the two corners of the border
/// that lead to diagonal pixels: h′ = (k h + 2 (k − 1) c)/k² and c′ = c/k².
fn enlarge_exchange(exchange: &mut Exchange, k: f64) {
    let corner = exchange.corner.as_ref().map_or(0.0, |corner| corner.value);
    let across = |fraction: f64| (k * fraction + 2.0 * (k - 1.0) * corner) / (k * k);
    exchange.horizontal.value = across(exchange.horizontal.value);
    exchange.vertical.value = across(exchange.vertical.value);
    exchange.corner.iter_mut().for_each(|corner| corner.value /= k * k);
}

/// Sources of dark current are distributed over the area: the number of those of hot and blinking pixels is unchanged. A pixel of n parts has one or more with
/// the probability 1 − (1 − p)ⁿ, and then n p/(1 − (1 − p)ⁿ) on average: the mean dark current of a pixel is exactly n times as large.
fn enlarge_dark(dark: &mut Dark, area: f64) {
    let hot = dark.hot.iter_mut().map(|hot| (&mut hot.fraction.value, &mut hot.mean_e_s.value));
    let blinking = dark.dark_current_rts.iter_mut().map(|rts| (&mut rts.fraction.value, &mut rts.mean_e_s.value));
    for (fraction, mean_e_s) in hot.chain(blinking) {
        let sources = area * *fraction;
        *fraction = -exp_m1(area * ln_1p(-*fraction));
        *mean_e_s *= sources / *fraction;
    }
}

/// Overflowing charge loses a fraction in each pixel that it crosses: k pixels per larger pixel along a column, and k² steps of a random walk in all directions.
fn enlarge_blooming(blooming: &mut Blooming, k: f64) {
    let steps = match blooming.direction.value {
        Direction::Column => k,
        Direction::Around => k * k,
    };
    let fraction = &mut blooming.overflow_fraction.value;
    *fraction = pow(*fraction, steps).max(f64::MIN_POSITIVE);
}

fn enlarge_response(response: &mut Response, area: f64) {
    match response {
        Response::Knees(line) => line.knees.iter_mut().for_each(|knee| knee.value[0] *= area),
        Response::Logarithmic(logarithm) => logarithm.from_e.value *= area,
    }
}

fn enlarge_captures(hdr: &mut Hdr, area: f64) {
    let wells = hdr.captures.iter_mut().filter_map(|capture| capture.full_well_e.as_mut());
    wells.for_each(|well| well.value *= area);
}
