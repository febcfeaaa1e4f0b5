//! Through the lens and at the pupil: two routes to the sensor plane, one truth.
//!
//! They must agree where the pupil's picture holds all there is to know: everything in focus (a pinhole) or nothing but a
//! uniform radiance.

use etendue_stats::chi_square::sidak_level;
use etendue_stats::{ReplicateEstimate, student};
use etendue_testkit::judge::SIGNIFICANCE;
use etendue_tests::Job;

const WIDTH: usize = 16;
const HEIGHT: usize = 12;

/// A camera that distorts, in the scene of `scene`.
fn job(scene: &str, lens: &str, route: &str) -> Job {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 0]
        look_at_m = [1, 0, 0]
        lens = {{ focal_length_mm = 6, {lens}, transmittance = 0.8, distortion = {{ k1 = -0.1, k2 = 0.02, direction = "ideal_to_observed", radius_unit = "focal_lengths" }} }}
        [cameras.sensor]
        width_px = {WIDTH}
        height_px = {HEIGHT}
        pixel_pitch_um = 250
        exposure_s = 0.0001
        cfa = "mono"
        quantum_efficiency = 0.5
        full_well_e = 1e9
        read_noise_e = 0
        dark_current_e_s = 0
        gain_dn_per_e = 0.5
        black_level_dn = 0
        bits = 16
        [render]
        spp = 256
        replicates = 16
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        accumulate = "cube"
        route = "{route}"
        [output]
        electrons = true
        {scene}
        "#
    ))
}

const LENSES: [&str; 3] = [
    "type = \"pinhole\", f_number = 4",
    "type = \"thin\", f_number = 1.4, focus_distance_m = 2",
    "type = \"thick\", f_number = 2, focus_distance_m = \"infinity\", constant_pupil = \"exit\", pupil_magnification = 1.3",
];

#[test]
fn a_uniform_radiance_gives_the_same_electrons() {
    let scene = "[scene]\nenvironment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }";
    let critical = student::critical(sidak_level(SIGNIFICANCE, WIDTH * HEIGHT), 15.0);
    for lens in LENSES {
        let direct = job(scene, lens, "lens").shot();
        let pupil = job(scene, lens, "pupil").shot().electrons();
        let irradiance = direct.irradiance();
        for (i, (a, b)) in direct.electrons().into_iter().zip(pupil).enumerate() {
            // Through the lens the weight is sampled over pixel and pupil: its scatter, from 16 replicates. At the pupil it
            // is taken at the pixel's centre: over a pixel of 250 µm at 6 mm the mean of cos⁴ differs from it by (p/c)²/24
            // times the curvature, below 12: 9e-4.
            let scatter = critical * f64::from(irradiance.variance[i].sqrt() / irradiance.mean[i]);
            assert!(f64::from(a / b - 1.0).abs() < scatter + 9e-4, "{lens}, pixel {i}: {a} {b}, scatter {scatter}");
        }
    }
}

/// A wall in the plane of focus, its light growing evenly from left to right and from the bottom to the top: a picture
/// environment would do as well, but a texture lies where the lens is sharp.
const WALL: &str = r#"
    [scene]
    textures = [{ name = "ramp", file = "ramp.hdr", encoding = "linear", wrap = "clamp" }]
    materials = [{ name = "wall", type = "emitter", emission = { luminance_cd_m2 = 1000, illuminant = "E", texture = "ramp" } }]
    [[scene.objects]]
    name = "wall"
    shape = { type = "quad", size_m = [4, 4] }
    material = "wall"
    position_m = [2, 0, 0]
    rotation_deg = [0, -90, 0]
"#;

fn ramp(job: Job) -> Job {
    let grey = |i: usize| 0.2 + 0.8 * ((i % 32) + (i / 32)) as f32 / 62.0;
    job.with_image("ramp.hdr", 32, 32, (0..1024).map(|i| [grey(i); 3]).collect())
}

#[test]
fn a_picture_in_focus_gives_the_same_electrons() {
    const PICTURES: u64 = 12;
    let critical = student::critical(sidak_level(SIGNIFICANCE, WIDTH * HEIGHT), (PICTURES - 1) as f64);
    for lens in &LENSES[..2] {
        let image = |route: &str, seed: u64| ramp(job(WALL, lens, route)).with_seed(seed).shot().electrons();
        let pictures: Vec<_> =
            (1..=PICTURES).map(|seed| (image("lens", seed), image("pupil", seed + PICTURES))).collect();
        for pixel in 0..WIDTH * HEIGHT {
            let ratios: Vec<f64> = pictures.iter().map(|(a, b)| f64::from(a[pixel] / b[pixel]) - 1.0).collect();
            let ratio = ReplicateEstimate::from_replicates(&ratios).expect("twelve pictures");
            // Resampling widens the pixel's box by the stored one's: of a linear ramp it changes nothing, of the lens's
            // cos⁴ and of the ramp's change of slope under the distortion it changes the curvature's share of a pixel,
            // (p/c)²/24 · 12 = 9e-4 for the étendue as above, and for the ramp no more.
            let allowed = 1.8e-3 + critical * ratio.standard_error();
            assert!(ratio.mean.abs() < allowed, "{lens}, pixel {pixel}: {ratio:?}");
            assert!(ratio.standard_error() < 2e-3, "{lens}, pixel {pixel}: {ratio:?}");
        }
        let sum = |samples: &[f32]| samples.iter().map(|v| f64::from(*v)).sum::<f64>();
        // Over the whole picture the étendue at the centres of pixels differs from its mean by 9e-4 at most.
        let (direct, pupil) = pictures.iter().fold((0.0, 0.0), |(a, b), p| (a + sum(&p.0), b + sum(&p.1)));
        let pupil_ratio = direct / pupil;
        assert!((pupil_ratio - 1.0).abs() < 9e-4, "{lens}: {pupil_ratio}");
    }
}

#[test]
fn an_edge_is_blurred_by_resampling_and_keeps_its_light() {
    // A bright half of a picture environment: the edge falls into some column. The light of a row that spans it is kept.
    let scene = "[scene]\nenvironment = { type = \"image\", file = \"sky.hdr\", luminance_cd_m2_per_unit = 1000 }";
    // Columns run from one side of the sphere to the other; the middle columns are bright in one half.
    let sky: Vec<[f32; 3]> = (0..64 * 32).map(|i| [if i % 64 < 32 { 1.0 } else { 0.1 }; 3]).collect();
    let rows = |route: &str| {
        let shot = job(scene, LENSES[0], route).with_image("sky.hdr", 64, 32, sky.clone()).shot();
        let e = shot.electrons();
        (0..HEIGHT)
            .map(|y| e[y * WIDTH..(y + 1) * WIDTH].iter().map(|v| f64::from(*v)).sum::<f64>())
            .collect::<Vec<_>>()
    };
    for (y, (a, b)) in rows("lens").into_iter().zip(rows("pupil")).enumerate() {
        // Light that blurs over the edge is seen through the étendue of the neighbouring column: on the axis cos⁴ changes
        // by less than 2 (250 µm/6 mm)² = 3.5e-3 from one to the next, of a share of one column in sixteen; and scatter of
        // the edge's column (256 samples: at most 2e-3 of it). The rest as above, 9e-4.
        assert!((a / b - 1.0).abs() < 2e-3, "row {y}: {a} {b}");
    }
}
