//! A camera wherever it stands: its lens, sensor and processing, and the pixels around its picture that they need.

use super::products::{Development, PictureFormat};
use super::row_exposure::RowExposure;
use etendue_optics::{DepthOfField, Effects, Front, FrontRay, Lens, OpticsError};
use etendue_projection::Raster;
use etendue_scene::Place;
use etendue_sensor::Sensor;
use glam::DVec2;

/// Distance of the nearest thing whose blur is followed from wholly outside of the picture, m.
const NEAREST_M: f64 = 1.0;
/// The maximum margin, as a part of the picture's longer side.
const MAX_MARGIN: f64 = 0.25;

/// A camera wherever it stands: lens, effects, sensor, processing.
#[derive(Clone, Debug)]
pub struct CameraBody {
    /// Where the description says how large the picture is.
    pub place: Place,
    /// The pixel grid.
    pub raster: Raster,
    /// Number of pixels of the described sensor in a row and in a column of one pixel: 4 for the scale 1/4.
    pub scale: u64,
    /// The lens.
    pub lens: Lens,
    /// What stands in front of it; `None` where nothing does.
    pub front: Option<Front>,
    /// What becomes of the irradiance behind the lens.
    pub effects: Effects,
    /// Side of the photosensitive area, in pixels.
    pub aperture_px: f64,
    /// When its rows are exposed.
    pub exposure: RowExposure,
    /// The electronics; `None` where no electrons are wanted.
    pub sensor: Option<Sensor>,
    /// How raw becomes a picture; `None` where none is wanted.
    pub development: Option<Development>,
}

impl CameraBody {
    /// How its pictures are written.
    #[must_use]
    pub fn picture_format(&self) -> PictureFormat {
        self.development.as_ref().map_or(PictureFormat::Png { bits: 8 }, |development| development.format)
    }

    /// The pixels that are rendered: the picture's, and those beyond it that the effects need.
    #[must_use]
    pub fn film(&self) -> Raster {
        self.effects.film(&self.raster)
    }

    /// The ray by which ground truth looks from a point of the picture (px), and whether it is off the pupil's centre;
    /// `None` where no light comes.
    #[must_use]
    pub fn truth_ray(&self, raster_px: DVec2) -> Option<(FrontRay, bool)> {
        let sensor_mm = self.raster.sensor_mm(raster_px);
        match &self.front {
            Some(front) => front.truth_ray(&self.lens, sensor_mm),
            None => self.lens.truth_ray(sensor_mm).map(|truth| (FrontRay::bare(truth.ray), truth.off_centre)),
        }
    }

    /// Whether a ray or its weight depends on the wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.lens.disperses() || self.front.as_ref().is_some_and(Front::disperses)
    }

    /// Whether some pixels look sideways, back or at a mirror, where depth along the axis means nothing: of a grid over the picture, its
    /// edges included.
    pub(crate) fn depth_has_gaps(&self) -> bool {
        const STEPS: usize = 16;
        let at = |i: usize, size: usize| (i * (size - 1)) as f64 / STEPS as f64 + 0.5;
        let pixels = (0..=STEPS).flat_map(|y| (0..=STEPS).map(move |x| (x, y)));
        let mut rays = pixels.filter_map(|(x, y)| {
            self.truth_ray(DVec2::new(at(x, self.raster.width()), at(y, self.raster.height()))).map(|(front, _)| front)
        });
        rays.any(|front| !has_planar_depth(&front))
    }

    /// Refuses what cannot be put on a stored radiance image: what bends rays in front of the lens.
    pub(crate) fn check_front_on_picture(&self) -> Result<(), OpticsError> {
        match self.front.as_ref().and_then(|front| front.optic()) {
            None => Ok(()),
            Some(optic) => Err(OpticsError::FrontNeedsLens { what: optic.name() }),
        }
    }

    /// Returns the pixels around the picture that its depth of field needs: as far as things at 1 m and farther blur, and a quarter of the
    /// picture's longer side at most.
    #[must_use]
    pub fn blur_margin_px(&self, depth_of_field: &DepthOfField) -> usize {
        self.blur_reach_px(depth_of_field).min(self.max_blur_margin_px())
    }

    /// Returns how far things at 1 m and farther blur, and the margin that is kept, px, where that is less: light from beyond it counts as the mean of
    /// what is within.
    #[must_use]
    pub fn short_blur_margin_px(&self, depth_of_field: &DepthOfField) -> Option<[usize; 2]> {
        let [reach, most] = [self.blur_reach_px(depth_of_field), self.max_blur_margin_px()];
        (reach > most).then_some([reach, most])
    }

    fn blur_reach_px(&self, depth_of_field: &DepthOfField) -> usize {
        depth_of_field.reach_px(&self.lens, &self.raster, NEAREST_M)
    }

    fn max_blur_margin_px(&self) -> usize {
        (MAX_MARGIN * self.raster.width().max(self.raster.height()) as f64) as usize
    }

    /// Returns the pixels around the picture, columns and rows: those of the effects behind the lens, and `blur_margin_px` for depth of field.
    #[must_use]
    pub fn whole_margin_px(&self, blur_margin_px: usize) -> [usize; 2] {
        self.effects.margin_px().map(|of_effects| of_effects + blur_margin_px)
    }
}

/// Whether the depth of what a ray meets is one along the camera's axis.
pub(crate) fn has_planar_depth(front: &FrontRay) -> bool {
    front.ray.direction.z > 0.0 && front.mirror_m.is_none()
}
