//! The page of a result: refusals, and the content read back by Chromium.

use crate::browser::Browser;
use crate::support::{BALL, etendue, root, text};
use etendue_io::exr::{ExrFile, parse_channel_name, read_exr};
use etendue_io::inspect::Preview;
use etendue_io::photograph::read_photograph;
use etendue_testkit::skip::skipped;
use std::fs;
use std::path::{Path, PathBuf};

const JOB: &str = r#"
[sequence]
frame_rate_hz = 10
[render]
spp = 8
replicates = 2
[output]
radiance = true
variance = true
electrons = true
signal_breakdown = true
boxes = true
optical_flow = "exr"
[cameras.isp]
"#;

/// Renders the result of a small colour camera, with all kinds of layers.
fn result(place: &Path, name: &str, seed: &str) -> PathBuf {
    let job = place.join("job.toml");
    // Two bands of the spectrum would suffice; the default is the users' setting.
    fs::write(&job, format!("{BALL}{JOB}")).expect("written");
    let folder = place.join(name);
    etendue(["render", &text(&job), "-o", &text(&folder), "--seed", seed]).ok();
    folder
}

fn view_page(arguments: &[&str]) -> PathBuf {
    let output = etendue([&["view", "--no-open"], arguments].concat()).ok();
    PathBuf::from(output.out.trim())
}

#[test]
fn a_page_is_made_replaced_and_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = place.path().join("out");
    fs::create_dir_all(&folder).expect("made");
    let image = Preview { width: 2, height: 1, rgb: vec![[0, 1, 2], [253, 254, 255]] }.to_png().expect("encoded");
    fs::write(folder.join("picture.png"), &image).expect("written");
    let page = view_page(&[&text(&folder)]);
    assert_eq!(page, folder.join("view/index.html"));
    assert_eq!(view_page(&[&text(&folder)]), page, "an earlier page is replaced");
    let one = text(&place.path().join("one.html"));
    view_page(&[&text(&folder), "-o", &one]);
    etendue(["view", &text(&folder), "-o", &one]).refused(&["one.html", "already exists", "--overwrite"]);
    view_page(&[&text(&folder), "-o", &one, "--overwrite"]);
    etendue(["view", &text(&place.path().join("none"))]).refused(&[
        "none",
        "does not exist",
        "expected the folder of a result",
    ]);
    etendue(["view", &text(&folder), "--max-mb", "0"]).refused(&["--max-mb", "1 to 1000"]);
    let camera = text(&root().join("scenes/cameras/ccd-mono.toml"));
    let flat = text(&place.path().join("flat"));
    let size = ["--set", "sensor.width_px=64", "--set", "sensor.height_px=64"];
    etendue([&["flat", &camera, "--wavelength-nm", "550", "--photons", "500", "-o", &flat], &size[..]].concat()).ok();
    let page = fs::read_to_string(view_page(&[&flat])).expect("a page");
    assert!(page.contains("\"kind\":\"raw\""), "a raw of the bare sensor has its levels");
    fs::write(folder.join("picture.png"), &image[..20]).expect("written");
    let other = place.path().join("page");
    etendue(["view", &text(&folder), "-o", &text(&other)]).refused(&["picture.png"]);
    assert!(!other.exists(), "nothing is half-written");
}

/// Value of a channel of a file at a pixel.
fn at(file: &ExrFile, name: &str, [x, y]: [usize; 2]) -> f64 {
    let samples = file.channel(name).unwrap_or_else(|| panic!("no channel {name}")).to_floats();
    f64::from(samples[y * file.width + x])
}

#[test]
fn chromium_reads_from_the_page_what_is_in_the_files() {
    let Ok(program) = std::env::var("ETENDUE_CHROMIUM") else {
        skipped("chromium_reads_from_the_page_what_is_in_the_files", "ETENDUE_CHROMIUM names no browser");
        return;
    };
    let place = tempfile::tempdir().expect("a temporary folder");
    let [a, b] = ["a", "b"].map(|name| result(place.path(), name, if name == "a" { "1" } else { "2" }));
    let folder = view_page(&[&text(&a), "--beside", &text(&b)]);
    let alone = view_page(&[&text(&a), "-o", &text(&place.path().join("alone.html"))]);
    let mut browser = Browser::start(&program, [1200, 800]);
    every_layer_is_drawn(&mut browser, &alone);
    values_are_those_of_the_files(&mut browser, &alone, &a.join("front"));
    two_results_are_shown_together(&mut browser, &folder, [&a, &b].map(|result| result.join("front")));
    assert_eq!(browser.complaints, [""; 0], "the page complains of nothing");
}

