//! Electrons folded pixel by pixel against electrons of a spectral cube.
//!
//! They differ by what bands cost: Σ over bands of (mean of E)·∫R instead of ∫E R. Here E is known in closed form, so the
//! difference is computed from the spectra and must be met.

use etendue_spectra::{Spectrum, illuminant, upsample};
use etendue_stats::ReplicateEstimate;
use etendue_testkit::form_factor::simpson;
use etendue_testkit::judge::is_near;
use etendue_tests::{Job, Shot};

const PAINT: [f32; 3] = [0.7, 0.15, 0.05];
const SIDE_PX: usize = 8;
const SEEDS: u64 = 8;

/// A wall of paint in the light of a lamp of lines, so that every pixel sees ρ(λ) L(λ); a camera with colour filters.
fn job(accumulate: &str, band_width_nm: u32, wavelengths: u32, seed: u64) -> Job {
    let [r, g, b] = PAINT;
    let bands = if accumulate == "cube" { format!("band_width_nm = {band_width_nm}") } else { String::new() };
    Job::new(format!(
        r#"
        [scene]
        materials = [{{ name = "paint", type = "diffuse", reflectance = [{r}, {g}, {b}] }}]
        objects = [{{ name = "wall", shape = {{ type = "quad", size_m = [50, 50] }}, material = "paint" }}]
        environment = {{ type = "uniform", luminance_cd_m2 = 100, illuminant = "FL2" }}
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 3]
        look_at_m = [0, 0, 0]
        up = [1, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 6, f_number = 4 }}
        [cameras.sensor]
        width_px = {SIDE_PX}
        height_px = {SIDE_PX}
        pixel_pitch_um = 5
        exposure_s = 0.01
        cfa = "rggb"
        quantum_efficiency = {{ camera = "nikon-d5100", peak = 0.5 }}
        full_well_e = 1e5
        read_noise_e = 0
        dark_current_e_s = 0
        gain_dn_per_e = 0.5
        black_level_dn = 0
        bits = 16
        [render]
        spp = 512
        replicates = 4
        max_bounces = 1
        wavelength_range_nm = [380, 780]
        wavelengths_per_path = {wavelengths}
        accumulate = "{accumulate}"
        {bands}
        [output]
        electrons = true
        "#
    ))
    .with_seed(seed)
}

/// Mean electrons of each channel.
fn channel_means(shot: &Shot) -> [f64; 3] {
    let sensor = shot.camera().body.sensor.as_ref().expect("a sensor");
    let mut sums = [(0.0, 0.0); 3];
    for (i, e) in shot.electrons().into_iter().enumerate() {
        let (sum, count) = &mut sums[sensor.channel_at(i % SIDE_PX, i / SIDE_PX)];
        *sum += f64::from(e);
        *count += 1.0;
    }
    sums.map(|(sum, count)| sum / count)
}

/// ∫ f over the sampled range; broken lines on the grid of 1 nm, so that Simpson's rule is exact for products of three.
fn integral(low_nm: f64, high_nm: f64, f: impl Fn(f64) -> f64) -> f64 {
    simpson(low_nm, high_nm, 2 * (high_nm - low_nm) as usize, f)
}

/// Relative to ∫ E R: what `width_nm`-wide bands make of a channel of responsivity R in the light E.
fn band_sum(light: &impl Fn(f64) -> f64, responsivity: &Spectrum, width_nm: u32) -> f64 {
    let r = |nm: f64| f64::from(responsivity.at(nm as f32));
    let band = |i: u32| {
        let (low, high) = (380.0 + f64::from(i * width_nm), 380.0 + f64::from((i + 1) * width_nm));
        integral(low, high, light) / f64::from(width_nm) * integral(low, high, r)
    };
    let banded: f64 = (0..400 / width_nm).map(band).sum();
    banded / integral(380.0, 780.0, |nm| light(nm) * r(nm))
}

