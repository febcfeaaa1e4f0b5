//! Exponential laws of size, and the quantities derived from them.
//!
//! N(d) = N₀ exp(−Λ d): d is a drop's diameter, or the diameter of a flake when molten. A flake itself is larger, by its density.

use core::f64::consts::PI;

use etendue_core::maths::f64::{cbrt, exp, exp_m1, ln_1p, pow};

/// Error of a size law.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SizeLawError {
    /// A rate beyond the measurements that a law was fitted to.
    #[error("the rate is {rate_mm_h} mm/h; the drop size distribution is valid from {low} to {high} mm/h")]
    Rate {
        /// Value given, mm/h of water.
        rate_mm_h: f64,
        /// Minimum rate, mm/h.
        low: f64,
        /// Maximum rate, mm/h.
        high: f64,
    },
}

/// Kind of precipitation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hydrometeor {
    Drop,
    Flake(Crystals),
}

/// Number density of particles by size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeLaw {
    /// N₀, 1/(m³ mm).
    pub(super) n0: f64,
    /// Λ, 1/mm.
    pub(super) lambda: f64,
    pub(super) hydrometeor: Hydrometeor,
    /// The requested rate, mm/h.
    pub(super) rate_mm_h: f64,
}

impl SizeLaw {
    /// Rain by Marshall and Palmer's law at a rate, mm/h. With the speeds of [`terminal_speed_mps`] it brings 5 to 18 % more water than
    /// that; [`SizeLaw::rescaled`] corrects this.
    ///
    /// # Errors
    /// If the rate is not within 0.1 to 150 mm/h.
    pub fn rain(rate_mm_h: f64) -> Result<Self, SizeLawError> {
        check_rate(rate_mm_h, RAIN_RATES)?;
        let [n0, lambda] = marshall_palmer(rate_mm_h);
        Ok(Self { n0, lambda, hydrometeor: Hydrometeor::Drop, rate_mm_h })
    }

    /// Snow by Sekhon and Srivastava's law at a rate, mm/h of water.
    ///
    /// # Errors
    /// If the rate is not within 0.1 to 3 mm/h.
    pub fn snow(rate_mm_h: f64, crystals: Crystals) -> Result<Self, SizeLawError> {
        check_rate(rate_mm_h, SNOW_RATES)?;
        let [n0, lambda] = sekhon_srivastava(rate_mm_h);
        Ok(Self { n0, lambda, hydrometeor: Hydrometeor::Flake(crystals), rate_mm_h })
    }

    /// The same with N₀ rescaled, so that the particles with their speeds bring the requested rate.
    #[must_use]
    pub fn rescaled(self) -> Self {
        Self { n0: self.n0 * self.rate_mm_h / self.water_rate_mm_h(), ..self }
    }

    /// The requested rate, mm/h of water.
    #[must_use]
    pub fn rate_mm_h(&self) -> f64 {
        self.rate_mm_h
    }

    /// True for snow.
    #[must_use]
    pub fn is_snow(&self) -> bool {
        matches!(self.hydrometeor, Hydrometeor::Flake(_))
    }

    /// N₀, 1/(m³ mm).
    #[must_use]
    pub fn n0(&self) -> f64 {
        self.n0
    }

    /// Λ, 1/mm.
    #[must_use]
    pub fn lambda_per_mm(&self) -> f64 {
        self.lambda
    }

    /// Maximum size of the field, mm: drops break up beyond 6 mm; for flakes that of the water in them.
    #[must_use]
    pub fn max_size_mm(&self) -> f64 {
        if self.is_snow() { 8.0 } else { 6.0 }
    }

    /// Particles per cubic metre, of all sizes.
    #[must_use]
    pub fn number_per_m3(&self) -> f64 {
        self.n0 / self.lambda
    }

    /// Extinction as meteorologists measure it over a narrow beam, 1/m: twice the cross-sections of spheres, half of it by diffraction.
    #[must_use]
    pub fn meteorological_extinction_per_m(&self) -> f64 {
        match self.hydrometeor {
            Hydrometeor::Drop => PI * self.n0 / (self.lambda * self.lambda * self.lambda) * 1e-6,
            Hydrometeor::Flake(_) => {
                self.integral(self.all_sizes(), |d| {
                    let across = self.diameter_mm(d);
                    0.5 * PI * across * across
                }) * 1e-6
            }
        }
    }

    /// The distance at which contrast falls to 2 % by [`SizeLaw::meteorological_extinction_per_m`], m.
    #[must_use]
    pub fn visibility_m(&self) -> f64 {
        -etendue_core::maths::f64::ln(0.02) / self.meteorological_extinction_per_m()
    }

