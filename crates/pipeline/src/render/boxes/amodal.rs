//! Image of a whole object, including its occluded parts.

use super::clipped;
use super::edges::ObjectEdges;
use super::pixel_box::PixelBox;
use crate::plan::Plan;
use crate::render::frame_view::FrameView;
use crate::render::motion::{OwnPoint, image_of};
use etendue_tracer::geometry::Instance;
use rayon::prelude::*;
use std::ops::Range;

/// Margin around the box of those points (as a fraction of its size, and in px) in which pixels of an object are searched.
const MARGIN_FRACTION: f64 = 0.1;
const MARGIN_PX: f64 = 1.0;

/// The image of an object.
pub(super) struct AmodalImage<'w> {
    /// Box around the images of its points; `None` if none has one.
    pub(super) image: Option<PixelBox>,
    /// True if some points have no image.
    pub(super) is_cut: bool,
    edges: ObjectEdges<'w>,
}

impl<'w> AmodalImage<'w> {
    /// Image of an instance in a frame; the outline of a sphere is that seen at `time_s`.
    pub(super) fn new(plan: &'w Plan, frame: &FrameView<'_>, instance: &Instance, time_s: f64) -> Self {
        let image = |own: OwnPoint<'_>| {
            image_of(frame, own, &instance.to_world).map(|at_px| PixelBox { low: at_px, high: at_px })
        };
        let edges = ObjectEdges::new(plan, frame, instance, time_s);
        let points = edges.points();
        let all = points.len();
        let boxes = points.into_par_iter().filter_map(image).map(|b| (1, b));
        let sum = boxes.reduce_with(|a, b| (a.0 + b.0, a.1.union_with(&b.1)));
        let is_cut = sum.map_or(0, |(n, _)| n) < all || all == 0;
        Self { image: sum.map(|(_, image)| image), is_cut, edges }
    }

    /// Box of the part of the instance's image within the image frame, given the box of the pixels that show it alone; `None` if there is none.
    ///
    /// It contains the images of its edges, clipped at the border, and the centres of those pixels. If the object covers the centre of an outermost pixel and
    /// extends beyond the image there, the box ends at the border.
    pub(super) fn within_image(
        &self,
        frame: &FrameView<'_>,
        instance: &Instance,
        visible: Option<&PixelBox>,
    ) -> Option<PixelBox> {
        let raster = &frame.camera.body.raster;
        let image_bounds = PixelBox::from_image_size(raster.width(), raster.height());
        let box_of_all = self.image.filter(|_| !self.is_cut);
        let visible = visible.map(|visible| visible.to_border(box_of_all.as_ref(), &image_bounds));
        if let Some(box_of_all) = box_of_all.filter(|box_of_all| image_bounds.contains(box_of_all)) {
            return PixelBox::union(Some(box_of_all), visible);
        }
        let edges = self.edges.edges.par_iter().map(|edge| {
            let image = |fraction: f64| image_of(frame, edge.at(fraction), &instance.to_world);
            clipped::clipped_box(&image, self.edges.parts, &image_bounds)
        });
        PixelBox::union(edges.reduce(|| None, PixelBox::union), visible)
    }

    /// Columns and rows of the pixels that may show the object: the whole image if a part of it has no image point; `None` if it lies outside.
    pub(super) fn pixels(&self, width: usize, height: usize) -> Option<[Range<usize>; 2]> {
        let Some(image) = self.image.filter(|_| !self.is_cut) else { return Some([0..width, 0..height]) };
        let margin = (image.high - image.low) * MARGIN_FRACTION + MARGIN_PX;
        let PixelBox { low, high } =
            PixelBox { low: image.low - margin, high: image.high + margin }.within(width, height)?;
        Some([low.x as usize..high.x.ceil() as usize, low.y as usize..high.y.ceil() as usize])
    }
}
