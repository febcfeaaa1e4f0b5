//! The density of wavelengths: by no choice of it do electrons change, and the light's spectrum in it saves what the plan foretells.
//!
//! `ETENDUE_BLESS=1 cargo test -p etendue-tests --test physics wavelength_density` (`just wavelengths`) writes docs/evidence/wavelengths.md and its
//! table, docs/evidence/data/wavelengths.csv.

use etendue_pipeline::plan::{SpectralGain, WavelengthSampling};
use etendue_stats::normal;
use etendue_testkit::judge::SIGNIFICANCE;
use etendue_tests::{Job, Shot, quad};
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
    let material = format!("[[scene.materials]]\nname = \"{name}\"\ntype = \"diffuse\"\nreflectance = {rgb:?}\n");
    material + &quad(name, [side, side], [2.0, y, z], [0.0, -90.0, 0.0], name)
}

/// A room of 4 m by 3 m by 2 m about camera and wall, with a lamp in its ceiling.
fn room(light: &str) -> String {
    [
        "[[scene.materials]]\nname = \"wall\"\ntype = \"diffuse\"\nreflectance = 0.6\n".to_owned(),
        format!(
            "[[scene.materials]]\nname = \"lamp\"\ntype = \"emitter\"\nemission = {{ luminance_cd_m2 = 20000, illuminant = \"{light}\" }}\n"
        ),
        quad("floor", [4.0, 3.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.0], "wall"),
        quad("ceiling", [4.0, 3.0], [0.1, 0.0, 2.0], [0.0, 0.0, 180.0], "wall"),
        quad("left", [4.0, 2.0], [0.1, 1.5, 1.0], [0.0, 0.0, 90.0], "wall"),
        quad("right", [4.0, 2.0], [0.1, -1.5, 1.0], [0.0, 0.0, -90.0], "wall"),
        quad("lamp", [0.3, 0.3], [0.8, 0.3, 1.99], [0.0, 0.0, 180.0], "lamp"),
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
    /// Whether the default follows the light.
    is_default: bool,
    gain: SpectralGain,
}

impl Row {
    fn variance_ratio(&self) -> f64 {
        self.by[1].relative / self.by[2].relative
    }

    /// Standard error of what is saved.
    fn saved_error(&self) -> f64 {
        let relative = |i: usize| self.by[i].error / self.by[i].relative;
        self.variance_ratio() * (relative(1) * relative(1) + relative(2) * relative(2)).sqrt()
    }

    fn words(&self) -> String {
        format!("{} {} {}: {} ± {}", self.light, self.sensor, self.colour, self.variance_ratio(), self.saved_error())
    }
}

fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for place in [Place::Even, Place::Room] {
        for (sensor, light) in SENSORS.iter().flat_map(|sensor| LIGHTS.iter().map(move |light| (sensor, *light))) {
            let shots = [0, 1, 2].map(|i| {
                let render = format!("wavelength_density = \"{}\"", DENSITIES[i]);
                job(place, light, sensor, &render).with_seed(1 + i as u64).shot()
            });
            let (sampling, gain) = chosen(place, light, sensor, "");
            let is_default = sampling == WavelengthSampling::ResponseAndSource;
            for (colour, places) in sensor.colours {
                let by = [0, 1, 2].map(|i| self::colour(&shots[i], places));
                rows.push(Row { place, light, sensor: sensor.name, colour, by, is_default, gain });
            }
        }
    }
    rows
}

/// The density of a job and what the light's spectrum is foretold to save.
fn chosen(place: Place, light: &str, sensor: &SensorKind, render: &str) -> (WavelengthSampling, SpectralGain) {
    let plan = job(place, light, sensor, render).plan();
    (plan.cameras[0].settings.wavelength_sampling, plan.cameras[0].settings.spectral_gain.expect("light"))
}

#[test]
fn electrons_are_the_same_by_every_density_and_the_lights_spectrum_saves_variance() {
    let rows = rows();
    if std::env::var_os("ETENDUE_BLESS").is_some_and(|value| value == "1") {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/evidence");
        std::fs::write(folder.join("wavelengths.md"), page(&rows)).expect("written");
        std::fs::write(folder.join("data/wavelengths.csv"), table(&rows)).expect("written");
    }
    // Unbiased: sums of 96 pixels or more are apart by chance alone, all rows together (Bonferroni).
    let pairs = rows.iter().flat_map(|row| [(0, 1), (1, 2), (0, 2)].map(|(a, b)| (row.by[a], row.by[b])));
    let differences: Vec<f64> = pairs.map(|(a, b)| (a.sum - b.sum).abs() / (a.variance + b.variance).sqrt()).collect();
    let worst = differences.iter().copied().fold(0.0, f64::max);
    let p = normal::two_sided_p(worst) * differences.len() as f64;
    assert!(p > SIGNIFICANCE, "{worst} standard errors among {}", differences.len());
    for row in &rows {
        let (ratio, error) = (row.variance_ratio(), row.saved_error());
        // Where the default follows the light, no colour loses; bounds with four standard errors.
        assert!(!row.is_default || ratio + 4.0 * error > 1.0, "{}", row.words());
        // Lines gain in any place.
        let min_gain = match (row.place, row.light, row.sensor) {
            (Place::Even, "sodium-low-pressure", "Bayer" | "RCCB") => 30.0,
            (Place::Even, "sodium-high-pressure", _) => 5.0,
            (Place::Room, "sodium-low-pressure", "Bayer" | "RCCB") => 1.5,
            _ => 0.0,
        };
        assert!(ratio - 4.0 * error > min_gain || ratio > 2.0 * min_gain, "{}", row.words());
    }
}

