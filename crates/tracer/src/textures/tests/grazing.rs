//! A road to the horizon: it must neither alias nor blur.
//!
//! A camera 1.5 m above a textured plane; pixels of 0.5 mrad about a line of sight that hits the plane at a distance. Each pixel takes a few
//! stratified samples with the footprint of a cone, as paths do, and is compared with the mean of 2048 unfiltered samples. The filter must keep the
//! mean, bring the pixels' errors well below those of unfiltered samples, and keep the contrast between pixels of the reference.

use super::*;
use etendue_core::maths::f32::tan;
use etendue_core::random::{Draw, FrameAddress, PathStream, Pixel, PixelAddress};
use etendue_stats::Moments;

const HEIGHT_M: f32 = 1.5;
const PIXEL_RAD: f32 = 0.5e-3;

/// The intersection of the ray of a point in the raster (px from the middle, y up) with the plane, for a view that hits it at `distance`.
fn road(distance: f32, raster: Vec2) -> Vec2 {
    let forward = HEIGHT_M / tan(HEIGHT_M / distance - PIXEL_RAD * raster.y);
    Vec2::new(forward * PIXEL_RAD * raster.x, forward)
}

/// Method of reading the texture.
#[derive(Clone, Copy)]
enum ReadMethod {
    Point,
    Footprint(f32),
}

struct RoadView<'a> {
    texture: &'a ImageTexture,
    tile_m: f32,
    distance: f32,
}

impl RoadView<'_> {
    fn pixel(&self, pixel: Pixel, samples: u32, draw: Draw, method: ReadMethod) -> f64 {
        let address = PixelAddress { frame: FrameAddress { seed: 1, ..FrameAddress::default() }, pixel, replicate: 0 };
        let stream = PathStream::new(&address, 0);
        let corner = Vec2::new(pixel.x as f32 - 12.0, pixel.y as f32 - 4.0);
        let one = |s| f64::from(self.read(road(self.distance, corner + stream.with_sample(s).two(draw, 0)), method));
        (0..samples).map(one).sum::<f64>() / f64::from(samples)
    }

    fn read(&self, place: Vec2, method: ReadMethod) -> f32 {
        let at = Lookup::point(place / self.tile_m);
        let lookup = match method {
            ReadMethod::Point => at,
            ReadMethod::Footprint(fraction) => {
                let width = fraction * place.y * PIXEL_RAD / self.tile_m;
                Lookup { width, long: Vec2::new(0.0, width * place.y / HEIGHT_M), ..at }
            }
        };
        self.texture.sample(&lookup)[0]
    }

    /// Moments of: the reference's pixels, those of the method, and their differences.
    fn moments(&self, samples: u32, method: ReadMethod) -> [Moments; 3] {
        let mut moments = [Moments::default(); 3];
        for (x, y) in (0..8).flat_map(|y| (0..24).map(move |x| (x, y))) {
            let pixel = Pixel { x, y };
            let reference = self.pixel(pixel, 2048, Draw::Pupil, ReadMethod::Point);
            let value = self.pixel(pixel, samples, Draw::PixelArea, method);
            for (m, v) in moments.iter_mut().zip([reference, value, value - reference]) {
                m.push(v);
            }
        }
        moments
    }
}

fn deviation(moments: &Moments) -> f64 {
    moments.variance().expect("many pixels").sqrt()
}

/// Squares of 1 m.
fn checker() -> ImageTexture {
    test_image(64, 64, Sampling::default(), |x, y| if (x / 32 + y / 32) % 2 == 0 { 0.1 } else { 0.5 })
}

/// Stones, one per texel, of reflectance 0.02 to 0.3.
fn asphalt() -> ImageTexture {
    test_image(256, 256, Sampling::default(), |x, y| {
        let address = PixelAddress {
            frame: FrameAddress { seed: 9, ..FrameAddress::default() },
            pixel: Pixel { x, y },
            replicate: 0,
        };
        let grey = PathStream::new(&address, 0).one(Draw::PixelArea, 0);
        0.02 + 0.28 * grey * grey
    })
}

/// Samples of a pixel.
const SAMPLES: u32 = 16;

/// Fraction of a pixel's width that each of its samples represents.
const PIXEL_FRACTION: f32 = 0.25;

#[test]
fn a_distant_road_neither_shimmers_nor_blurs_away() {
    for (name, texture, tile_m) in
        [("checker", checker(), 2.0), ("gravel", asphalt(), 2.56), ("slabs", asphalt(), 25.6)]
    {
        for distance in [10.0, 30.0, 100.0, 300.0] {
            let actual = RoadView { texture: &texture, tile_m, distance };
            let [reference, _, unfiltered] = actual.moments(SAMPLES, ReadMethod::Point);
            let [_, filtered, errors] = actual.moments(SAMPLES, ReadMethod::Footprint(PIXEL_FRACTION));
            let name = format!("{name} at {distance} m: {reference:?} {filtered:?} {errors:?}");
            // Three standard errors of the mean difference, and 0.1 % for light that filtering moves across the window's edge.
            let allowed = 3.0 * errors.variance_of_mean().expect("pixels").sqrt() + 1e-3 * reference.mean();
            assert!(errors.mean().abs() < allowed, "mean of {name}");
            // Measured: 1.0 near by, 0.6 at 100 m, 0.1 to 0.4 at 300 m.
            let maximum = if distance < 100.0 {
                1.02
            } else if distance < 300.0 {
                0.65
            } else {
                0.45
            };
            assert!(deviation(&errors) < maximum * deviation(&unfiltered), "shimmer of {name}");
            // Measured: 0.99 and more near by, 0.83 at 100 m, 0.7 at 300 m, where a thousand stones share a pixel.
            let minimum = if distance < 100.0 { 0.97 } else { 0.65 };
            assert!(deviation(&filtered) > minimum * deviation(&reference), "contrast of {name}");
        }
    }
}

#[test]
fn long_footprints_see_what_lies_along_them() {
    // Stripes across the viewing direction: a long footprint averages them, a round one of the same width does not.
    let stripes = test_image(64, 64, Sampling::default(), |_, y| f32::from(u8::from(y % 16 < 8)));
    let round = Lookup { width: 1.0 / 64.0, ..Lookup::point(Vec2::new(0.5, 3.5 / 64.0)) };
    let along = Lookup { long: Vec2::new(0.0, 0.25), ..round };
    let across = Lookup { long: Vec2::new(0.25, 0.0), ..round };
    let [round, along, across] = [round, along, across].map(|l| stripes.sample(&l)[0]);
    assert_eq!((round, across), (round.round(), round), "no stripe is crossed");
    assert!((along - 0.5).abs() < 0.13, "eight places over one period: {along}");
}
