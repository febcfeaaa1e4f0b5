//! A calibrated camera: a model, its camera matrix, and its image size.
//!
//! Points are raster coordinates of this project: px, the top-left corner of the image at (0, 0), pixel centres at + 0.5.

use core::f64::consts::TAU;

use etendue_core::maths::f64::sin_cos;
use glam::{DVec2, DVec3};

use crate::model::{DirectionAndSolidAngle, Model, field_angle};
use crate::raster::CameraMatrix;

/// Error of a calibration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CalibrationError {
    /// An invalid camera matrix.
    #[error(
        "the camera matrix fx = {fx}, fy = {fy}, skew = {skew}, cx = {cx}, cy = {cy} needs finite numbers and positive fx and fy"
    )]
    Matrix {
        /// fx, px.
        fx: f64,
        /// fy, px.
        fy: f64,
        /// Skew, px.
        skew: f64,
        /// cx, px.
        cx: f64,
        /// cy, px.
        cy: f64,
    },
    /// No pixels.
    #[error("an image of {width} × {height} pixels is empty: give at least one column and one row")]
    Empty {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// An invalid maximum angle.
    #[error("the greatest field angle is {}°; expected more than 0° and no more than 180°", angle_rad.to_degrees())]
    Angle { angle_rad: f64 },
    /// A fold inside the image.
    #[error(
        "the calibration folds the image over at a radius of {radius_px:.3} px from the principal point (field angle {:.3}°), inside the image, \
         which extends to {needed_px:.3} px: use coefficients fitted over the whole image, crop it, or state the maximum field angle up to which \
         they are valid",
        angle_rad.to_degrees()
    )]
    Fold {
        /// Smallest distance of the fold's image from the principal point, px.
        radius_px: f64,
        /// Field angle of the fold, rad.
        angle_rad: f64,
        /// Largest distance of a corner of the image from the principal point, px.
        needed_px: f64,
    },
}

/// A camera model in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    model: Model,
    matrix: CameraMatrix,
    size_px: [usize; 2],
    max_angle_rad: Option<f64>,
}

impl Calibration {
    /// Creates the camera from a model, a camera matrix (raster coordinates) and a size (width, height).
    ///
    /// # Errors
    /// If the matrix or the image size is invalid. A fold inside the image is reported by [`check`](Self::check).
    pub fn new(model: Model, matrix: CameraMatrix, size_px: [usize; 2]) -> Result<Self, CalibrationError> {
        let CameraMatrix { fx, fy, skew, cx, cy } = matrix;
        let finite = [fx, fy, skew, cx, cy].iter().all(|x| x.is_finite());
        if !(finite && fx > 0.0 && fy > 0.0) {
            return Err(CalibrationError::Matrix { fx, fy, skew, cx, cy });
        }
        let [width, height] = size_px;
        if width == 0 || height == 0 {
            return Err(CalibrationError::Empty { width, height });
        }
        Ok(Self { model, matrix, size_px, max_angle_rad: None })
    }

    /// The same camera with another image size (width, height).
    ///
    /// # Errors
    /// If the size is empty.
    pub fn with_size(self, size_px: [usize; 2]) -> Result<Self, CalibrationError> {
        match size_px {
            [0, _] | [_, 0] => Err(CalibrationError::Empty { width: size_px[0], height: size_px[1] }),
            _ => Ok(Self { size_px, ..self }),
        }
    }

    /// The same camera limited to directions below this field angle.
    ///
    /// # Errors
    /// If the angle is not in (0, π].
    pub fn with_max_angle(self, angle_rad: f64) -> Result<Self, CalibrationError> {
        if !(angle_rad > 0.0 && angle_rad <= core::f64::consts::PI) {
            return Err(CalibrationError::Angle { angle_rad });
        }
        Ok(Self { max_angle_rad: Some(angle_rad), ..self })
    }

    /// Returns the same camera with `k` × `k` of its pixels combined into one. In raster coordinates, whose origin is the corner of the image, every
    /// length is divided by k: the whole matrix is scaled, so that polynomials in pixels are unchanged. A size that does not divide is rounded down.
    #[must_use]
    pub fn with_larger_pixels(self, k: usize) -> Self {
        let CameraMatrix { fx, fy, skew, cx, cy } = self.matrix;
        let by = k as f64;
        let matrix = CameraMatrix { fx: fx / by, fy: fy / by, skew: skew / by, cx: cx / by, cy: cy / by };
        Self { matrix, size_px: self.size_px.map(|side| side / k), ..self }
    }

    /// The camera model.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The camera matrix, in raster coordinates.
    #[must_use]
    pub fn matrix(&self) -> CameraMatrix {
        self.matrix
    }

    /// Width and height, px.
    #[must_use]
    pub fn size_px(&self) -> [usize; 2] {
        self.size_px
    }