const HEAD: &str = "# Variance by the density of wavelengths

This page states how much variance of a pixel's electrons each `wavelength_density` of `[render]` leaves, by sensor and light, for users who choose it ([model](../decisions/wavelength-sampling.md)). `just wavelengths` writes it; its test compares the means of the three densities (Z test).

- Six patches (grey, white, four colours) are rendered with 24 × 16 pixels, 64 samples of four wavelengths and 16 replicates.
- **Uniform illumination**: light is equal from all directions, so that only the wavelengths of samples differ. **Room**: a light in a room with walls of reflectance 0.6; most of the noise is that of the paths.
- *Saved* is the variance by response over the variance by response and source, over the colours of the sensor. Samples for equal noise fall by this factor.
- *Estimated* is the factor that `plan` states for noisy pixels, over all pixels of the sensor. Under sodium lamps most measured factors are larger. Bold: the default density follows the light.
- Bayer is the Nikon D5100; RCCB is an invented clear pixel with its red and blue; 589 nm is a triangle of 10 nm.
- The table of the low-pressure sodium lamp has one value, at 590 nm: a triangle of 10 nm, ten times as wide as the line.

| sensor | light | uniform illumination, saved | room, saved | estimated |
| --- | --- | ---: | ---: | ---: |
";

const TAIL: &str = "
[Variances of each colour](data/wavelengths.csv), × 1 000 of the squared mean, mean over the pixels of a colour with the standard error over eight parts of the image.
";

/// The page: a row for each sensor and light.
fn page(rows: &[Row]) -> String {
    let mut page = HEAD.to_owned();
    for (sensor, light) in SENSORS.iter().flat_map(|sensor| LIGHTS.iter().map(move |light| (sensor.name, *light))) {
        let [uniform, room] = [Place::Even, Place::Room].map(|place| saved_range(rows, place, sensor, light));
        let row = rows.iter().find(|row| row.sensor == sensor && row.light == light).expect("a row");
        let emphasis = if row.is_default { "**" } else { "" };
        writeln!(page, "| {sensor} | {light} | {uniform} | {room} | {emphasis}{:.2}{emphasis} |", row.gain.mean)
            .expect("text");
    }
    page + TAIL
}

/// The saved factors over the colours of a sensor.
fn saved_range(rows: &[Row], place: Place, sensor: &str, light: &str) -> String {
    let is_own = |row: &&Row| row.place == place && row.sensor == sensor && row.light == light;
    let mut own: Vec<&Row> = rows.iter().filter(is_own).collect();
    own.sort_by(|a, b| a.variance_ratio().total_cmp(&b.variance_ratio()));
    let figure = |row: &Row| {
        with_error(row.variance_ratio(), row.saved_error()).split(' ').next().unwrap_or_default().to_owned()
    };
    match own[..] {
        [] => String::new(),
        [only] => figure(only),
        [min, .., max] => format!("{} to {}", figure(min), figure(max)),
    }
}

/// The table with all figures, as CSV.
fn table(rows: &[Row]) -> String {
    let mut table = "place,sensor,colour,light,uniform,by response,by response and source,saved,estimated,\
                     default follows the light\n"
        .to_owned();
    for row in rows {
        let place = if row.place == Place::Even { "uniform illumination" } else { "room" };
        let cells = row.by.map(|c| with_error(1e3 * c.relative, 1e3 * c.error)).join(",");
        let ratio_text = with_error(row.variance_ratio(), row.saved_error());
        let follows = if row.is_default { "yes" } else { "no" };
        let Row { sensor, colour, light, gain, .. } = row;
        writeln!(table, "{place},{sensor},{colour},{light},{cells},{ratio_text},{:.2},{follows}", gain.mean)
            .expect("text");
    }
    table
}

/// A figure with the digits that its error leaves.
fn with_error(value: f64, error: f64) -> String {
    let digits =
        [(10.0, 0), (1.0, 1), (0.1, 2)].into_iter().find(|(from, _)| error >= *from).map_or(3, |(_, digits)| digits);
    format!("{value:.digits$} ± {error:.digits$}")
}

#[test]
fn the_density_follows_the_light_where_that_pays() {
    let (sampling, gain) = chosen(Place::Even, "D65", &SENSORS[0], "");
    assert!(sampling == WavelengthSampling::Response && gain.mean < 1.02, "{gain:?}");
    let (sampling, gain) = chosen(Place::Even, "sodium-low-pressure", &SENSORS[0], "");
    assert!(sampling == WavelengthSampling::ResponseAndSource && gain.mean > 2.0, "{gain:?}");
    let key = "wavelength_density = \"response\"";
    assert_eq!(chosen(Place::Even, "sodium-low-pressure", &SENSORS[0], key).0, WavelengthSampling::Response);
    // Bands beside electrons keep their share.
    let output_keys = "[output]\nirradiance = true\nelectrons = true";
    let (sampling, gain) = chosen(Place::Even, "sodium-low-pressure", &SENSORS[0], output_keys);
    assert!(sampling == WavelengthSampling::Response && gain.should_apply(), "{gain:?}");
    // Where no electrons are summed the key is idle, and the plan says so.
    let plan = job(Place::Even, "D65", &SENSORS[0], "accumulate = \"cube\"\nwavelength_density = \"response\"").plan();
    assert!(plan.cameras[0].settings.spectral_gain.is_none());
    assert!(plan.notes.iter().any(|remark| remark.text.contains("no pixels sum electrons")), "{:?}", plan.notes);
}
