//! State of a path besides its throughput: the footprint of texture look-ups, the scattering history, the state of Russian roulette and the current
//! medium.

use core::f32::consts::FRAC_1_PI;

use etendue_core::{Spectral, Wavelengths, maths::f32::exp};
use etendue_spectra::Spectrum;
use glam::Vec3;

/// Fraction of the scattered cone that later look-ups average over.
const SPREAD_FRACTION: f32 = 0.25;

/// Spread from which on a footprint has no long side, rad: that of a pixel of a very wide or coarse camera.
const MAX_ELONGATED_SPREAD_RAD: f32 = 0.02;

/// Maximum ratio of length to width of a footprint.
const MAX_ELONGATION: f32 = 1000.0;

/// Width and growth of a path: the footprint of texture look-ups.
///
/// A cone about the path (Amanatides 1984): its width grows by spread × distance. Scattering with density p widens the spread to at least a
/// quarter of √(1/(π p)), the half angle of a small cone of solid angle 1/p, limited to 1 rad. A diffuse surface (p ≤ 1/π) thus always
/// widens it to 0.25 rad, a mirror not at all. The quarter is a choice: it keeps texture visible in light between diffuse surfaces.
/// Curvature of mirrors is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PathCone {
    pub(super) width_m: f32,
    pub(super) spread_rad: f32,
}

impl PathCone {
    pub(super) fn new(spread_rad: f32) -> Self {
        Self { width_m: 0.0, spread_rad }
    }

    pub(super) fn travel(&mut self, distance_m: f32) {
        self.width_m += self.spread_rad * distance_m;
    }

    /// The long side (m, from end to end) of the ellipse in which the cone cuts a surface of unit `normal`, about the unit `direction`:
    /// `None` if it is less than twice as long as wide. A cone that scattering has widened has none: such a path sees an average of many
    /// others, and long sides need many texture readings.
    pub(super) fn long_side(self, normal: Vec3, direction: Vec3) -> Option<Vec3> {
        let cos = normal.dot(direction);
        let is_long = cos.abs() < 0.5 && self.spread_rad < MAX_ELONGATED_SPREAD_RAD;
        let along = direction - normal * cos;
        is_long.then(|| along.normalize_or_zero() * (self.width_m / cos.abs().max(1.0 / MAX_ELONGATION)))
    }

    /// Widens the cone after scattering into a direction of density `pdf`, 1/sr.
    pub(super) fn scatter(&mut self, pdf: f32) {
        self.spread_rad = self.spread_rad.max(SPREAD_FRACTION * (FRAC_1_PI / pdf).sqrt().min(1.0));
    }
}

// Caustics of light sources: light that a smooth surface focuses on a diffuse one, or a mirror on a surface that blurs its reflection.
//
// Seen from the camera, a path scatters at a diffuse surface, then at a smooth one, and then hits a sun or an emitting surface; or it
// scatters at a glossy surface (a wet road), then at one that is much smoother (car paint). Unidirectional paths find such light only by
// chance, in a few very bright samples. If the caller leaves it out ([`super::PathSettings::caustics`]), the image is darker by exactly
// that light: light of suns and emitting surfaces that arrives by a scattering of more than [`SMOOTH_PER_SR`] after one of less, or by one
// of more than [`MIN_CAUSTIC_RATIO`] times the density of one before it. Reflections of the surroundings in smooth surfaces are kept.
//
// In fog the light of a sun comes from a bright patch around it, which paths find as rarely. Without caustics, light that a medium's
// forward peak scatters counts as not scattered, behind the first diffuse surface and the first scattering in a medium (`crate::media`).
// The rule uses densities alone, so that it holds for sampled lights and for lights that are hit.

/// Density of scattering, 1/sr, above which a surface counts as smooth: that of the highlight of a GGX surface of α ≈ 0.14.
const SMOOTH_PER_SR: f32 = 4.0;

/// Ratio of a scattering density to the smallest density before it, above which light that arrives by this scattering is part of a caustic:
/// the earlier, glossier surface samples the directions of that light only by chance. For GGX surfaces the ratio corresponds to an α of an
/// eighth to a quarter of the earlier surface's.
const MIN_CAUSTIC_RATIO: f32 = 16.0;

/// The kinds of scattering that a path has undergone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScatteringHistory {
    has_diffuse: bool,
    caustic: bool,
    /// Minimum density of any scattering, 1/sr; infinite if all were mirrors.
    min_density: f32,
}

