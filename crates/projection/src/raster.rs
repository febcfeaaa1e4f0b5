//! Positions of pixels on the sensor plane, and the camera matrix that other programs expect.
//!
//! Raster coordinates have their origin at the top-left corner of the image and pixel centres at + 0.5; column i covers [i, i + 1). OpenCV and ROS
//! put the centre of the top-left pixel at (0, 0), so their cx = cx(raster) − 0.5 and cy = cy(raster) − 0.5; COLMAP uses the raster's own convention.
//! fx and fy are the same in all of them.

use glam::DVec2;

/// Error of a raster.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RasterError {
    /// No pixels.
    #[error("an image of {width} × {height} pixels is empty: give at least one column and one row")]
    Empty {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A pitch that is not a positive number.
    #[error("the pixel pitch {x_mm} × {y_mm} mm is not positive and finite")]
    Pitch {
        /// Pitch along a row, mm.
        x_mm: f64,
        /// Pitch along a column, mm.
        y_mm: f64,
    },
    /// A principal point that is not a number.
    #[error("the principal point ({x_px}, {y_px}) px is not finite")]
    Principal {
        /// Column coordinate, px.
        x_px: f64,
        /// Row coordinate, px.
        y_px: f64,
    },
}

/// The pixel grid on the sensor plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    width: usize,
    height: usize,
    pitch_mm: DVec2,
    principal_px: DVec2,
}

impl Raster {
    /// Creates a grid of `width` × `height` pixels of `pitch_mm`, with the optical axis at `principal_px` (raster coordinates).
    ///
    /// # Errors
    /// If there are no pixels, a number is not finite, or a pitch is not positive.
    pub fn new(width: usize, height: usize, pitch_mm: DVec2, principal_px: DVec2) -> Result<Self, RasterError> {
        if width == 0 || height == 0 {
            return Err(RasterError::Empty { width, height });
        }
        if !(pitch_mm.is_finite() && pitch_mm.min_element() > 0.0) {
            return Err(RasterError::Pitch { x_mm: pitch_mm.x, y_mm: pitch_mm.y });
        }
        if !principal_px.is_finite() {
            return Err(RasterError::Principal { x_px: principal_px.x, y_px: principal_px.y });
        }
        Ok(Self { width, height, pitch_mm, principal_px })
    }

    /// Creates a grid of square pixels with the optical axis at its centre.
    ///
    /// # Errors
    /// As [`Raster::new`].
    pub fn centred(width: usize, height: usize, pitch_mm: f64) -> Result<Self, RasterError> {
        let centre = DVec2::new(width as f64, height as f64) / 2.0;
        Self::new(width, height, DVec2::splat(pitch_mm), centre)
    }

    /// The same grid with additional columns on the left and on the right, and additional rows above and below.
    #[must_use]
    pub fn widened(&self, [columns, rows]: [usize; 2]) -> Self {
        Self {
            width: self.width + 2 * columns,
            height: self.height + 2 * rows,
            principal_px: self.principal_px + DVec2::new(columns as f64, rows as f64),
            ..*self
        }
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Pixel pitch, mm.
    #[must_use]
    pub fn pitch_mm(&self) -> DVec2 {
        self.pitch_mm
    }

    /// The principal point in raster coordinates, px.
    #[must_use]
    pub fn principal_px(&self) -> DVec2 {
        self.principal_px
    }

    /// Width and height of the image on the sensor, mm.
    #[must_use]
    pub fn size_mm(&self) -> DVec2 {
        self.pitch_mm * DVec2::new(self.width as f64, self.height as f64)
    }

    /// Half the image's diagonal, mm.
    #[must_use]
    pub fn half_diagonal_mm(&self) -> f64 {
        0.5 * self.size_mm().length()
    }

    /// The largest distance of a point of the image from the principal point, mm.
    #[must_use]
    pub fn max_radius_mm(&self) -> f64 {
        let far_px =
            self.principal_px.abs().max((DVec2::new(self.width as f64, self.height as f64) - self.principal_px).abs());
        (far_px * self.pitch_mm).length()
    }

    /// The point of the sensor plane (mm from the principal point) at raster coordinates.
    #[must_use]
    pub fn sensor_mm(&self, raster_px: DVec2) -> DVec2 {
        (raster_px - self.principal_px) * self.pitch_mm
    }

    /// The raster coordinates of a point of the sensor plane.
    #[must_use]
    pub fn raster_px(&self, sensor_mm: DVec2) -> DVec2 {
        sensor_mm / self.pitch_mm + self.principal_px
    }

    /// The camera matrix of a camera with this grid and a principal distance.
    #[must_use]
    pub fn camera_matrix(&self, principal_distance_mm: f64) -> CameraMatrix {
        let f = DVec2::splat(principal_distance_mm) / self.pitch_mm;
        CameraMatrix { fx: f.x, fy: f.y, skew: 0.0, cx: self.principal_px.x, cy: self.principal_px.y }
    }
}

/// Focal lengths and principal point in pixels, in raster coordinates (centres at + 0.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraMatrix {
    /// Principal distance in columns, px.
    pub fx: f64,
    /// Principal distance in rows, px.
    pub fy: f64,
    /// Columns added per principal distance downwards, px; 0 if rows and columns are at right angles.
    pub skew: f64,
    /// Column coordinate of the principal point, px.
    pub cx: f64,
    /// Row coordinate of the principal point, px.
    pub cy: f64,
}