    fn all_sizes(&self) -> SizeRange {
        SizeRange { low_mm: 0.0, high_mm: self.max_size_mm() }
    }

    /// The water rate carried by the particles with their speeds, mm/h.
    #[must_use]
    pub fn water_rate_mm_h(&self) -> f64 {
        // mm³/m³ · m/s to mm/h.
        let volume = |d: f64| PI / 6.0 * d * d * d;
        3.6e-3 * self.integral(self.all_sizes(), |d| volume(d) * self.speed_mps(d))
    }

    /// Diameter of the sphere of a particle's volume, mm, for the size `d` mm.
    #[must_use]
    pub fn diameter_mm(&self, d: f64) -> f64 {
        match self.hydrometeor {
            Hydrometeor::Drop => d,
            Hydrometeor::Flake(crystals) => crystals.flake_mm(d),
        }
    }

    /// Speed of fall, m/s, for the size `d` mm.
    #[must_use]
    pub fn speed_mps(&self, d: f64) -> f64 {
        match self.hydrometeor {
            Hydrometeor::Drop => terminal_speed_mps(d),
            Hydrometeor::Flake(crystals) => crystals.speed_mps(d),
        }
    }

    /// Height over width for the size `d` mm.
    #[must_use]
    pub fn axis_ratio(&self, d: f64) -> f64 {
        match self.hydrometeor {
            Hydrometeor::Drop => axis_ratio(d),
            Hydrometeor::Flake(_) => 1.0,
        }
    }

    /// Cross-section as seen from the side, m², for the size `d` mm: that of a spheroid of the particle's volume.
    #[must_use]
    pub fn cross_section_m2(&self, d: f64) -> f64 {
        let across = self.diameter_mm(d) * 1e-3;
        0.25 * PI * across * across * cbrt(self.axis_ratio(d))
    }

    /// ∫ N(d) f(d) dd over a range of sizes, mm, by Simpson's rule.
    pub(super) fn integral(&self, range: SizeRange, f: impl Fn(f64) -> f64) -> f64 {
        let SizeRange { low_mm: low, high_mm: high } = range;
        const STEPS: u32 = 400;
        let h = (high - low) / f64::from(STEPS);
        let value = |i: u32| {
            let d = low + h * f64::from(i);
            let weight = if i == 0 || i == STEPS { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
            weight * self.n0 * exp(-self.lambda * d) * f(d)
        };
        (0..=STEPS).map(value).sum::<f64>() * h / 3.0
    }
}

/// Range of validity of a law, in rates.
#[derive(Clone, Copy)]
pub(super) struct RateRange {
    low_mm_h: f64,
    high_mm_h: f64,
}

/// Checks a rate, mm/h, against a law's range.
fn check_rate(rate_mm_h: f64, range: RateRange) -> Result<(), SizeLawError> {
    let RateRange { low_mm_h: low, high_mm_h: high } = range;
    if rate_mm_h >= low && rate_mm_h <= high { Ok(()) } else { Err(SizeLawError::Rate { rate_mm_h, low, high }) }
}

/// Legal rates of rain, mm/h: from drizzle to a cloudburst. Marshall and Palmer measured up to some 25 mm/h; others have used the law up to
/// 150.
const RAIN_RATES: RateRange = RateRange { low_mm_h: 0.1, high_mm_h: 150.0 };

/// N₀, 1/(m³ mm), and Λ, 1/mm, by Marshall and Palmer ("The distribution of raindrops with size", J. Meteorol. 5, 1948) at a rate, mm/h:
/// N(D) = 8000 exp(−4.1 R^−0.21 D) 1/(m³ mm).
fn marshall_palmer(rate_mm_h: f64) -> [f64; 2] {
    [8000.0, 4.1 * pow(rate_mm_h, -0.21)]
}

/// Terminal speed of a drop of a diameter in mm, m/s: 9.65 − 10.3 exp(−0.6 D) (Atlas, Srivastava and Sekhon, Rev. Geophys. 11, 1973), of
/// 0.1 to 6 mm; 0 if the formula is negative.
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

/// Legal rates of snow, mm/h of water.
const SNOW_RATES: RateRange = RateRange { low_mm_h: 0.1, high_mm_h: 3.0 };

/// Density of ice, g/cm³.
const ICE: f64 = 0.917;

/// Kind of snow crystals, which determines the size, density and speed of flakes at the same rate: visibility in snow of one rate differs
/// by 3 to 10 times with it (Rasmussen et al., J. Appl. Meteorol. 38, 1999).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Crystals {
    /// Dry, feathery: half the density of aggregates.
    Dendrites,
    /// Flakes of many crystals: 0.178 D^−0.922 g/cm³, D in mm (Brandes et al., J. Appl. Meteorol. Climatol. 46, 2007).
    #[default]
    Aggregates,
    /// Covered by frozen droplets: twice the density of aggregates.
    Rimed,
    /// Soft hail: four times the density of aggregates.
    Graupel,
}

