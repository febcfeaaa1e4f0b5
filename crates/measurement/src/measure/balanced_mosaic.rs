//! A grey image of a raw mosaic, without demosaicing.
//!
//! The light of a black and white chart gives the pixels under two filters a v + b and a' v + b', with the same v where the same
//! light falls. Each place of the tile is scaled and shifted until its pixels have the average mean and standard deviation of the
//! four. The result is the image of a sensor without filters: nothing is interpolated, and edge positions do not depend on the
//! colour of the pixel, unlike with a mean of unequal responses or with the artefacts of demosaicing. Pixels of tiles with a
//! saturated pixel do not count.
//!
//! Limitations: light whose colour varies over the image (coloured surfaces, lateral chromatic aberration) and saturation under
//! only some of the filters leave a pattern with a period of two pixels.

use etendue_metrology::Image;

/// Distance of pixels of one place in the tile, along rows and along columns.
const PERIOD: usize = 2;
const PLACES: usize = PERIOD * PERIOD;

/// The image of a mosaic with a two by two tile and balanced colours, in the mosaic's unit, one reading per pixel. `saturated` is
/// the reading of a saturated pixel, if known. A mosaic of a single row or column has no tiles and is returned unchanged.
pub(super) fn balanced_mosaic(mosaic: &Image, saturated: Option<f64>) -> Image {
    let (width, height) = (mosaic.width(), mosaic.height());
    let balance = TileStatistics::from_mosaic(mosaic, saturated);
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let samples = places.map(|(x, y)| balance.applied(place(x, y), mosaic.at(x, y)));
    Image::from_samples(width, height, samples.collect()).expect("as many as before")
}

fn place(x: usize, y: usize) -> usize {
    x % PERIOD + PERIOD * (y % PERIOD)
}

/// Mean and standard deviation of each place of the tile.
struct TileStatistics {
    mean: [f64; PLACES],
    deviation: [f64; PLACES],
}

impl TileStatistics {
    fn from_mosaic(mosaic: &Image, saturated: Option<f64>) -> Self {
        let unsaturated = |tile: &[f64; PLACES]| saturated.is_none_or(|full| tile.iter().all(|v| *v < full));
        let mean = mean(tiles(mosaic).filter(unsaturated));
        let squares = |tile: [f64; PLACES]| std::array::from_fn(|p| (tile[p] - mean[p]) * (tile[p] - mean[p]));
        let variance = self::mean(tiles(mosaic).filter(unsaturated).map(squares));
        Self { mean, deviation: variance.map(f64::sqrt) }
    }

    fn applied(&self, place: usize, reading: f32) -> f32 {
        let common = |of: &[f64; PLACES]| of.iter().sum::<f64>() / PLACES as f64;
        let own = self.deviation[place];
        let scale = if own > 0.0 { common(&self.deviation) / own } else { 1.0 };
        (common(&self.mean) + (f64::from(reading) - self.mean[place]) * scale) as f32
    }
}

/// Readings of the whole tiles, by place.
fn tiles(mosaic: &Image) -> impl Iterator<Item = [f64; PLACES]> + '_ {
    let (columns, rows) = (mosaic.width() / PERIOD, mosaic.height() / PERIOD);
    let tile = move |x: usize, y: usize| {
        std::array::from_fn(|p| f64::from(mosaic.at(PERIOD * x + p % PERIOD, PERIOD * y + p / PERIOD)))
    };
    (0..rows).flat_map(move |y| (0..columns).map(move |x| tile(x, y)))
}

