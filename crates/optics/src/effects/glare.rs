//! Veiling glare: light scattered over the sensor by dust, coatings and the barrel.
//!
//! A fraction 1 − s of the light of a point stays there; s is spread over the plane with the density K(r) = C (r₀² + r²)^(−p/2), r the distance on
//! the sensor (the form is Harvey and Shack's ABg scatter (1976), taken to be the same for every point of the sensor and every wavelength). C makes
//! the integral of K one, over the plane (p > 2) or over a disc of the radius "reach" (any p). With G(r) the integral of ρ (r₀² + ρ²)^(−p/2) from 0
//! to r, the fraction of K within r is F(r) = G(r)/G(reach); over the plane F(r) = 1 − (1 + r²/r₀²)^(1 − p/2).
//!
//! Closed forms checked by tests: the centre of a black disc of radius a in an infinite white field (the veiling glare index of ISO 9358) has s (1 −
//! F(a)) of the field's irradiance; a bright patch far away gives s K(d) times its area.
//!
//! Left out: dependence on field, wavelength and direction of the light; scattered light that misses the sensor (it is part of the transmittance).

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use etendue_core::EffectStatus;
use etendue_core::maths::f64::{atan2, exp_m1, ln_1p, pow, sin_cos};
use glam::DVec2;

use super::convolve::{self, OperationCounts, UsageCounts};
use super::error::{EffectsError, positive};
use super::{Canvas, kernel::Kernel};

/// The largest scattered fraction.
const MAX_SCATTER: f64 = 0.5;
const MM_PER_UM: f64 = 1e-3;
/// Columns and rows about the centre whose taps are summed ring by ring; beyond them K is nearly uniform over a pixel.
const NEAR_PX: usize = 8;
/// Rings of the near taps, their angles, and their end: beyond the corner of the farthest near tap's triangle.
const RINGS: usize = 600;
const ANGLES: usize = 256;
const RINGS_END_PX: f64 = 13.0;
/// Directions of the integral of F over the lattice rectangle.
const DIRECTIONS: usize = 4096;

/// Parameters of the scatter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlareParameters {
    /// Fraction s of the light that is scattered, 0 to 0.5.
    pub scatter: f64,
    /// Radius r₀ within which the scattered light is nearly uniform, µm.
    pub core_um: f64,
    /// Exponent p of the decay with distance.
    pub exponent: f64,
    /// Cut-off radius, mm; `None`: unlimited.
    pub reach_mm: Option<f64>,
}

/// Veiling glare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glare {
    parameters: GlareParameters,
}

