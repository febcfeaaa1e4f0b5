//! The wavelengths that stand for a band.

use etendue_core::WavelengthRange;

pub(super) const MM_PER_NM: f64 = 1e-6;
pub(super) const NM_PER_UM: f64 = 1e3;
/// Wavelengths of a band are at most this far apart, nm.
const STEP_NM: f64 = 10.0;

/// The middles of the equal parts of a band, none wider than the step.
pub(super) fn mid_wavelengths(band: WavelengthRange) -> impl Iterator<Item = f64> {
    let parts = (band.width_nm() / STEP_NM).ceil().max(1.0);
    (0..parts as usize).map(move |part| band.low_nm + band.width_nm() * (part as f64 + 0.5) / parts)
}
