//! What the reference implementation of EMVA 1288 measures on `etendue flat`'s stacks (tests/oracles/emva.py).
//!
//! Three links: the stored figures recover the cameras' parameters; the standard's formulas, written here anew, make the same figures
//! of the stored sums; and stacks that are taken again here have those sums, so that the figures are those of this program's bits.

use etendue_core::maths::f64::{exp, pow};
use etendue_io::load_assets;
use etendue_pipeline::compile_camera;
use etendue_pipeline::flat::{self, FlatLight, FrameStack, PhotonTransfer};
use etendue_pipeline::plan::CameraBody;
use etendue_scene::{Overrides, load_camera, named_files};
use etendue_sensor::{FrameAddress, Sensor, SensorState};
use serde_json::Value;
use std::path::Path;

const PIXELS: f64 = 256.0 * 256.0;
const LEVELS: usize = 50;

/// A camera of the figures, and its parameters.
struct Camera {
    name: &'static str,
    gain_dn_e: f64,
    efficiency: f64,
    /// At the sensor's temperature, e⁻/s.
    dark_e_s: f64,
    /// White, row and column read noise, e⁻.
    read_e: f64,
    /// Pixels, columns, and the spread of the dark current times its mean, e⁻/s.
    dsnu: [f64; 3],
    /// Pixels and columns.
    prnu: [f64; 2],
    /// Full well, or where the converter ends, e⁻.
    saturation_e: f64,
}

fn cameras() -> [Camera; 3] {
    // 25 to 40 °C at a doubling every 8 K.
    let web_dark_e_s = 150.0 * pow(2.0, 15.0 / 8.0);
    [
        Camera {
            name: "web",
            gain_dn_e: 0.106,
            efficiency: 0.35,
            dark_e_s: web_dark_e_s,
            // Noise of whole rows is noise of pixels to this measurement.
            read_e: 65.0_f64.sqrt(),
            dsnu: [3.0, 2.0, 0.5 * web_dark_e_s],
            prnu: [0.01, 0.002],
            saturation_e: 9000.0,
        },
        Camera {
            name: "ccd",
            gain_dn_e: 0.2,
            efficiency: 0.45,
            dark_e_s: 5.0,
            read_e: 10.0,
            dsnu: [1.0, 0.0, 0.3 * 5.0],
            prnu: [0.008, 0.0],
            saturation_e: 20_000.0,
        },
        Camera {
            name: "automotive",
            gain_dn_e: 0.8,
            efficiency: 0.6,
            dark_e_s: 20.0,
            read_e: 1.2,
            dsnu: [1.0, 0.0, 0.4 * 20.0],
            prnu: [0.006, 0.0],
            saturation_e: (4095.0 - 64.0) / 0.8,
        },
    ]
}

/// What the program says of a camera.
struct Figures {
    results: Value,
    /// Exposure, s, photons, sum of two frames, sum of squared differences; bright and dark in turn.
    levels: Vec<[f64; 4]>,
    stacks: Value,
}

impl Figures {
    fn load(name: &str) -> Self {
        let all: Value = serde_json::from_str(include_str!("../../oracles/figures/emva.json")).expect("JSON");
        let camera = &all["cameras"][name];
        let level = |level: &Value| {
            let [sum, squares] = [0, 1].map(|i| number(&level["sum_and_squared_difference"][i]));
            [1e-9 * number(&level["exposure_ns"]), number(&level["photons"]), sum, squares]
        };
        let levels = camera["levels"].as_array().expect("levels").iter().map(level).collect();
        Self { results: camera["results"].clone(), levels, stacks: camera["stacks"].clone() }
    }

