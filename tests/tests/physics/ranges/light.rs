//! Light at the ends of its range: surfaces that swallow nothing, hide nothing or are not there, lamps without number, lines.

use super::fog::lamps_in_fog;
use etendue_core::{Bands, Spectral, Wavelengths};
use etendue_pipeline::render::gather::{ReplicateMoments, ReplicateSums};
use etendue_pipeline::sizes::film::FilmLayout;
use etendue_spectra::illuminant;
use etendue_stats::Moments;
use etendue_testkit::page::{Row, check, figure, worst};
use etendue_tests::Job;

/// A camera over a matt floor with a ball of a material, under an even sky.
fn ball(material: &str, more: &str) -> Job {
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [-3, 0, 1]
        look_at_m = [0, 0, 0.5]
        lens = {{ type = "pinhole", focal_length_mm = 20, f_number = 8 }}
        sensor = {{ width_px = 16, height_px = 12, pixel_pitch_um = 1000 }}
        [render]
        spp = 64
        replicates = 16
        max_bounces = 8
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        [output]
        irradiance = true
        [scene]
        materials = [
            {{ name = "matt", type = "diffuse", reflectance = 0.5 }},
            {{ name = "ball", {material} }},
        ]
        environment = {{ type = "uniform", radiance_w_m2_sr_nm = 1 }}
        [[scene.objects]]
        name = "floor"
        material = "matt"
        shape = {{ type = "quad", size_m = [20, 20] }}
        [[scene.objects]]
        name = "ball"
        material = "ball"
        position_m = [0, 0, 0.5]
        shape = {{ type = "sphere", radius_m = 0.5 }}
        {more}
        "#
    ))
}

fn irradiances(job: &Job) -> Vec<f64> {
    job.shot().irradiance().mean.into_iter().map(f64::from).collect()
}

/// The greatest relative difference of two pictures, pixel by pixel.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    worst(a.iter().zip(b).map(|(a, b)| (a / b - 1.0).abs()))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Pixels that are not above 0 and finite.
fn bad(values: &[f64]) -> f64 {
    values.iter().filter(|v| !(v.is_finite() && **v > 0.0)).count() as f64
}

const ALL_LIT: &str = "light in every pixel (pixels dark or not finite)";

fn surfaces() -> Vec<Row> {
    let glass = |index: f64| irradiances(&ball(&format!("type = \"dielectric\", index = {index}"), ""));
    let metal = |alpha: f64| irradiances(&ball(&format!("type = \"conductor\", metal = \"Al\", alpha = {alpha}"), ""));
    let without_ball =
        ball("type = \"diffuse\", reflectance = 0", "").replaced("position_m = [0, 0, 0.5]", "position_m = [0, 0, -5]");
    let without_ball = irradiances(&without_ball);
    let (one, smooth) = (glass(1.0), metal(0.0));
    let mut rows = vec![
        Row::at_most(
            "a sphere of index 1",
            "invisible: the image without it (relative difference of the mean)",
            (mean(&one) / mean(&without_ball) - 1.0).abs(),
            1e-2,
        ),
        Row::at_most(
            "a mirror of roughness 0 and one of 10⁻⁶",
            "equal images: a lobe below 0.01° is a mirror",
            difference(&metal(1e-6), &smooth),
            1e-6,
        ),
    ];
    for index in [1.0001, 4.0] {
        rows.push(Row::at_most(&format!("a sphere of index {index}"), ALL_LIT, bad(&glass(index)), 0.0));
    }
    for alpha in [1e-4, 1e-3, 1.0] {
        rows.push(Row::at_most(
            &format!("a metal sphere of roughness {}", figure(alpha)),
            ALL_LIT,
            bad(&metal(alpha)),
            0.0,
        ));
    }
    rows
}

