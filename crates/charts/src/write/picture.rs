//! The print as pixels: each pixel is the mean of the pieces that cover it.

use etendue_core::{Plane, quantity::Display};
use etendue_spectra::colour::encode;
use glam::DVec2;

use crate::shape::{Fill, area, bounds};
use crate::{drawing::Drawing, error::ChartError, ink::Paint};

/// Maximum number of pixels; more are taken for a typing error.
const MAX_PX: f64 = 2e8;
const MM_PER_INCH: f64 = 25.4;

/// The first sheet, sRGB-encoded, at `dpi` pixels per inch. Coverage is exact; colours are mixed in linear light.
///
/// # Errors
/// If the chart is not one flat sheet, or the image size is not reasonable.
pub fn chart_image(drawing: &Drawing, dpi: f64) -> Result<Plane<Display>, ChartError> {
    if !drawing.is_flat() {
        return Err(ChartError::option(
            "png",
            dpi,
            "this chart is three-dimensional and has no print; leave `png` out",
        ));
    }
    let sheet = &drawing.panels[0].sheet;
    let px_per_mm = dpi / MM_PER_INCH;
    let size = (sheet.size_mm * px_per_mm).round();
    if !(dpi > 0.0 && size.min_element() >= 1.0 && size.element_product() <= MAX_PX) {
        let [w, h] = sheet.size_mm.to_array();
        let message = format!(
            "at this resolution a sheet of {w:.0} x {h:.0} mm has {:.0} x {:.0} pixels; expected 1 to 2e8",
            size.x, size.y
        );
        return Err(ChartError::option("png", dpi, message));
    }
    let (width, height) = (size.x as usize, size.y as usize);
    let mut linear = vec![[0.0_f64; 3]; width * height];
    let scale = size / sheet.size_mm;
    for piece in &sheet.pieces {
        let corners: Vec<DVec2> = piece.outline.iter().map(|p| (*p + sheet.size_mm / 2.0) * scale).collect();
        let ink = match piece.fill {
            Fill::Ink(ink) => &drawing.inks[ink],
            Fill::Hole => continue,
        };
        let plain = ink.print_rgb();
        let texture = match ink.paint {
            Paint::Texture { texture, .. } => Some(&drawing.textures[texture]),
            _ => None,
        };
        let (low, high) = bounds(&corners);
        cover(&corners, width, height, |x, y, coverage| {
            let colour = texture.map_or(plain, |texture| {
                let at = (DVec2::new(x as f64, y as f64) + 0.5 - low) / (high - low);
                let place = |t: f64, n: usize| ((t * n as f64).max(0.0) as usize).min(n - 1);
                let (column, row) = (place(at.x, texture.width), place(at.y, texture.height));
                [f64::from(texture.values[row * texture.width + column]) / 65_535.0; 3]
            });
            let pixel = &mut linear[y * width + x];
            (0..3).for_each(|c| pixel[c] += coverage * colour[c]);
        });
    }
    let encoded = linear.into_iter().map(|rgb| rgb.map(|v| encode(v as f32))).collect();
    Ok(Plane::from_samples(width, height, encoded).expect("one sample per pixel"))
}

/// Calls `take` with each pixel that a convex outline (px) touches, and the fraction of it that it covers.
fn cover(outline: &[DVec2], width: usize, height: usize, mut take: impl FnMut(usize, usize, f64)) {
    let (low, high) = bounds(outline);
    for y in cells(low.y, high.y, height) {
        let row = between(outline, DVec2::Y, y as f64);
        if row.len() < 3 {
            continue;
        }
        let (low, high) = bounds(&row);
        for x in cells(low.x, high.x, width) {
            let coverage = area(&between(&row, DVec2::X, x as f64));
            if coverage > 0.0 {
                take(x, y, coverage);
            }
        }
    }
}

fn cells(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    (low.max(0.0) as usize)..(high.ceil().max(0.0) as usize).min(count)
}

/// Part of a convex outline from `start` to `start` + 1 along an axis.
fn between(outline: &[DVec2], axis: DVec2, start: f64) -> Vec<DVec2> {
    let above = cut(outline, |p| p.dot(axis) - start);
    cut(&above, |p| start + 1.0 - p.dot(axis))
}

/// Part of a convex outline where `side` is positive (Sutherland and Hodgman 1974).
fn cut(outline: &[DVec2], side: impl Fn(DVec2) -> f64) -> Vec<DVec2> {
    let mut clipped = Vec::with_capacity(outline.len() + 1);
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        let (at_a, at_b) = (side(*a), side(b));
        if at_a >= 0.0 {
            clipped.push(*a);
        }
        if (at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0) {
            clipped.push(*a + (b - *a) * (at_a / (at_a - at_b)));
        }
    }
    clipped
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::disc;

    #[test]
    fn coverage_is_exact() {
        let outline = disc(DVec2::new(10.3, 7.7), 5.0, 64, 0.1);
        let (mut sum, mut largest) = (0.0, 0.0_f64);
        cover(&outline, 30, 30, |_, _, coverage| {
            sum += coverage;
            largest = largest.max(coverage);
        });
        assert!((sum / area(&outline) - 1.0).abs() < 1e-12 && (largest - 1.0).abs() < 1e-12);
        let mut covered_beyond = 0.0;
        cover(&outline, 10, 30, |x, _, coverage| {
            assert!(x < 10);
            covered_beyond += coverage;
        });
        assert!(covered_beyond < sum && covered_beyond > 0.0);
    }
}