impl Default for ScatteringHistory {
    fn default() -> Self {
        Self { has_diffuse: false, caustic: false, min_density: f32::INFINITY }
    }
}

impl ScatteringHistory {
    /// Adds a scattering of density `pdf`, 1/sr; `None` for a mirror.
    pub(super) fn scatter(&mut self, pdf: Option<f32>) {
        let density = pdf.unwrap_or(f32::INFINITY);
        self.caustic = self.would_be_caustic(density);
        self.has_diffuse |= !is_smooth(density);
        self.min_density = self.min_density.min(density);
    }

    /// Minimum density of any scattering so far, 1/sr; infinite if all were mirrors.
    pub(super) fn min_density(self) -> f32 {
        self.min_density
    }

    /// True if the path comes straight from the camera, or by mirrors alone.
    pub(super) fn is_directly_visible(self) -> bool {
        self.min_density == f32::INFINITY
    }

    /// True if anything except smooth surfaces has scattered the path.
    pub(super) fn has_diffuse(self) -> bool {
        self.has_diffuse
    }

    /// True if the path has such a scattering once it continues by one of density `pdf`, 1/sr.
    pub(super) fn would_have_diffuse(self, pdf: f32) -> bool {
        self.has_diffuse || !is_smooth(pdf)
    }

    /// True if light of a source that is hit now is part of a caustic.
    pub(super) fn is_caustic(self) -> bool {
        self.caustic
    }

    /// True if light of a source would be part of a caustic if it arrived by a scattering of density `pdf`, 1/sr.
    pub(super) fn would_be_caustic(self, pdf: f32) -> bool {
        is_smooth(pdf) && (self.has_diffuse || pdf > MIN_CAUSTIC_RATIO * self.min_density)
    }
}

fn is_smooth(pdf: f32) -> bool {
    pdf > SMOOTH_PER_SR
}

/// Survival probability of a path, over the fraction that is left of its throughput behind the first surface.
const PROBABILITY_PER_FRACTION: f32 = 1.5;

/// The throughput from which Russian roulette computes the survival probability of a path.
#[derive(Clone, Copy)]
pub(super) struct RouletteState {
    /// Factor on the path's throughput: the relative densities of guided directions, and the throughputs at which `path_reuse.rs` has set it to one.
    factor: f32,
    /// Throughput behind the first surface that is no mirror.
    first: Option<f32>,
}

impl Default for RouletteState {
    fn default() -> Self {
        Self { factor: 1.0, first: None }
    }
}

impl RouletteState {
    /// Multiplies the factor on the throughput.
    pub(super) fn scale(&mut self, factor: f32) {
        self.factor *= factor;
    }

    /// Survival probability of a path that more than mirrors have scattered. At 1 or more, or NaN, it survives.
    pub(super) fn survival_probability(&mut self, throughput: f32) -> f32 {
        let now = self.factor * throughput;
        PROBABILITY_PER_FRACTION * (now / *self.first.get_or_insert(now))
    }
}

/// The medium that a path is in: air, or the inside of clear, absorbing matter.
///
/// Beer–Lambert: over d metres of absorption coefficient a (1/m) the fraction exp(−a d) is left. A path is inside from the point where it
/// was refracted in, or from a camera inside ([`super::Surroundings`]), until it is refracted out. Fog and other media (`crate::media`) are
/// not in solids. Left out: scattering inside, and solids within solids (a path that leaves the inner one is in air).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathMedium<'a> {
    /// Absorption coefficient, 1/m; `None` if nothing absorbs.
    absorption: Option<&'a Spectrum>,
    /// True for the inside of a solid.
    solid: bool,
}

impl<'a> PathMedium<'a> {
    /// The medium beyond a surface whose inside has this `absorption`, for a path that comes from its front or its back.
    pub(super) fn beyond(front: bool, solid: bool, absorption: Option<&'a Spectrum>) -> Self {
        Self { absorption: if front { absorption } else { None }, solid: solid && front }
    }

    /// The inside of a solid of this `absorption`.
    pub(super) fn inside(absorption: Option<&'a Spectrum>) -> Self {
        Self { absorption, solid: true }
    }

    /// True for the inside of a solid.
    pub(super) fn is_solid(self) -> bool {
        self.solid
    }

    /// True if nothing absorbs.
    pub(super) fn is_clear(self) -> bool {
        self.absorption.is_none()
    }

