//! The geometry of a stored radiance image.
//!
//! Rectilinear about the entrance pupil's centre: the pixel coordinates (raster convention, centres at + 0.5) are
//! principal point + tangent / pitch, with the tangents X/Z and Y/Z of the camera frame. The pitch is dimensionless: a
//! pixel's side on the plane at unit distance. Without distortion and with square pixels an image made by
//! [`PupilProjection::covering`] has exactly the pixels of the picture.

use crate::error::{OpticsError, finite, positive};
use crate::lens::Lens;
use core::f64::consts::FRAC_PI_2;
use etendue_projection::Raster;
use glam::{DVec2, DVec3, UVec2};

/// The rectilinear geometry of a radiance image as seen from the entrance pupil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PupilProjection {
    width: usize,
    height: usize,
    pitch_tan: f64,
    principal_px: DVec2,
}

impl PupilProjection {
    /// An image of `width` × `height` pixels, each `pitch_tan` wide in tangent, with the optical axis at `principal_px`.
    ///
    /// # Errors
    /// Where a number is not finite, or size or pitch not positive.
    pub fn new(width: usize, height: usize, pitch_tan: f64, principal_px: DVec2) -> Result<Self, OpticsError> {
        positive("width", width as f64)?;
        positive("height", height as f64)?;
        positive("pitch_tan", pitch_tan)?;
        finite("principal_px", principal_px.x)?;
        finite("principal_px", principal_px.y)?;
        Ok(Self { width, height, pitch_tan, principal_px })
    }

    /// The geometry that holds every direction of a picture (overscan included where the lens distorts), fine enough that
    /// none of its pixels is wider than a pixel of the picture.
    ///
    /// # Errors
    /// Where the lens cannot image the picture.
    pub fn covering(lens: &Lens, raster: &Raster) -> Result<Self, OpticsError> {
        serves(lens)?;
        lens.check(raster)?;
        let border: Vec<DVec2> = border_tangents(lens, raster).collect();
        let low = border.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = border.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let pitch_tan = raster.pitch_mm().min_element() / lens.principal_distance_mm() * finest_scale(lens, raster);
        let margin = if lens.distortion().is_some() { 1.0 } else { 0.0 };
        // The lattice keeps the fraction of the principal point, so that pixels coincide where nothing is distorted.
        let fraction = raster.principal_px() - raster.principal_px().floor();
        let before = (-low / pitch_tan - fraction - ROUNDING_PX).ceil() + margin;
        let principal_px = before + fraction;
        let size = (principal_px + high / pitch_tan - ROUNDING_PX).ceil() + margin;
        Self::new(size.x as usize, size.y as usize, pitch_tan, principal_px)
    }

    /// The same image with `columns` more on the left and on the right, and `rows` more above and below: room for other
    /// lenses and sensors.
    #[must_use]
    pub fn widened(&self, columns: usize, rows: usize) -> Self {
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

    /// A pixel's side on the plane at unit distance.
    #[must_use]
    pub fn pitch_tan(&self) -> f64 {
        self.pitch_tan
    }

    /// The optical axis in pixel coordinates.
    #[must_use]
    pub fn principal_px(&self) -> DVec2 {
        self.principal_px
    }

    /// The unit direction (camera frame) at pixel coordinates.
    #[must_use]
    pub fn direction(&self, px: DVec2) -> DVec3 {
        ((px - self.principal_px) * self.pitch_tan).extend(1.0).normalize()
    }

    /// The pixel coordinates of tangents X/Z, Y/Z.
    #[must_use]
    pub fn px_of_tangent(&self, tangent: DVec2) -> DVec2 {
        tangent / self.pitch_tan + self.principal_px
    }

    /// Refuses a picture that needs directions outside this image.
    ///
    /// # Errors
    /// Names the edge beyond which most is missing, and how much; or says why the lens cannot image the picture.
    pub fn check_covers(&self, lens: &Lens, raster: &Raster) -> Result<(), OpticsError> {
        serves(lens)?;
        lens.check(raster)?;
        let worst = border_tangents(lens, raster)
            .filter_map(|tangent| self.missing(self.px_of_tangent(tangent)))
            .max_by(|a, b| a.1.total_cmp(&b.1));
        worst.map_or(Ok(()), |(edge, missing_rad)| Err(OpticsError::MissingDirections { edge, missing_rad }))
    }

    /// The edge that pixel coordinates lie beyond, and by what angle.
    fn missing(&self, px: DVec2) -> Option<(&'static str, f64)> {
        let size = DVec2::new(self.width as f64, self.height as f64);
        let inside = px.clamp(DVec2::ZERO, size);
        let beyond = px - inside;
        if beyond.abs().max_element() <= EDGE_PX {
            return None;
        }
        let edge = if beyond.x.abs() >= beyond.y.abs() {
            if beyond.x < 0.0 { "left" } else { "right" }
        } else if beyond.y < 0.0 {
            "top"
        } else {
            "bottom"
        };
        let (a, b) = (self.direction(px), self.direction(inside));
        Some((edge, etendue_core::maths::f64::atan2(a.cross(b).length(), a.dot(b)).min(FRAC_PI_2)))
    }
}

/// Refuses lenses that have no rectilinear picture of their own, or more than one.
fn serves(lens: &Lens) -> Result<(), OpticsError> {
    match lens {
        Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) => Ok(()),
        Lens::Prescription(_) | Lens::Calibrated(_) | Lens::Parallel(_) => {
            Err(OpticsError::NoPupilRoute { kind: lens.kind() })
        }
    }
}

/// Rounding that a position in pixels may have before it counts as another pixel.
const ROUNDING_PX: f64 = 1e-6;

/// How far a picture may reach beyond an image before directions count as missing: rounding of the same geometry
/// written down and read back.
const EDGE_PX: f64 = 1e-3;

/// Tangents of the directions seen at the pixel corners around a picture. The distortion is continuous and one-to-one, so
/// the border's image bounds the picture's.
fn border_tangents(lens: &Lens, raster: &Raster) -> impl Iterator<Item = DVec2> {
    let (w, h) = (raster.width(), raster.height());
    let across = (0..=w).flat_map(move |x| [UVec2::new(x as u32, 0), UVec2::new(x as u32, h as u32)]);
    let down = (0..=h).flat_map(move |y| [UVec2::new(0, y as u32), UVec2::new(w as u32, y as u32)]);
    across.chain(down).filter_map(move |corner| lens.tangent(raster.sensor_mm(corner.as_dvec2())))
}

/// Radii at which the scale of the distortion is looked up.
const SCALE_SAMPLES: usize = 256;

/// The least ratio of an ideal length to the observed one over the picture, radial and tangential; at most 1.
fn finest_scale(lens: &Lens, raster: &Raster) -> f64 {
    let Some(distortion) = lens.distortion() else { return 1.0 };
    let end_mm = raster.max_radius_mm();
    (1..=SCALE_SAMPLES)
        .filter_map(|i| {
            let r = end_mm * i as f64 / SCALE_SAMPLES as f64;
            let tangential = distortion.ideal_radius_mm(r)? / r;
            let radial = distortion.ideal_area_per_observed(r)? / tangential;
            Some(tangential.min(radial))
        })
        .fold(1.0, f64::min)
}
