//! A camera without its pose: lens, sensor and processing, and the margin of pixels around its image that they need.

use super::products::{Development, PictureFormat};
use super::row_exposure::RowExposure;
use etendue_optics::{DepthOfField, Effects, Front, FrontRay, Lens, OpticsError};
use etendue_projection::Raster;
use etendue_scene::Place;
use etendue_sensor::Sensor;
use glam::DVec2;

/// Distance of the nearest object whose blur from outside the image is included, m.
const MIN_DISTANCE_M: f64 = 1.0;
/// Maximum margin, as a fraction of the longer side of the image.
const MAX_MARGIN: f64 = 0.25;

/// A camera without its pose: lens, effects, sensor, processing.
#[derive(Clone, Debug)]
pub struct CameraBody {
    /// Place in the description that states the image size.
    pub place: Place,
    /// The pixel grid.
    pub raster: Raster,
    /// Number of pixels of the described sensor along each side of one pixel: 4 for the scale 1/4.
    pub scale: u64,
    pub lens: Lens,
    /// Optics in front of the lens; `None` without any.
    pub front: Option<Front>,
    /// Effects on the irradiance behind the lens.
    pub effects: Effects,
    /// Side of the photosensitive area, in pixels.
    pub aperture_px: f64,
    /// Exposure times of its rows.
    pub exposure: RowExposure,
    /// Electronics; `None` if no electrons are requested.
    pub sensor: Option<Sensor>,
    /// Processing from raw to image; `None` if no image is requested.
    pub development: Option<Development>,
}

impl CameraBody {
    /// File format of its images.
    #[must_use]
    pub fn picture_format(&self) -> PictureFormat {
        self.development.as_ref().map_or(PictureFormat::Png { bits: 8 }, |development| development.format)
    }

    /// Raster that is rendered: the image, and the pixels around it that the effects need.
    #[must_use]
    pub fn film(&self) -> Raster {
        self.effects.film(&self.raster)
    }

    /// Ray of the ground truth from an image point (px), and whether its origin is off the pupil's centre; `None` where no light arrives.
    #[must_use]
    pub fn truth_ray(&self, raster_px: DVec2) -> Option<(FrontRay, bool)> {
        let sensor_mm = self.raster.sensor_mm(raster_px);
        match &self.front {
            Some(front) => front.truth_ray(&self.lens, sensor_mm),
            None => self.lens.truth_ray(sensor_mm).map(|truth| (FrontRay::without_front(truth.ray), truth.off_centre)),
        }
    }

    /// Returns true if a ray or its weight depends on wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.lens.disperses() || self.front.as_ref().is_some_and(Front::disperses)
    }

    /// Returns true if some pixels look sideways, backwards or at a mirror, where depth along the axis is undefined. Tests a grid over the image, including
    /// its edges.
    pub(crate) fn depth_has_gaps(&self) -> bool {
        const STEPS: usize = 16;
        let at = |i: usize, size: usize| (i * (size - 1)) as f64 / STEPS as f64 + 0.5;
        let pixels = (0..=STEPS).flat_map(|y| (0..=STEPS).map(move |x| (x, y)));
        let mut rays = pixels.filter_map(|(x, y)| {
            self.truth_ray(DVec2::new(at(x, self.raster.width()), at(y, self.raster.height()))).map(|(front, _)| front)
        });
        rays.any(|front| !has_planar_depth(&front))
    }

    /// Refuses optics in front of the lens that bend rays: they cannot be applied to a stored radiance image.
    pub(crate) fn check_front_on_picture(&self) -> Result<(), OpticsError> {
        match self.front.as_ref().and_then(|front| front.optic()) {
            None => Ok(()),
            Some(optic) => Err(OpticsError::FrontNeedsLens { what: optic.name() }),
        }
    }

    /// Returns the margin around the image for depth of field, px: the blur of objects at 1 m and farther, limited to a quarter of the image's longer side.
    #[must_use]
    pub fn blur_margin_px(&self, depth_of_field: &DepthOfField) -> usize {
        self.blur_reach_px(depth_of_field).min(self.max_blur_margin_px())
    }

    /// Returns the blur of objects at 1 m and farther, and the margin, px, if the margin is smaller: light from beyond it counts as the mean of the light
    /// within.
    #[must_use]
    pub fn short_blur_margin_px(&self, depth_of_field: &DepthOfField) -> Option<[usize; 2]> {
        let [reach, max_margin] = [self.blur_reach_px(depth_of_field), self.max_blur_margin_px()];
        (reach > max_margin).then_some([reach, max_margin])
    }

    fn blur_reach_px(&self, depth_of_field: &DepthOfField) -> usize {
        depth_of_field.reach_px(&self.lens, &self.raster, MIN_DISTANCE_M)
    }

    fn max_blur_margin_px(&self) -> usize {
        (MAX_MARGIN * self.raster.width().max(self.raster.height()) as f64) as usize
    }

    /// Returns the margin around the image, columns and rows: that of the effects behind the lens, plus `blur_margin_px` for depth of field.
    #[must_use]
    pub fn whole_margin_px(&self, blur_margin_px: usize) -> [usize; 2] {
        self.effects.margin_px().map(|of_effects| of_effects + blur_margin_px)
    }
}

/// Returns true if the depth of a hit is measured along the camera's axis.
pub(crate) fn has_planar_depth(front: &FrontRay) -> bool {
    front.ray.direction.z > 0.0 && front.mirror_m.is_none()
}
