//! The set of particles and their places.

use super::*;
use etendue_core::maths::f64::exp;
use etendue_stats::chi_square::goodness_of_fit;

fn field(seed: u32) -> PrecipitationField {
    PrecipitationField::new(SizeLaw::rain(50.0).expect("legal"), DVec3::new(3.0, -1.0, 0.0), 500.0, seed)
}

fn within(field: &PrecipitationField, origin_m: DVec3, time_s: f64, radius_m: f64) -> Vec<Particle> {
    let all = field.particles_near(origin_m, moment(time_s), &VisibleRegion::EVERYWHERE, &ball(radius_m));
    all.into_iter().filter(|particle| particle.at(time_s).distance(origin_m) < radius_m).collect()
}

/// χ² of sizes in bins of 0.2 mm at the level 10⁻⁴, and the number of drops within 4 standard deviations of a Poisson number.
#[test]
fn drops_have_the_sizes_of_the_law() {
    let field = field(3);
    let (radius_m, law) = (1.6, *field.law());
    let particles = within(&field, DVec3::new(20.0, -7.0, 1.5), 12.0, radius_m);
    let volume = 4.0 / 3.0 * core::f64::consts::PI * radius_m * radius_m * radius_m;
    let tail = |d: f64| exp(-law.lambda_per_mm() * d);
    let expected_total = volume * law.number_per_m3() * (1.0 - tail(6.0));
    assert!((particles.len() as f64 - expected_total).abs() < 4.0 * expected_total.sqrt());
    let mut counts = [0_u64; 30];
    particles.iter().for_each(|particle| counts[(particle.size_mm / 0.2) as usize] += 1);
    let fraction = |i: usize| (tail(0.2 * i as f64) - tail(0.2 * (i + 1) as f64)) / (1.0 - tail(6.0));
    let expected: Vec<f64> = (0..30).map(|i| particles.len() as f64 * fraction(i)).collect();
    let test = goodness_of_fit(&counts, &expected).expect("bins");
    assert!(test.p > 1e-4 && test.degrees_of_freedom > 10, "{test:?}");
}

/// Every view of a part of space at some time finds the drops that have fallen there, with their velocities, and no others.
#[test]
fn two_views_at_two_times_see_the_same_drops() {
    let field = field(7);
    let (here, there) = (DVec3::new(100.0, 5.0, 2.0), DVec3::new(100.4, 5.2, 1.7));
    for (early, late) in [(0.0, 0.0), (1.0, 1.05), (3600.0, 3600.02)] {
        let (a, b) = (within(&field, here, early, 1.0), within(&field, there, late, 1.0));
        let seen_by_both =
            |particle: &&Particle| particle.at(early).distance(here) < 1.0 && particle.at(late).distance(there) < 1.0;
        let key = |particle: &Particle| (particle.class, particle.start_m.to_array().map(f64::to_bits));
        let keys = |all: &[Particle]| {
            let mut keys: Vec<_> = all.iter().filter(seen_by_both).map(key).collect();
            keys.sort_unstable();
            keys
        };
        assert!(keys(&a).len() > 500, "{early}");
        assert_eq!(keys(&a), keys(&b), "{early}");
    }
}

/// An exposure's drops are those of all its times.
#[test]
fn an_interval_holds_what_its_moments_hold() {
    let field = field(1);
    let interval = TimeInterval::new(2.0, 2.1).expect("legal");
    let region = VisibleRegion::around(&[DVec3::X, DVec3::new(0.9, 0.3, 0.0).normalize()], 0.05, 0.01);
    let long = field.particles_near(DVec3::ZERO, interval, &region, &ball(2.0));
    for time_s in [2.0, 2.03, 2.1] {
        let short = field.particles_near(DVec3::ZERO, moment(time_s), &region, &ball(2.0));
        let actual = |particle: &&Particle| region.may_see(particle.at(time_s), 0.0);
        assert!(short.iter().filter(actual).count() > 20);
        assert!(short.iter().filter(actual).all(|particle| long.contains(particle)), "{time_s}");
    }
}

#[test]
fn another_seed_is_another_rain_and_nothing_is_above_the_top() {
    let particles = |seed| within(&field(seed), DVec3::ZERO, 0.0, 0.5);
    assert_ne!(particles(0), particles(1));
    let below = PrecipitationField::new(SizeLaw::rain(50.0).expect("legal"), DVec3::ZERO, 0.0, 0);
    let actual = within(&below, DVec3::ZERO, 5.0, 1.0);
    assert!(actual.len() > 1000 && actual.iter().all(|particle| particle.at(5.0).z <= 0.0));
}

/// The modelled particles depend on the resolution of a pixel, and are bounded.
#[test]
fn finer_pixels_resolve_more_drops_up_to_a_bound() {
    let field = field(0);
    let region = VisibleRegion::around(&[DVec3::X], 0.4, 0.0);
    let of = |pixel_rad, maximum| {
        let resolution =
            CameraResolution { pixel_rad, min_size_px: 0.5, max_particles: maximum, clear_m: 0.0, exposure_s: 0.0 };
        ChangeOver::new(field.classes(), &resolution, &region)
    };
    let (coarse, fine, bounded) = (of(2e-3, 1e9), of(5e-4, 1e9), of(5e-4, 20_000.0));
    let class = &field.classes()[30];
    assert!((coarse.radii_m[30] / (class.diameter_m / 1e-3) - 1.0).abs() < 1e-12);
    assert!(fine.expected > 60.0 * coarse.expected && fine.max_distance_m() > 3.9 * coarse.max_distance_m());
    assert!((bounded.expected / 20_000.0 - 1.0).abs() < 0.01, "{}", bounded.expected);
    let actual = field.particles_near(DVec3::ZERO, moment(0.0), &region, &bounded).len() as f64;
    assert!(actual > 19_000.0 && actual < 30_000.0, "{actual}");
}
