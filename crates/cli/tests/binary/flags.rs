//! Every flag of a measurement has an effect: each is set alone on a suitable image, and the printed, written or refused output must differ from that
//! without it. The list of flags is that of `--help`, so that a new flag is tried or fails the test.

use crate::lens_files::{BK7, zmx};
use crate::support::{etendue, text};
use etendue_core::Plane;
use etendue_core::quantity::{DigitalNumber, Display};
use etendue_io::photograph::Encoding;
use etendue_io::png::{encode_display, encode_raw16};
use std::path::Path;

/// Flags that need another one, and are tried with it, or that concern the process.
const TESTED_ELSEWHERE: [&str; 4] = ["--help", "--limit", "--camera", "--overwrite"];

/// Flags of all measurements of images, and values that change every image of this test.
const PICTURE: &[(&str, &str)] = &[
    ("--channel", "R"),
    ("--cfa", "RGGB"),
    ("--region", "8,4,200,160"),
    ("--encoding", "srgb"),
    ("--black", "300"),
    ("--full-scale", "12000"),
];
const CHART: &[(&str, &str)] = &[
    ("--target", "checkerboard"),
    ("--grid", "5x4"),
    ("--channel", "R"),
    ("--cfa", "RGGB"),
    ("--encoding", "linear"),
    ("--region", "40,20,200,160"),
    ("--size-px", "10x10"),
    ("--points", ""),
];

/// Output of a run, its exit status, and its files.
fn run(words: &[&str], out: &Path) -> (i32, String, String, Vec<String>) {
    let result = etendue(words);
    let files = std::fs::read_dir(out).expect("a folder").map(|f| text(&f.expect("a file").path()));
    (result.status, result.out, result.err, files.collect())
}

/// The flags that `--help` lists.
fn flags(kind: &str) -> Vec<String> {
    let help = etendue(["measure", kind, "--help"]).ok().out;
    let first = |line: &str| line.split_whitespace().find(|word| word.starts_with("--")).map(str::to_owned);
    let listed = help.lines().filter(|line| line.trim_start().starts_with('-')).filter_map(first);
    listed.map(|flag| flag.trim_end_matches([',', '.']).to_owned()).collect()
}

#[track_caller]
fn each_changes_something(base: &[&str], values: &[&[(&str, &str)]]) {
    let kind = base[0];
    let folder = tempfile::tempdir().expect("a folder");
    let empty = folder.path().join("without");
    std::fs::create_dir(&empty).expect("a folder");
    let words: Vec<&str> = ["measure"].into_iter().chain(base.iter().copied()).collect();
    let without = run(&words, &empty);
    assert_eq!(without.0, 0, "{words:?}: {}", without.2);
    let lost = text(&folder.path().join("lost.json"));
    for (i, flag) in flags(kind).iter().filter(|flag| !TESTED_ELSEWHERE.contains(&flag.as_str())).enumerate() {
        let out = folder.path().join(i.to_string());
        std::fs::create_dir(&out).expect("a folder");
        let file = |name: &str| text(&out.join(name));
        let known = values.iter().flat_map(|list| list.iter()).find(|(name, _)| name == flag);
        let value = match (flag.as_str(), known) {
            (_, Some((_, value))) => (*value).to_owned(),
            ("--json", None) => String::new(),
            ("--plot", None) => file("plot.svg"),
            ("--html", None) => file("page.html"),
            ("--camera-out", None) => file("camera.toml"),
            ("--truth", None) => lost.clone(),
            _ => panic!("measure {kind}: no value of {flag} is tried; add one to this test"),
        };
        // A value from the base is replaced.
        let mut all = words.clone();
        match all.iter().position(|word| word == flag) {
            Some(place) => all[place + 1] = value.as_str(),
            None => all.extend([flag.as_str(), value.as_str()].into_iter().filter(|word| !word.is_empty())),
        }
        assert_ne!(run(&all, &out), without, "measure {kind}: {flag} {value} changes nothing");
    }
}