/// A closed room that swallows nothing, whose walls glow a little: L = Lₑ (1 + 1 + … ) over max_bounces + 1 terms.
fn nothing_is_swallowed() -> Row {
    const BOUNCES: u32 = 200;
    let job = ball("type = \"diffuse\", reflectance = 1, emission = { radiance_w_m2_sr_nm = 1, sides = \"both\" }", "");
    let job = job
        .replaced("position_m = [-3, 0, 1]", "position_m = [0, 0, 0.5]")
        .replaced("look_at_m = [0, 0, 0.5]", "look_at_m = [1, 0, 0.5]");
    let job = job
        .replaced("max_bounces = 8", &format!("max_bounces = {BOUNCES}"))
        .replaced("radius_m = 0.5", "radius_m = 0.4");
    let radiance = job.shot().radiance();
    let actual = mean(&radiance.mean.iter().map(|v| f64::from(*v)).collect::<Vec<_>>());
    let expected = f64::from(BOUNCES) + 1.0;
    Row::at_most(
        "a closed sphere of albedo 1 that emits inside, 200 bounces",
        "201 times its radiance (relative error)",
        (actual / expected - 1.0).abs(),
        1e-2,
    )
}

/// Two mirrors that face each other, the camera between them.
fn mirrors() -> Vec<Row> {
    let mirror = |name: &str, x: f64, turn: f64| {
        format!(
            "[[scene.objects]]\nname = \"{name}\"\nmaterial = \"ball\"\nposition_m = [{x}, 0, 2]\nrotation_deg = [0, {turn}, 0]\nshape = {{ type = \"quad\", size_m = [8, 8] }}\n"
        )
    };
    let ball_between = || {
        ball(
            "type = \"conductor\", metal = \"Ag\", alpha = 0",
            &(mirror("near", -4.0, 90.0) + &mirror("far", 4.0, -90.0)),
        )
    };
    let bounces =
        |bounces: &str| irradiances(&ball_between().replaced("max_bounces = 8", &format!("max_bounces = {bounces}")));
    let (few, many) = (bounces("8"), bounces("1000"));
    let extreme = "two facing mirrors, 1 000 bounces";
    let deeper = "more light than with 8 bounces (ratio of means)";
    vec![Row::at_most(extreme, ALL_LIT, bad(&many), 0.0), Row::at_most(extreme, deeper, mean(&few) / mean(&many), 0.99)]
}

/// As many lamps at one place as make one.
fn lamps() -> Vec<Row> {
    const MANY: usize = 100_000;
    let lamp = |i: usize, power: f64| {
        format!(
            "[[scene.lights]]\nname = \"lamp{i}\"\ntype = \"point\"\nposition_m = [0, 2, 3]\nilluminant = \"E\"\nintensity_cd = {power:?}\n"
        )
    };
    let dark = |lights: String| {
        ball("type = \"diffuse\", reflectance = 0.5", &lights)
            .replaced("environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }", "")
    };
    let one = mean(&irradiances(&dark(lamp(0, 1e5))));
    let many = mean(&irradiances(&dark((0..MANY).map(|i| lamp(i, 1e5 / MANY as f64)).collect())));
    vec![Row::at_most(
        "10⁵ lights at one place, each of 10⁻⁵ of the power",
        "the light of one (relative difference of the mean)",
        (many / one - 1.0).abs(),
        5e-3,
    )]
}

/// Light of one wavelength, and bands at the ends of the domain.
fn wavelengths() -> Vec<Row> {
    let band_image = |range: &str, radiance: &str| {
        let sky = format!("environment = {{ type = \"uniform\", {radiance} }}");
        let job = ball("type = \"diffuse\", reflectance = 0.5", "")
            .replaced("wavelength_range_nm = [500, 600]\n        band_width_nm = 100", range);
        job.replaced("environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }", &sky)
    };
    let line = band_image(
        "wavelength_range_nm = [580, 600]\n        band_width_nm = 20",
        "radiance_w_m2_sr_nm = { spectrum = \"line.csv\" }",
    )
    .with_spectrum("line.csv", &[(588.0, 0.0), (589.0, 1.0), (590.0, 0.0)]);
    let flat = band_image("wavelength_range_nm = [580, 600]\n        band_width_nm = 20", "radiance_w_m2_sr_nm = 1");
    let ends = |low: u32, high: u32| {
        band_image(
            &format!("wavelength_range_nm = [{low}, {high}]\n        band_width_nm = 5"),
            "radiance_w_m2_sr_nm = 1",
        )
    };
    // A triangle of base 2 nm in a band of 20 nm: a twentieth of the flat one.
    let ratio = 20.0 * mean(&irradiances(&line)) / mean(&irradiances(&flat));
    vec![
        Row::at_most(
            "light of a line 1 nm wide in a band of 20 nm",
            "a twentieth of that of a flat spectrum (relative error of the mean)",
            (ratio - 1.0).abs(),
            3e-2,
        ),
        Row::at_most(
            "bands from 300 nm and to 1 100 nm",
            ALL_LIT,
            bad(&irradiances(&ends(300, 310))) + bad(&irradiances(&ends(1090, 1100))),
            0.0,
        ),
    ]
}