impl CameraMatrix {
    /// The same camera with the centre of the top-left pixel at (0, 0), as in OpenCV and ROS.
    #[must_use]
    pub fn to_opencv(self) -> Self {
        Self { cx: self.cx - 0.5, cy: self.cy - 0.5, ..self }
    }

    /// The raster's matrix of one from OpenCV or ROS.
    #[must_use]
    pub fn from_opencv(self) -> Self {
        Self { cx: self.cx + 0.5, cy: self.cy + 0.5, ..self }
    }

    /// The raster point of a point of the normalised image plane: (fx x + skew y + cx, fy y + cy).
    #[must_use]
    pub fn raster_px(self, point: DVec2) -> DVec2 {
        DVec2::new(self.fx * point.x + self.skew * point.y + self.cx, self.fy * point.y + self.cy)
    }

    /// The point of the normalised image plane at a raster point.
    #[must_use]
    pub fn point(self, raster_px: DVec2) -> DVec2 {
        let y = (raster_px.y - self.cy) / self.fy;
        DVec2::new((raster_px.x - self.cx - self.skew * y) / self.fx, y)
    }

    /// Area of the unit square of the normalised plane, px².
    #[must_use]
    pub fn area_px(self) -> f64 {
        self.fx * self.fy
    }

    /// Row by row, as stored in calibration files.
    #[must_use]
    pub fn rows(self) -> [[f64; 3]; 3] {
        [[self.fx, self.skew, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sensor_of_the_paper_has_its_size() {
        // 776 × 582 at 8.3 µm is 6.4408 × 4.8306 mm.
        let raster = Raster::centred(776, 582, 0.0083).expect("legal");
        assert!((raster.size_mm() - DVec2::new(6.4408, 4.8306)).length() < 1e-12);
        assert!((raster.max_radius_mm() - raster.half_diagonal_mm()).abs() < 1e-12);
    }

    #[test]
    fn pixel_centres_are_at_a_half_and_opencv_s_at_whole_numbers() {
        let raster = Raster::centred(4, 2, 0.01).expect("legal");
        assert!((raster.sensor_mm(DVec2::new(0.5, 0.5)) - DVec2::new(-0.015, -0.005)).length() < 1e-15);
        let matrix = raster.camera_matrix(10.0);
        assert_eq!(matrix, CameraMatrix { fx: 1000.0, fy: 1000.0, skew: 0.0, cx: 2.0, cy: 1.0 });
        assert_eq!((matrix.to_opencv().cx, matrix.to_opencv().cy), (1.5, 0.5));
        assert_eq!(matrix.to_opencv().from_opencv(), matrix);
    }

    #[test]
    fn the_far_corner_counts_where_the_axis_is_off_centre() {
        let raster = Raster::new(4, 4, DVec2::splat(1.0), DVec2::new(1.0, 4.0)).expect("legal");
        assert!((raster.max_radius_mm() - 5.0).abs() < 1e-12);
        let p = DVec2::new(0.3, 3.7);
        assert!((raster.raster_px(raster.sensor_mm(p)) - p).length() < 1e-14);
    }

    #[test]
    fn a_skewed_matrix_takes_points_to_pixels_and_back() {
        let matrix = CameraMatrix { fx: 800.0, fy: 790.0, skew: 1.5, cx: 320.5, cy: 240.0 };
        let p = DVec2::new(0.2, -0.4);
        let px = matrix.raster_px(p);
        assert!((px - DVec2::new(160.0 - 0.6 + 320.5, -316.0 + 240.0)).length() < 1e-12);
        assert!((matrix.point(px) - p).length() < 1e-15);
        assert_eq!(matrix.rows()[0], [800.0, 1.5, 320.5]);
    }

    #[test]
    fn a_wider_grid_keeps_its_points_where_they_are() {
        let raster = Raster::new(4, 6, DVec2::splat(0.5), DVec2::new(1.0, 4.0)).expect("legal");
        let wide = raster.widened([3, 2]);
        assert_eq!((wide.width(), wide.height()), (10, 10));
        let p = DVec2::new(0.25, 5.5);
        assert_eq!(wide.sensor_mm(p + DVec2::new(3.0, 2.0)), raster.sensor_mm(p));
    }

    #[test]
    fn what_is_no_raster_is_refused() {
        assert!(matches!(Raster::centred(0, 4, 0.01), Err(RasterError::Empty { .. })));
        assert!(matches!(Raster::centred(4, 4, -0.01), Err(RasterError::Pitch { .. })));
        let nan = Raster::new(4, 4, DVec2::ONE, DVec2::NAN);
        assert!(matches!(nan, Err(RasterError::Principal { .. })));
    }
}