/// Numbers of 16 bits, the mean of 16 samples each.
fn picture(folder: &Path, name: &str, [w, h]: [usize; 2], brightness: impl Fn(f64, f64) -> f64) -> String {
    let at = |k: usize| (k as f64 + 0.5) / 4.0;
    let pixel = |i: usize| {
        let samples = (0..16).map(|k| brightness((i % w) as f64 + at(k % 4), (i / w) as f64 + at(k / 4)));
        (samples.sum::<f64>() / 16.0).round() as u32
    };
    let plane = Plane::<DigitalNumber>::from_samples(w, h, (0..w * h).map(pixel).collect()).expect("a rectangle");
    let file = folder.join(name);
    std::fs::write(&file, encode_raw16(&plane).expect("a picture")).expect("written");
    text(&file)
}

/// A number from −1 to 1 that differs by position and frame.
fn scatter(x: f64, y: f64, frame: usize) -> f64 {
    let mixed = (x as usize * 73_856_093) ^ (y as usize * 19_349_663) ^ (frame * 83_492_791 + 12_345);
    ((mixed ^ (mixed >> 13)).wrapping_mul(0x5bd1_e995) % 65_537) as f64 / 32_768.0 - 1.0
}

fn dot(x: f64, y: f64) -> f64 {
    let (u, v) = (x - x.round(), y - y.round());
    if u * u + v * v < 0.0625 { 0.1 } else { 0.9 }
}

const SIZE: [usize; 2] = [320, 240];

#[test]
fn flags_of_point_chart_measurements() {
    let folder = tempfile::tempdir().expect("a folder");
    let grey = picture(folder.path(), "dots.png", SIZE, |x, y| 20_000.0 * dot(x / 20.3 + 0.25, y / 20.3 + 0.25));
    each_changes_something(&["distortion", &grey], &[CHART, &[("--encoding", "srgb"), ("--centre-px", "150,120")]]);
    let at = |k: usize| (k as f64 + 0.5) / 4.0;
    let level = |x: f64, y: f64, shift: f64| {
        let samples = (0..16).map(|k| dot((x + at(k % 4) - shift) / 20.0 + 0.25, (y + at(k / 4)) / 20.0 + 0.25));
        etendue_spectra::colour::encode(samples.sum::<f64>() as f32 / 16.0)
    };
    let pixel = |i: usize| {
        let (x, y) = ((i % SIZE[0]) as f64, (i / SIZE[0]) as f64);
        [level(x, y, 0.4), level(x, y, 0.0), level(x, y, -0.2)]
    };
    let pixels = (0..SIZE[0] * SIZE[1]).map(pixel).collect();
    let plane = Plane::<Display>::from_samples(SIZE[0], SIZE[1], pixels).expect("a rectangle");
    let colours = folder.path().join("colours.png");
    std::fs::write(&colours, encode_display(&plane, &Encoding::Srgb).expect("a picture")).expect("written");
    each_changes_something(&["chromatic", &text(&colours)], &[CHART]);
}

#[test]
fn flags_of_edge_and_flat_field_measurements() {
    let folder = tempfile::tempdir().expect("a folder");
    // 5° from the columns, slightly non-uniform.
    let edge = picture(folder.path(), "edge.png", SIZE, |x, y| {
        let level = if x - 160.0 < 0.0875 * (y - 120.0) { 2_000.0 } else { 14_000.0 };
        level * (1.0 + 1e-4 * x + 1e-7 * x * x) + 100.0 * scatter(x, y, 0)
    });
    let own: &[(&str, &str)] = &[
        ("--edge", "100,40,120,160"),
        ("--edge-degree", "4"),
        ("--reach-px", "4"),
        ("--shading-degree", "2"),
        ("--pixel-pitch-um", "3"),
        ("--pixels-per-degree", "40"),
    ];
    each_changes_something(&["sfr", &edge], &[own, PICTURE]);
    let uniform = picture(folder.path(), "even.png", SIZE, |x, y| {
        let r2 = ((x - 160.0) * (x - 160.0) + (y - 120.0) * (y - 120.0)) / 40_000.0;
        15_000.0 * (1.0 - 0.3 * r2) + 300.0 + 50.0 * scatter(x, y, 0)
    });
    let own: &[(&str, &str)] = &[("--centre-px", "150,110"), ("--rings", "6"), ("--pixel-pitch-um", "3")];
    each_changes_something(&["vignetting", &uniform], &[own, PICTURE]);
}

