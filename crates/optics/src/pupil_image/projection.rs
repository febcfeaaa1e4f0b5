//! The geometry of a stored radiance image.
//!
//! # Contract
//!
//! - A stored image is one perspective view or several ([`View`]). Pixel coordinates are those of the stored image (raster convention, centres at +
//!   0.5); a pixel outside all views has no direction.
//! - [`PupilProjection::Rectilinear`]: one view about the optical axis, direction = ((px − principal) · pitch, 1) with the
//!   tangents X/Z and Y/Z of the camera frame. Without distortion and with square pixels an image made by
//!   [`PupilProjection::covering`] has exactly the pixels of the sensor image.
//! - [`PupilProjection::Cube`]: six views (`cube.rs`), for sensor images that extend farther than [`MAX_RECTILINEAR_RAD`] from the axis.

use core::f64::consts::FRAC_PI_2;

use etendue_core::maths::f64::atan2;
use glam::{DVec2, DVec3};

use super::cube::Cube;
use super::view::{Face, View};
use crate::error::OpticsError;
use crate::overlap::{finite, positive};

/// The angle from the axis up to which one rectilinear view is used: 65°. There its pixels are 2.4 times as dense along the radius as a direction
/// needs, and 5.6 times as many.
pub const MAX_RECTILINEAR_RAD: f64 = 65.0 * core::f64::consts::PI / 180.0;

/// The geometry of a radiance image as seen from the entrance pupil: the closed list.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one a camera, and settings that hold it stay Copy")]
pub enum PupilProjection {
    /// One view about the axis.
    Rectilinear(View),
    /// Up to six views.
    Cube(Cube),
}

impl PupilProjection {
    /// Creates one view of `width` × `height` pixels, each `pitch_tan` wide in tangent, with the optical axis at `principal_px`.
    ///
    /// # Errors
    /// If a number is not finite, or size or pitch not positive.
    pub fn rectilinear(width: usize, height: usize, pitch_tan: f64, principal_px: DVec2) -> Result<Self, OpticsError> {
        positive("width", width as f64)?;
        positive("height", height as f64)?;
        positive("pitch_tan", pitch_tan)?;
        finite("principal_px", principal_px.x)?;
        finite("principal_px", principal_px.y)?;
        Ok(Self::Rectilinear(View { face: Face::Front, pitch_tan, principal_px, first: [0, 0], size: [width, height] }))
    }

    /// The same image with `columns` more on the left and on the right of each view, and `rows` more above and below, as room for other lenses and
    /// sensors. A view of a cube grows at most to its face.
    #[must_use]
    pub fn widened(&self, columns: usize, rows: usize) -> Self {
        match self {
            Self::Rectilinear(view) => Self::Rectilinear(View {
                size: [view.size[0] + 2 * columns, view.size[1] + 2 * rows],
                principal_px: view.principal_px + DVec2::new(columns as f64, rows as f64),
                ..*view
            }),
            Self::Cube(cube) => Self::Cube(cube.widened(columns, rows).unwrap_or(*cube)),
        }
    }

    /// [`Self::widened`] by a fraction of the view, or of the cube's faces.
    #[must_use]
    pub fn overscanned(&self, fraction: f64) -> Self {
        let [columns, rows] = match self {
            Self::Rectilinear(view) => view.size,
            Self::Cube(cube) => [cube.face_px(); 2],
        };
        let pixels = |n: usize| (fraction * n as f64).ceil() as usize;
        self.widened(pixels(columns), pixels(rows))
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        match self {
            Self::Rectilinear(view) => view.size[0],
            Self::Cube(cube) => cube.width(),
        }
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        match self {
            Self::Rectilinear(view) => view.size[1],
            Self::Cube(cube) => cube.height(),
        }
    }

    /// A pixel's side on the plane at unit distance.
    #[must_use]
    pub fn pitch_tan(&self) -> f64 {
        match self {
            Self::Rectilinear(view) => view.pitch_tan,
            Self::Cube(cube) => 2.0 / cube.face_px() as f64,
        }
    }

    /// The views, in the order of storage.
    pub fn views(&self) -> impl Iterator<Item = &View> {
        match self {
            Self::Rectilinear(view) => core::slice::from_ref(view).iter().chain([].iter().flatten()),
            Self::Cube(cube) => [].iter().chain(cube.views().iter().flatten()),
        }
    }

    /// The unit direction (camera frame) at pixel coordinates; `None` between the views.
    #[must_use]
    pub fn direction(&self, px: DVec2) -> Option<DVec3> {
        self.views().find(|view| view.holds(px)).map(|view| view.direction(px))
    }

    /// The view that shows a direction; `None` if none does.
    #[must_use]
    pub fn view(&self, direction: DVec3) -> Option<&View> {
        match self {
            Self::Rectilinear(view) => (direction.z > 0.0).then_some(view),
            Self::Cube(cube) => {
                let face = Face::towards(direction);
                cube.views().iter().flatten().find(|view| view.face == face)
            }
        }
    }

    /// Refuses a direction outside the image, except for rounding.
    ///
    /// # Errors
    /// Names the edge beyond which the direction lies and by how much, or the missing view.
    pub(super) fn check_holds(&self, direction: DVec3) -> Result<(), OpticsError> {
        match self {
            Self::Rectilinear(view) => check_view(view, direction),
            Self::Cube(_) => match self.view(direction) {
                Some(view) => check_view(view, direction),
                None => Err(OpticsError::MissingView { view: Face::towards(direction).name() }),
            },
        }
    }
}

/// Distance by which a sensor image may reach beyond a stored image before directions count as missing: rounding of the same geometry written and
/// read back.
const EDGE_PX: f64 = 1e-3;

/// Pixel coordinate that stands for points behind a view.
const FAR_PX: f64 = 1e12;

fn check_view(view: &View, direction: DVec3) -> Result<(), OpticsError> {
    let px = view.px(direction).unwrap_or_else(|| {
        let [right, down, _] = view.face.axes();
        DVec2::new(direction.dot(right), direction.dot(down)).normalize_or(DVec2::X) * FAR_PX
    });
    let [low, high] = view.bounds();
    let inside = px.clamp(low, high);
    let beyond = px - inside;
    if beyond.abs().max_element() <= EDGE_PX {
        return Ok(());
    }
    let edge = if beyond.x.abs() >= beyond.y.abs() {
        if beyond.x < 0.0 { "left" } else { "right" }
    } else if beyond.y < 0.0 {
        "top"
    } else {
        "bottom"
    };
    let nearest = view.direction(inside);
    let missing_rad = atan2(direction.cross(nearest).length(), direction.dot(nearest)).min(FRAC_PI_2);
    Err(OpticsError::MissingDirections { edge, missing_rad })
}
