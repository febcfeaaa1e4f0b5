//! Frames with time-dependent light: equal bytes alone, in a sequence, in shards, and after an interrupted run.

use crate::support::{contents, etendue, tests, text};
use etendue_io::picture::read_image;
use etendue_scene::asset::ImagePixels;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

type Files = BTreeMap<String, Vec<u8>>;

fn job() -> String {
    text(&tests().join("jobs/moving/moving.toml"))
}

fn render(folder: &Path, options: &[&str]) {
    let arguments = ["render".to_owned(), job(), "-o".to_owned(), text(folder)];
    etendue(arguments.into_iter().chain(options.iter().map(|option| (*option).to_owned()))).ok();
}

fn rendered(options: &[&str]) -> Files {
    let place = tempfile::tempdir().expect("a temporary folder");
    render(&place.path().join("out"), options);
    contents(&place.path().join("out"))
}

#[track_caller]
fn assert_same(expected: &Files, actual: &Files, what: &str) {
    assert_eq!(expected.keys().collect::<Vec<_>>(), actual.keys().collect::<Vec<_>>(), "{what}");
    expected.iter().for_each(|(name, bytes)| assert!(actual[name] == *bytes, "{what}: {name}"));
}

#[test]
fn a_frame_alone_has_the_light_that_it_has_in_a_sequence() {
    let all = rendered(&["--frames", "0..3"]);
    let alone = rendered(&["--frames", "2..3", "--threads", "1"]);
    for name in ["left/ground_truth.0002.exr", "right/radiance.0002.exr", "right/ground_truth.0002.exr"] {
        assert!(all[name] == alone[name], "{name}");
    }
    assert_ne!(all["right/radiance.0001.exr"], all["right/radiance.0002.exr"]);
    assert_ne!(all["left/raw.0002.png"], alone["left/raw.0002.png"], "the sensor remembers the frames before");
}

#[test]
fn shards_of_frames_are_merged_to_the_same_bytes() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = |name: &str| place.path().join(name);
    let mut arguments = vec!["merge".to_owned(), "-o".to_owned(), text(&folder("whole"))];
    for index in [1, 0] {
        let part = folder(&index.to_string());
        render(&part, &["--frames", "0..2", "--shard", &format!("{index}/2")]);
        arguments.push(text(&part));
    }
    etendue(arguments).ok();
    assert_same(&rendered(&["--frames", "0..2"]), &contents(&folder("whole")), "two shards");
}

#[test]
fn what_is_made_of_all_frames_says_what_the_frames_say() {
    let all = rendered(&["--frames", "0..3"]);
    for name in ["ros/left.yaml", "ros/static_transforms.yaml", "kalibr/camchain-left.yaml", "colmap/images.txt"] {
        assert!(all.contains_key(&format!("calibration/{name}")), "{name}");
    }
    let json = |name: &str| serde_json::from_slice::<Value>(&all[name]).expect("JSON");
    let tracks = json("left/tracks.json");
    assert_eq!(tracks["frames"].as_array().map(Vec::len), Some(3));
    let of = |frame: u64| {
        let tracks = tracks["tracks"].as_array().expect("a list").iter();
        let places = tracks.filter_map(move |track| {
            let entry = track["frames"].as_array()?.iter().find(|entry| entry["frame"] == frame)?;
            Some((track["id"].clone(), track["name"].clone(), entry.clone()))
        });
        places.collect::<Vec<_>>()
    };
    for frame in 0..3 {
        let boxes = json(&format!("left/boxes.{frame:04}.json"));
        let objects = boxes["objects"].as_array().expect("a list");
        assert_eq!(objects.len(), of(frame).len(), "frame {frame}");
        for (object, (id, name, in_frame)) in objects.iter().zip(of(frame)) {
            assert_eq!((&object["id"], &object["name"], &boxes["time_s"]), (&id, &name, &in_frame["time_s"]));
            for key in ["box_3d", "visible_box_px", "amodal_box_px", "visible_fraction", "is_cut"] {
                assert_eq!(object[key], in_frame[key], "{key}");
            }
        }
    }
    let video = &all["left/picture.y4m"];
    let head = b"YUV4MPEG2 W40 H24 F20:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    assert!(video.starts_with(head));
    assert_eq!(video.len(), head.len() + 3 * ("FRAME\n".len() + 3 * 40 * 24));
    // Luma of the first pixel, in the image's own numbers.
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("picture.png");
    fs::write(&file, &all["left/picture.0002.png"]).expect("a file");
    let ImagePixels::Rgb8(pixels) = read_image(&file).expect("PNG").pixels else { panic!("8 bits") };
    let [r, g, b] = pixels[0].map(f64::from);
    let luma = 16.0 + 219.0 / 255.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b);
    let first = head.len() + 2 * ("FRAME\n".len() + 3 * 40 * 24) + "FRAME\n".len();
    assert!((f64::from(video[first]) - luma).abs() <= 0.5 + 1e-9, "{} for {luma}", video[first]);
}