/// By place; zero if there are no tiles.
fn mean(tiles: impl Iterator<Item = [f64; PLACES]>) -> [f64; PLACES] {
    let (mut sum, mut count) = ([0.0; PLACES], 0.0_f64);
    for tile in tiles {
        sum.iter_mut().zip(tile).for_each(|(sum, value)| *sum += value);
        count += 1.0;
    }
    sum.map(|sum| sum / count.max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_metrology::target::{Target, TargetQuery, find};
    use glam::DVec2;

    const RESPONSE: [f32; PLACES] = [0.58, 1.0, 0.9, 0.85];
    const BLACK: [f32; PLACES] = [0.06, 0.06, 0.07, 0.05];

    fn light_image(width: usize, height: usize, reading: impl Fn(usize, usize) -> f32) -> Image {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Image::from_samples(width, height, places.map(|(x, y)| reading(x, y)).collect()).expect("as many as places")
    }

    fn mosaic(light: &Image) -> Image {
        let reading = |x, y| RESPONSE[place(x, y)] * light.at(x, y) + BLACK[place(x, y)];
        light_image(light.width(), light.height(), reading)
    }

    /// Squares of 14.5 px with corners offset by `shift`, blurred only by the area of the pixels, brighter towards the right.
    fn checkerboard(shift: [f64; 2], turn: f64) -> Image {
        const STEPS: usize = 10;
        let square = |x: f64, y: f64| {
            let (x, y) = (x - 66.0 - shift[0], y - 59.0 - shift[1]);
            let (u, v) = ((x + turn * y) / 14.5, (y - turn * x) / 14.5);
            let within = u.abs() < 4.0 && v.abs() < 3.0;
            let white = (u.floor() + v.floor()).rem_euclid(2.0) == 0.0;
            if within && white { 0.8 + 0.002 * x } else { 0.04 }
        };
        let at = |i: usize, k: usize| i as f64 + (k as f64 + 0.5) / STEPS as f64;
        light_image(132, 118, |x, y| {
            let all = (0..STEPS * STEPS).map(|k| square(at(x, k % STEPS), at(y, k / STEPS))).sum::<f64>();
            (all / (STEPS * STEPS) as f64) as f32
        })
    }

    fn corners(image: &Image) -> Vec<DVec2> {
        let grid = find(image, TargetQuery { target: Some(Target::Checkerboard), size: None }).expect("a chart");
        grid.nodes.iter().map(|node| node.at).collect()
    }

    /// The corners of a sharp chart are where a sensor without filters would see them, whatever the colours of the pixels.
    #[test]
    fn corners_do_not_move_with_their_place_among_the_colours() {
        let mut worst: f64 = 0.0;
        for phase in 0..8 {
            let shift = [0.25 * f64::from(phase), 0.25 * f64::from(5 * phase % 8)];
            let light = checkerboard(shift, 0.03 * f64::from(phase % 3));
            let (mono, balanced) = (corners(&light), corners(&balanced_mosaic(&mosaic(&light), None)));
            assert_eq!((mono.len(), balanced.len()), (35, 35));
            let distances = mono.iter().zip(&balanced).map(|(a, b)| a.distance(*b));
            worst = distances.fold(worst, f64::max);
        }
        assert!(worst < 0.005, "{worst} px");
    }

    /// Light with equal steps at all places is reproduced exactly, up to one scale and one shift.
    #[test]
    fn uniform_light_leaves_no_trace_of_the_filters() {
        let light = light_image(12, 8, |x, y| 0.1 + 0.2 * ((x / 2 + y / 2) % 3) as f32);
        let grey = balanced_mosaic(&mosaic(&light), None);
        let light_and_grey = |i: usize| (f64::from(light.samples()[i]), f64::from(grey.samples()[i]));
        let ((l0, g0), (l1, g1)) = (light_and_grey(0), light_and_grey(2));
        for i in 0..96 {
            let (l, g) = light_and_grey(i);
            assert!((g - (g0 + (l - l0) * (g1 - g0) / (l1 - l0))).abs() < 1e-6, "{i}: {g}");
        }
    }

    #[test]
    fn saturated_tiles_do_not_count() {
        let light = light_image(12, 8, |x, y| 0.1 + 0.2 * ((x / 2 + y / 2) % 3) as f32);
        let clipped = |x: usize, y: usize| if y >= 6 { 1.0 } else { mosaic(&light).at(x, y) };
        let with = balanced_mosaic(&light_image(12, 8, clipped), Some(1.0));
        let without = balanced_mosaic(&mosaic(&light).part(0, 0, 12, 6), None);
        assert_eq!(with.samples()[..72], without.samples()[..]);
    }

    #[test]
    fn flat_and_thin_pictures_keep_their_readings() {
        let flat = balanced_mosaic(&light_image(6, 4, |x, y| [1.0, 2.0, 4.0, 9.0][place(x, y)]), None);
        assert!(flat.samples().iter().all(|v| *v == 4.0));
        let row = light_image(5, 1, |x, _| x as f32);
        assert_eq!(balanced_mosaic(&row, None).samples(), row.samples());
    }
}