    fn result(&self, key: &str) -> f64 {
        number(&self.results[key])
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// One level as the standard reads it: exposure, photons, bright mean less the dark one, dark mean, and their temporal variances.
struct Level {
    exposure_s: f64,
    photons: f64,
    signal_dn: f64,
    dark_dn: f64,
    variance: f64,
    dark_variance: f64,
}

fn levels(figures: &Figures) -> Vec<Level> {
    // Half of the mean squared difference. The frames' means differ by their noise alone, of which the program takes the square away: less
    // than 1/N of the variance but for noise of whole rows.
    let variance = |squares: f64| squares / (2.0 * PIXELS);
    let level = |pair: &[[f64; 4]]| {
        let ([exposure_s, photons, sum, squares], [_, _, dark_sum, dark_squares]) = (pair[0], pair[1]);
        let dark_dn = dark_sum / (2.0 * PIXELS);
        Level {
            exposure_s,
            photons,
            signal_dn: sum / (2.0 * PIXELS) - dark_dn,
            dark_dn,
            variance: variance(squares),
            dark_variance: variance(dark_squares),
        }
    };
    figures.levels.chunks(2).map(level).collect()
}

/// Slope of a straight line through 0.
fn slope_through_0(points: &[(f64, f64)]) -> f64 {
    let sum = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>();
    sum(|(x, y)| x * y) / sum(|(x, _)| x * x)
}

/// Offset and slope of a straight line.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let n = points.len() as f64;
    let sum = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>();
    let (x, y) = (sum(|p| p.0) / n, sum(|p| p.1) / n);
    let slope = (sum(|p| p.0 * p.1) / n - x * y) / (sum(|p| p.0 * p.0) / n - x * x);
    (y - slope * x, slope)
}

/// The level of the largest temporal variance.
fn saturated(levels: &[Level]) -> usize {
    (0..levels.len()).max_by(|a, b| levels[*a].variance.total_cmp(&levels[*b].variance)).expect("levels")
}

/// Those up to 70 % of saturation.
fn fitted(levels: &[Level]) -> &[Level] {
    let end = 0.7 * levels[saturated(levels)].signal_dn;
    &levels[..levels.iter().take_while(|l| l.signal_dn <= end).count()]
}

fn near(name: &str, quantity: &str, actual: f64, expected: f64, relative: f64) {
    assert!(
        (actual / expected - 1.0).abs() <= relative,
        "{name}: {quantity} {actual}, expected {expected} ± {relative}"
    );
}

/// One per cent, as is asked. The standard uncertainties of gain, efficiency and PRNU (pixels and levels as they are) are 0.1 to 0.3 %; of the
/// dark current 0.1 to 0.5 %, so that three of them are allowed there.
#[test]
fn the_reference_recovers_what_was_put_in() {
    for camera in cameras() {
        let (name, figures) = (camera.name, Figures::load(camera.name));
        near(name, "gain", figures.result("K"), camera.gain_dn_e, 0.01);
        near(name, "efficiency", 0.01 * figures.result("QE"), camera.efficiency, 0.01);
        near(name, "dark current", figures.result("u_I_mean"), camera.dark_e_s, 0.015);
        let half_s = 0.5 * figures.levels[2 * LEVELS - 2][0] / 1.05;
        let [pixels, columns, dark_e_s] = camera.dsnu;
        let dsnu = (pixels * pixels + columns * columns + pow(dark_e_s * half_s, 2.0)).sqrt();
        near(name, "DSNU", figures.result("DSNU1288"), dsnu, 0.01);
        let [pixels, columns] = camera.prnu;
        let prnu = (pixels * pixels + columns * columns).sqrt();
        near(name, "PRNU", 0.01 * figures.result("PRNU1288"), prnu, 0.01);
        if camera.dsnu[1] > 0.0 {
            // Deviations of 256 columns have an uncertainty of 1/√512.
            near(name, "DSNU of columns", figures.result("DSNU1288_col"), camera.dsnu[1], 0.13);
            near(name, "PRNU of columns", 0.01 * figures.result("PRNU1288_col"), columns, 0.13);
        }
        // No bias but sampling: intercept of 50 variances of 0.6 % each, and the gain's.
        near(name, "read noise", figures.result("sigma_d"), camera.read_e, 0.01);
    }
}

/// The reference takes the level of the largest temporal variance for saturation. Where that is expected follows from the level's mean
/// and noise, cut at the well: averaged over the pixels' responses, Var min(X, well) of a normal X. Blooming changes the fall beyond, not
/// where it begins; levels are 2.1 % apart and neighbours may change places.
#[test]
fn saturation_is_where_the_clipped_variance_is_largest() {
    for camera in cameras() {
        let figures = Figures::load(camera.name);
        let expected =
            |level: usize| clipped_variance(&camera, 1.05 * camera.saturation_e * (level + 1) as f64 / LEVELS as f64);
        let best = (0..LEVELS).max_by(|a, b| expected(*a).total_cmp(&expected(*b))).expect("levels");
        let actual = figures.result("index_u_ysat");
        assert!((actual - best as f64).abs() <= 1.0, "{}: level {actual}, expected {best}", camera.name);
        let bias = 1.05 * (actual + 1.0) / LEVELS as f64;
        near(camera.name, "saturation", figures.result("u_e_sat"), bias * camera.saturation_e, 0.01);
    }
}

/// Variance of the charge of a pixel of mean `mean_e`, cut at saturation, averaged over the pixels.
fn clipped_variance(camera: &Camera, mean_e: f64) -> f64 {
    let prnu = camera.prnu[0];
    let steps = || (-400..=400).map(|i| 0.01 * f64::from(i));
    let bell = |z: f64| exp(-0.5 * z * z);
    let clipped_pixel = |mean: f64| {
        let cut = |z: f64| (mean + mean.sqrt() * z).min(camera.saturation_e);
        let weight: f64 = steps().map(bell).sum();
        let first: f64 = steps().map(|z| bell(z) * cut(z)).sum::<f64>() / weight;
        steps().map(|z| bell(z) * pow(cut(z) - first, 2.0)).sum::<f64>() / weight
    };
    let responses = || (-8..=8).map(|i| 0.5 * f64::from(i));
    let weight: f64 = responses().map(bell).sum();
    responses().map(|z| bell(z) * clipped_pixel(mean_e * (1.0 + prnu * z))).sum::<f64>() / weight
}

/// The same formulas on the same sums. The program also takes the square of the difference of two frames' means off their variance,
/// which the sums do not hold: below 2e-5 of it for pixels' noise; rows' noise is 1/65 of the web camera's, a share of which is common.
#[test]
fn the_standards_formulas_make_the_same_figures() {
    for camera in cameras() {
        let (name, figures) = (camera.name, Figures::load(camera.name));
        let levels = levels(&figures);
        assert_eq!(saturated(&levels) as f64, figures.result("index_u_ysat"), "{name}");
        let fitted = fitted(&levels);
        assert_eq!((fitted.len() - 1) as f64, figures.result("index_sensitivity_max"), "{name}");
        let points = |f: fn(&Level) -> (f64, f64), levels_of: &[Level]| levels_of.iter().map(f).collect::<Vec<_>>();
        let gain = slope_through_0(&points(|l| (l.signal_dn, l.variance - l.dark_variance), fitted));
        let responsivity = slope_through_0(&points(|l| (l.photons, l.signal_dn), fitted));
        near(name, "K", gain, figures.result("K"), 1e-4);
        near(name, "R", responsivity, figures.result("R"), 1e-6);
        near(name, "QE", 100.0 * responsivity / gain, figures.result("QE"), 1e-4);
        let (_, slope) = line(&points(|l| (l.exposure_s, l.dark_dn), &levels));
        near(name, "dark current", slope / gain, figures.result("u_I_mean"), 2e-4);
        let (variance, _) = line(&points(|l| (l.exposure_s, l.dark_variance), &levels));
        near(name, "read noise", (variance - 1.0 / 12.0).sqrt() / gain, figures.result("sigma_d"), 1e-3);
    }
}

/// A bare camera and its series.
struct Bench {
    body: CameraBody,
    series: PhotonTransfer,
}

impl Bench {
    fn new(name: &str) -> Self {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("oracles/figures/emva/{name}.toml"));
        let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string().into());
        let camera = load_camera(&file, &read, &Overrides::default()).expect("a camera");
        let assets = load_assets(&named_files::camera_files(&camera)).expect("its files");
        let body = flat::bare(&compile_camera(&camera, &assets).expect("it compiles")).expect("electronics");
        let series = flat::photon_transfer(body.sensor.as_ref().expect("electronics"), 525.0, LEVELS as u32, 100);
        Self { series: series.expect("linear"), body }
    }

    fn sensor(&self) -> &Sensor {
        self.body.sensor.as_ref().expect("electronics")
    }

    /// The first frames of a stack.
    fn frames(&self, stack: &FrameStack, count: usize) -> Vec<Vec<u32>> {
        let irradiance_w_m2 = if stack.photons > 0.0 { self.series.light.irradiance_w_m2 } else { 0.0 };
        let light = FlatLight { irradiance_w_m2, ..self.series.light };
        let electrons = flat::electrons(&self.body, light).expect("electronics");
        let mut state = SensorState::default();
        let take = |frame| {
            let address = FrameAddress { seed: 0, camera: 0, frame, capture: 0 };
            let start_state = stack.state(self.sensor(), std::mem::take(&mut state));
            let (next, raw) = self.sensor().step(start_state, &electrons, address);
            state = next;
            raw.linear().plane.samples().to_vec()
        };
        stack.frames.clone().take(count).map(take).collect()
    }
}

