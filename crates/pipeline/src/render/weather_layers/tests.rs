//! Layers of weather compared with closed forms, and with weather over stored radiance.

use super::*;
use crate::camera::stored::StoredRadianceImage;
use crate::plan::{Airlight, PrecipitationExposure, Route, Weather};
use crate::{Choices, compile};
use etendue_core::TimeInterval;
use etendue_core::maths::f64::exp;
use etendue_core::quantity::Length;
use etendue_scene::asset::Assets;
use etendue_scene::{Description, Overrides};
use etendue_spectra::Spectrum;
use glam::DVec2;
use std::path::Path;

/// Columns, rows, and focal length over pitch.
const SIZE: [usize; 2] = [32, 24];
const FOCAL_PX: f64 = 60.0;

/// A wall across the view of a camera at the origin that looks along +x, 10 m before it, in weather.
fn plan(weather: &str, render: &str) -> Plan {
    let text = format!(
        "format = 1\n[[cameras]]\nname = \"eye\"\nposition_m = [0, 0, 0]\nrotation_deg = [0, 0, 0]\n\
         lens = {{ type = \"pinhole\", focal_length_mm = 6, f_number = 2 }}\n\
         [cameras.sensor]\nwidth_px = 32\nheight_px = 24\npixel_pitch_um = 100\nexposure_s = 0.001\ncfa = \"mono\"\n\
         quantum_efficiency = 0.6\nfull_well_e = 20000\nread_noise_e = 2\ndark_current_e_s = 5\ngain_dn_per_e = 0.2\nblack_level_dn = 64\n\
         bits = 12\n[render]\nmax_bounces = 4\nseed = 1\n{render}\n\
         [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[scene.objects]]\nname = \"wall\"\nmaterial = \"grey\"\nshape = {{ type = \"quad\", size_m = [400, 400] }}\n\
         position_m = [10, 0, 0]\nrotation_deg = [0, 90, 0]\n{weather}"
    );
    let read = |_: &Path| Ok(text.clone());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).unwrap_or_else(|f| panic!("{f}"));
    compile(&job, &Assets::default(), &Choices::default()).unwrap_or_else(|f| panic!("{f:?}"))
}

fn layers(plan: &Plan) -> WeatherLayers {
    weather_layers(plan, &plan.cameras[0], FrameCapture::default(), Simd::Auto)
}

/// 1 over the cosine of a pixel's direction to the axis.
fn slant(i: usize) -> f64 {
    let (x, y) = ((i % SIZE[0]) as f64 + 0.5 - 16.0, (i / SIZE[0]) as f64 + 0.5 - 12.0);
    (1.0 + (x * x + y * y) / (FOCAL_PX * FOCAL_PX)).sqrt()
}

/// The mean of a pixel's 16 samples differs from the value at its centre: tolerance 1e-3.
fn agree(plane: &Plane<Transmittance>, expected: impl Fn(usize) -> f64) {
    for (i, fraction) in plane.samples().iter().enumerate() {
        assert!((f64::from(*fraction) - expected(i)).abs() < 1e-3, "{i}: {fraction} {}", expected(i));
    }
}

const EVEN: &str = "[[scene.media]]\nname = \"fog\"\nextinction_per_m = 0.05\nphase = { type = \"isotropic\" }\n";

#[test]
fn transmittance_to_a_wall_is_that_of_beer_and_lambert() {
    let everywhere = layers(&plan(EVEN, "spp = 16"));
    agree(&everywhere.transmittance, |i| exp(-0.05 * 10.0 * slant(i)));
    assert!(everywhere.cover.is_none());
    // In a world without light the air scatters none.
    assert!(everywhere.airlight.planes().iter().all(|plane| plane.samples().iter().all(|light| *light == 0.0)));
    // From 4 m on 3 m of it; and a layer with the camera at its centre.
    let within = "shape = { type = \"box\", size_m = [3, 90, 90] }\nposition_m = [5.5, 0, 0]\n";
    agree(&layers(&plan(&format!("{EVEN}{within}"), "spp = 16")).transmittance, |i| exp(-0.05 * 3.0 * slant(i)));
    let within = "shape = { type = \"box\", size_m = [14, 90, 90] }\n";
    agree(&layers(&plan(&format!("{EVEN}{within}"), "spp = 16")).transmittance, |i| exp(-0.05 * 7.0 * slant(i)));
}