    /// The stated limit of the field angle, rad; the model's own [`edge`](Model::edge) may come before.
    #[must_use]
    pub fn max_angle_rad(&self) -> Option<f64> {
        self.max_angle_rad
    }

    /// The raster point (px) of a direction of the camera frame (any length), inside the image or not; `None` outside the field.
    #[must_use]
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        let limit = self.max_angle_rad;
        if limit.is_some_and(|limit| field_angle(direction).is_none_or(|angle| angle >= limit)) {
            return None;
        }
        Some(self.matrix.raster_px(self.model.project(direction)?))
    }

    /// The unit direction of the camera frame seen at a raster point; `None` if there is none.
    #[must_use]
    pub fn unproject(&self, raster_px: DVec2) -> Option<DVec3> {
        let direction = self.model.unproject(self.matrix.point(raster_px))?;
        self.sees(direction).then_some(direction)
    }

    /// dΩ/dA, the solid angle seen per pixel area at a raster point, sr per px²; `None` if there is no direction.
    #[must_use]
    pub fn solid_angle_per_area(&self, raster_px: DVec2) -> Option<f64> {
        let point = self.matrix.point(raster_px);
        if self.max_angle_rad.is_some() {
            self.unproject(raster_px)?;
        }
        Some(self.model.solid_angle_per_area(point)? / self.matrix.area_px())
    }

    /// [`unproject`](Self::unproject) and [`solid_angle_per_area`](Self::solid_angle_per_area) (sr per px²) of a raster point, at little more than
    /// the cost of one of them; `None` if there is no direction.
    #[must_use]
    pub fn sight(&self, raster_px: DVec2) -> Option<DirectionAndSolidAngle> {
        let sight = self.model.sight(self.matrix.point(raster_px))?;
        self.sees(sight.direction).then(|| sight.enlarged(self.matrix.area_px()))
    }

    /// Refuses a calibration that folds inside the image, with the radius of the fold. Parts of the image beyond the maximum angle, or beyond the end
    /// of the model's formula without a fold, are legal: they have no direction.
    ///
    /// # Errors
    /// [`CalibrationError::Fold`].
    pub fn check(&self) -> Result<(), CalibrationError> {
        let edge = self.model.edge();
        let limited = self.max_angle_rad.is_some_and(|angle| angle < edge.angle_rad);
        if !edge.folds || limited || self.border().all(|p| self.unproject(p).is_some()) {
            return Ok(());
        }
        let radius_px = self.fold_radius_px(edge.angle_rad);
        let needed_px = self.corners().map(|p| self.principal_distance(p)).fold(0.0, f64::max);
        Err(CalibrationError::Fold { radius_px, angle_rad: edge.angle_rad, needed_px })
    }

    fn sees(&self, direction: DVec3) -> bool {
        self.max_angle_rad.is_none_or(|limit| field_angle(direction).is_some_and(|angle| angle < limit))
    }

    fn principal_distance(&self, raster_px: DVec2) -> f64 {
        (raster_px - DVec2::new(self.matrix.cx, self.matrix.cy)).length()
    }

    /// Smallest distance of the fold's image from the principal point, from directions a few roundings before it. There the radius is stationary (a
    /// polynomial of the angle) or the angle is (one of the radius: √1e-14 of the radius off).
    fn fold_radius_px(&self, angle_rad: f64) -> f64 {
        const DIRECTIONS: i32 = 720;
        let (sin, cos) = sin_cos(angle_rad * (1.0 - 1e-14));
        let towards = |i: i32| (DVec2::from(sin_cos(TAU * f64::from(i) / f64::from(DIRECTIONS))) * sin).extend(cos);
        let images = (0..DIRECTIONS).filter_map(|i| Some(self.matrix.raster_px(self.model.project(towards(i))?)));
        images.map(|p| self.principal_distance(p)).fold(f64::INFINITY, f64::min)
    }

    fn corners(&self) -> impl Iterator<Item = DVec2> {
        let size = self.size();
        [DVec2::ZERO, DVec2::new(size.x, 0.0), DVec2::new(0.0, size.y), size].into_iter()
    }

    /// The corners of all pixels along the image's border, at most some thousand per side.
    fn border(&self) -> impl Iterator<Item = DVec2> {
        const MAX_DIRECTIONS: usize = 4096;
        let size = self.size();
        let along = |n: usize| (0..=n.min(MAX_DIRECTIONS)).map(move |i| i as f64 / n.min(MAX_DIRECTIONS) as f64);
        let rows = along(self.size_px[0]).flat_map(move |t| [0.0, size.y].map(|y| DVec2::new(t * size.x, y)));
        let columns = along(self.size_px[1]).flat_map(move |t| [0.0, size.x].map(|x| DVec2::new(x, t * size.y)));
        rows.chain(columns)
    }

    fn size(&self) -> DVec2 {
        DVec2::new(self.size_px[0] as f64, self.size_px[1] as f64)
    }
}
