//! Photons and energy, with the exact constants of the SI (2019).

/// Planck's constant h, J·s.
pub const PLANCK_J_S: f64 = 6.626_070_15e-34;
/// Speed of light c, m·s⁻¹.
pub const LIGHT_M_S: f64 = 299_792_458.0;

/// Photons of wavelength `nm` per joule: λ/(hc).
#[must_use]
pub fn photons_per_joule(nm: f64) -> f64 {
    nm * 1e-9 / (PLANCK_J_S * LIGHT_M_S)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn emva_1288_handy_form() {
        // 1 µm², 1 ms, 1 µm and 1 µW/cm²: the standard's factor 50.34.
        let photons = 1e-12 * 1e-3 * 1e-2 * photons_per_joule(1000.0);
        assert!((photons - 50.341_165_675_4).abs() < 5e-11, "{photons}");
    }
}
