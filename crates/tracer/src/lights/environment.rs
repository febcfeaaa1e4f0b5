//! The surroundings of the scene, infinitely far away.
//!
//! An image of the surroundings is equirectangular, z up: its centre looks along +x, a quarter of its width to the left along +y, its left and right
//! edges along −x; the top row is the zenith. A rotation turns the surroundings about z, anticlockwise seen from above. Colours are interpolated
//! between texels. Directions are sampled texel by texel, by the mean of the interpolated image over the texel and its solid angle, so that every
//! direction with radiance can be sampled.

use core::f32::consts::{PI, TAU};

use etendue_core::maths::f32::{acos, atan2, sin_cos};
use etendue_core::{Spectral, WavelengthRange, Wavelengths, distribution::Distribution2, maths};
use etendue_spectra::{Spectrum, upsample};
use glam::{DVec3, Vec2, Vec3};

use super::patches::{EnvironmentCell, patches};
use super::{LightSample, MAX_LIGHT_VALUE, sky::SkyEnvironment};

/// Surroundings of the scene.
#[derive(Clone, Debug)]
pub enum Environment {
    /// The same spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) from every direction.
    Uniform(Spectrum),
    Image(ImageEnvironment),
    /// A clear sky.
    Sky(Box<SkyEnvironment>),
}

impl Environment {
    /// Irradiance that determines how often the surroundings are sampled next to suns of irradiance `of_suns`, W·m⁻²·nm⁻¹; 0 if they are
    /// not sampled. It is the irradiance of their bright patches, and the part of the remaining irradiance that exceeds that of the suns.
    /// Scattered rays hit uniform surroundings as well as light samples do.
    pub(super) fn sampled_irradiance(&self, range: WavelengthRange, of_suns: f64) -> f64 {
        let (mean, patches) = match self {
            Self::Uniform(_) => return 0.0,
            Self::Image(image) => (image.mean_irradiance(range.low_nm, range.high_nm), image.patches),
            Self::Sky(sky) => (sky.mean_irradiance(range.low_nm, range.high_nm), sky.patches),
        };
        mean * patches + (mean * (1.0 - patches) - of_suns).max(0.0)
    }

    /// Radiance from a direction, and the density with which the direction would be sampled, 1/sr. The density is computed only if
    /// `wanted`.
    pub(super) fn radiance_and_pdf<const N: usize>(
        &self,
        direction: Vec3,
        is_wanted: bool,
        wavelengths: &Wavelengths<N>,
    ) -> (Spectral<N>, f32) {
        match self {
            Self::Uniform(radiance) => (radiance.sample(wavelengths), 0.0),
            Self::Image(image) => {
                let place = image.place(direction);
                let pdf = if is_wanted { image.pdf_at(place, direction) } else { 0.0 };
                (image.radiance_at(place, wavelengths), pdf)
            }
            Self::Sky(sky) => (sky.radiance(direction, wavelengths), if is_wanted { sky.pdf(direction) } else { 0.0 }),
        }
    }

    pub(super) fn sample<const N: usize>(&self, u: Vec2, wavelengths: &Wavelengths<N>) -> Option<LightSample<N>> {
        match self {
            Self::Uniform(_) => None,
            Self::Image(image) => image.sample(u, wavelengths),
            Self::Sky(sky) => sky.sample(u, wavelengths),
        }
    }
}

/// Error of an environment image.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum EnvironmentError {
    /// The texels do not fill the image.
    #[error("the environment map has {actual} texels, but its size is {width} × {height}; correct its size")]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Number of texels given.
        actual: usize,
    },
    /// A texel is negative or not finite.
    #[error("texel {texel} of the environment map is negative or not a finite number; correct the image")]
    Texel {
        /// Index of the texel, by rows from the top.
        texel: usize,
    },
    /// All texels are black.
    #[error("the environment map is black everywhere; remove it")]
    Black,
    /// Luminance above [`MAX_LIGHT_VALUE`].
    #[error(
        "the brightest texel of the environment map, {texel:e} times {scale:e} cd/m², exceeds the maximum of 1e30; lower the \
         scale"
    )]
    Bright {
        /// Maximum component of a texel.
        texel: f32,
        /// Luminance scale, cd/m².
        scale: f64,
    },
    /// The scale or the rotation is not a usable number.
    #[error("the scale of the environment map must be positive and finite, and its rotation finite")]
    Placement,
}

