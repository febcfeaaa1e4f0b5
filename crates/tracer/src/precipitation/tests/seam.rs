//! Single drops and the medium beyond them are one rain.

use super::*;
use crate::accel::Simd;
use crate::media::Media;
use etendue_core::Ray;
use etendue_core::maths::f64::{exp, ln};
use etendue_core::random::{philox4x32, unit_f64};

/// Rain a hundred times as dense, so that few metres attenuate half of the light.
fn dense() -> PrecipitationField {
    let law = SizeLaw::rain(100.0).expect("legal");
    PrecipitationField::new(size_law::SizeLaw { n0: 100.0 * law.n0(), ..law }, DVec3::new(1.0, 2.0, 0.0), 500.0, 0)
}

/// By distance, the transmittance of single drops and the hollowed medium together is exp(−β d), within 2 %: before, at and beyond the
/// change-over of the relevant sizes (1 m for 2 mm). A thousand rays in each of 60 directions and times; the drops' number alone leaves 0.5
/// %.
#[test]
fn extinction_is_the_same_before_and_beyond_the_change_over() {
    const RAYS: u32 = 1000;
    let field = dense();
    let medium = [field.medium().expect("legal")];
    let distances = [0.4_f32, 0.8, 1.2, 2.0, 4.0];
    let mut through = [0.0; 5];
    let rounds = 60_u32;
    for round in 0..rounds {
        let origin_m = DVec3::new(f64::from(round) * 50.0, 0.0, 1.0);
        let interval = TimeInterval::new(f64::from(round), f64::from(round) + 0.01).expect("legal");
        let axis = DVec3::new(1.0, 0.3, 0.1).normalize();
        let region = VisibleRegion::around(&[axis], 0.1, 0.0);
        let resolution =
            CameraResolution { pixel_rad: 8e-3, min_size_px: 0.25, max_particles: 1e9, clear_m: 0.0, exposure_s: 0.0 };
        let change_over = ChangeOver::new(field.classes(), &resolution, &region);
        let media = Media::new(&medium, origin_m, interval);
        let near = NearParticles::new(
            &field,
            media,
            0,
            ViewPlacement { origin_m, interval, simd: Simd::Auto },
            &region,
            &change_over,
        );
        for i in 0..RAYS {
            let [a, b, c, _] = philox4x32([i, round, 0, 0], [1, 2]).map(|word| unit_f64(u64::from(word) << 32));
            let direction = (axis + 0.09 * DVec3::new(0.0, 2.0 * a - 1.0, 2.0 * b - 1.0) * 0.7).normalize();
            let ray = Ray::new(glam::Vec3::ZERO, direction.as_vec3(), (c * interval.length_s()) as f32);
            let hit_m = near.closest(&ray, 10.0).map_or(f32::INFINITY, |hit| hit.t);
            for (sum, distance) in through.iter_mut().zip(distances) {
                if hit_m > distance {
                    *sum += exp(-field.extinction_per_m() * optical_depth(&field, &change_over, f64::from(distance)));
                }
            }
        }
    }
    for (sum, distance) in through.into_iter().zip(distances) {
        let depth = -ln(sum / f64::from(RAYS * rounds));
        let ratio = depth / (field.extinction_per_m() * f64::from(distance));
        assert!((ratio - 1.0).abs() < 0.02, "{distance} m: {ratio}");
    }
}

fn optical_depth(field: &PrecipitationField, change_over: &ChangeOver, distance_m: f64) -> f64 {
    field.hollow(change_over).path_length(DVec3::ZERO, DVec3::X, 0.0, distance_m)
}

/// If a camera stands under a roof, nothing is attenuated within it.
#[test]
fn nothing_falls_within_the_clear_distance() {
    let field = dense();
    let region = VisibleRegion::EVERYWHERE;
    let resolution =
        CameraResolution { pixel_rad: 8e-3, min_size_px: 0.25, max_particles: 2000.0, clear_m: 0.5, exposure_s: 0.0 };
    let change_over = ChangeOver::new(field.classes(), &resolution, &region);
    assert_eq!(optical_depth(&field, &change_over, 0.5), 0.0);
    let origin_m = DVec3::ZERO;
    let streaks = field.particles_near(origin_m, moment(0.0), &region, &change_over);
    let far = |particle| field.streak(particle, origin_m, moment(0.0), &change_over).from_m;
    assert!(!streaks.is_empty() && streaks.iter().all(|particle| far(particle) == 0.5));
}
