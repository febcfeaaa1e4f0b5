//! Jobs that begin far from the time 0: they have the same light as near it, and keep the full precision of every time.

use etendue::{ExistingFiles, JobRequest, MemoryFiles, NullObserver, RenderOptions};
use etendue_io::exr::read_exr;
use std::path::Path;

/// A square that moves between two keys under a light with pulses of 1 MHz and one with a programme that runs once; the exposure is 0.25 µs.
fn job(start: &str, second: &str, third: &str, more: &str) -> String {
    format!(
        "format = 1\n[sequence]\nframe_rate_hz = 10\nstart_s = {start}\n\
         [scene]\nmaterials = [{{ name = \"m\", type = \"diffuse\", reflectance = 0.5 }}]\n\
         [[scene.objects]]\nname = \"p\"\nshape = {{ type = \"quad\", size_m = [1, 1] }}\nmaterial = \"m\"\n\
         keys = [{{ time_s = {start}, position_m = [0, 0, 0] }}, {{ time_s = {second}, position_m = [0.5, 0, 0] }}]\n\
         [[scene.lights]]\ntype = \"point\"\nname = \"fast\"\nposition_m = [0, 0, 2]\nintensity_cd = 1000\nilluminant = \"E\"\n\
         modulation = {{ type = \"pwm\", frequency_hz = 1e6, duty_cycle = 0.3 }}\n\
         [[scene.lights]]\ntype = \"point\"\nname = \"slow\"\nposition_m = [1, 0, 2]\nintensity_cd = 500\nilluminant = \"E\"\n\
         modulation = {{ type = \"programme\", repeats = false, delay_s = {third}, steps = [{{ level = 1, duration_s = 0.1 }}, \
         {{ level = 0.25, duration_s = 1 }}] }}\n\
         [[cameras]]\nname = \"c\"\nposition_m = [0, 0, 3]\nlook_at_m = [0, 0, 0]\nup = [1, 0, 0]\n\
         lens = {{ type = \"pinhole\", focal_length_mm = 5, f_number = 8 }}\n\
         sensor = {{ width_px = 8, height_px = 6, pixel_pitch_um = 800, shutter = {{ type = \"global\", exposure_s = 2.5e-7 }} }}\n\
         [render]\nspp = 8\nmax_bounces = 1\nwavelength_range_nm = [549.5, 550.5]\nband_width_nm = 1\n\
         [output]\nradiance = true\nboxes = true\n{more}"
    )
}

fn render(text: &str, out: &Path) -> Result<(), String> {
    let mut files = MemoryFiles::new();
    files.add_text("job.toml", text);
    let job = JobRequest::new("job.toml").open_in(&files).map_err(|error| error.to_string())?;
    let options = RenderOptions { frames: 0..3, ..RenderOptions::default() };
    let results = job.render(&options, &NullObserver).map_err(|error| error.to_string())?;
    results.save(out, ExistingFiles::Refuse, &NullObserver).map(drop).map_err(|error| error.to_string())
}

/// Reads the radiance of all frames.
fn radiance(out: &Path) -> Vec<f32> {
    let frame =
        |n: u32| read_exr(&out.join(format!("c/radiance.{n:04}.exr"))).unwrap_or_else(|error| panic!("{error}"));
    let floats = |n: u32| frame(n).channels.into_iter().flat_map(|channel| channel.samples.to_floats());
    (0..3).flat_map(floats).collect()
}

fn json(out: &Path, name: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(out.join("c").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    serde_json::from_str(&text).expect("JSON")
}

/// Whole seconds change neither the phase of 1 MHz nor the position between keys: the light is bit-identical.
#[test]
fn light_is_the_same_at_unix_times_as_near_zero() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = |name: &str| folder.path().join(name);
    render(&job("1e-7", "1.0000001", "0.2", ""), &out("near")).expect("rendered");
    let near = radiance(&out("near"));
    assert!(near.iter().any(|value| *value > 0.0));
    for second in ["1700000000", "10000000000", "-5000000"] {
        let time_text = |fraction: &str| match second.strip_prefix('-') {
            // -5000000 + 0.2, in digits.
            Some(_) => format!(
                "\"{}\"",
                [("0000001", "-4999999.9999999"), ("1", "-4999998.9999999"), ("2", "-4999999.8")]
                    .iter()
                    .find(|(name, _)| *name == fraction)
                    .expect("one of three")
                    .1
            ),
            None => match fraction {
                "1" => format!("\"{}.0000001\"", second.parse::<i64>().expect("digits") + 1),
                fraction => format!("\"{second}.{fraction}\""),
            },
        };
        render(&job(&time_text("0000001"), &time_text("1"), &time_text("2"), ""), &out(second)).expect("rendered");
        assert_eq!(radiance(&out(second)), near, "{second}");
    }
    let frame = json(&out("1700000000"), "frame.0001.json");
    assert_eq!(frame["time"], "1700000000.1000001");
    assert_eq!(frame["time_s"], 1_700_000_000.100_000_1);
    assert_eq!(frame["exposure"]["end"], "1700000000.10000035");
    assert_eq!(json(&out("1700000000"), "boxes.0001.json")["time"], "1700000000.100000225");
    assert_eq!(json(&out("near"), "frame.0001.json").get("time"), None, "numbers near zero need no text");
}

#[test]
fn a_rounded_number_gives_a_warning_and_old_drops_are_refused() {
    let summary = |text: &str| {
        let mut files = MemoryFiles::new();
        files.add_text("job.toml", text);
        JobRequest::new("job.toml").open_in(&files).map(|job| job.summary()).map_err(|error| error.to_string())
    };
    let rounded = summary(&job("1700000000.1", "1700000001.1", "0", "")).expect("a job");
    assert!(rounded.contains("job.toml:4:11: sequence.start_s, job.toml:11:20: scene.objects.p.keys[0].time_s, job.toml:11:71: scene.objects.p.keys[1].time_s: a number this far from zero is rounded to a multiple of 238.4 ns"), "{rounded}");
    let text = summary(&job("\"1700000000.1\"", "\"1700000001.1\"", "0", "")).expect("a job");
    assert!(!text.contains("multiple of"), "{text}");
    let wrong = summary(&job("\"12:30\"", "13", "0", "")).expect_err("no time");
    assert!(
        wrong.contains("job.toml:4:11: sequence.start_s: found the text \"12:30\"; give a time (s) from -1e15 to 1e15"),
        "{wrong}"
    );
    let drops = "[cameras.external_optics.windscreen]\ndistance_mm = 50\ntilt_deg = 60\n\
                 [cameras.external_optics.windscreen.drops]\nsize_mm = [80, 60]\ncount = 5\nmin_radius_mm = 0.5\nmax_radius_mm = 2\ndrying_s = 10\n";
    let old = summary(&job("1700000000", "1700000001", "0", drops)).expect_err("too old");
    assert!(old.contains("the drops begin 1700000000 s before frame 0"), "{old}");
}
