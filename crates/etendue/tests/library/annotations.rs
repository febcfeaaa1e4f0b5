//! Flow, disparity and boxes, from a job to files.

use etendue::{ExistingFiles, Job, JobRequest, MemoryFiles, NullObserver, RenderOptions};
use etendue_io::correspondence::decode_flo;
use etendue_io::exr::{ExrSamples, read_exr};
use std::path::Path;

const CAMERA: &str = "lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 8 }\n\
                      sensor = { width_px = 32, height_px = 24, pixel_pitch_um = 100 }\n";

/// Two cameras side by side that move to the left at 3 m/s, in front of a wall at 10 m.
fn job(left: &str, sequence: &str) -> String {
    let camera = |name: &str, y: f64, more: &str| {
        let key =
            |t: f64| format!("{{ time_s = {t}, position_m = [0, {}, 0], rotation_deg = [0, 0, 0] }}", y + 3.0 * t);
        format!("[[cameras]]\nname = \"{name}\"\nkeys = [{}, {}]\n{CAMERA}{more}", key(0.0), key(1.0))
    };
    format!(
        "format = 1\n{sequence}{}{}\
         [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[scene.objects]]\nname = \"wall\"\nmaterial = \"grey\"\nclass = \"wall\"\nshape = {{ type = \"quad\", size_m = [40, 40] }}\n\
         position_m = [10, 0, 0]\nrotation_deg = [0, 90, 0]\n[scene.classes]\nwall = 3\n\
         [render]\nspp = 1\nreplicates = 1\nintegrator = \"flat\"\n",
        camera("left", 0.0, left),
        camera("right", -0.3, ""),
    )
}

const SEQUENCE: &str = "[sequence]\nframe_rate_hz = 10\n";

fn open_job(text: &str) -> Result<Job, String> {
    let mut files = MemoryFiles::new();
    files.add_text("job.toml", text);
    JobRequest::new("job.toml").open_in(&files).map_err(|error| error.to_string())
}

fn floats(folder: &Path, file: &str, channel: &str) -> Vec<f32> {
    let exr = read_exr(&folder.join(file)).unwrap_or_else(|error| panic!("{error}"));
    exr.channel(channel).unwrap_or_else(|| panic!("{file} has {:?}", exr.channels)).to_floats()
}

#[test]
fn all_requested_annotations_are_written_and_right() {
    let left = "output = { optical_flow = \"middlebury\", scene_flow = true, disparity_to = \"right\", disparity_format = \"kitti\", \
                boxes = true }\n";
    let job = open_job(&job(left, SEQUENCE)).expect("a legal job");
    assert!(job.summary().contains("optical flow, scene flow, disparity, boxes"), "{}", job.summary());
    let folder = tempfile::tempdir().expect("a folder");
    let options = RenderOptions { frames: 0..2, ..RenderOptions::default() };
    let results = job.render(&options, &NullObserver).expect("rendered");
    results.save(folder.path(), ExistingFiles::Refuse, &NullObserver).expect("saved");
    let named = job.file_names(&(0..2));
    assert!(named.iter().all(|name| folder.path().join(name).is_file()), "{named:?}");
    let at = |file: &str| folder.path().join("left").join(file);
    // f v T / z = 60 px · 0.3 m / 10 m; positions are stored in 32 bits.
    let flo = std::fs::read(at("flow_forward.0000.flo")).expect("flow");
    let flow = decode_flo(Path::new("flow"), &flo).expect(".flo");
    assert!(flow.samples().iter().all(|[u, v]| (u - 1.8).abs() < 1e-5 && v.abs() < 1e-5), "{:?}", flow.at(3, 3));
    let left = folder.path().join("left");
    let backward = floats(&left, "motion.0001.exr", "flow.backward.X");
    assert!(backward.iter().all(|u| (u + 1.8).abs() < 1e-5), "{:?}", &backward[..4]);
    let first = read_exr(&at("motion.0000.exr")).expect("motion");
    assert!(first.channel("flow.backward.X").is_none(), "nothing is before frame 0");
    let speed = floats(&left, "motion.0001.exr", "motion_vector.X");
    assert!(speed.iter().all(|u| (u - 18.0).abs() < 1e-3), "{:?}", &speed[..4]);
    let shift = floats(&left, "motion.0000.exr", "scene_flow.forward.X");
    assert!(shift.iter().all(|x| (x - 0.3).abs() < 1e-6), "{:?}", &shift[..4]);
    // b f / z = 0.3 m · 60 px / 10 m; the right camera sees it in all but the two columns that lie outside.
    let disparity = floats(&left, "disparity.0000.exr", "disparity.X");
    assert!(disparity.iter().all(|d| (d - 1.8).abs() < 1e-5), "{:?}", &disparity[..4]);
    let visibility = read_exr(&at("disparity.0000.exr")).expect("disparity");
    let Some(ExrSamples::Uint(visibility)) = visibility.channel("visibility.ID") else { panic!("no visibility") };
    assert_eq!((visibility[0], visibility[1], visibility[2]), (3, 3, 1));
    assert!(at("disparity.0001.png").is_file());
    let boxes = std::fs::read_to_string(at("boxes.0001.json")).expect("boxes");
    let boxes: serde_json::Value = serde_json::from_str(&boxes).expect("JSON");
    let wall = &boxes["objects"][0];
    assert_eq!((wall["name"].as_str(), wall["class"].as_str()), (Some("wall"), Some("wall")));
    assert_eq!(wall["visible_box_px"], serde_json::json!([0.0, 0.0, 32.0, 24.0]));
    let centre = wall["box_3d"]["camera"]["centre_m"][0].as_f64().expect("a number");
    assert!((centre - 0.3).abs() < 1e-9, "0.1 s later the wall's middle is 0.3 m to the right: {centre}");
}

#[test]
fn what_cannot_be_is_refused_with_its_remedy() {
    let error = |left: &str, sequence: &str| open_job(&job(left, sequence)).map(|_| ()).expect_err("refused");
    let message = error("output = { optical_flow = \"exr\" }\n", "");
    assert!(
        message.contains("\"optical_flow\" requires the previous and the next frame") && message.contains("[sequence]"),
        "{message}"
    );
    let message = error("output = { disparity_to = \"top\" }\n", SEQUENCE);
    assert!(message.contains("there is no other camera \"top\"") && message.contains("give one of right"), "{message}");
    let message = error("output = { disparity_format = \"kitti\" }\n", SEQUENCE);
    assert!(message.contains("\"disparity_format\" has no effect without \"disparity_to\""), "{message}");
    let turned = job("output = { disparity_to = \"right\" }\n", SEQUENCE).replacen(
        "rotation_deg = [0, 0, 0]",
        "rotation_deg = [0, 1, 0]",
        2,
    );
    let message = open_job(&turned).map(|_| ()).expect_err("refused");
    assert!(message.contains("are not rectified") && message.contains("the same lens without distortion"), "{message}");
    let swapped =
        job("", SEQUENCE).replace("name = \"right\"", "name = \"right\"\noutput = { disparity_to = \"left\" }");
    let message = open_job(&swapped).map(|_| ()).expect_err("refused");
    assert!(message.contains("camera \"left\" is not to the right of \"right\""), "{message}");
}
