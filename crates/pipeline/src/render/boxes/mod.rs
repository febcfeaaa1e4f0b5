//! Boxes of objects: in the image, of the visible pixels and of the whole object, and in space.
//!
//! Every instance with an identity whose pixels are visible, or would be if it were alone, has an entry. A pixel is counted by its centre's
//! principal ray at the middle of its row's exposure, as in the ground truth; objects smaller than that grid may have no entry.
//!
//! - **Visible**: the pixels that show the instance's identity.
//! - **Alone**: the pixels that would show it if it were the only instance; every pixel of its amodal box is tested.
//! - **Amodal box**: contains the images of its vertices and of points on its edges, at least about 500 (of a sphere: of its outline), and
//!   the centres of the pixels that it shows alone, which account for the bending of edges by distortion; it may extend beyond the image. If a part has no
//!   image (behind the camera,
//!   beyond the lens's field), the box contains the rest, and `is_cut` is true.
//! - **Amodal box in the image**: contains the part of the whole object's image within the image frame. Edges are clipped at its border, not the box,
//!   because the box of an object next to the camera extends far above and below the visible part.
//! - **Box in space**: along the axes of the object (x forward, y left, z up), at the middle of the frame's exposure.
//!
//! Limitations: by mirrors, where a point may have several images, amodal boxes are those of the pixels that the object shows alone, and
//! invisible objects have none. A hidden object without an image of any edge point has no entry.

mod amodal;
mod clipped;
mod edges;
mod pixel_box;
mod solid;
#[cfg(test)]
mod tests;
mod world;

pub use pixel_box::PixelBox;
pub use solid::{BoxPose, SolidBox};
pub use world::{WorldObject, world_objects};

use crate::plan::Plan;
use crate::render::frame_view::FrameView;
use crate::render::look_at::GroundTruthView;
use amodal::AmodalImage;
use etendue_core::Plane;
use etendue_core::quantity::Identity;
use etendue_tracer::accel::Simd;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Boxes of one object in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectBoxes {
    /// Instance id in the ground truth.
    pub id: u32,
    /// Box of the pixels that show it; `None` if there are none.
    pub visible: Option<PixelBox>,
    /// Box of the whole object; `None` if nothing of it has an image, or only by a mirror in which it is not visible.
    pub amodal: Option<PixelBox>,
    /// Box of the part of the whole object's image within the image frame; `None` if there is none.
    pub amodal_in_picture: Option<PixelBox>,
    /// True if parts of it have no image, so that the amodal box contains only the rest.
    pub is_cut: bool,
    /// Number of pixels that show it.
    pub visible_pixels: usize,
    /// Number of pixels that would show it if it were alone.
    pub alone_pixels: usize,
    /// Its box in space.
    pub solid: SolidBox,
}

impl ObjectBoxes {
    /// Fraction of its pixels that are not occluded, 0 to 1.
    #[must_use]
    pub fn visible_fraction(&self) -> f64 {
        // A silhouette pixel may be visible but not counted, because the ray can find the lone object differently.
        let alone = self.alone_pixels.max(self.visible_pixels);
        if alone == 0 { 0.0 } else { self.visible_pixels as f64 / alone as f64 }
    }

    /// Fraction of its amodal box's area outside an image, 0 to 1; `None` if parts have no image.
    #[must_use]
    pub fn truncated_fraction(&self, width_px: usize, height_px: usize) -> Option<f64> {
        let amodal = self.amodal.filter(|_| !self.is_cut)?;
        let within = amodal.within(width_px, height_px).map_or(0.0, |within| within.area_px2());
        Some(if amodal.area_px2() > 0.0 { (1.0 - within / amodal.area_px2()).max(0.0) } else { 0.0 })
    }
}

