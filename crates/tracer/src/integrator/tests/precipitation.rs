//! Light through rain and snow.

use super::*;
use crate::accel::Simd;
use crate::media::Media;
use crate::precipitation::{
    CameraResolution, ChangeOver, Crystals, NearParticles, PrecipitationField, SizeLaw, ViewPlacement, VisibleRegion,
};

/// Mean radiance over rays that start near the origin within a cone along x, from 32 replicates, with precipitation or without.
fn measure(ready: &BuiltScene, law: SizeLaw, settings: PathSettings) -> (ReplicateEstimate, f64) {
    let field = PrecipitationField::new(law, DVec3::new(0.0, 4.0, 0.0), 5.0, 9);
    let interval = TimeInterval::new(0.0, 0.02).expect("legal");
    let region = VisibleRegion::around(&[DVec3::X], 0.1, 0.0);
    let resolution =
        CameraResolution { pixel_rad: 1e-3, min_size_px: 0.25, max_particles: 20_000.0, clear_m: 0.0, exposure_s: 0.0 };
    let change_over = ChangeOver::new(field.classes(), &resolution, &region);
    let medium = [field.medium().expect("legal")];
    let media = Media::new(&medium, DVec3::ZERO, interval);
    let near = NearParticles::new(
        &field,
        media.clone(),
        0,
        ViewPlacement { origin_m: DVec3::ZERO, interval, simd: Simd::Auto },
        &region,
        &change_over,
    );
    let view = ready.world.render_space(DVec3::ZERO);
    let lights = ready.lights(&view);
    let tracer =
        PathTracer::new(&view, &ready.material_table, &lights, settings).with_media(&media).with_near(Some(&near));
    let ray = |k: u32| {
        let [a, b] = [k % 16, k / 16].map(|i| (i as f32 + 0.5) / 16.0 - 0.5);
        Ray::new(Vec3::ZERO, Vec3::new(1.0, 0.12 * a, 0.12 * b).normalize(), 0.02 * (k as f32 / 256.0))
    };
    let hit_fraction = (0..256).filter(|k| near.closest(&ray(*k), 1e9).is_some()).count() as f64 / 256.0;
    let mean = |r: u32| (0..256).map(|k| replicate(&tracer, &ray(k), 4, 256 * r + k)).sum::<f64>() / 256.0;
    (ReplicateEstimate::from_replicates(&(0..32).map(mean).collect::<Vec<_>>()).expect("replicates"), hit_fraction)
}

fn scene_under(environment: Environment) -> BuiltScene {
    Scene { sources: Sources { environment: Some(environment), ..Sources::default() }, ..Scene::default() }.ready()
}

/// A sky and a floor that reflects all light, so that none is lost in rain below.
fn furnace() -> BuiltScene {
    let environment = Some(Environment::Uniform(Spectrum::constant(1.0)));
    let mut scene = Scene { sources: Sources { environment, ..Sources::default() }, ..Scene::default() };
    let white = scene.material(diffuse_surface(1.0), None);
    scene.square(Vec3::new(0.0, 0.0, -2.0), 20_000.0, white);
    scene.ready()
}

/// In uniform light of 1 precipitation is invisible, near or far. Spheroids scatter slightly differently from the balls of the phase
/// function, so that light that is both sampled and hit is not quite complete: 1e-3 is allowed, of the tenth of the rays that hit drops.
#[test]
fn rain_and_snow_in_a_furnace_are_not_seen() {
    let settings = PathSettings { max_bounces: 400, roulette_start: 400, ..PathSettings::default() };
    for law in [SizeLaw::rain(150.0), SizeLaw::snow(3.0, Crystals::Dendrites)] {
        let law = law.expect("legal");
        let (actual, hit_fraction) = measure(&furnace(), law, settings);
        assert!(hit_fraction > 0.01, "{hit_fraction}");
        assert!((actual.mean - 1.0).abs() < 3.0 * actual.standard_error() + 1e-3, "{law:?}: {actual:?}");
    }
}

/// In front of darkness drops show their surroundings, and are dark if everything is.
#[test]
fn rain_is_bright_before_a_dark_wall_and_dark_where_nothing_shines() {
    let settings = PathSettings { max_bounces: 4, ..PathSettings::default() };
    let mut scene = Scene {
        sources: Sources { environment: Some(Environment::Uniform(Spectrum::constant(1.0))), ..Sources::default() },
        ..Scene::default()
    };
    let black = scene.material(Surface::Absorber, None);
    let wall = vec![
        Vec3::new(30.0, -6.0, -6.0),
        Vec3::new(30.0, 6.0, -6.0),
        Vec3::new(30.0, 6.0, 6.0),
        Vec3::new(30.0, -6.0, 6.0),
    ];
    scene.mesh(wall, vec![[0, 1, 2], [0, 2, 3]], black);
    let law = SizeLaw::rain(150.0).expect("legal");
    let (actual, _) = measure(&scene.ready(), law, settings);
    // 30 m of β as of an image: lost light is replaced by light of the surroundings, a part of which the wall hides around the viewing
    // direction.
    let lost = 30.0 * PrecipitationField::new(law, DVec3::ZERO, 500.0, 0).extinction_per_m();
    assert!(actual.mean > 0.2 * lost && actual.mean < 1.1 * lost, "{actual:?} {lost}");
    let (dark, _) = measure(&scene_under(Environment::Uniform(Spectrum::constant(0.0))), law, settings);
    assert_eq!(dark.mean, 0.0);
}
