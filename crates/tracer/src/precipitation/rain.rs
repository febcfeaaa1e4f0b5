//! Laws of rain.

use etendue_core::maths::f64::{exp, pow};

/// Rates that rain may have, mm/h: from drizzle to a cloudburst. Marshall and Palmer measured up to some 25 mm/h; others have used the law up to 150.
pub(super) const RATES_MM_H: [f64; 2] = [0.1, 150.0];

/// N₀, 1/(m³ mm), and Λ, 1/mm, by Marshall and Palmer ("The distribution of raindrops with size", J. Meteorol. 5, 1948) at a rate, mm/h:
/// N(D) = 8000 exp(−4.1 R^−0.21 D) 1/(m³ mm).
pub(super) fn marshall_palmer(rate_mm_h: f64) -> [f64; 2] {
    [8000.0, 4.1 * pow(rate_mm_h, -0.21)]
}

/// Terminal speed of a drop of a diameter in mm, m/s: 9.65 − 10.3 exp(−0.6 D) (Atlas, Srivastava and Sekhon, Rev. Geophys. 11, 1973), of
/// 0.1 to 6 mm; 0 where the formula is below.
#[must_use]
pub fn terminal_speed_mps(diameter_mm: f64) -> f64 {
    (9.65 - 10.3 * exp(-0.6 * diameter_mm)).max(0.0)
}

/// Height over width of a falling drop of a diameter in mm: 1.03 − 0.062 D above 1 mm (Pruppacher and Beard, Q. J. R. Meteorol. Soc. 96,
/// 1970), but at most 1; a sphere below.
#[must_use]
pub fn axis_ratio(diameter_mm: f64) -> f64 {
    if diameter_mm > 1.0 { (1.03 - 0.062 * diameter_mm).min(1.0) } else { 1.0 }
}
