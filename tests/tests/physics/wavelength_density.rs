//! The density of wavelengths: by no choice of it do electrons change, and the light's spectrum in it saves what the plan foretells.
//!
//! `ETENDUE_BLESS=1 cargo test -p etendue-tests --test physics wavelength_density` (`just wavelengths`) writes docs/wavelengths.md.

use etendue_pipeline::plan::WavelengthSampling;
use etendue_stats::normal;
use etendue_tests::{Job, Shot};
use std::fmt::Write as _;
use std::path::Path;

/// The keys of the densities, in the order of the table's columns.
const DENSITIES: [&str; 3] = ["uniform", "response", "response_and_source"];
const LIGHTS: [&str; 4] = ["D65", "LED-B3", "sodium-high-pressure", "sodium-low-pressure"];

/// Samples a pixel and replicates.
const SPP: u32 = 64;
const REPLICATES: u32 = 16;

/// Six patches, 24 × 16 pixels.
const PATCHES: [(&str, [f64; 3]); 6] = [
    ("grey", [0.18, 0.18, 0.18]),
    ("red", [0.45, 0.05, 0.04]),
    ("yellow", [0.7, 0.5, 0.03]),
    ("white", [0.85, 0.85, 0.85]),
    ("green", [0.08, 0.32, 0.07]),
    ("blue", [0.04, 0.06, 0.35]),
];

/// A sensor: its name, its keys, and the colours of its tile in the order of the table.
struct SensorKind {
    name: &'static str,
    keys: &'static str,
    colours: &'static [(&'static str, &'static [usize])],
}

const SENSORS: [SensorKind; 3] = [
    SensorKind {
        name: "Bayer",
        keys: "cfa = \"rggb\"\nquantum_efficiency = { camera = \"nikon-d5100\", peak = 0.55 }",
        colours: &[("red", &[0]), ("green", &[1, 2]), ("blue", &[3])],
    },
    SensorKind {
        name: "RCCB",
        keys: "cfa = \"rccb\"\nquantum_efficiency = { channels = { red = { spectrum = \"red.csv\" }, clear = { spectrum = \
               \"clear.csv\" }, blue = { spectrum = \"blue.csv\" } } }",
        colours: &[("red", &[0]), ("clear", &[1, 2]), ("blue", &[3])],
    },
    SensorKind {
        name: "589 nm ± 5 nm",
        keys: "cfa = \"mono\"\nquantum_efficiency = { spectrum = \"narrow.csv\" }",
        colours: &[("all", &[0, 1, 2, 3])],
    },
];

/// Made-up efficiencies of a clear, a red and a blue pixel behind an infra-red cut, and of one behind an interference filter.
const EFFICIENCIES: [(&str, &[(f64, f64)]); 4] = [
    ("clear.csv", &[(395.0, 0.0), (430.0, 0.55), (530.0, 0.7), (650.0, 0.6), (690.0, 0.5), (710.0, 0.0)]),
    ("red.csv", &[(395.0, 0.0), (420.0, 0.03), (570.0, 0.04), (600.0, 0.5), (690.0, 0.48), (710.0, 0.0)]),
    ("blue.csv", &[(395.0, 0.0), (430.0, 0.4), (465.0, 0.48), (530.0, 0.06), (690.0, 0.03), (710.0, 0.0)]),
    ("narrow.csv", &[(579.0, 0.0), (589.0, 0.6), (599.0, 0.0)]),
];

/// Where the patches are.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    /// In light that is the same from everywhere: only wavelengths differ between samples.
    Even,
    /// On the wall of a room with a lamp, whose light is scattered from wall to wall.
    Room,
}

fn job(place: Place, light: &str, sensor: &SensorKind, render: &str) -> Job {
    let patches: String = PATCHES.iter().enumerate().map(|(i, (name, rgb))| patch(i, name, *rgb)).collect();
    let scene = match place {
        Place::Even => {
            format!("[scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = 1000\nilluminant = \"{light}\"\n")
        }
        Place::Room => room(light),
    };
    let job = Job::new(format!(
        r#"
        [scene]
        {scene}
        {patches}
        [[cameras]]
        name = "eye"
        position_m = [0, 0, 1]
        look_at_m = [2, 0, 1]
        lens = {{ type = "thin", focal_length_mm = 6, f_number = 2, focus_distance_m = 2 }}
        [cameras.sensor]
        width_px = 24
        height_px = 16
        pixel_pitch_um = 200
        exposure_s = 1e-6
        {}
        full_well_e = 1e6
        read_noise_e = 1
        dark_current_e_s = 0
        gain_dn_per_e = 0.05
        black_level_dn = 64
        bits = 16
        [render]
        spp = {SPP}
        replicates = {REPLICATES}
        {render}
        "#,
        sensor.keys
    ));
    EFFICIENCIES.iter().fold(job, |job, (file, points)| job.with_spectrum(file, points))
}

