//! The Cornell box with its measured spectra, against Mitsuba 3's spectral path tracer.
//!
//! tests/oracles/cornell_mitsuba.py rendered the same box from the same camera; figures/cornell.json keeps the mean
//! radiance of every wall and block in six bands, with standard errors. A wall's mean is over the pixels whose centre
//! and whose eight neighbours' centres see it.

use etendue_core::Plane;
use etendue_core::quantity::Identity;
use etendue_stats::{EstimatedPlane, student};
use etendue_testkit::judge::{SIGNIFICANCE, mean_and_error};
use etendue_tests::{Job, Shot};
use serde_json::Value;

const FIGURES: &str = include_str!("../../oracles/figures/cornell.json");
const SCENE: &str = include_str!("../../../scenes/cornell/cornell.toml");
const SPECTRA: [(&str, &str); 4] = [
    ("white.csv", include_str!("../../../scenes/cornell/white.csv")),
    ("red.csv", include_str!("../../../scenes/cornell/red.csv")),
    ("green.csv", include_str!("../../../scenes/cornell/green.csv")),
    ("light.csv", include_str!("../../../scenes/cornell/light.csv")),
];

fn points(csv: &str) -> Vec<(f64, f64)> {
    let rows = csv.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    rows.map(|row| row.split_once(',').map(|(nm, value)| (number(nm), number(value))).expect("two columns")).collect()
}

fn number(text: &str) -> f64 {
    text.trim().parse().expect("a number")
}

fn rendered(max_bounces: u64) -> Shot {
    let render = format!(
        "[render]\nroute = \"pupil\"\nwavelength_range_nm = [400, 700]\nband_width_nm = 50\nmax_bounces = {max_bounces}\n\
         spp = 16\nreplicates = 4\nseed = 1\n[output]\nradiance = true"
    );
    let job = Job::new(&SCENE[SCENE.find("[scene]").expect("a scene")..]);
    let job = job.replacing("[render]\nspp = 64\nreplicates = 4\nmax_bounces = 12\nseed = 1", &render);
    SPECTRA.iter().fold(job, |job, (path, csv)| job.with_spectrum(path, &points(csv))).shot()
}

/// Pixels that see an instance, and so do their neighbours; rows from the top.
fn inside(ids: &Plane<Identity>, id: u32) -> Vec<usize> {
    let (width, height) = (ids.width(), ids.height());
    let is_interior = |x: usize, y: usize| (y - 1..=y + 1).all(|y| (x - 1..=x + 1).all(|x| ids.at(x, y) == id));
    let pixels = (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| (x, y)));
    pixels.filter(|(x, y)| is_interior(*x, *y)).map(|(x, y)| y * width + x).collect()
}

/// Mean radiance of some pixels in a band and its standard error.
fn mean_of(shot: &Shot, band: usize, pixels: &[usize]) -> (f64, f64) {
    let radiance = shot.film.radiance().expect("a cube is kept");
    let (mean, variance) = (radiance.mean.planes()[band].samples(), radiance.variance.planes()[band].samples());
    let chosen = |values: &[f32]| pixels.iter().map(|i| values[*i]).collect::<Vec<f32>>();
    let (mean, variance) = (chosen(mean), chosen(variance));
    mean_and_error(EstimatedPlane {
        mean: &mean,
        variance_of_mean: &variance,
        replicates: shot.film.replicates,
        correlated_pixels: 1,
    })
}

#[test]
fn every_wall_is_as_bright_as_mitsubas_in_every_band() {
    let figures: Value = serde_json::from_str(FIGURES).expect("JSON");
    let shot = rendered(figures["max_bounces"].as_u64().expect("a number"));
    let ids = shot.truth().instance;
    let walls = figures["walls"].as_array().expect("a list");
    let tests = walls.len() * figures["bands_nm"].as_array().expect("a list").len();
    // Mitsuba's standard error is of 16 pictures; ours has thousands of degrees of freedom.
    let critical = student::critical(SIGNIFICANCE / tests as f64, 15.0);
    for (i, wall) in walls.iter().enumerate() {
        let pixels = inside(&ids, i as u32 + 1);
        assert_eq!(pixels.len() as u64, wall["pixels"], "pixels of {}", wall["name"]);
        for (band, mitsuba_mean) in wall["mean"].as_array().expect("a list").iter().enumerate() {
            let mitsuba =
                (mitsuba_mean.as_f64().expect("a number"), wall["standard_error"][band].as_f64().expect("a number"));
            let own = mean_of(&shot, band, &pixels);
            let error = (own.1 * own.1 + mitsuba.1 * mitsuba.1).sqrt();
            let (difference, known) = ((own.0 - mitsuba.0).abs(), error / mitsuba.0);
            assert!(difference < critical * error, "{} band {band}: {own:?}, Mitsuba {mitsuba:?}", wall["name"]);
            // A test that could not fail would be of no use.
            assert!(known < 0.02, "{} band {band} is known to {known}", wall["name"]);
        }
    }
}