/// An image of the surroundings. Its `Debug` text leaves out the texels.
#[derive(Clone)]
pub struct ImageEnvironment {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
    /// Luminance of (1, 1, 1), cd/m².
    scale: f32,
    rotation_turns: f32,
    distribution: Distribution2,
    mean_luminance: f64,
    /// Fraction of bright patches in its light.
    patches: f64,
}

impl core::fmt::Debug for ImageEnvironment {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { width, height, scale, rotation_turns, mean_luminance, .. } = self;
        f.debug_struct("ImageEnvironment")
            .field("size", &(width, height))
            .field("scale", scale)
            .field("rotation_turns", rotation_turns)
            .field("mean_luminance", mean_luminance)
            .finish_non_exhaustive()
    }
}

impl ImageEnvironment {
    /// An image of linear sRGB colours, rows from the zenith down, in which (1, 1, 1) is D65 of `luminance_scale` cd/m², turned by
    /// `rotation_rad` about z.
    ///
    /// # Errors
    /// If the texels do not fill the image, one is negative or not finite, or all are black.
    pub fn new(
        width: usize,
        height: usize,
        texels: Vec<[f32; 3]>,
        luminance_scale: f64,
        rotation_rad: f64,
    ) -> Result<Self, EnvironmentError> {
        if texels.is_empty() || texels.len() != width * height {
            return Err(EnvironmentError::Size { width, height, actual: texels.len() });
        }
        if let Some(texel) = texels.iter().position(|t| t.iter().any(|v| !(v.is_finite() && *v >= 0.0))) {
            return Err(EnvironmentError::Texel { texel });
        }
        if !(luminance_scale > 0.0 && luminance_scale.is_finite() && rotation_rad.is_finite()) {
            return Err(EnvironmentError::Placement);
        }
        let brightest = texels.iter().flatten().fold(0.0_f32, |maximum, v| maximum.max(*v));
        if f64::from(brightest) * luminance_scale > f64::from(MAX_LIGHT_VALUE) {
            return Err(EnvironmentError::Bright { texel: brightest, scale: luminance_scale });
        }
        let weights = weights(width, height, &texels);
        let distribution = Distribution2::new(width, &weights).ok_or(EnvironmentError::Black)?;
        let solid_angle_mean: f64 = (0..height).map(|y| solid_angle(y, height)).sum::<f64>() / height as f64;
        let mean_luminance = luminance_scale * distribution.mean() / solid_angle_mean;
        let rotation_turns = (rotation_rad / core::f64::consts::TAU).rem_euclid(1.0) as f32;
        let scale = luminance_scale as f32;
        let patches = patches(weights.iter().enumerate().map(|(k, weight)| EnvironmentCell {
            weight: f64::from(*weight),
            solid_angle: solid_angle(k / width, height) / width as f64,
        }));
        Ok(Self { width, height, texels, scale, rotation_turns, distribution, mean_luminance, patches })
    }

    /// Spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) from the unit `direction` (away from the viewer).
    #[must_use]
    pub fn radiance<const N: usize>(&self, direction: Vec3, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        self.radiance_at(self.place(direction), wavelengths)
    }

    fn radiance_at<const N: usize>(&self, place: Vec2, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        upsample::emission((self.colour(place) * self.scale).to_array(), wavelengths)
    }

    /// Place in the image (to the right, downwards, in [0, 1]) of a direction.
    fn place(&self, direction: Vec3) -> Vec2 {
        let turns = 0.5 - atan2(direction.y, direction.x) / TAU + self.rotation_turns;
        Vec2::new((turns - turns.floor()).min(ONE_BELOW), (acos(direction.z.clamp(-1.0, 1.0)) / PI).min(ONE_BELOW))
    }

    /// Direction of a place in the image, and the sine of its angle from z.
    fn direction(&self, place: Vec2) -> (Vec3, f32) {
        let (sin_phi, cos_phi) = sin_cos((0.5 - place.x + self.rotation_turns) * TAU);
        let (sin, cos) = sin_cos(place.y * PI);
        (Vec3::new(sin * cos_phi, sin * sin_phi, cos), sin)
    }

