//! Drops on the windscreen in images: their refraction, and their times.

use crate::support::{assert_same, etendue, rendered, text};
use etendue_io::exr::{ExrSamples, read_exr};
use std::path::Path;

const SIDE: usize = 24;

/// A camera of 4.6° that looks at the horizon through flat glass 50 mm in front of it.
const JOB: &str = r#"format = 1
[scene.environment]
type = "uniform"
luminance_cd_m2 = 300
illuminant = "D65"
FLOOR
[[cameras]]
name = "c"
position_m = [0, 0, 1.4]
look_at_m = [9, 0, 1.4]
[cameras.lens]
type = "pinhole"
focal_length_mm = 6
f_number = 4
[cameras.sensor]
width_px = 24
height_px = 24
pixel_pitch_um = 20
exposure_s = 1e-3
cfa = "mono"
quantum_efficiency = 0.5
full_well_e = 50_000
read_noise_e = 4
dark_current_e_s = 0
black_level_dn = 64
gain_dn_per_e = 0.05
bits = 12
[cameras.external_optics.windscreen]
distance_mm = 50
double_image = false
DROPS
[render]
spp = 16
integrator = "direct"
wavelengths_per_path = 4
seed = 5
[output]
electrons = true
raw = false
picture = false
ground_truth = true
"#;

/// Black ground up to the horizon.
const FLOOR: &str = r#"
[[scene.materials]]
name = "black"
type = "diffuse"
reflectance = 0
[[scene.objects]]
name = "floor"
shape = { type = "quad", size_m = [4000, 4000] }
material = "black"
"#;

/// One drop that fills the image.
const ONE: &str = r#"
[cameras.external_optics.windscreen.drops]
size_mm = [1e-6, 1e-6]
count = 1
min_radius_mm = 4
max_radius_mm = 4
dispersion = false
"#;

/// Rain on the glass, in a rectangle that covers the left two thirds of the image.
const RAIN: &str = r#"
[cameras.external_optics.windscreen.drops]
size_mm = [3, 6]
offset_mm = [-1, 0]
count = 12
min_radius_mm = 0.1
max_radius_mm = 0.4
dispersion = false
"#;

const CHANGING: &str = r#"
arrivals_per_s = 40
drying_s = 3
[cameras.external_optics.windscreen.drops.sliding]
speed_mm_s = 8
still_radius_mm = 0.2
[cameras.external_optics.windscreen.drops.wiper]
pivot_mm = [0, 20]
blade_mm = [0, 30]
angles_deg = [-60, 60]
sweep_s = 0.5
period_s = 2
start_s = 0.9
[sequence]
frame_rate_hz = 5
"#;

struct DropsScene {
    _place: tempfile::TempDir,
    job: String,
}

fn scene(floor: &str, drops: &str) -> DropsScene {
    let place = tempfile::tempdir().expect("a temporary folder");
    let path = place.path().join("job.toml");
    std::fs::write(&path, JOB.replace("FLOOR", floor).replace("DROPS", drops)).expect("written");
    DropsScene { job: text(&path), _place: place }
}

impl DropsScene {
    /// Electrons of all pixels, row by row.
    fn electrons(&self) -> Vec<f64> {
        self.plane("electrons.exr", "electrons")
    }

    /// A layer of a file of the camera, row by row.
    fn plane(&self, name: &str, channel: &str) -> Vec<f64> {
        let place = tempfile::tempdir().expect("a temporary folder");
        let output = text(&place.path().join("out"));
        etendue(["render", &self.job, "-o", &output]).ok();
        let file = read_exr(Path::new(&format!("{output}/c/{name}"))).expect("a picture");
        let Some(ExrSamples::Float(values)) = file.channel(channel) else { panic!("{channel}") };
        values.iter().map(|v| f64::from(*v)).collect()
    }
}

/// The drop shows the sky below and the ground above.
#[test]
fn a_drop_turns_the_picture_upside_down() {
    let rows = |electrons: &[f64]| {
        let mean = |rows: std::ops::Range<usize>| {
            let values = &electrons[rows.start * SIDE..rows.end * SIDE];
            values.iter().sum::<f64>() / values.len() as f64
        };
        // Except for the two rows at the horizon.
        [mean(0..SIDE / 2 - 1), mean(SIDE / 2 + 1..SIDE)]
    };
    let [above, below] = rows(&scene(FLOOR, "").electrons());
    assert!(above > 100.0 && below == 0.0, "{above} {below}");
    let [upper, lower] = rows(&scene(FLOOR, ONE).electrons());
    assert!(upper == 0.0 && lower > 0.9 * above, "{upper} {lower}");
}