/// A lamp in fog, the camera close to it: 1/r² along the rays that pass it.
fn lamp_in_fog() -> Row {
    let fog = "[[scene.media]]\nname = \"fog\"\nvisibility = { distance_m = 20, contrast = 0.05 }\nphase = { type = \"henyey_greenstein\", g = 0.8 }\n[[scene.lights]]\nname = \"lamp\"\ntype = \"point\"\nposition_m = [-2.9, 0, 1]\nilluminant = \"E\"\nintensity_cd = 100\n";
    Row::at_most(
        "a point light in fog, 10 cm in front of the camera",
        ALL_LIT,
        bad(&irradiances(&ball("type = \"diffuse\", reflectance = 0.5", fog))),
        0.0,
    )
}

/// The same picture under brighter and darker skies.
fn levels() -> Vec<Row> {
    let under = |level: f64| {
        let sky = format!("environment = {{ type = \"uniform\", radiance_w_m2_sr_nm = {level:e} }}");
        irradiances(
            &ball("type = \"diffuse\", reflectance = 0.5", "")
                .replaced("environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }", &sky),
        )
    };
    let one = under(1.0);
    let scaled = |level: f64| one.iter().map(|v| v * level).collect::<Vec<_>>();
    let row = |level: f64| {
        Row::at_most(
            &format!("a sky of {} W·m⁻²·sr⁻¹·nm⁻¹", figure(level)),
            "the image under 1, scaled: only 32-bit rounding (relative difference)",
            difference(&under(level), &scaled(level)),
            1e-5,
        )
    };
    [1e-9, 1e12].map(row).into()
}

/// The sun, 0.53° across, within a picture of 1.8° by 1.4°.
fn sun_in_frame() -> Row {
    let sun = "[[scene.lights]]\nname = \"sun\"\ntype = \"sun\"\nelevation_deg = 30\nazimuth_deg = 0\nilluminant = \"E\"\nirradiance_w_m2 = 1000\n";
    let aimed = |more: &str, sky: &str| {
        let job = ball("type = \"diffuse\", reflectance = 0.5", more)
            .replaced("look_at_m = [0, 0, 0.5]", "look_at_m = [-2.1339746, 0, 1.5]")
            .replaced("focal_length_mm = 20", "focal_length_mm = 500")
            .replaced("environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }", sky);
        irradiances(&job.replaced("spp = 64", "spp = 1024"))
    };
    // Illuminant E is even where the observer sees: in 1 000 W/m² each nanometre has as much as a sky of 1 sends from so many steradians.
    let flat = illuminant::by_name("E").expect("an illuminant");
    let expected = 1000.0 * flat.band_mean(500.0, 600.0) / flat.integral(300.0, 1100.0);
    let (lit, uniform) = (aimed(sun, ""), aimed("", "environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }"));
    let pixel_sr = 1.0 / (500.0 * 500.0);
    let actual = lit.iter().sum::<f64>() * pixel_sr / mean(&uniform);
    Row::at_most(
        "the sun in the image, 4.7 px across",
        "the sum of pixels is its irradiance, compared with a uniform sky (relative error)",
        (actual / expected - 1.0).abs(),
        1e-2,
    )
}

