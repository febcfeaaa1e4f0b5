//! Boxes of objects over a picture, in the objects' identity colours: around what is seen with a full line, around the whole object with dots.

use super::identity_colour::identity_colour;
use crate::inspect::Preview;
use crate::inspect::object_box::ObjectBox;

/// Dots of a dotted line are one pixel of so many.
const DOT_PITCH: usize = 4;

/// Draws the boxes of objects that are seen.
pub(in crate::inspect) fn draw_boxes(preview: &mut Preview, objects: &[ObjectBox]) {
    for object in objects.iter().filter(|object| object.visible_box_px.is_some()) {
        let colour = identity_colour(object.id);
        if let Some(edges) = object.amodal_box_px {
            outline(preview, edges, colour, DOT_PITCH);
        }
        if let Some(edges) = object.visible_box_px {
            outline(preview, edges, colour, 1);
        }
    }
}

/// The outermost pixels within `left, top, right, bottom` (raster coordinates of the edges), as far as the picture has them.
fn outline(preview: &mut Preview, edges: [f64; 4], colour: [u8; 3], pitch: usize) {
    let (width, height) = (preview.width as f64, preview.height as f64);
    let [left, top, right, bottom] = edges;
    if !(left < right && top < bottom) {
        return;
    }
    // From the pixel in which an edge begins to the last one before the opposite edge.
    let (first, last) = ([left.floor(), top.floor()], [right.ceil() - 1.0, bottom.ceil() - 1.0]);
    let inside = |from: f64, to: f64, size: f64| {
        let (from, to) = (from.max(0.0), to.min(size - 1.0));
        if from <= to { (from as usize)..(to as usize + 1) } else { 0..0 }
    };
    for y in [first[1], last[1]].into_iter().filter(|y| (0.0..height).contains(y)) {
        inside(first[0], last[0], width).step_by(pitch).for_each(|x| set(preview, x, y as usize, colour));
    }
    for x in [first[0], last[0]].into_iter().filter(|x| (0.0..width).contains(x)) {
        inside(first[1], last[1], height).step_by(pitch).for_each(|y| set(preview, x as usize, y, colour));
    }
}

fn set(preview: &mut Preview, x: usize, y: usize, colour: [u8; 3]) {
    preview.rgb[y * preview.width + x] = colour;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(edges: [f64; 4]) -> Vec<usize> {
        let mut preview = Preview { width: 8, height: 6, rgb: vec![[0; 3]; 48] };
        outline(&mut preview, edges, [9; 3], 1);
        (0..48).filter(|i| preview.rgb[*i] == [9; 3]).collect()
    }

    #[test]
    fn a_box_is_drawn_on_its_outermost_pixels() {
        assert_eq!(drawn([2.0, 1.0, 5.0, 4.0]), [10, 11, 12, 18, 20, 26, 27, 28]);
        assert_eq!(drawn([3.0, 3.0, 4.0, 4.0]), [27]);
        assert_eq!(drawn([2.3, 1.9, 4.1, 3.5]), drawn([2.0, 1.0, 5.0, 4.0]));
    }

    #[test]
    fn what_lies_outside_is_left_out() {
        // The right and lower edge only.
        assert_eq!(drawn([-5.0, -5.0, 3.0, 2.0]), [2, 8, 9, 10]);
        assert_eq!(drawn([-5.0, -5.0, 30.0, 20.0]), [0; 0]);
        assert_eq!(drawn([20.0, 20.0, 30.0, 30.0]), [0; 0]);
        assert_eq!(drawn([-9.0, 1.0, -2.0, 3.0]), [0; 0]);
        assert_eq!(drawn([f64::NAN, 0.0, 1.0, 1.0]), [0; 0]);
    }
}