#[test]
fn flags_of_patch_measurements() {
    let folder = tempfile::tempdir().expect("a folder");
    let patches = |name: &str, frame: usize| {
        picture(folder.path(), name, SIZE, |x, y| {
            [600.0, 10_000.0, 15_000.0][(x / 107.0) as usize] + 300.0 * scatter(x, y, frame)
        })
    };
    let first = patches("0.png", 0);
    let flare = ["flare", &first, "--trap", "0,0,90,200", "--white", "220,0,90,200"];
    each_changes_something(
        &flare,
        &[
            &[("--trap", "2,2,50,50"), ("--white", "230,0,50,50"), ("--encoding", "srgb"), ("--region", "0,0,100,100")],
            PICTURE,
        ],
    );
    let cdp = ["cdp", &first, "--darker", "110,0,90,200", "--brighter", "220,0,90,200", "--contrast", "0.5"];
    let flat = picture(folder.path(), "flat.png", SIZE, |x, _| 10_000.0 - 10.0 * x);
    let own: &[(&str, &str)] = &[
        ("--darker", "0,0,90,200"),
        ("--brighter", "0,0,90,200"),
        ("--contrast", "0.6"),
        ("--tolerance", "0.02"),
        ("--flat", &flat),
    ];
    each_changes_something(&cdp, &[own, PICTURE]);
    let frames: Vec<String> = (0..8)
        .map(|i| picture(folder.path(), &format!("even{i}.png"), SIZE, |x, y| 10_000.0 + 300.0 * scatter(x, y, i)))
        .collect();
    let noise: Vec<&str> = ["noise"].into_iter().chain(frames.iter().map(String::as_str)).collect();
    each_changes_something(&noise, &[&[("--full-scale", "9000")], PICTURE]);
}

#[test]
fn flags_of_depth_and_lens_measurements() {
    let folder = tempfile::tempdir().expect("a folder");
    let depth = |name: &str, metres: &dyn Fn(usize, usize) -> f32| {
        let mut bytes = b"Pf\n64 48\n-1.0\n".to_vec();
        (0..64 * 48).for_each(|i| bytes.extend(metres(i % 64, i / 64).to_le_bytes()));
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).expect("written");
        text(&file)
    };
    let truth = |x: usize| if x < 32 { 2.0_f32 } else { 6.0 };
    let of_truth = depth("truth.pfm", &|x, _| truth(x));
    let estimate = depth("estimate.pfm", &|x, y| {
        truth(x) * (1.05 + 0.004 * y as f32) + if (30..36).contains(&x) { 1.5 } else { 0.0 }
    });
    let own: &[(&str, &str)] = &[
        ("--estimate-channel", "none"),
        ("--truth-channel", "none"),
        ("--estimate-unit-m", "0.9"),
        ("--truth-unit-m", "0.9"),
        ("--ranges-m", "0,4,9"),
        ("--outlier-ratio", "0.2"),
        ("--outlier-least-m", "0.5"),
        ("--focal-base-px-m", "400"),
        ("--align", "median"),
        ("--edge-ratio", "5"),
        ("--edge-px", "9"),
    ];
    each_changes_something(&["depth", &estimate, &of_truth], &[own]);
    let write = |name: &str, content: &str| {
        let file = folder.path().join(name);
        std::fs::write(&file, content).expect("written");
        text(&file)
    };
    let lens = write("lens.zmx", &zmx("", BK7));
    // n² = 1 + 1.56 for N-BK7.
    let glasses = write("own.agf", "NM N-BK7 2 0 1.6 60 0\nCD 1.56 0 0 0 0 0\nLD 0.3 1.2\n");
    let own: &[(&str, &str)] = &[
        ("--set", "lens.f_number=12"),
        ("--f-number", "16"),
        ("--fields", "3"),
        ("--glasses", &glasses),
        ("--picture-radius-mm", "5"),
        ("--wavelength-nm", "486"),
    ];
    each_changes_something(&["lens", &lens, "--fields", "2"], &[own]);
}