/// N₀, 1/(m³ mm), and Λ, 1/mm, by Sekhon and Srivastava ("Snow size spectra and radar reflectivity", J. Atmos. Sci. 27, 1970) at a rate, mm/h of
/// water: N(D) = 2500 R^−0.94 exp(−2.29 R^−0.45 D) 1/(m³ mm), D the diameter of the molten flake.
fn sekhon_srivastava(rate_mm_h: f64) -> [f64; 2] {
    [2500.0 * pow(rate_mm_h, -0.94), 2.29 * pow(rate_mm_h, -0.45)]
}

impl Crystals {
    /// Density over that of aggregates of the same size. The factors are a choice that spans Rasmussen's range.
    fn density_factor(self) -> f64 {
        match self {
            Self::Dendrites => 0.5,
            Self::Aggregates => 1.0,
            Self::Rimed => 2.0,
            Self::Graupel => 4.0,
        }
    }

    /// Diameter of a flake, mm, that melts to a drop of `melted_mm`: ρ(D) D³ = d³ g/cm³, but never denser than ice.
    fn flake_mm(self, melted_mm: f64) -> f64 {
        let cube = melted_mm * melted_mm * melted_mm;
        let by_law = pow(cube / (0.178 * self.density_factor()), 1.0 / 2.078);
        by_law.max(cbrt(cube / ICE))
    }

    /// Speed of fall, m/s: 1 m/s for an aggregate of 1 mm, otherwise proportional to the root of density times diameter by the balance of
    /// weight and drag; limited to 1 to 2 m/s, the range of real flakes.
    pub(super) fn speed_mps(self, melted_mm: f64) -> f64 {
        let flake = self.flake_mm(melted_mm);
        let ratio = if flake > 0.0 { melted_mm / flake } else { 1.0 };
        (ratio * ratio * ratio * flake / 0.178).sqrt().clamp(1.0, 2.0)
    }
}

/// Classes of a law. The speeds within one differ from its own by some per cent.
pub(super) const CLASSES: u32 = 40;

/// A range of sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeRange {
    /// Minimum, mm.
    pub low_mm: f64,
    /// Maximum, mm.
    pub high_mm: f64,
}

/// Particles of a narrow range of sizes, which fall together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeClass {
    /// Its sizes.
    pub range: SizeRange,
    /// Number density, 1/m³.
    pub number_per_m3: f64,
    /// Speed of fall, m/s: the one that gives the class's water rate.
    pub speed_mps: f64,
    /// Cross-sections as seen from the side, 1/m: the extinction of an image.
    pub extinction_per_m: f64,
    /// Diameter of the middle size, m, which determines whether a pixel resolves the class.
    pub diameter_m: f64,
}

impl SizeClass {
    /// All classes of a law, from the smallest. Small sizes have narrower ones: their speeds differ more.
    pub(super) fn all(law: &SizeLaw) -> Vec<Self> {
        let edge = |i: u32| {
            let x = f64::from(i) / f64::from(CLASSES);
            law.max_size_mm() * x * x.sqrt()
        };
        (0..CLASSES).map(|i| Self::new(law, SizeRange { low_mm: edge(i), high_mm: edge(i + 1) })).collect()
    }

    fn new(law: &SizeLaw, range: SizeRange) -> Self {
        let water = law.integral(range, |d| d * d * d);
        Self {
            range,
            number_per_m3: law.integral(range, |_| 1.0),
            speed_mps: law.integral(range, |d| d * d * d * law.speed_mps(d)) / water,
            extinction_per_m: law.integral(range, |d| law.cross_section_m2(d)),
            diameter_m: law.diameter_mm(0.5 * (range.low_mm + range.high_mm)) * 1e-3,
        }
    }

    /// The size, mm, below which the fraction `u` of the class's particles lies.
    pub(super) fn size_mm(&self, law: &SizeLaw, u: f64) -> f64 {
        let SizeRange { low_mm: low, high_mm: high } = self.range;
        low - ln_1p(u * exp_m1(-law.lambda_per_mm() * (high - low))) / law.lambda_per_mm()
    }
}
