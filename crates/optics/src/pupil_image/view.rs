//! One perspective view of a stored radiance image.
//!
//! A view looks along an axis of the camera frame and holds an upright rectangle of pixels of equal pitch on the plane at
//! unit distance. In the frame of its face (right, down, ahead) a pixel looks along ((px − principal) · pitch, 1).

use glam::{DVec2, DVec3};

/// A face of the cube about the entrance pupil: the direction of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// Along the optical axis, +z.
    Front,
    /// +x.
    Right,
    /// −x.
    Left,
    /// −y: up, as y points down.
    Top,
    /// +y.
    Bottom,
    /// −z.
    Back,
}

impl Face {
    /// All six, in the order of storage.
    pub const ALL: [Self; 6] = [Self::Front, Self::Right, Self::Left, Self::Top, Self::Bottom, Self::Back];

    /// The face's name in headers.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Right => "right",
            Self::Left => "left",
            Self::Top => "top",
            Self::Bottom => "bottom",
            Self::Back => "back",
        }
    }

    /// Unit vectors (camera frame) to the right, down and ahead in the face's sensor image.
    #[must_use]
    pub fn axes(self) -> [DVec3; 3] {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        match self {
            Self::Front => [x, y, z],
            Self::Right => [-z, y, x],
            Self::Left => [z, y, -x],
            Self::Top => [x, z, -y],
            Self::Bottom => [x, -z, y],
            Self::Back => [-x, y, -z],
        }
    }

    /// The face through which a direction leaves the cube; of two that share an edge, the earlier one.
    #[must_use]
    pub fn towards(direction: DVec3) -> Self {
        let maximum = direction.abs().max_element();
        if direction.z == maximum {
            Self::Front
        } else if direction.x == maximum {
            Self::Right
        } else if -direction.x == maximum {
            Self::Left
        } else if -direction.y == maximum {
            Self::Top
        } else if direction.y == maximum {
            Self::Bottom
        } else {
            Self::Back
        }
    }

    /// The direction's point on the plane at unit distance; `None` if it does not look ahead.
    #[must_use]
    pub fn tangent(self, direction: DVec3) -> Option<DVec2> {
        let [right, down, ahead] = self.axes();
        let z = direction.dot(ahead);
        (z > 0.0).then(|| DVec2::new(direction.dot(right), direction.dot(down)) / z)
    }

    /// The unit direction at a point of the plane at unit distance.
    #[must_use]
    pub fn direction(self, tangent: DVec2) -> DVec3 {
        let [right, down, ahead] = self.axes();
        (right * tangent.x + down * tangent.y + ahead).normalize()
    }
}

/// A view within a stored image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Direction of the view.
    pub(super) face: Face,
    /// A pixel's side on the plane at unit distance.
    pub(super) pitch_tan: f64,
    /// Position of the face's axis, in pixel coordinates of the stored image.
    pub(super) principal_px: DVec2,
    /// First column and row of its pixels in the stored image.
    pub(super) first: [usize; 2],
    /// Its columns and rows.
    pub(super) size: [usize; 2],
}

impl View {
    /// Direction of the view.
    #[must_use]
    pub fn face(&self) -> Face {
        self.face
    }

    /// Position of the face's axis, in pixel coordinates of the stored image.
    #[must_use]
    pub fn principal_px(&self) -> DVec2 {
        self.principal_px
    }

    /// First column and row of its pixels in the stored image.
    #[must_use]
    pub fn first(&self) -> [usize; 2] {
        self.first
    }

    /// Its columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The unit direction (camera frame) at pixel coordinates of the stored image.
    #[must_use]
    pub fn direction(&self, px: DVec2) -> DVec3 {
        self.face.direction((px - self.principal_px) * self.pitch_tan)
    }

    /// The pixel coordinates of a direction, within the view's pixels or not; `None` if it does not look ahead.
    #[must_use]
    pub fn px(&self, direction: DVec3) -> Option<DVec2> {
        self.face.tangent(direction).map(|t| t / self.pitch_tan + self.principal_px)
    }

    /// Pixel coordinates of the corners of its pixels: top left and bottom right.
    pub(super) fn bounds(&self) -> [DVec2; 2] {
        let low = DVec2::new(self.first[0] as f64, self.first[1] as f64);
        [low, low + DVec2::new(self.size[0] as f64, self.size[1] as f64)]
    }

    /// True if a pixel of the stored image belongs to the view.
    #[must_use]
    pub fn holds(&self, px: DVec2) -> bool {
        let [low, high] = self.bounds();
        px.cmpge(low).all() && px.cmplt(high).all()
    }
}