fn every_layer_is_drawn(browser: &mut Browser, page: &Path) {
    browser.open(page, "");
    let keys = browser.value("[...document.querySelectorAll('nav button')].map((button) => button.dataset.key)");
    let keys: Vec<String> = serde_json::from_value(keys).expect("keys");
    for layer in
        ["picture", "raw", "radiance", "electrons", "signal_breakdown", "depth", "instance", "flow.forward", "N"]
    {
        assert!(keys.iter().any(|key| key.ends_with(&format!("/{layer}"))), "{layer} is not among {keys:?}");
    }
    for key in &keys {
        browser.navigate(&format!("layer={key}&boxes=1&arrows=1"));
        // A copy of one pixel, because reading canvases drawn by the graphics card gives warnings.
        let middle = "(() => { const c = document.querySelector('.pane canvas'), one = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true }); \
                      one.drawImage(c, -(c.width >> 1), -(c.height >> 1)); return one.getImageData(0, 0, 1, 1).data[3]; })()";
        assert_eq!(browser.value(middle), 255, "{key} is drawn");
        let current = browser.value("document.querySelector('nav button[aria-current=\"true\"]').dataset.key");
        assert_eq!(current, *key);
    }
}

fn values_are_those_of_the_files(browser: &mut Browser, page: &Path, files: &Path) {
    let pixel = [22, 15];
    let truth = read_exr(&files.join("ground_truth.exr")).expect("a file");
    browser.open(page, "layer=depth&at=22,15");
    assert_eq!(browser.numbers("depth"), [at(&truth, "depth.Z", pixel)]);
    assert!(browser.text("#where").contains("column 22, row 15"));
    browser.key("ArrowRight");
    assert_eq!(browser.numbers("depth"), [at(&truth, "depth.Z", [23, 15])]);
    browser.navigate("layer=instance&at=22,15");
    assert_eq!(browser.numbers("instance"), [at(&truth, "instance.ID", pixel)]);
    assert!(browser.text("#probe").contains("ball"), "{}", browser.text("#probe"));
    let raw = &read_photograph(&files.join("raw.0000.png")).expect("a raw").channels[0];
    browser.navigate("layer=raw&at=22,15");
    assert_eq!(browser.numbers("raw"), [f64::from(raw.samples[15 * 40 + 22])]);
    light_is_that_of_the_file(browser, &read_exr(&files.join("radiance.exr")).expect("a file"), pixel);
    let parts = read_exr(&files.join("signal_breakdown.0000.exr")).expect("a file");
    browser.navigate("layer=signal_breakdown&at=22,15");
    assert_eq!(browser.numbers("signal"), [at(&parts, "signal", pixel)]);
    browser.navigate("layer=depth");
    browser.key("Escape");
    // The cursor: the pixel under the middle of the pane is that of the middle of the image, 40 × 28 pixels.
    let middle = "(() => { const box = document.querySelector('.pane').getBoundingClientRect(); return [box.x + box.width / 2 + 3, box.y + box.height / 2 + 3]; })()";
    let middle: [f64; 2] = serde_json::from_value(browser.value(middle)).expect("a place");
    browser.mouse(middle, false);
    assert_eq!(browser.text("#where"), "column 20, row 14");
    browser.mouse(middle, true);
    assert_eq!(browser.text("#where"), "column 20, row 14 (marked)");
    assert_eq!(browser.numbers("depth"), [at(&truth, "depth.Z", [20, 14])]);
    browser.key("j");
    assert_ne!(browser.value("document.querySelector('nav button[aria-current=\"true\"]').textContent"), "depth");
}