/// A patch of the wall 2 m before the camera, of three columns and two rows.
fn patch(i: usize, name: &str, rgb: [f64; 3]) -> String {
    let side = 1.6 / 3.0;
    let (y, z) = (side * (1.0 - (i % 3) as f64), 1.0 + side * (0.5 - (i / 3) as f64));
    format!(
        "[[scene.materials]]\nname = \"{name}\"\ntype = \"diffuse\"\nreflectance = {rgb:?}\n[[scene.objects]]\nname = \"{name}\"\n\
         shape = {{ type = \"quad\", size_m = [{side}, {side}] }}\nmaterial = \"{name}\"\nposition_m = [2, {y}, {z}]\n\
         rotation_deg = [0, -90, 0]\n"
    )
}

/// A room of 4 m by 3 m by 2 m about camera and wall, with a lamp in its ceiling.
fn room(light: &str) -> String {
    let quad = |name: &str, size: [f64; 2], at: [f64; 3], turn: [f64; 3], material: &str| {
        format!(
            "[[scene.objects]]\nname = \"{name}\"\nshape = {{ type = \"quad\", size_m = {size:?} }}\nmaterial = \"{material}\"\n\
             position_m = {at:?}\nrotation_deg = {turn:?}\n"
        )
    };
    [
        "[[scene.materials]]\nname = \"wall\"\ntype = \"diffuse\"\nreflectance = 0.6\n".to_owned(),
        format!(
            "[[scene.materials]]\nname = \"lamp\"\ntype = \"emitter\"\nemission = {{ luminance_cd_m2 = 20000, illuminant = \"{light}\" }}\n"
        ),
        quad("floor", [4.0, 3.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.0], "wall"),
        quad("ceiling", [4.0, 3.0], [0.1, 0.0, 2.0], [180.0, 0.0, 0.0], "wall"),
        quad("left", [4.0, 2.0], [0.1, 1.5, 1.0], [90.0, 0.0, 0.0], "wall"),
        quad("right", [4.0, 2.0], [0.1, -1.5, 1.0], [-90.0, 0.0, 0.0], "wall"),
        quad("lamp", [0.3, 0.3], [0.8, 0.3, 1.99], [180.0, 0.0, 0.0], "lamp"),
    ]
    .concat()
}

/// What the pixels of a colour hold, a second.
#[derive(Clone, Copy)]
struct Colour {
    /// Sums over the pixels of the means and of their variances.
    sum: f64,
    variance: f64,
    /// Mean of the pixels' variances over the mean of their squared means, and the standard error of it over eight parts of the picture.
    relative: f64,
    error: f64,
}

/// Parts of the picture whose scatter tells the error of its mean variance.
const PARTS: usize = 8;

fn colour(shot: &Shot, places: &[usize]) -> Colour {
    let film = shot.film.electron_rate.as_ref().expect("electrons are summed");
    let mut parts = [(0.0, 0.0); PARTS];
    let (mut sum, mut variance) = (0.0, 0.0);
    let pixels = film.mean.samples().iter().zip(film.variance.samples()).enumerate();
    for (i, (mean, of_mean)) in pixels.filter(|(i, _)| places.contains(&(2 * ((i / 24) % 2) + i % 2))) {
        let (mean, of_mean) = (f64::from(*mean), f64::from(*of_mean));
        // Blocks of the tile in turns, so that every part has all patches.
        let part = &mut parts[((i % 24) / 2 + 3 * (i / 48)) % PARTS];
        (part.0, part.1) = (part.0 + of_mean, part.1 + mean * mean);
        (sum, variance) = (sum + mean, variance + of_mean);
    }
    let total = parts.iter().fold((0.0, 0.0), |all, part| (all.0 + part.0, all.1 + part.1));
    let relative = total.0 / total.1;
    let scatter: f64 = parts
        .iter()
        .map(|part| {
            let off = part.0 - relative * part.1;
            off * off
        })
        .sum();
    let n = PARTS as f64;
    Colour { sum, variance, relative, error: (scatter * n / (n - 1.0)).sqrt() / total.1 }
}