fn sum(frame: &[u32]) -> u64 {
    frame.iter().map(|dn| u64::from(*dn)).sum()
}

fn sum_of_squares(frame: &[u32]) -> u64 {
    frame.iter().map(|dn| u64::from(*dn) * u64::from(*dn)).sum()
}

#[test]
fn the_figures_are_those_of_this_programs_bits() {
    for name in ["web", "ccd", "automotive"] {
        let (bench, figures) = (Bench::new(name), Figures::load(name));
        for i in [0, 1, 24, 47, 66, 67, 98, 99] {
            let frames = bench.frames(&bench.series.stacks[i], 2);
            let squares: u64 = frames[0].iter().zip(&frames[1]).map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum();
            let actual = [sum(&frames[0]) + sum(&frames[1]), squares].map(|n| n as f64);
            assert_eq!(actual, figures.levels[i][2..], "{name}, stack {i}");
            near(name, "photons", bench.series.stacks[i].photons.max(1.0), figures.levels[i][1].max(1.0), 1e-6);
        }
        for (k, stack) in bench.series.stacks[2 * LEVELS..].iter().enumerate() {
            let first = &bench.frames(stack, 1)[0];
            let stored = &figures.stacks[k]["first_and_last"][0];
            assert_eq!([sum(first), sum_of_squares(first)].map(Some), [0, 1].map(|i| stored[i].as_u64()), "{name}");
        }
    }
}

