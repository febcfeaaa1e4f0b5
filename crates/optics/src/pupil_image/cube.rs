//! Six perspective views: the pixel grid of a cube map, limited to the part needed.
//!
//! # Layout
//!
//! Each face of the cube about the entrance pupil has `face_px` × `face_px` pixels over the tangents −1 to 1, so the pitch is 2/`face_px`; pixel (i,
//! j) of a face has its centre at the tangents (i + 0.5, j + 0.5) · pitch − 1. A window of each face is stored: an upright rectangle that may extend
//! some pixels beyond the face ([`BORDER_PX`]), so that points across an edge can be read from either side. Faces that no direction needs have no
//! window.
//!
//! Windows are stored in the image in the order front, right, left, top, bottom, back: side by side from the left up to a total width of 5/4 of the
//! widest window, then in a new row below the tallest. Pixels between them belong to no window.

use glam::DVec2;

use super::view::{Face, View};
use crate::error::OpticsError;

/// Stored pixels beyond a face's edge. Cells of the resampling are two pixels wide at most.
pub(super) const BORDER_PX: i64 = 4;

/// The stored part of a face, in its own pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column; may be negative.
    pub left: i64,
    /// First row; may be negative.
    pub top: i64,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// The geometry of a stored image of up to six views.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cube {
    face_px: usize,
    width: usize,
    height: usize,
    views: [Option<View>; 6],
}

impl Cube {
    /// Creates faces of `face_px` × `face_px` pixels with the given stored windows, in the order of [`Face::ALL`].
    ///
    /// # Errors
    /// If there is no window, or one is empty.
    pub fn new(face_px: usize, windows: [Option<Window>; 6]) -> Result<Self, OpticsError> {
        let empty = |w: &Window| w.width == 0 || w.height == 0;
        if face_px == 0 || windows.iter().all(Option::is_none) || windows.iter().flatten().any(empty) {
            return Err(OpticsError::NoViews);
        }
        let widest = windows.iter().flatten().map(|w| w.width).max().unwrap_or(0);
        let mut packing = RowPacking { limit: widest * 5 / 4, x: 0, y: 0, row_height: 0, width: 0 };
        let view = |(face, window): (Face, Option<Window>)| {
            let window = window?;
            let [x, y] = packing.place(&window);
            let left = x as f64 - window.left as f64;
            let top = y as f64 - window.top as f64;
            Some(View {
                face,
                pitch_tan: 2.0 / face_px as f64,
                principal_px: DVec2::new(left, top) + 0.5 * face_px as f64,
                first: [x, y],
                size: [window.width, window.height],
            })
        };
        let mut placed = Face::ALL.into_iter().zip(windows).map(view);
        let views = core::array::from_fn(|_| placed.next().flatten());
        Ok(Self { face_px, width: packing.width, height: packing.y + packing.row_height, views })
    }

    /// Columns and rows of a face.
    #[must_use]
    pub fn face_px(&self) -> usize {
        self.face_px
    }

    /// Columns of the stored image.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows of the stored image.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The views, in the order of [`Face::ALL`].
    #[must_use]
    pub fn views(&self) -> &[Option<View>; 6] {
        &self.views
    }

    /// The stored part of each face, in the order of [`Face::ALL`].
    #[must_use]
    pub fn windows(&self) -> [Option<Window>; 6] {
        self.views.map(|view| {
            view.map(|v| {
                let first = DVec2::new(v.first[0] as f64, v.first[1] as f64);
                let corner = first - v.principal_px + 0.5 * self.face_px as f64;
                let [left, top] = [corner.x.round() as i64, corner.y.round() as i64];
                Window { left, top, width: v.size[0], height: v.size[1] }
            })
        })
    }

    /// The same with each window wider and taller by `columns` and `rows` on either side, at most to its face.
    pub(super) fn widened(&self, columns: usize, rows: usize) -> Result<Self, OpticsError> {
        let grown = |w: Window| {
            let [left, width] = grown(w.left, w.width, columns, self.face_px);
            let [top, height] = grown(w.top, w.height, rows, self.face_px);
            Window { left, top, width: width as usize, height: height as usize }
        };
        Self::new(self.face_px, self.windows().map(|window| window.map(grown)))
    }
}

/// First pixel and length of an interval of pixels, extended at both ends, but not beyond a face with its border.
fn grown(first: i64, length: usize, by: usize, face_px: usize) -> [i64; 2] {
    let start = (first - by as i64).max(first.min(-BORDER_PX));
    let old_end = first + length as i64;
    let end = (old_end + by as i64).min(old_end.max(face_px as i64 + BORDER_PX));
    [start, end - start]
}

/// Places rectangles in rows.
struct RowPacking {
    limit: usize,
    x: usize,
    y: usize,
    row_height: usize,
    width: usize,
}

impl RowPacking {
    fn place(&mut self, window: &Window) -> [usize; 2] {
        if self.x + window.width > self.limit {
            self.y += self.row_height;
            (self.x, self.row_height) = (0, 0);
        }
        let at = [self.x, self.y];
        self.x += window.width;
        self.width = self.width.max(self.x);
        self.row_height = self.row_height.max(window.height);
        at
    }
}