/// In uniform light the middle of a drop is brighter by T(glass, water) T(water, air)/T(glass, air), 1.0188 for 1.52 and 1.333.
#[test]
fn a_drop_in_even_light_is_seen_by_its_fresnel_losses_alone() {
    let (dry, wet) = (scene("", "").electrons(), scene("", ONE).electrons());
    for (i, (dry, wet)) in dry.iter().zip(&wet).enumerate() {
        let (x, y) = (i % SIDE, i / SIDE);
        let ratio = wet / dry;
        // Losses at the sphere change by less than a tenth of a per cent up to 15° from its middle.
        let (dx, dy) = (x.abs_diff(SIDE / 2), y.abs_diff(SIDE / 2));
        let expected = if dx < 4 && dy < 4 { 1.017..1.0195 } else { 0.9..1.0195 };
        assert!(expected.contains(&ratio), "{x} {y}: {ratio}");
    }
}

#[test]
fn beside_drops_and_in_ground_truth_nothing_changes() {
    let (dry, wet) = (scene(FLOOR, ""), scene(FLOOR, RAIN));
    let [a, b] = [&dry, &wet].map(|scene| scene.plane("ground_truth.exr", "distance.Z"));
    let bits = |plane: Vec<f64>| plane.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert!(a.iter().filter(|d| d.is_finite()).count() > SIDE * 10, "the ground is seen");
    assert_eq!(bits(a), bits(b));
    let same = |columns: std::ops::Range<usize>| {
        let pixels = dry.electrons().into_iter().zip(wet.electrons()).enumerate();
        pixels.filter(|(i, (a, b))| columns.contains(&(i % SIDE)) && a.to_bits() == b.to_bits()).count()
    };
    assert_eq!(same(22..SIDE), 2 * SIDE, "beyond their rectangle by more than a radius");
    assert!(same(0..16) < 16 * SIDE - 8);
}

#[test]
fn a_frame_of_changing_drops_is_the_same_alone_and_in_shards() {
    let rain = scene(FLOOR, &format!("{RAIN}{CHANGING}"));
    let all = rendered(&rain.job, &["--frames", "0..6"]);
    let alone = rendered(&rain.job, &["--frames", "4..5", "--threads", "1"]);
    for name in ["c/electrons.0004.exr", "c/ground_truth.0004.exr"] {
        assert!(all[name] == alone[name], "{name}");
    }
    for frame in 1..6 {
        assert_ne!(all["c/electrons.0000.exr"], all[&format!("c/electrons.{frame:04}.exr")], "frame {frame}");
    }
    let place = tempfile::tempdir().expect("a temporary folder");
    let part = |i: u32| text(&place.path().join(i.to_string()));
    for i in 0..2 {
        let shard = format!("{i}/2");
        etendue(["render", &rain.job, "-o", &part(i), "--frames", "3..5", "--shard", &shard]).ok();
    }
    let merged_folder = text(&place.path().join("whole"));
    etendue(["merge", "-o", &merged_folder, &part(0), &part(1)]).ok();
    let merged = crate::support::contents(Path::new(&merged_folder));
    assert_same(&rendered(&rain.job, &["--frames", "3..5"]), &merged, "two shards");
}

#[test]
fn the_plan_says_how_drops_change() {
    let rain = scene(FLOOR, &format!("{RAIN}{CHANGING}"));
    let plan = etendue(["plan", &rain.job]).ok().out;
    for phrase in [
        "12 of 0.1 to 0.4 mm radius",
        "slide at up to 8 mm/s from 0.2 mm",
        "dry in 3 s",
        "40 per second",
        "every 2 s from 0.9 s",
    ] {
        assert!(plan.contains(phrase), "{phrase}: {plan}");
    }
    assert!(plan.contains("each sample has a time within"), "{plan}");
    let still = etendue(["plan", &scene(FLOOR, RAIN).job]).ok().out;
    assert!(!still.contains("each sample has a time within"), "{still}");
}