#[test]
fn a_rig_has_the_files_of_a_render_without_one() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let output = etendue(["rig", &job(), "-o", &out, "--frames", "0..2"]).ok();
    assert_eq!(output.out.lines().count(), 8, "{}", output.out);
    let mut expected = rendered(&["--frames", "0..2"]);
    expected.retain(|name, _| name.starts_with("calibration/"));
    assert_same(&expected, &contents(Path::new(&out)), "rig");
    etendue(["rig", &job(), "-o", &out]).refused(&["already exists"]);
}

#[test]
fn what_needs_more_than_is_there_is_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let refused = |set: &str, phrases: &[&str]| {
        let arguments = ["render", &job(), "-o", &text(&place.path().join("out")), "--set", set].map(str::to_owned);
        etendue(arguments).refused(phrases);
    };
    refused("cameras.left.output.boxes=false", &["\"tracks\" is requested", "boxes", "add boxes = true"]);
    refused("cameras.right.output={ video = \"y4m\" }", &["\"video\" is requested", "no [isp]"]);
    refused("cameras.left.output.picture=false", &["\"video\" is requested", "request \"picture\""]);
    refused("cameras.left.isp={ picture_format = \"jpeg\" }", &["\"video\" is requested", "JPEG"]);
    let late = ["cameras.right.sensor.shutter.exposure_s", "a row takes 0.2", "frame period is 0.05 s"];
    refused("cameras.right.sensor.shutter.exposure_s=0.2", &late);
    let slow = ["cameras.left.sensor.shutter.row_time_us", "reading all rows takes", "read rows faster"];
    refused("cameras.left.sensor.shutter.row_time_us=20000", &slow);
}

/// Two unconnected cameras are rectified at first, and the right one turns by 2° between keys.
#[test]
fn pairs_that_come_apart_are_not_rectified() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let lens = "lens = { type = \"pinhole\", focal_length_mm = 4, f_number = 2 }\n\
                sensor = { width_px = 30, height_px = 20, pixel_pitch_um = 80 }";
    let keys = |y: f64, pitch_deg: f64| {
        format!(
            "keys = [{{ time_s = 0, position_m = [0, {y}, 1], rotation_deg = [0, 0, 0] }}, \
             {{ time_s = 2, position_m = [4, {y}, 1], rotation_deg = [0, {pitch_deg}, 0] }}]"
        )
    };
    let refused = |pitch_deg: f64| {
        let job = format!(
            "format = 1\n[[cameras]]\nname = \"left\"\n{}\n{lens}\noutput = {{ disparity_to = \"right\" }}\n\
             [[cameras]]\nname = \"right\"\n{}\n{lens}\n[sequence]\nframe_rate_hz = 10\n[scene]\n\
             environment = {{ type = \"uniform\", luminance_cd_m2 = 20, illuminant = \"D65\" }}\n",
            keys(0.1, 0.0),
            keys(-0.1, pitch_deg)
        );
        let file = place.path().join("pair.toml");
        fs::write(&file, job).expect("a file");
        etendue(["plan".to_owned(), text(&file)])
    };
    refused(0.0).ok();
    refused(2.0).refused(&["cameras.left.output.disparity_to", "at 1 s", "not rectified"]);
}

/// State after a kill within frame 2: complete frames 0 and 1, a file of frame 2 under its final name, no side-cars.
#[test]
fn a_run_that_was_interrupted_goes_on_to_the_same_bytes() {
    let expected = rendered(&["--frames", "0..4"]);
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    render(&out, &["--frames", "0..2"]);
    fs::remove_file(out.join("left/camera.json")).expect("it was written");
    fs::remove_file(out.join("right/camera.json")).expect("it was written");
    fs::write(out.join("left/raw.0002.png"), b"half").expect("a file");
    let modified = fs::metadata(out.join("left/raw.0001.png")).and_then(|m| m.modified()).expect("a file");
    render(&out, &["--frames", "0..4", "--resume"]);
    assert_same(&expected, &contents(&out), "resumed");
    let now = fs::metadata(out.join("left/raw.0001.png")).and_then(|m| m.modified()).expect("a file");
    assert_eq!(modified, now, "whole frames are not rendered again");
}

