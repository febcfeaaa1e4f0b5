//! An image as sources at infinity: single pixels where it is bright, blocks of pixels where it is dim.

use etendue_core::{plane::Plane, quantity::Quantity};
use glam::DVec2;

/// The fraction of all light above which a block of several pixels is split.
pub(super) const SPLIT_FRACTION: f64 = 1.0 / 300.0;

/// An image whose samples, times a factor of the pixel and one of the band, are radiance times solid angle.
pub(super) struct SourceImage<'a, Q: Quantity<Sample = f32>> {
    pub(super) planes: &'a [Plane<Q>],
    /// By pixel, row by row; 0 for one that is no source.
    pub(super) pixel_factor: Vec<f64>,
    /// By band.
    pub(super) band_factor: Vec<f64>,
}

/// Light from one direction.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GhostSource {
    /// The centroid of its light in the image, raster coordinates.
    pub(super) at_px: DVec2,
    /// Radiance times solid angle by band: the irradiance of a surface that faces it, W·m⁻²·nm⁻¹.
    pub(super) spectrum: Vec<f32>,
    /// Its fraction of all light.
    pub(super) fraction: f64,
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug)]
struct Block {
    x: [usize; 2],
    y: [usize; 2],
}

impl<Q: Quantity<Sample = f32>> SourceImage<'_, Q> {
    /// The image's sources, in a fixed order.
    pub(super) fn sources(&self) -> Vec<GhostSource> {
        let strength = self.strength();
        let total: f64 = strength.iter().sum();
        let Some(first) = self.planes.first().filter(|_| total > 0.0) else { return Vec::new() };
        let (width, height) = (first.width(), first.height());
        let mut open = vec![Block { x: [0, width], y: [0, height] }];
        let mut sources = Vec::new();
        while let Some(block) = open.pop() {
            let light: f64 = block.pixels(width).map(|i| strength[i]).sum();
            if light > SPLIT_FRACTION * total && block.len() > 1 {
                open.extend(block.parts());
            } else if light > 0.0 {
                sources.push(self.source(block, &strength, light, light / total));
            }
        }
        sources
    }

    /// Total light of all bands of each pixel.
    fn strength(&self) -> Vec<f64> {
        let mut strength = vec![0.0; self.pixel_factor.len()];
        for (plane, band) in self.planes.iter().zip(&self.band_factor) {
            for ((sum, value), pixel) in strength.iter_mut().zip(plane.samples()).zip(&self.pixel_factor) {
                let light = f64::from(*value) * pixel * band;
                *sum += if light.is_finite() { light.max(0.0) } else { 0.0 };
            }
        }
        strength
    }

    fn source(&self, block: Block, strength: &[f64], light: f64, fraction: f64) -> GhostSource {
        let width = self.planes[0].width();
        let centre = |i: usize| DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let moment: DVec2 = block.pixels(width).map(|i| centre(i) * strength[i]).sum();
        let of_band = |(plane, factor): (&Plane<Q>, &f64)| {
            let pixels = block.pixels(width).filter(|i| strength[*i] > 0.0);
            (factor * pixels.map(|i| f64::from(plane.samples()[i]) * self.pixel_factor[i]).sum::<f64>()) as f32
        };
        let spectrum = self.planes.iter().zip(&self.band_factor).map(of_band).collect();
        GhostSource { at_px: moment / light, spectrum, fraction }
    }
}

impl Block {
    fn len(&self) -> usize {
        (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
    }

    /// Indices of its pixels in an image of a width.
    fn pixels(self, width: usize) -> impl Iterator<Item = usize> {
        (self.y[0]..self.y[1]).flat_map(move |y| (self.x[0]..self.x[1]).map(move |x| y * width + x))
    }

    /// Halves along each direction with more than one pixel.
    fn parts(self) -> Vec<Self> {
        let halves = |[low, high]: [usize; 2]| {
            let middle = usize::midpoint(low, high);
            if high - low > 1 { vec![[low, middle], [middle, high]] } else { vec![[low, high]] }
        };
        let columns = halves(self.x);
        halves(self.y).into_iter().flat_map(|y| columns.iter().map(move |x| Self { x: *x, y })).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::quantity::Radiance;

    #[test]
    fn light_is_kept_and_bright_pixels_stand_alone() {
        let mut plane: Plane<Radiance> = Plane::filled(37, 23, 1.0);
        plane.set(20, 11, 5000.0);
        let planes = [plane.clone(), plane.map(|v| 2.0 * v)];
        let image = SourceImage { planes: &planes, pixel_factor: vec![0.5; 37 * 23], band_factor: vec![1.0, 3.0] };
        let sources = image.sources();
        let all: f64 = 37.0 * 23.0 - 1.0 + 5000.0;
        let sum = |band: usize| sources.iter().map(|s| f64::from(s.spectrum[band])).sum::<f64>();
        assert!((sum(0) / (0.5 * all) - 1.0).abs() < 1e-6 && (sum(1) / (3.0 * all) - 1.0).abs() < 1e-6);
        let bright = sources.iter().max_by(|a, b| a.fraction.total_cmp(&b.fraction)).expect("sources");
        assert_eq!(bright.at_px, DVec2::new(20.5, 11.5));
        assert!((bright.fraction - 5000.0 / all).abs() < 1e-9);
        assert!(sources.iter().filter(|s| s.fraction > SPLIT_FRACTION).count() == 1, "no other is above the share");
    }

    #[test]
    fn darkness_has_no_sources() {
        let planes = [Plane::<Radiance>::new(4, 4)];
        let image = SourceImage { planes: &planes, pixel_factor: vec![1.0; 16], band_factor: vec![1.0] };
        assert!(image.sources().is_empty());
    }
}
