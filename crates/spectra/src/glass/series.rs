//! Squared indices as sums of resonances and powers of the wavelength.

/// Number of resonances.
const RESONANCES: usize = 5;
/// Exponent k of the first power λ²ᵏ.
const FIRST_POWER: i32 = -6;
/// Number of powers: λ⁻¹² to λ⁶, without the constant.
const POWERS: usize = 10;

/// n² = A + Σ Bᵢ λ²/(λ² − Cᵢ) + Σ aₖ λ²ᵏ, k = −6 … 3, λ in µm. Beyond the range of the fit n continues along its tangent over 1/λ², as Cauchy's n = A + B/λ²
/// would: the formulas themselves turn there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DispersionSeries {
    constant: f64,
    /// B and C, µm².
    resonances: [[f64; 2]; RESONANCES],
    /// aₖ, µm⁻²ᵏ.
    powers: [f64; POWERS],
    /// Tangents at the shortest and the longest wavelength of the fit.
    ends: [Tangent; 2],
}

/// A line n(u) over u = 1/λ².
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tangent {
    /// u of its point, µm⁻².
    u: f64,
    /// n there.
    index: f64,
    /// dn/du, µm².
    slope: f64,
}

impl Tangent {
    /// A point that no wavelength reaches.
    const NONE: Self = Self { u: f64::NAN, index: 1.0, slope: 0.0 };

    fn at(self, u: f64) -> f64 {
        self.index + self.slope * (u - self.u)
    }
}

impl DispersionSeries {
    /// A constant squared index.
    #[must_use]
    pub fn new(constant: f64) -> Self {
        Self { constant, resonances: [[0.0; 2]; RESONANCES], powers: [0.0; POWERS], ends: [Tangent::NONE; 2] }
    }

    /// Adds B λ²/(λ² − C) in the next free place; terms beyond the fifth are left out, as no formula has them.
    #[must_use]
    pub fn with_resonance(mut self, b: f64, c_um2: f64) -> Self {
        if let Some(free) = self.resonances.iter_mut().find(|term| term[0] == 0.0) {
            *free = [b, c_um2];
        }
        self
    }

    /// Adds a λᵖ, p even from −12 to 6.
    #[must_use]
    pub fn with_power(mut self, power: i32, a: f64) -> Self {
        match power {
            0 => self.constant += a,
            _ => self.powers[(power / 2 - FIRST_POWER) as usize] += a,
        }
        self
    }

    /// Sets the range of the fit, µm; to be called after all terms are added.
    #[must_use]
    pub fn within(mut self, range_um: [f64; 2]) -> Self {
        self.ends = range_um.map(|um| self.tangent(1.0 / (um * um)));
        self
    }

    /// The refractive index at a wavelength, µm.
    pub(super) fn index(&self, um: f64) -> f64 {
        let u = 1.0 / (um * um);
        match self.ends {
            [shortest, _] if u > shortest.u => shortest.at(u),
            [_, longest] if u < longest.u => longest.at(u),
            _ => self.square(u).sqrt(),
        }
    }

    /// n² at u.
    fn square(&self, u: f64) -> f64 {
        let resonances: f64 = self.resonances.iter().map(|[b, c]| b / (1.0 - c * u)).sum();
        let powers: f64 = (FIRST_POWER..).zip(&self.powers).map(|(k, a)| a * power(u, -k)).sum();
        self.constant + resonances + powers
    }

    fn tangent(&self, u: f64) -> Tangent {
        let resonance = |[b, c]: &[f64; 2]| b * c / ((1.0 - c * u) * (1.0 - c * u));
        let resonances: f64 = self.resonances.iter().map(resonance).sum();
        let powers: f64 = (FIRST_POWER..).zip(&self.powers).map(|(k, a)| -f64::from(k) * a * power(u, -k - 1)).sum();
        let index = self.square(u).sqrt();
        Tangent { u, index, slope: (resonances + powers) / (2.0 * index) }
    }
}

/// Whole power by multiplication: the same bits on every machine.
fn power(x: f64, exponent: i32) -> f64 {
    let product = (0..exponent.unsigned_abs()).fold(1.0, |product, _| product * x);
    if exponent < 0 { 1.0 / product } else { product }
}