    /// Returns `light` after absorption over `distance_m`.
    pub(super) fn attenuate<const N: usize>(
        self,
        light: Spectral<N>,
        distance_m: f32,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        match self.absorption {
            None => light,
            Some(absorption) => light * absorption.sample(wavelengths).map(|a| exp(-a * distance_m)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(spread_rad: f32, pdf: f32) -> f32 {
        let mut cone = PathCone::new(spread_rad);
        cone.scatter(pdf);
        cone.spread_rad
    }

    #[test]
    fn scattering_widens_as_stated() {
        for cos in [1.0, 0.5, 1e-6] {
            assert_eq!(after(1e-3, cos * FRAC_1_PI), SPREAD_FRACTION, "Lambert's law at cosine {cos}");
        }
        // A lobe of a hundredth of a diffuse surface's solid angle is a tenth as wide; four roundings of 6e-8.
        assert!((after(1e-3, 100.0 * FRAC_1_PI) - 0.1 * SPREAD_FRACTION).abs() < 1e-8);
        assert_eq!(after(1e-3, 1e12), 1e-3, "a lobe narrower than the cone leaves it");
        assert_eq!(after(0.5, FRAC_1_PI), 0.5, "nothing narrows it");
    }

    #[test]
    fn grazing_cones_cut_long_ellipses() {
        let cone = PathCone { width_m: 0.1, spread_rad: 1e-3 };
        let direction = Vec3::new(0.6, 0.0, -0.8);
        assert_eq!(cone.long_side(Vec3::Z, direction), None);
        // Seen at a cosine of 0.28: 0.1 / 0.28 along x, from either side.
        let grazing = Vec3::new(0.96, 0.0, -0.28);
        for normal in [Vec3::Z, Vec3::NEG_Z] {
            let long = cone.long_side(normal, grazing).expect("long");
            assert!((long - Vec3::X * (0.1 / 0.28)).length() < 1e-6, "{long}");
        }
        assert_eq!(PathCone { spread_rad: 0.25, ..cone }.long_side(Vec3::Z, grazing), None);
        assert!(cone.long_side(Vec3::Z, Vec3::X).expect("long").is_finite());
    }

    #[test]
    fn width_grows_with_the_way() {
        let mut cone = PathCone::new(0.5);
        cone.travel(2.0);
        cone.scatter(1e12);
        cone.travel(4.0);
        assert_eq!(cone.width_m, 3.0);
    }

    #[test]
    fn a_caustic_is_smooth_after_diffuse() {
        let after = |events: &[Option<f32>]| {
            let mut history = ScatteringHistory::default();
            events.iter().for_each(|pdf| history.scatter(*pdf));
            history.is_caustic()
        };
        assert!(!after(&[]) && !after(&[None]) && !after(&[Some(0.3)]) && !after(&[Some(50.0), Some(0.3)]));
        assert!(after(&[Some(0.3), None]) && after(&[Some(0.3), Some(50.0)]) && after(&[Some(0.3), None, None]));
        let mut diffuse = ScatteringHistory::default();
        diffuse.scatter(Some(0.3));
        assert!(diffuse.would_be_caustic(50.0) && !diffuse.would_be_caustic(0.3));
        assert!(!ScatteringHistory::default().would_be_caustic(50.0));
        assert!(!after(&[Some(20.0), Some(300.0)]) && after(&[Some(20.0), Some(330.0)]) && after(&[Some(20.0), None]));
        // Scattering in a medium counts as of zero density.
        assert!(!after(&[Some(0.0), Some(0.3)]) && after(&[Some(0.0), Some(5.0)]));
        assert!(!after(&[Some(5000.0), Some(20.0)]) && !after(&[None, None]) && !after(&[None, Some(20.0)]));
    }

    #[test]
    fn the_law_of_beer_and_lambert() {
        let wavelengths = Wavelengths::<4>::uniform(400.0, 700.0, 0.3);
        let absorption = Spectrum::constant(50.0);
        let left = |medium: PathMedium<'_>, d: f32| medium.attenuate(Spectral::splat(2.0), d, &wavelengths)[1];
        // exp(−0.5) = 0.606 531; two roundings.
        assert!((left(PathMedium::beyond(true, true, Some(&absorption)), 0.01) - 2.0 * 0.606_530_7).abs() < 3e-7);
        assert_eq!(left(PathMedium::beyond(true, true, Some(&absorption)), 1e9), 0.0, "no light is left, and no NaN");
        assert_eq!(left(PathMedium::beyond(false, true, Some(&absorption)), 7.0), 2.0, "outside");
        assert_eq!(left(PathMedium::beyond(true, true, None), 7.0), 2.0, "perfectly clear");
    }
}
