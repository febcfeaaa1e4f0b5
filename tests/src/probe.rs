//! Cameras of one pixel, which see the light of one direction.

use etendue_core::maths::f64::acos;
use etendue_spectra::{illuminant, observer};
use glam::DVec3;

/// One band, where lamps of [`FLAT`] have no scatter of wavelengths.
pub const ONE_BAND: &str = "wavelength_range_nm = [500, 600]\nband_width_nm = 100";

/// An illuminant of the same power at every wavelength.
pub const FLAT: &str = "illuminant = \"E\"";

/// Spectral radiance in [`ONE_BAND`] of light of [`FLAT`] a cd/m², or irradiance a lux: W·m⁻²·(sr⁻¹)·nm⁻¹.
///
/// # Panics
/// Never: the illuminant is there.
#[must_use]
pub fn flat_per_lux() -> f64 {
    let flat = illuminant::by_name("E").expect("an illuminant");
    observer::with_luminance(flat, 1.0).expect("visible").band_mean(500.0, 600.0)
}

/// A pinhole camera at `from` whose only pixel, 0.1 mrad wide, sees the point `at`.
#[must_use]
pub fn eye(name: &str, from: DVec3, at: DVec3) -> String {
    let direction = (at - from).normalize();
    // Where it looks nearly up or down, up is forward.
    let up = if acos(direction.z.abs()) < 0.01 { DVec3::X } else { DVec3::Z };
    format!(
        "[[cameras]]\nname = \"{name}\"\nposition_m = {:?}\nlook_at_m = {:?}\nup = {:?}\n\
         lens = {{ type = \"pinhole\", focal_length_mm = 10, f_number = 8 }}\n\
         sensor = {{ width_px = 1, height_px = 1, pixel_pitch_um = 1000, fill_factor = 1e-6 }}\n",
        from.to_array(),
        at.to_array(),
        up.to_array()
    )
}
