//! Boxes of objects: in the picture around what is seen and around the whole object, and in space.
//!
//! Every instance with an identity whose pixels are seen, or would be if it stood alone, has an entry. A pixel is counted by its centre's
//! principal ray at the middle of its row's exposure, as in the ground truth; what is smaller than that grid may have no entry.
//!
//! - **Visible**: the pixels that show the instance's identity.
//! - **Alone**: the pixels that would show it were it the only instance; every pixel of its amodal box is asked.
//! - **Amodal box**: about the images of its vertices and of points on its edges, at least some 500 (of a sphere: of its outline), and about
//!   the centres of the pixels that it shows alone, which know how distortion bends an edge between; it may reach beyond the picture. Where a part has no image (behind the camera,
//!   beyond the lens's field) it is about the rest, and `is_cut` says so.
//! - **Amodal box in the picture**: about the part of the whole object's image that lies in the picture. Edges are cut at its border, not the box,
//!   which of an object beside the camera reaches far above and below what is in the picture.
//! - **Box in space**: along the axes of the object (x forward, y left, z up), at the middle of the frame's exposure.
//!
//! Left out: amodal boxes by mirrors, where a point may have several images: they are those of the pixels that the object shows alone, and
//! what is not seen has none. What has no point on its edges with an image, and is hidden, has no entry.

mod amodal;
mod clipped;
mod edges;
mod pixel_box;
mod solid;
#[cfg(test)]
mod tests;
mod world;

pub use pixel_box::PixelBox;
pub use solid::{SolidBox, Stance};
pub use world::{WorldObject, world_objects};

use crate::plan::Plan;
use crate::render::frame_view::FrameView;
use crate::render::look_at::LookAt;
use amodal::Amodal;
use etendue_core::Plane;
use etendue_core::quantity::Identity;
use etendue_tracer::accel::Simd;
use glam::DVec2;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The boxes of one object in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectBoxes {
    /// Its identity in the ground truth.
    pub id: u32,
    /// About the pixels that show it; `None` where none does.
    pub visible: Option<PixelBox>,
    /// About the whole object; `None` where nothing of it has an image, or only by a mirror in which it is not seen.
    pub amodal: Option<PixelBox>,
    /// About the part of the whole object's image within the picture; `None` where none is.
    pub amodal_in_picture: Option<PixelBox>,
    /// Whether parts of it have no image, so that the amodal box is about the rest.
    pub is_cut: bool,
    /// Pixels that show it.
    pub visible_pixels: usize,
    /// Pixels that would show it were it alone.
    pub alone_pixels: usize,
    /// Its box in space.
    pub solid: SolidBox,
}

impl ObjectBoxes {
    /// The part of its pixels that nothing hides, 0 to 1.
    #[must_use]
    pub fn visible_fraction(&self) -> f64 {
        // A pixel whose ray the alone object is found by differently (a silhouette) may be seen and not counted.
        let alone = self.alone_pixels.max(self.visible_pixels);
        if alone == 0 { 0.0 } else { self.visible_pixels as f64 / alone as f64 }
    }

    /// The part of its amodal box's area that lies outside a picture, 0 to 1; `None` where parts have no image.
    #[must_use]
    pub fn truncated_fraction(&self, width_px: usize, height_px: usize) -> Option<f64> {
        let whole = self.amodal.filter(|_| !self.is_cut)?;
        let within = whole.within(width_px, height_px).map_or(0.0, |within| within.area_px2());
        Some(if whole.area_px2() > 0.0 { (1.0 - within / whole.area_px2()).max(0.0) } else { 0.0 })
    }
}

