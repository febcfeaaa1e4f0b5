//! Visibility of rain in images by their exposure.

use super::*;
use core::f64::consts::PI;
use etendue_core::maths::f64::ln;

const PIXEL_RAD: f64 = 2e-3;
const SIZE: [usize; 2] = [160, 90];

/// Fraction of each pixel that drops cover during an exposure that begins at 0, by the drops' paths and cross-sections; a drop is no wider
/// than a pixel if it is farther than 1 m.
fn cover(field: &PrecipitationField, exposure_s: f64) -> Vec<f64> {
    const STEP_S: f64 = 1e-4;
    let interval = TimeInterval::new(0.0, exposure_s).expect("legal");
    let region = VisibleRegion::around(&[DVec3::X], 0.19, 0.0);
    let resolution =
        CameraResolution { pixel_rad: PIXEL_RAD, min_size_px: 0.25, max_particles: 1e9, clear_m: 1.0, exposure_s: 0.0 };
    let change_over = ChangeOver::new(field.classes(), &resolution, &region);
    let mut cover = vec![0.0; SIZE[0] * SIZE[1]];
    for particle in field.particles_near(DVec3::ZERO, interval, &region, &change_over) {
        let streak = field.streak(&particle, DVec3::ZERO, interval, &change_over);
        let area_m2 = PI * f64::from(streak.half_m[0]) * f64::from(streak.half_m[1]);
        for i in 0..(exposure_s / STEP_S).round() as u32 {
            let at = streak.centre(((f64::from(i) + 0.5) * STEP_S) as f32).as_dvec3();
            let distance_m = at.length();
            if at.x <= 0.0 || distance_m < 1.0 || distance_m >= f64::from(streak.to_m) {
                continue;
            }
            let [x, y] =
                [at.y / at.x / PIXEL_RAD + SIZE[0] as f64 / 2.0, at.z / at.x / PIXEL_RAD + SIZE[1] as f64 / 2.0];
            if x >= 0.0 && y >= 0.0 && (x as usize) < SIZE[0] && (y as usize) < SIZE[1] {
                let pixel_m = PIXEL_RAD * distance_m;
                cover[y as usize * SIZE[0] + x as usize] += area_m2 / (pixel_m * pixel_m) * STEP_S / exposure_s;
            }
        }
    }
    cover
}

/// Garg and Nayar ("Vision and rain", IJCV 75, 2007): the standard deviation due to rain falls as the root of the exposure. Fitted over 8
/// to 125 ms, each the mean of four rains.
#[test]
fn the_visibility_of_rain_falls_as_the_root_of_the_exposure() {
    let exposures_s = [0.008, 0.016, 0.032, 0.064, 0.125];
    let points = exposures_s.map(|exposure_s| {
        let variance = |seed| {
            let field = PrecipitationField::new(SizeLaw::rain(50.0).expect("legal"), DVec3::ZERO, 500.0, seed);
            let cover = cover(&field, exposure_s);
            let mean = cover.iter().sum::<f64>() / cover.len() as f64;
            cover.iter().map(|c| (c - mean) * (c - mean)).sum::<f64>() / cover.len() as f64
        };
        (ln(exposure_s), 0.5 * ln((0..4).map(variance).sum::<f64>() / 4.0))
    });
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>()
        / points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>();
    assert!((slope + 0.5).abs() < 0.1, "{slope}: {points:?}");
}