/// A colour of a sensor in a light: by the three densities.
struct Row {
    place: Place,
    light: &'static str,
    sensor: &'static str,
    colour: &'static str,
    by: [Colour; 3],
}

impl Row {
    fn saved(&self) -> f64 {
        self.by[1].relative / self.by[2].relative
    }

    /// Relative standard error of what is saved.
    fn saved_error(&self) -> f64 {
        (1..3)
            .map(|i| {
                let error = self.by[i].error / self.by[i].relative;
                error * error
            })
            .sum::<f64>()
            .sqrt()
    }
}

fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for place in [Place::Even, Place::Room] {
        for (sensor, light) in SENSORS.iter().flat_map(|sensor| LIGHTS.iter().map(move |light| (sensor, light))) {
            let shot = |(i, density): (u64, &str)| {
                let render = format!("wavelength_density = \"{density}\"");
                job(place, light, sensor, &render).with_seed(1 + i).shot()
            };
            let shots = [0, 1, 2].map(|i| shot((i, DENSITIES[i as usize])));
            for (name, places) in sensor.colours {
                let by = [0, 1, 2].map(|i| colour(&shots[i], places));
                rows.push(Row { place, light, sensor: sensor.name, colour: name, by });
            }
        }
    }
    rows
}

fn find<'a>(rows: &'a [Row], place: Place, light: &str, sensor: &str, colour: &str) -> &'a Row {
    let is = |row: &&Row| row.place == place && row.light == light && row.sensor == sensor && row.colour == colour;
    rows.iter().find(is).expect("a row of the table")
}

#[test]
fn electrons_are_the_same_by_every_density_and_the_lights_spectrum_saves_variance() {
    let rows = rows();
    if std::env::var_os("ETENDUE_BLESS").is_some_and(|value| value == "1") {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/wavelengths.md");
        std::fs::write(page, self::page(&rows)).expect("written");
    }
    // Unbiased: means by chance alone apart, of all rows together.
    let mut pairs = 0;
    let mut worst = 0.0_f64;
    for row in &rows {
        for (a, b) in [(0, 1), (1, 2), (0, 2)] {
            let (a, b) = (row.by[a], row.by[b]);
            pairs += 1;
            worst = worst.max((a.sum - b.sum).abs() / (a.variance + b.variance).sqrt());
        }
    }
    let p = normal::two_sided_p(worst) * f64::from(pairs);
    assert!(p > 1e-3, "{worst} standard errors among {pairs}");
    for row in &rows {
        let (saved, error) = (row.saved(), row.saved_error());
        // Nowhere does it cost a twentieth, by three standard errors.
        assert!(saved * (1.0 + 3.0 * error) > 0.95, "{} {} {}: {saved} ± {error}", row.light, row.sensor, row.colour);
    }
    let _ = find;
}

fn page(rows: &[Row]) -> String {
    let mut page = String::new();
    for row in rows {
        let place = if row.place == Place::Even { "even" } else { "room" };
        let [a, b, c] = row.by;
        let cell = |c: Colour| format!("{:.3} ± {:.3}", 1e3 * c.relative, 1e3 * c.error);
        writeln!(
            page,
            "| {place} | {} | {} {} | {} | {} | {} | {:.2} ± {:.2} |",
            row.light,
            row.sensor,
            row.colour,
            cell(a),
            cell(b),
            cell(c),
            row.saved(),
            row.saved() * row.saved_error()
        )
        .expect("text");
    }
    page
}

#[test]
fn the_density_follows_the_light_where_that_pays() {
    let chosen = |light: &str, sensor: &SensorKind, render: &str| {
        let plan = job(Place::Even, light, sensor, render).plan();
        (plan.cameras[0].settings.wavelength_sampling, plan.cameras[0].spectral_gain.expect("light"))
    };
    let (sampling, gain) = chosen("D65", &SENSORS[0], "");
    assert!(sampling == WavelengthSampling::Response && gain.mean < 1.02, "{gain:?}");
    let (sampling, gain) = chosen("sodium-low-pressure", &SENSORS[0], "");
    assert!(sampling == WavelengthSampling::ResponseAndSource && gain.mean > 2.0, "{gain:?}");
    let (sampling, _) = chosen("sodium-low-pressure", &SENSORS[0], "wavelength_density = \"response\"");
    assert_eq!(sampling, WavelengthSampling::Response);
}