/// Non-uniformity of one camera, from all of its frames, by the standard's equations (33) to (38).
#[test]
fn non_uniformity_is_the_same_from_the_same_frames() {
    let (bench, figures) = (Bench::new("automotive"), Figures::load("automotive"));
    let spatial = |stack: &FrameStack| {
        let frames = bench.frames(stack, 100);
        let l = frames.len() as f64;
        let pixel = |i: usize| {
            let (sum, squares) =
                frames.iter().map(|f| f64::from(f[i])).fold((0.0, 0.0), |(s, q), v| (s + v, q + v * v));
            (sum / l, (squares - sum * sum / l) / (l - 1.0))
        };
        let pixels: Vec<(f64, f64)> = (0..frames[0].len()).map(pixel).collect();
        let mean = pixels.iter().map(|p| p.0).sum::<f64>() / PIXELS;
        let temporal = pixels.iter().map(|p| p.1).sum::<f64>() / PIXELS;
        let measured = pixels.iter().map(|p| (p.0 - mean) * (p.0 - mean)).sum::<f64>() / (PIXELS - 1.0);
        (mean, measured - temporal / l)
    };
    let (mean, variance) = spatial(&bench.series.stacks[2 * LEVELS]);
    let (dark_mean, dark_variance) = spatial(&bench.series.stacks[2 * LEVELS + 1]);
    near("automotive", "DSNU", dark_variance.sqrt() / figures.result("K"), figures.result("DSNU1288"), 1e-9);
    let prnu = 100.0 * (variance - dark_variance).sqrt() / (mean - dark_mean);
    near("automotive", "PRNU", prnu, figures.result("PRNU1288"), 1e-9);
}