    fn colour(&self, place: Vec2) -> Vec3 {
        let (x, y) = (place.x * self.width as f32 - 0.5, place.y * self.height as f32 - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let line = |j: i32| self.texel(column as i32, j).lerp(self.texel(column as i32 + 1, j), x - column);
        line(row as i32).lerp(line(row as i32 + 1), y - row)
    }

    /// Texel at a column and row. Columns wrap at the edges, rows are clamped at the poles.
    fn texel(&self, column: i32, row: i32) -> Vec3 {
        // At most one column beyond an edge.
        let width = self.width as i32;
        let x = if column < 0 { column + width } else { column };
        let x = (if x >= width { x - width } else { x }) as usize;
        let y = row.clamp(0, self.height as i32 - 1) as usize;
        Vec3::from(self.texels[y * self.width + x])
    }

    /// Density with which [`ImageEnvironment::sample`] returns the unit `direction`, 1/sr.
    #[cfg(test)]
    fn pdf(&self, direction: Vec3) -> f32 {
        self.pdf_at(self.place(direction), direction)
    }

    fn pdf_at(&self, place: Vec2, direction: Vec3) -> f32 {
        let sin = (direction.x * direction.x + direction.y * direction.y).sqrt();
        if sin > 0.0 { self.distribution.pdf(place) / (2.0 * PI * PI * sin) } else { 0.0 }
    }

    pub(super) fn sample<const N: usize>(&self, u: Vec2, wavelengths: &Wavelengths<N>) -> Option<LightSample<N>> {
        let (place, by_area) = self.distribution.sample(u);
        let (direction, sin) = self.direction(place);
        let pdf = by_area / (2.0 * PI * PI * sin);
        LightSample::from_environment(direction, self.radiance_at(place, wavelengths), pdf)
    }

    /// Spectral irradiance of a surface under the mean colour of all directions, W·m⁻²·nm⁻¹.
    pub(super) fn irradiance(&self) -> Spectrum {
        let rows = self.texels.chunks(self.width).enumerate();
        let row = |(y, texels): (usize, &[[f32; 3]])| {
            let sum = texels.iter().fold(DVec3::ZERO, |sum, texel| sum + Vec3::from(*texel).as_dvec3());
            sum * (solid_angle(y, self.height) / self.width as f64)
        };
        let mean = rows.map(row).fold(DVec3::ZERO, |sum, row| sum + row);
        upsample::emission_spectrum((mean * f64::from(self.scale)).as_vec3().to_array()).scaled(f64::from(PI))
    }

    pub(super) fn mean_irradiance(&self, low_nm: f64, high_nm: f64) -> f64 {
        let white = upsample::emission_spectrum([1.0; 3]);
        core::f64::consts::PI * self.mean_luminance * white.band_mean(low_nm, high_nm)
    }
}

const ONE_BELOW: f32 = 1.0 - 0.5 * f32::EPSILON;

/// Solid angle of row `y`, in units of the whole sphere.
fn solid_angle(y: usize, height: usize) -> f64 {
    let edge = |y: usize| maths::f64::cos(core::f64::consts::PI * y as f64 / height as f64);
    0.5 * (edge(y) - edge(y + 1))
}

/// Mean of the interpolated image over each texel, all channels weighted equally, times the texel's solid angle.
fn weights(width: usize, height: usize, texels: &[[f32; 3]]) -> Vec<f32> {
    let grey = |x: usize, y: usize| texels[y * width + x].iter().map(|v| f64::from(*v)).sum::<f64>() / 3.0;
    // The mean of linear interpolation over a texel is 1/8, 6/8, 1/8 of its neighbours and itself.
    let across =
        |x: usize, y: usize| 0.125 * (grey((x + width - 1) % width, y) + grey((x + 1) % width, y)) + 0.75 * grey(x, y);
    let mean = |x: usize, y: usize| {
        0.125 * (across(x, y.saturating_sub(1)) + across(x, (y + 1).min(height - 1))) + 0.75 * across(x, y)
    };
    let cells = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    cells.map(|(x, y)| (mean(x, y) * solid_angle(y, height)) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient(width: usize, height: usize, rotation_rad: f64) -> ImageEnvironment {
        let texels = (0..width * height).map(|i| [(i % 7) as f32, (i % 5) as f32, 0.5]).collect();
        ImageEnvironment::new(width, height, texels, 1.0, rotation_rad).expect("surroundings")
    }

    #[test]
    fn the_image_lies_as_stated() {
        let e = gradient(8, 4, 0.0);
        for (direction, place) in [
            (Vec3::X, Vec2::new(0.5, 0.5)),
            (Vec3::Y, Vec2::new(0.25, 0.5)),
            (Vec3::NEG_Y, Vec2::new(0.75, 0.5)),
            (Vec3::Z, Vec2::new(0.5, 0.0)),
        ] {
            assert!((e.place(direction) - place).length() < 1e-6, "{direction}: {}", e.place(direction));
        }
        let turned = gradient(8, 4, core::f64::consts::FRAC_PI_2);
        assert!((turned.place(Vec3::Y) - Vec2::splat(0.5)).length() < 1e-6, "the centre has turned to +y");
    }

    #[test]
    fn places_and_directions_are_inverse() {
        for rotation in [0.0, 1.0, -2.5] {
            let e = gradient(8, 4, rotation);
            for i in 0..100 {
                let place = Vec2::new((i % 10) as f32 / 10.0 + 0.05, (i / 10) as f32 / 10.0 + 0.05);
                assert!((e.place(e.direction(place).0) - place).length() < 1e-5);
            }
        }
    }

    #[test]
    fn densities_integrate_to_one_and_are_those_of_the_samples() {
        let e = gradient(16, 8, 0.7);
        let (n, mut sum, mut apart) = (1 << 16, 0.0, 0);
        for i in 0..n {
            // A lattice of two dimensions (golden ratio): error of the order log(n)/n for bounded integrands.
            let u = Vec2::new((i as f32 + 0.5) / n as f32, (0.618_034 * (f64::from(i) + 0.5)).fract() as f32);
            sum += f64::from(e.pdf(etendue_core::warp::uniform_sphere(u))) * 4.0 * core::f64::consts::PI;
            let sample = e.sample(u, &Wavelengths::<1>::uniform(400.0, 700.0, 0.5)).expect("light");
            let pdf = e.pdf(sample.direction);
            apart += usize::from((pdf - sample.pdf).abs() > 1e-3 * sample.pdf);
        }
        assert!((sum / f64::from(n) - 1.0).abs() < 2e-3, "{}", sum / f64::from(n));
        // Only on the borders of texels may rounding give the neighbour's density.
        assert!(apart < 100, "{apart} of 65536 densities differ");
    }

    #[test]
    fn whatever_shines_can_be_sampled() {
        let mut texels = vec![[0.0; 3]; 32];
        texels[12] = [0.0, 0.0, 3.0];
        let e = ImageEnvironment::new(8, 4, texels, 1.0, 0.0).expect("one star");
        let w = Wavelengths::<1>::uniform(400.0, 700.0, 0.2);
        for i in 0..4096 {
            let u = Vec2::new(((i % 64) as f32 + 0.5) / 64.0, ((i / 64) as f32 + 0.5) / 64.0);
            let direction = etendue_core::warp::uniform_sphere(u);
            assert!(e.radiance(direction, &w)[0] <= 0.0 || e.pdf(direction) > 0.0);
        }
    }

    #[test]
    fn faulty_surroundings_are_refused() {
        let of = |texels: Vec<[f32; 3]>, scale| ImageEnvironment::new(2, 1, texels, scale, 0.0).err();
        assert!(matches!(of(vec![[1.0; 3]], 1.0), Some(EnvironmentError::Size { .. })));
        assert_eq!(of(vec![[1.0; 3], [-1.0; 3]], 1.0), Some(EnvironmentError::Texel { texel: 1 }));
        assert_eq!(of(vec![[0.0; 3]; 2], 1.0), Some(EnvironmentError::Black));
        assert_eq!(of(vec![[1.0; 3]; 2], 0.0), Some(EnvironmentError::Placement));
    }
}
