//! Dirt and scratches on the front glass: an image of transmittances on a plane before the lens.
//!
//! Each ray is weighted by the mask at its crossing, so the dirt has its true defocus. On stored radiance the mask becomes an operator: each pixel is
//! multiplied by the mask's mean over its footprint, the bundle of rays that reaches the pixel ([`Dirt::shade`]). This ignores the variation of a
//! pixel's blurred scene over the pupil.
//!
//! Left out: light that the dirt scatters into the image (see glare), its thickness, its colour.

use core::fmt;

use glam::{DVec2, DVec3};

use super::{MemberRay, Placement, line};
use crate::error::front::{FrontError, positive};
use crate::{lens::Lens, overlap::PRINCIPAL_NM};

/// Pupil samples for the mean over a footprint: a rank-1 sequence whose steps are powers of the inverse of 1.3247…, the root of x³ = x + 1, so that
/// no edge runs along its rows (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
const SAMPLES: u32 = 1024;
const STEP: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);

/// Transmittances, 0 … 1, row by row, the top one first.
#[derive(Clone, PartialEq)]
pub struct Mask {
    width: usize,
    height: usize,
    transmittance: Vec<f32>,
}

impl fmt::Debug for Mask {
    /// Prints the size only: the texels are those of the file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mask({} × {})", self.width, self.height)
    }
}

impl Mask {
    /// Creates a mask.
    ///
    /// # Errors
    /// If the number of texels does not match the size, there are none, or one is outside 0 to 1.
    pub fn new(width: usize, height: usize, transmittance: Vec<f32>) -> Result<Self, FrontError> {
        if width == 0 || height == 0 || transmittance.len() != width * height {
            return Err(FrontError::MaskSize { width, height, texels: transmittance.len() });
        }
        if let Some(texel) = transmittance.iter().find(|t| !(0.0..=1.0).contains(*t)) {
            return Err(FrontError::Fraction { name: "the mask", value: f64::from(*texel), range: "0 and 1" });
        }
        Ok(Self { width, height, transmittance })
    }

    /// Linear interpolation between texel centres; `at` from 0 to 1 over the image, from its top left.
    fn at(&self, at: DVec2) -> f64 {
        let size = DVec2::new(self.width as f64, self.height as f64);
        let texel = (at * size - 0.5).clamp(DVec2::ZERO, size - 1.0);
        let (low, part) = (texel.floor(), texel - texel.floor());
        let [x, y] = [low.x as usize, low.y as usize];
        let [right, down] = [(x + 1).min(self.width - 1), (y + 1).min(self.height - 1)];
        let read = |x: usize, y: usize| f64::from(self.transmittance[y * self.width + x]);
        let across = |y: usize| read(x, y) + part.x * (read(right, y) - read(x, y));
        across(y) + part.y * (across(down) - across(y))
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct DirtParameters {
    /// Placement: the centre of the mask is at the origin, in the plane z = 0, x to the right, y down.
    pub placement: Placement,
    /// Width and height of the mask, mm. Beyond it the glass is clean.
    pub size_mm: DVec2,
    pub mask: Mask,
}

/// Dirt on the front glass.
#[derive(Clone, Debug, PartialEq)]
pub struct Dirt {
    parameters: DirtParameters,
}

impl Dirt {
    /// Creates dirt.
    ///
    /// # Errors
    /// If the size is invalid.
    pub fn new(parameters: DirtParameters) -> Result<Self, FrontError> {
        positive("size_mm", parameters.size_mm.min_element())?;
        positive("size_mm", parameters.size_mm.max_element())?;
        Ok(Self { parameters })
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &DirtParameters {
        &self.parameters
    }

    /// True if a ray starts on the camera's side of the dirt.
    pub(super) fn is_after(&self, start: MemberRay) -> bool {
        self.parameters.placement.inward(start).point_mm.z < 0.0
    }

    /// The transmitted fraction of a ray's light.
    pub(super) fn transmittance_along(&self, ray: MemberRay) -> f64 {
        let MemberRay { point_mm, direction } = self.parameters.placement.inward(ray);
        let travel = -point_mm.z / direction.z;
        if !(travel.is_finite() && travel > 0.0) {
            return 1.0;
        }
        let crossing: DVec3 = point_mm + direction * travel;
        let at = crossing.truncate() / self.parameters.size_mm + 0.5;
        let inside = at.cmpge(DVec2::ZERO).all() && at.cmple(DVec2::ONE).all();
        if inside { self.parameters.mask.at(at) } else { 1.0 }
    }

    /// Mean transmittance over the footprint of a sensor point (mm), at 587.56 nm; 1 if no light arrives.
    #[must_use]
    pub fn shade(&self, lens: &Lens, sensor_mm: DVec2) -> f64 {
        let (mut passed, mut all) = (0.0, 0.0);
        for i in 0..SAMPLES {
            let pupil = (STEP * (f64::from(i) + 0.5)).fract();
            if let Some(ray) = lens.ray(sensor_mm, pupil, PRINCIPAL_NM) {
                passed += ray.weight_sr * self.transmittance_along(line(&ray));
                all += ray.weight_sr;
            }
        }
        if all > 0.0 { passed / all } else { 1.0 }
    }
}