/// Mirrors seen from nearly aside.
fn grazing() -> Vec<Row> {
    const COSINE: f64 = 1e-4;
    let floor = |material: &str| {
        let job = ball(material, "")
            .replaced("name = \"floor\"\n        material = \"matt\"", "name = \"floor\"\n        material = \"ball\"")
            .replaced("position_m = [0, 0, 0.5]", "position_m = [0, 9, 30]")
            .replaced("size_m = [20, 20]", "size_m = [2e5, 2e5]")
            .replaced("position_m = [-3, 0, 1]", "position_m = [0, 0, 1]")
            .replaced("look_at_m = [0, 0, 0.5]", "look_at_m = [1e4, 0, 0]")
            .replaced("focal_length_mm = 20", "focal_length_mm = 1e6");
        let sky = job.clone().replaced("size_m = [2e5, 2e5]", "size_m = [1e-3, 1e-3]");
        mean(&irradiances(&job)) / mean(&irradiances(&sky))
    };
    // 1 − F to first order, mean of both planes: 2 cos θ Re((1 + N²)/√(N² − 1)) = 2.06 cos θ for N = 1.0 + 6.6i; n is 0.77 to 1.20 over the band.
    vec![
        Row::at_most(
            "an aluminium mirror at a cosine of 10⁻⁴",
            "reflectance 1 − 2.06·10⁻⁴ (difference; its index over the band causes up to 4·10⁻⁵)",
            (1.0 - floor("type = \"conductor\", metal = \"Al\", alpha = 0") - 2.06 * COSINE).abs(),
            0.4 * COSINE,
        ),
        Row::at_most(
            "rough aluminium (0.3) at a cosine of 10⁻⁴",
            "between half of the sky's light and all of it (distance from 3/4)",
            (floor("type = \"conductor\", metal = \"Al\", alpha = 0.3") - 0.75).abs(),
            0.25,
        ),
    ]
}

/// A thousand million numbers into one sum.
fn long_sums() -> Vec<Row> {
    const COUNT: u32 = 1_000_000_000;
    // 0.1 has no exact form, so that every sum rounds.
    let moments = Moments::from_values((0..COUNT).map(|i| if i % 2 == 0 { 0.1 } else { 0.3 }));
    let variance = 0.01 * f64::from(COUNT) / f64::from(COUNT - 1);
    let error = (moments.mean() / 0.2 - 1.0).abs().max((moments.variance().unwrap_or(f64::NAN) / variance - 1.0).abs());
    let layout =
        FilmLayout { bands: Bands::covering(500.0, 600.0, 100.0), accumulates_electrons: false, watched: false };
    let wavelengths = Wavelengths { nm: [550.0], pdf: [0.01] };
    let mut sums = ReplicateSums::new(layout);
    (0..COUNT).for_each(|_| sums.add(0.1, Spectral([0.7]), &wavelengths, None));
    let mut gather = ReplicateMoments::new(&layout);
    gather.end_replicate(&mut sums, COUNT);
    let pixel = gather.light(&layout, COUNT, 0).bands()[0];
    // As the sum has it: of floats of 32 bits.
    let each = 0.1 * f64::from(0.7_f32) / (f64::from(0.01_f32) * 100.0);
    vec![
        Row::at_most("mean and variance of 10⁹ numbers", "no drift (relative error)", error, 1e-9),
        Row::at_most(
            "a pixel of 10⁹ equal samples",
            "equals one sample: below 6·10⁻⁸, the resolution of 32 bits (relative error)",
            (pixel / each - 1.0).abs(),
            6e-8,
        ),
    ]
}

#[test]
fn light() {
    let mut rows = surfaces();
    rows.push(nothing_is_swallowed());
    rows.extend(mirrors());
    rows.extend(lamps());
    rows.extend(wavelengths());
    rows.push(lamp_in_fog());
    rows.extend(lamps_in_fog());
    rows.extend(levels());
    rows.push(sun_in_frame());
    rows.extend(grazing());
    rows.extend(long_sums());
    let introduction = "A sphere over a floor under a uniform sky, 64 samples.";
    check("Light", introduction, &rows);
}