fn light() -> impl Fn(f64) -> f64 {
    let paint = upsample::reflectance_spectrum(PAINT);
    let lamp = illuminant::by_name("FL2").expect("known").clone();
    move |nm| f64::from(paint.at(nm as f32)) * f64::from(lamp.at(nm as f32))
}

/// Relative differences of the cube's electrons to the folded ones, channel by channel, over independent pictures.
fn differences(band_width_nm: u32, wavelengths: u32) -> [ReplicateEstimate; 3] {
    let means: Vec<[f64; 3]> = (1..=SEEDS)
        .map(|seed| {
            // Other seeds: nothing is shared between the two.
            let cube = channel_means(&job("cube", band_width_nm, wavelengths, seed).shot());
            let electron_means = channel_means(&job("electrons", band_width_nm, wavelengths, seed + SEEDS).shot());
            std::array::from_fn(|c| cube[c] / electron_means[c] - 1.0)
        })
        .collect();
    std::array::from_fn(|c| {
        let values: Vec<f64> = means.iter().map(|p| p[c]).collect();
        ReplicateEstimate::from_replicates(&values).expect("several pictures")
    })
}

fn bias(band_width_nm: u32) -> [f64; 3] {
    let plan = job("electrons", 5, 4, 1).plan();
    let sensor = plan.cameras[0].body.sensor.as_ref().expect("a sensor");
    std::array::from_fn(|c| band_sum(&light(), sensor.responsivity(c), band_width_nm) - 1.0)
}

#[test]
fn the_cube_differs_from_folding_by_what_its_bands_cost() {
    for width_nm in [5, 10, 20] {
        let bias = bias(width_nm);
        for wavelengths in [1, 4, 8] {
            for (channel, difference) in differences(width_nm, wavelengths).iter().enumerate() {
                let truth = bias[channel];
                let measured = (difference.mean, difference.standard_error());
                // Nine cases of three channels: each is judged one time in a thousand wrongly. f32 sums: 1e-5.
                assert!(
                    is_near(measured, truth, 1e-5, f64::from(difference.degrees_of_freedom)),
                    "{width_nm} nm, {wavelengths} wavelengths, channel {channel}: {difference:?} for {truth:e}"
                );
            }
        }
    }
}

#[test]
fn wider_bands_cost_more_and_five_nanometres_little() {
    let worst = |width_nm| bias(width_nm).into_iter().map(f64::abs).fold(0.0, f64::max);
    // A fluorescent lamp, tabulated every 5 nm, and smooth filters. The figures are for the documentation.
    assert!(worst(5) < 2e-3 && worst(10) < 6e-3 && worst(20) < 3e-2, "{} {} {}", worst(5), worst(10), worst(20));
    assert!(worst(5) < worst(10) && worst(10) < worst(20));
}

#[test]
fn both_are_the_integral_of_light_and_responsivity() {
    // E = w ρ L; the pinhole's weight is π/(4N²) on the axis, cos⁴ ≥ 1 − 2 (20 µm · √2/6 mm)² = 1 − 5e-5.
    let shots: Vec<[f64; 3]> = (1..=SEEDS).map(|seed| channel_means(&job("electrons", 5, 8, seed).shot())).collect();
    let plan = job("electrons", 5, 4, 1).plan();
    let sensor = plan.cameras[0].body.sensor.as_ref().expect("a sensor");
    let lamp = illuminant::by_name("FL2").expect("known");
    let scale = 100.0 / etendue_spectra::observer::luminance(lamp) * core::f64::consts::PI / 64.0;
    for channel in 0..3 {
        let r = |nm: f64| f64::from(sensor.responsivity(channel).at(nm as f32));
        let truth = scale * integral(380.0, 780.0, |nm| light()(nm) * r(nm));
        let values: Vec<f64> = shots.iter().map(|s| s[channel] / truth - 1.0).collect();
        let estimate = ReplicateEstimate::from_replicates(&values).expect("several pictures");
        assert!(is_near((estimate.mean, estimate.standard_error()), 0.0, 6e-5, 7.0), "channel {channel}: {estimate:?}");
    }
}