/// A frame's file states the digests of all others: missing, truncated, changed or exchanged files are made again.
#[test]
fn a_run_that_goes_on_believes_no_file_that_is_not_whole() {
    let expected = rendered(&["--frames", "0..3"]);
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let spoil = |what: &str, name: &str, change: &dyn Fn(&Path)| {
        let _ = fs::remove_dir_all(&out);
        for (name, bytes) in &expected {
            let file = out.join(name);
            fs::create_dir_all(file.parent().expect("a folder")).expect("made");
            fs::write(&file, bytes).expect("written");
        }
        change(&out.join(name));
        let arguments = ["render", &job(), "-o", &text(&out), "--frames", "0..3", "--resume"].map(str::to_owned);
        let output = etendue(arguments).ok();
        assert_same(&expected, &contents(&out), what);
        output.err
    };
    let gone = |file: &Path| fs::remove_file(file).expect("it was there");
    let cut = |file: &Path| fs::write(file, b"").expect("written");
    let changed = |file: &Path| {
        let mut bytes = fs::read(file).expect("a file");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(file, bytes).expect("written");
    };
    let stderr = spoil("whole", "left", &|_| ());
    assert!(stderr.lines().all(|line| line.contains("mean level")), "whole frames are not named: {stderr}");
    let stderr = spoil("gone", "left/ground_truth.0001.exr", &gone);
    assert!(
        stderr.contains("ground_truth.0001.exr is missing or was changed; frame 1 of left is rendered again"),
        "{stderr}"
    );
    for (what, change) in [("cut", &cut as &dyn Fn(&Path)), ("changed", &changed)] {
        let stderr = spoil(what, "left/raw.0001.png", change);
        assert!(stderr.contains("raw.0001.png is missing or was changed"), "{stderr}");
    }
    let sensor = |file: &Path| {
        let facts = fs::read_to_string(file).expect("a file");
        let mut facts: Value = serde_json::from_str(&facts).expect("JSON");
        facts["exposure"]["start_s"] = 17.into();
        fs::write(file, serde_json::to_string_pretty(&facts).expect("JSON")).expect("written");
    };
    let messages = spoil("facts", "left/frame.0001.json", &sensor);
    assert!(messages.contains("frame.0001.json: it was changed after it was written"), "{messages}");
    let other = |file: &Path| _ = fs::copy(file.with_file_name("frame.0000.json"), file).expect("copied");
    let messages = spoil("exchanged", "left/frame.0001.json", &other);
    assert!(messages.contains("it is the file of another frame"), "{messages}");
    for name in ["left/tracks.json", "left/picture.y4m", "left/camera.json"] {
        spoil(name, name, &gone);
    }
}

#[test]
fn a_frame_of_another_plan_is_no_part_of_the_run() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    render(&out, &["--frames", "0..1"]);
    let options =
        ["render", &job(), "-o", &text(&out), "--frames", "0..2", "--resume", "--spp", "16"].map(str::to_owned);
    etendue(options).refused(&["frame.0000.json", "another plan"]);
}

/// For a camera with constant light only the side-car states the plan.
#[test]
fn a_steady_camera_of_another_plan_is_no_part_of_the_run() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = text(&place.path().join("out"));
    let steady = |more: &[&str]| {
        let small = text(&tests().join("jobs/small/small.toml"));
        let arguments = ["render", &small, "-o", &out];
        etendue(arguments.iter().chain(more).map(|word| (*word).to_owned()))
    };
    steady(&["--spp", "4"]).ok();
    steady(&["--spp", "4", "--resume"]).ok();
    steady(&["--spp", "8", "--resume"]).refused(&["camera.json", "another plan"]);
}

#[test]
fn frames_without_a_rate_are_refused_where_light_depends_on_time() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let text_of =
        fs::read_to_string(job()).expect("the job").replace("[sequence]\nframe_rate_hz = 20\nstart_s = 3\n", "");
    let file = place.path().join("job.toml");
    fs::write(&file, text_of.replace("trigger_jitter_s = 1e-3\n", "")).expect("a file");
    let arguments = ["render".to_owned(), text(&file), "-o".to_owned(), text(&place.path().join("out"))];
    let more = arguments.iter().cloned().chain(["--frames".to_owned(), "0..2".to_owned()]);
    etendue(more).refused(&["camera right", "[sequence]", "frame_rate_hz"]);
    etendue(arguments).ok();
}