/// Mean over the image compared with exp(−∫β dt) by quadrature along the centres of its pixels. The scatter of ratio tracking is at most 0.5 per sample: 1e-3
/// over 768 pixels of 64; and noise of 3 m is nearly uniform over a pixel.
#[test]
fn transmittance_of_uneven_fog_is_right_in_the_mean() {
    let uneven = format!("{EVEN}unevenness = {{ amplitude = 0.9, scale_m = 3, octaves = 2 }}\n");
    let plan = plan(&uneven, "spp = 64");
    let media = Media::new(&plan.media, glam::DVec3::ZERO, TimeInterval::default());
    let pose = plan.cameras[0].path.at(0.0);
    let expected = |i: usize| {
        let towards = glam::DVec3::new((i % SIZE[0]) as f64 - 15.5, (i / SIZE[0]) as f64 - 11.5, FOCAL_PX);
        let mut ray = etendue_core::Ray::new(glam::Vec3::ZERO, (pose.rotation * towards.normalize()).as_vec3(), 0.0);
        ray.t_max = (10.0 * slant(i)) as f32;
        exp(-0.05 * media.columns_m(&ray)[0])
    };
    let count = SIZE[0] * SIZE[1];
    let mean = (0..count).map(expected).sum::<f64>() / count as f64;
    let actual =
        layers(&plan).transmittance.samples().iter().map(|fraction| f64::from(*fraction)).sum::<f64>() / count as f64;
    assert!((actual - mean).abs() < 4e-3, "{actual} {mean}");
    assert!((mean - exp(-0.5)).abs() > 1e-3, "uneven: {mean}");
}

/// Streaks over stored radiance and traced drops are the same ones in the same pixels: the nearest, of some tenths of a pixel's exposure, exceed the noise of
/// 1 024 samples (0.015).
#[test]
fn both_forms_of_rain_cover_the_same_pixels() {
    const RAIN: &str = "[scene.precipitation]\ntype = \"rain\"\nrate_mm_h = 100\nsmallest_px = 0.05\nclear_m = 0.1\nwind_m_s = [1, 2, 0]\n";
    let plan = plan(RAIN, "spp = 1024\nroute = \"pupil\"");
    let camera = &plan.cameras[0];
    let Route::Pupil(projection) = &camera.settings.route else { panic!("at the pupil") };
    let (width, height) = (projection.width(), projection.height());
    let traced = layers(&plan).cover.expect("rain falls");
    let distance = |i: usize| {
        let at = DVec2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        projection.direction(at).map_or(f32::NAN, |direction| (10.0 / direction.z) as f32)
    };
    let distance = Plane::<Length>::from_samples(width, height, (0..width * height).map(distance).collect());
    let radiance = SpectralCube::new(width, height, Bands::new(500.0, 100.0, 1).expect("a band"));
    let stored = StoredRadianceImage { projection, radiance: &radiance, distance: distance.as_ref() };
    let precipitation = plan.precipitation.clone().expect("rain");
    let weather = Weather {
        airlight: Airlight::Uniform(Spectrum::constant(1.0)),
        media: plan.media.clone(),
        falling: Some(PrecipitationExposure { precipitation, exposure_s: 0.001 }),
    };
    let start = TimeInterval::at(camera.timing.frame_start_s(0)).expect("finite");
    let rendered_drops =
        weather.apply(&stored, &camera.path.at(0.0), start).expect("distances").cover.expect("rain falls");
    let of = |plane: &Plane<Cover>, [x, y]: [usize; 2]| f64::from(plane.at(x, y));
    let mean =
        |plane: &Plane<Cover>| plane.samples().iter().map(|c| f64::from(*c)).sum::<f64>() / (width * height) as f64;
    let means = [mean(&traced), mean(&rendered_drops)];
    assert!((means[0] / means[1] - 1.0).abs() < 0.05 && means[0] > 1e-3, "{means:?}");
    let like = |dx: usize, dy: usize| {
        let (mut both, mut a2, mut b2) = (0.0, 0.0, 0.0);
        for at in (2..height - 2).flat_map(|y| (2..width - 2).map(move |x| [x, y])) {
            let a = of(&traced, [at[0] + dx - 2, at[1] + dy - 2]) - means[0];
            let b = of(&rendered_drops, at) - means[1];
            (both, a2, b2) = (both + a * b, a2 + a * a, b2 + b * b);
        }
        both / (a2 * b2).sqrt()
    };
    let here = like(2, 2);
    assert!(here > 0.9, "{here}");
    for (dx, dy) in [(1, 2), (3, 2), (2, 0), (2, 4), (0, 2), (4, 2)] {
        assert!(like(dx, dy) < here - 0.05, "{dx} {dy}: {} {here}", like(dx, dy));
    }
}