/// The boxes of the objects that a frame shows, in the order of their identities; `ids` are the identities of the frame's ground truth. On
/// the caller's pool.
#[must_use]
pub fn object_boxes(plan: &Plan, frame: &FrameView<'_>, ids: &Plane<Identity>, simd: Simd) -> Vec<ObjectBoxes> {
    let seen = visible(ids);
    let looks = LookAt::new(plan, frame, simd);
    let time_s = frame.interval().middle_s();
    let pose = frame.pose_at(time_s);
    let numbered = plan.world.instances().iter().enumerate().filter(|(_, instance)| instance.instance_id > 0);
    let boxes = numbered.collect::<Vec<_>>().into_par_iter().filter_map(|(index, instance)| {
        let amodal = Amodal::of(plan, frame, instance, time_s);
        if amodal.image.is_none() && !seen.contains_key(&instance.instance_id) {
            return None; // Behind the camera, as far as its edges tell, and not seen: no pixel is asked.
        }
        let alone = alone(&looks, index as u32, &amodal, ids);
        let (visible_pixels, visible) = seen.get(&instance.instance_id).map_or((0, None), |(n, b)| (*n, Some(*b)));
        let (alone_pixels, shown) = alone.map_or((0, None), |(n, b)| (n, Some(b)));
        (visible_pixels + alone_pixels > 0).then(|| ObjectBoxes {
            id: instance.instance_id,
            visible,
            amodal: [shown, visible]
                .into_iter()
                .flatten()
                .fold(amodal.image, |whole, pixels| PixelBox::union(whole, Some(pixels.of_centres()))),
            amodal_in_picture: amodal.in_picture(frame, instance, PixelBox::union(shown, visible).as_ref()),
            is_cut: amodal.is_cut,
            visible_pixels,
            alone_pixels,
            solid: SolidBox::of(plan, instance, time_s, &pose),
        })
    });
    let mut boxes: Vec<ObjectBoxes> = boxes.collect();
    boxes.sort_by_key(|object| object.id);
    boxes
}

/// Number and box of the pixels of each identity.
fn visible(ids: &Plane<Identity>) -> BTreeMap<u32, (usize, PixelBox)> {
    let mut found = BTreeMap::new();
    for (i, id) in ids.samples().iter().enumerate().filter(|(_, id)| **id > 0) {
        let pixel = PixelBox::of_pixel(i % ids.width(), i / ids.width());
        let entry = found.entry(*id).or_insert((0, pixel));
        *entry = (entry.0 + 1, entry.1.about(&pixel));
    }
    found
}

/// The pixels (row by row from the top left) that would show each object of these identities were it alone, or that show it in the ground truth `ids`. On the
/// caller's pool.
#[must_use]
pub fn silhouettes(plan: &Plan, frame: &FrameView<'_>, ids: &Plane<Identity>, simd: Simd) -> BTreeMap<u32, Vec<usize>> {
    let looks = LookAt::new(plan, frame, simd);
    let time_s = frame.interval().middle_s();
    let mut found: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    ids.samples()
        .iter()
        .enumerate()
        .filter(|(_, id)| **id > 0)
        .for_each(|(at, id)| found.entry(*id).or_default().push(at));
    let numbered = plan.world.instances().iter().enumerate().filter(|(_, instance)| instance.instance_id > 0);
    for (index, instance) in numbered {
        let amodal = Amodal::of(plan, frame, instance, time_s);
        if amodal.image.is_none() && !found.contains_key(&instance.instance_id) {
            continue;
        }
        let Some(pixels) = alone_pixels(&looks, index as u32, &amodal, ids) else { continue };
        let seen = found.remove(&instance.instance_id).unwrap_or_default();
        let mut all: Vec<usize> = pixels.map(|(x, y)| y * ids.width() + x).chain(seen).collect();
        all.sort_unstable();
        all.dedup();
        if !all.is_empty() {
            found.insert(instance.instance_id, all);
        }
    }
    found
}

/// Number and box of the pixels that would show an instance were it alone; `None` where none would.
fn alone(looks: &LookAt<'_>, index: u32, amodal: &Amodal, ids: &Plane<Identity>) -> Option<(usize, PixelBox)> {
    let counted = alone_pixels(looks, index, amodal, ids)?.map(|(x, y)| (1, PixelBox::of_pixel(x, y)));
    // Least and greatest of whole numbers: the same in any order.
    counted.reduce_with(|a, b| (a.0 + b.0, a.1.about(&b.1)))
}

/// Columns and rows of these pixels; `None` where the object lies outside the picture.
fn alone_pixels<'a>(
    looks: &'a LookAt<'_>,
    index: u32,
    amodal: &Amodal,
    ids: &Plane<Identity>,
) -> Option<impl ParallelIterator<Item = (usize, usize)> + use<'a>> {
    let [columns, rows] = amodal.pixels(ids.width(), ids.height())?;
    let pixels = rows.into_par_iter().flat_map_iter(move |y| columns.clone().map(move |x| (x, y)));
    Some(pixels.filter(move |(x, y)| looks.meets_alone(DVec2::new(*x as f64, *y as f64) + 0.5, index)))
}