fn light_is_that_of_the_file(browser: &mut Browser, file: &ExrFile, pixel: [usize; 2]) {
    browser.navigate(&format!("layer=radiance&at={},{}", pixel[0], pixel[1]));
    let bands = file.channels.iter().filter(|c| parse_channel_name(&c.name).is_some_and(|name| !name.variance));
    let bands: Vec<f64> = bands.map(|channel| at(file, &channel.name, pixel)).collect();
    let width_nm: f64 = file.attributes["etendue:band_width_nm"].parse().expect("a width");
    let total = width_nm * bands.iter().sum::<f64>();
    // Each band is rounded to 11 binary digits.
    let near = |actual: f64, value: f64| (actual - value).abs() <= value.abs() / 2048.0;
    let actual = browser.numbers("over all bands")[0];
    assert!(near(actual, total), "{actual} for {total}");
    let [r, g, b] = ["R", "G", "B"].map(|name| at(file, name, pixel));
    let luminance = 0.212_672_9 * r + 0.715_152_2 * g + 0.072_175 * b;
    let actual = browser.numbers("luminance")[0];
    assert!(near(actual, luminance), "{actual} for {luminance} cd/m²");
    let points = browser.value("document.querySelector('#chart polyline').getAttribute('points').split(' ').length");
    assert_eq!(points, 2 * bands.len(), "a step for each band");
    assert!(browser.text("#chart").contains("W·m⁻²·sr⁻¹·nm⁻¹") && browser.text("#chart").contains("nm"));
    assert_eq!(browser.value("document.querySelectorAll('#chart polygon').length"), 1, "the standard error");
}

/// As in a page whose sensors have different effects: planes of only one result do not shift the others.
fn planes_are_subtracted_by_name(browser: &mut Browser) {
    let script = std::fs::read_to_string(root().join("crates/view/page/maps.js")).expect("the page's script");
    let (_, script) = script.split_once("const APART").expect("what a difference is made by");
    let mut difference = |kind: &str, of_a: &str, of_b: &str| {
        let layer = |names: &str| {
            let planes = names.split(' ').map(|name| format!("{{ name: '{name}' }}")).collect::<Vec<_>>().join(", ");
            format!("{{ kind: '{kind}', width: 1, height: 1, planes: [{planes}] }}")
        };
        // A plane's number is the length of its name, and ten times that in B.
        let numbers = |names: &str, gain: usize| {
            format!("{:?}", names.split(' ').map(|name| [gain * name.len()]).collect::<Vec<_>>())
        };
        let (a, b) = (layer(of_a), layer(of_b));
        let expression = format!("differenceOf({a}, {b}, {}, {})", numbers(of_a, 1), numbers(of_b, 10));
        browser.value(&format!(
            "(() => {{ const APART{script}; const d = {expression}; return d && [d[1].map(([v]) => v), d[0].left_out]; }})()"
        ))
    };
    let actual = difference("parts", "signal dark smear", "lag2 signal dark");
    assert_eq!(actual, serde_json::json!([[54, 36], ["smear (only A)", "lag2 (only B)"]]));
    assert_eq!(difference("number", "x", "yy"), serde_json::Value::Null);
    assert_eq!(difference("colour", "R G B", "R G C"), serde_json::Value::Null);
}

fn two_results_are_shown_together(browser: &mut Browser, page: &Path, [a, b]: [PathBuf; 2]) {
    let image = |folder: &Path| {
        let image = read_photograph(&folder.join("picture.0000.png")).expect("a picture");
        f64::from(image.channels[0].samples[15 * 40 + 22])
    };
    let red = [image(&a), image(&b)];
    browser.open(page, "layer=picture&show=side&at=22,15");
    assert_eq!(browser.numbers("picture R"), red);
    assert_eq!(browser.value("document.querySelectorAll('.pane').length"), 2);
    browser.key("w");
    assert_eq!(browser.value("document.querySelectorAll('.pane').length"), 1);
    assert_eq!(browser.numbers("picture R"), red);
    browser.key("d");
    assert_eq!(browser.numbers("picture R"), [red[1] - red[0]]);
    browser.navigate("layer=depth&show=difference&at=22,15");
    assert_eq!(browser.numbers("root mean square"), [0.0], "both look at the same scene");
    browser.navigate("layer=radiance&show=difference&at=22,15");
    assert!(browser.numbers("root mean square")[0] > 0.0, "of other seeds the light differs");
    planes_are_subtracted_by_name(browser);
}