impl Glare {
    /// Creates veiling glare.
    ///
    /// # Errors
    /// If a number is outside its range, or the kernel's integral is infinite.
    pub fn new(parameters: GlareParameters) -> Result<Self, EffectsError> {
        let GlareParameters { scatter, core_um, exponent, reach_mm } = parameters;
        if !(0.0..=MAX_SCATTER).contains(&scatter) {
            return Err(EffectsError::Scatter { fraction: scatter, most: MAX_SCATTER });
        }
        positive("core_um", core_um)?;
        positive("exponent", exponent)?;
        match reach_mm {
            Some(reach) => positive("reach_mm", reach).map(|_| ())?,
            None if exponent <= 2.0 => return Err(EffectsError::Endless { exponent }),
            None => {}
        }
        Ok(Self { parameters })
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &GlareParameters {
        &self.parameters
    }

    /// Fraction of the scattered light within `radius_mm`.
    #[must_use]
    pub fn light_within(&self, radius_mm: f64) -> f64 {
        match self.parameters.reach_mm {
            Some(reach) => self.integrated_to(radius_mm.min(reach)) / self.integrated_to(reach),
            None => -exp_m1((1.0 - self.half()) * ln_1p(self.relative(radius_mm))),
        }
    }

    /// Density K of the scattered light at `radius_mm`, 1/mm².
    #[must_use]
    pub fn density_per_mm2(&self, radius_mm: f64) -> f64 {
        if self.parameters.reach_mm.is_some_and(|reach| radius_mm > reach) {
            return 0.0;
        }
        self.constant() * pow(1.0 + self.relative(radius_mm), -self.half())
    }

    pub(super) fn status(glare: Option<&Self>) -> EffectStatus {
        let Some(glare) = glare else { return EffectStatus::LeftOut("no [effects.glare] is described".to_owned()) };
        let p = glare.parameters;
        if p.scatter == 0.0 {
            return EffectStatus::LeftOut("the scattered fraction is 0".to_owned());
        }
        let end = p.reach_mm.map_or_else(|| "over the whole plane".to_owned(), |mm| format!("up to {mm} mm"));
        let how = format!(
            "{} of the light scattered {end}, falling with r^-{} beyond {} µm",
            p.scatter, p.exponent, p.core_um
        );
        EffectStatus::Modelled(how)
    }

    /// Columns and rows over which light is scattered; `None`: unlimited.
    pub(super) fn reach_px(&self, pitch_mm: DVec2) -> Option<[usize; 2]> {
        let px = |pitch: f64| move |reach: f64| (reach / pitch).ceil() as usize;
        let reach = self.parameters.reach_mm?;
        Some([px(pitch_mm.x)(reach), px(pitch_mm.y)(reach)])
    }

    /// Operation counts for the given number of images, with one kernel for all.
    pub(super) fn operation_counts(&self, canvas: &Canvas, images: f64) -> OperationCounts {
        let reach = self.reach_on(canvas);
        let shared = RINGS * ANGLES + (reach[0] + 1) * (reach[1] + 1);
        let uses = UsageCounts { ready: 2.0, applied: images };
        OperationCounts { shared: shared as f64, ..OperationCounts::default() }
            + convolve::operation_counts(reach, canvas.size(), &canvas.film_region(), uses)
    }

    /// Columns and rows over which light is scattered on a canvas.
    fn reach_on(&self, canvas: &Canvas) -> [usize; 2] {
        let far = canvas.size().map(|side| side.saturating_sub(1));
        self.reach_px(canvas.pitch_mm()).map_or(far, |[x, y]| [far[0].min(x + 1), far[1].min(y + 1)])
    }

    /// The kernel (1 − s) δ + s K on a canvas: up to the largest distance between two of its pixels.
    pub(super) fn kernel(&self, canvas: &Canvas) -> Kernel {
        let pitch = canvas.pitch_mm();
        let reach = self.reach_on(canvas);
        let mut kernel = Kernel::zeros(reach);
        self.add_near(&mut kernel, pitch);
        self.add_far(&mut kernel, pitch);
        let edge = (DVec2::new(reach[0] as f64, reach[1] as f64) + 0.5) * pitch;
        let mass = self.parameters.scatter * self.within_rectangle(edge);
        let sum = kernel.sum();
        let mut kernel = kernel.scaled(mass / sum);
        kernel.add(0, 0, 1.0 - self.parameters.scatter);
        kernel
    }

    /// The near taps: rings of exact mass, distributed over the taps.
    fn add_near(&self, kernel: &mut Kernel, pitch_mm: DVec2) {
        let mut near = Kernel::zeros([NEAR_PX, NEAR_PX]);
        let edge = |i: usize| {
            let t = i as f64 / RINGS as f64;
            RINGS_END_PX * pitch_mm.max_element() * t * t
        };
        for ring in 0..RINGS {
            let mass = self.light_within(edge(ring + 1)) - self.light_within(edge(ring));
            let radius = 0.5 * (edge(ring) + edge(ring + 1));
            for angle in 0..ANGLES {
                let (s, c) = sin_cos(TAU * (angle as f64 + 0.5) / ANGLES as f64);
                near.deposit(DVec2::new(c, s) * radius / pitch_mm, mass / ANGLES as f64);
            }
        }
        near.taps().for_each(|(x, y, tap)| kernel.add(x, y, tap));
    }

    /// The far taps: p² (K + p² ∇²K/12), the integral of K with the triangle to fourth order in the pitch.
    fn add_far(&self, kernel: &mut Kernel, pitch_mm: DVec2) {
        let [rx, ry] = kernel.reach();
        for y in 0..=ry as isize {
            for x in 0..=rx as isize {
                if x as usize <= NEAR_PX && y as usize <= NEAR_PX {
                    continue;
                }
                let tap = self.smooth_tap(DVec2::new(x as f64, y as f64) * pitch_mm, pitch_mm);
                let mirrored = |v: isize| if v == 0 { vec![0] } else { vec![v, -v] };
                for y in mirrored(y) {
                    mirrored(x).into_iter().for_each(|x| kernel.add(x, y, tap));
                }
            }
        }
    }

    fn smooth_tap(&self, offset_mm: DVec2, pitch_mm: DVec2) -> f64 {
        let r2 = offset_mm.length_squared();
        let r0 = self.parameters.core_um * MM_PER_UM;
        let (q, base) = (self.half(), r0 * r0 + r2);
        let second = |x: f64, pitch: f64| pitch * pitch / 12.0 * (4.0 * q * (q + 1.0) * x * x / base - 2.0 * q) / base;
        let correction = second(offset_mm.x, pitch_mm.x) + second(offset_mm.y, pitch_mm.y);
        self.density_per_mm2(r2.sqrt()) * (1.0 + correction) * pitch_mm.x * pitch_mm.y
    }

    /// Fraction of the scattered light within |x| ≤ `half_mm.x`, |y| ≤ `half_mm.y`: F at the edge, averaged over directions.
    fn within_rectangle(&self, half_mm: DVec2) -> f64 {
        let corner = atan2(half_mm.y, half_mm.x);
        // The corner is a kink: each side is averaged separately.
        let side = |from: f64, to: f64| {
            let direction = |i: usize| from + (to - from) * (i as f64 + 0.5) / DIRECTIONS as f64;
            let edge = |angle: f64| {
                let (s, c) = sin_cos(angle);
                self.light_within((half_mm.x / c).min(half_mm.y / s))
            };
            (0..DIRECTIONS).map(|i| edge(direction(i))).sum::<f64>() / DIRECTIONS as f64 * (to - from)
        };
        (side(0.0, corner) + side(corner, FRAC_PI_2)) / FRAC_PI_2
    }

    /// p/2.
    fn half(&self) -> f64 {
        0.5 * self.parameters.exponent
    }

    /// r²/r₀².
    fn relative(&self, radius_mm: f64) -> f64 {
        let ratio = radius_mm / (self.parameters.core_um * MM_PER_UM);
        ratio * ratio
    }

    /// G(r) in units of r₀^(2 − p).
    fn integrated_to(&self, radius_mm: f64) -> f64 {
        let (power, log) = (1.0 - self.half(), ln_1p(self.relative(radius_mm)));
        if power == 0.0 { 0.5 * log } else { 0.5 * exp_m1(power * log) / power }
    }

    /// K at the centre, 1/mm².
    fn constant(&self) -> f64 {
        let r0 = self.parameters.core_um * MM_PER_UM;
        let full_extent =
            self.parameters.reach_mm.map_or_else(|| 0.5 / (self.half() - 1.0), |reach| self.integrated_to(reach));
        1.0 / (2.0 * PI * r0 * r0 * full_extent)
    }
}