/// Boxes of the objects in a frame, in the order of their identities; `ids` are the identities of the frame's ground truth. Runs on the caller's pool.
#[must_use]
pub fn object_boxes(plan: &Plan, frame: &FrameView<'_>, ids: &Plane<Identity>, simd: Simd) -> Vec<ObjectBoxes> {
    let visible_boxes = visible(ids);
    let views = GroundTruthView::new(plan, frame, simd);
    let time_s = frame.interval().middle_s();
    let pose = frame.pose_at(time_s);
    let numbered = plan.world.instances().iter().enumerate().filter(|(_, instance)| instance.instance_id > 0);
    let boxes = numbered.collect::<Vec<_>>().into_par_iter().filter_map(|(index, instance)| {
        let amodal = AmodalImage::new(plan, frame, instance, time_s);
        if amodal.image.is_none() && !visible_boxes.contains_key(&instance.instance_id) {
            return None; // Behind the camera, as far as its edges show, and not visible: no pixel is tested.
        }
        let alone = box_if_alone(&views, index as u32, &amodal, ids);
        let (visible_pixels, visible) =
            visible_boxes.get(&instance.instance_id).map_or((0, None), |(n, b)| (*n, Some(*b)));
        let (alone_pixels, visible_box) = alone.map_or((0, None), |(n, b)| (n, Some(b)));
        (visible_pixels + alone_pixels > 0).then(|| ObjectBoxes {
            id: instance.instance_id,
            visible,
            amodal: [visible_box, visible]
                .into_iter()
                .flatten()
                .fold(amodal.image, |all_pixels, pixels| PixelBox::union(all_pixels, Some(pixels.pixel_centres()))),
            amodal_in_picture: amodal.within_image(frame, instance, PixelBox::union(visible_box, visible).as_ref()),
            is_cut: amodal.is_cut,
            visible_pixels,
            alone_pixels,
            solid: SolidBox::new(plan, instance, time_s, &pose),
        })
    });
    let mut boxes: Vec<ObjectBoxes> = boxes.collect();
    boxes.sort_by_key(|object| object.id);
    boxes
}

/// Number and box of the visible pixels of each identity.
fn visible(ids: &Plane<Identity>) -> BTreeMap<u32, (usize, PixelBox)> {
    let mut boxes = BTreeMap::new();
    for (i, id) in ids.samples().iter().enumerate().filter(|(_, id)| **id > 0) {
        let pixel = PixelBox::from_pixel(i % ids.width(), i / ids.width());
        let entry = boxes.entry(*id).or_insert((0, pixel));
        *entry = (entry.0 + 1, entry.1.union_with(&pixel));
    }
    boxes
}

/// Pixels (row by row from the top left) that would show each object of these identities if it were alone, or that show it in the ground truth `ids`. Runs on
/// the caller's pool.
#[must_use]
pub fn silhouettes(plan: &Plan, frame: &FrameView<'_>, ids: &Plane<Identity>, simd: Simd) -> BTreeMap<u32, Vec<usize>> {
    let views = GroundTruthView::new(plan, frame, simd);
    let time_s = frame.interval().middle_s();
    let mut pixels_by_instance: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    ids.samples()
        .iter()
        .enumerate()
        .filter(|(_, id)| **id > 0)
        .for_each(|(at, id)| pixels_by_instance.entry(*id).or_default().push(at));
    let numbered = plan.world.instances().iter().enumerate().filter(|(_, instance)| instance.instance_id > 0);
    for (index, instance) in numbered {
        let amodal = AmodalImage::new(plan, frame, instance, time_s);
        if amodal.image.is_none() && !pixels_by_instance.contains_key(&instance.instance_id) {
            continue;
        }
        let Some(pixels) = alone_pixels(&views, index as u32, &amodal, ids) else { continue };
        let own_pixels = pixels_by_instance.remove(&instance.instance_id).unwrap_or_default();
        let mut all: Vec<usize> = pixels.map(|(x, y)| y * ids.width() + x).chain(own_pixels).collect();
        all.sort_unstable();
        all.dedup();
        if !all.is_empty() {
            pixels_by_instance.insert(instance.instance_id, all);
        }
    }
    pixels_by_instance
}

/// Number and box of the pixels that would show an instance if it were alone; `None` if there are none.
fn box_if_alone(
    views: &GroundTruthView<'_>,
    index: u32,
    amodal: &AmodalImage,
    ids: &Plane<Identity>,
) -> Option<(usize, PixelBox)> {
    let counted = alone_pixels(views, index, amodal, ids)?.map(|(x, y)| (1, PixelBox::from_pixel(x, y)));
    // Minimum and maximum of integers: independent of the order.
    counted.reduce_with(|a, b| (a.0 + b.0, a.1.union_with(&b.1)))
}

/// Columns and rows of these pixels; `None` if the object lies outside the image.
fn alone_pixels<'a>(
    views: &'a GroundTruthView<'_>,
    index: u32,
    amodal: &AmodalImage,
    ids: &Plane<Identity>,
) -> Option<impl ParallelIterator<Item = (usize, usize)> + use<'a>> {
    let [columns, rows] = amodal.pixels(ids.width(), ids.height())?;
    let pixels = rows.into_par_iter().flat_map_iter(move |y| columns.clone().map(move |x| (x, y)));
    Some(pixels.filter(move |(x, y)| views.would_show(DVec2::new(*x as f64, *y as f64) + 0.5, index)))
}
