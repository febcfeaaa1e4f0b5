//! A law of sizes in narrow ranges.

use etendue_core::maths::f64::{exp_m1, ln_1p};

use super::size_law::SizeLaw;

/// Classes of a law. The speeds within one differ from its own by some per cent.
pub(super) const CLASSES: u32 = 40;

/// Particles of a narrow range of sizes, which fall together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeClass {
    /// From which size to which, mm.
    pub range_mm: [f64; 2],
    /// How many, 1/m³.
    pub number_per_m3: f64,
    /// Speed of fall, m/s: that which brings the class's water.
    pub speed_mps: f64,
    /// Cross-sections as seen from the side, 1/m: the extinction of an image.
    pub extinction_per_m: f64,
    /// Diameter of the middle size, m, by which it is told whether a pixel resolves the class.
    pub diameter_m: f64,
}

impl SizeClass {
    /// All classes of a law, from the smallest. Small sizes have narrower ones: their speeds differ more.
    pub(super) fn all(law: &SizeLaw) -> Vec<Self> {
        let edge = |i: u32| {
            let x = f64::from(i) / f64::from(CLASSES);
            law.greatest_mm() * x * x.sqrt()
        };
        (0..CLASSES).map(|i| Self::new(law, [edge(i), edge(i + 1)])).collect()
    }

    fn new(law: &SizeLaw, range_mm: [f64; 2]) -> Self {
        let water = law.integral(range_mm, |d| d * d * d);
        Self {
            range_mm,
            number_per_m3: law.integral(range_mm, |_| 1.0),
            speed_mps: law.integral(range_mm, |d| d * d * d * law.speed_mps(d)) / water,
            extinction_per_m: law.integral(range_mm, |d| law.cross_section_m2(d)),
            diameter_m: law.diameter_mm(0.5 * (range_mm[0] + range_mm[1])) * 1e-3,
        }
    }

    /// The size, mm, below which the share `u` of the class's particles are.
    pub(super) fn size_mm(&self, law: &SizeLaw, u: f64) -> f64 {
        let [low, high] = self.range_mm;
        low - ln_1p(u * exp_m1(-law.lambda_per_mm() * (high - low))) / law.lambda_per_mm()
    }
}
