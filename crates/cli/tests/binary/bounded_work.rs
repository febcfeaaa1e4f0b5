//! Short descriptions with unbounded work, and files larger than their reader expects.

use crate::support::{BALL, etendue, text};
use std::fs;
use std::path::Path;

fn plan_of(folder: &Path, scene: &str) -> crate::support::CommandOutput {
    let job = folder.join("job.toml");
    fs::write(&job, format!("{BALL}{scene}[sequence]\nframe_rate_hz = 20\n")).expect("written");
    etendue(["plan", &text(&job)])
}

/// Pieces of such a rotation were halved as long as times could be distinguished: about 1e15 times.
#[test]
fn a_wheel_that_turns_by_more_than_can_be_followed_is_refused() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let wheel = |x: &str, radius: &str| {
        let scene = format!(
            "[[scene.frames]]\nname = \"car\"\nkeys = [{{ time_s = 0, position_m = [0, 0, 0.3] }}, {{ time_s = 10, position_m = [{x}, 0, 0.3], rotation_deg = [10, 0, 0] }}]\n\
             [[scene.objects]]\nname = \"wheel\"\nframe = \"car\"\nrolls = {{ radius_m = {radius} }}\nshape = {{ type = \"disc\", radius_m = 0.3 }}\nmaterial = \"grey\"\n"
        );
        plan_of(place.path(), &scene)
    };
    wheel("3", "0.3").ok();
    wheel("3", "1e-9").ok();
    for (x, radius) in [("3", "1e-30"), ("3", "1e-13"), ("1e30", "0.3"), ("3", "1e-310")] {
        wheel(x, radius).refused(&["job.toml:", "rolls.radius_m", "at most 1e12 can be traced", "larger radius"]);
    }
    // A frame may also be the wheel.
    plan_of(
        place.path(),
        "[[scene.frames]]\nname = \"car\"\nkeys = [{ time_s = 0 }, { time_s = 1, position_m = [3, 0, 0] }]\n\
         [[scene.frames]]\nname = \"hub\"\nparent = \"car\"\nrolls = { radius_m = 1e-30 }\n\
         [[scene.objects]]\nname = \"wheel\"\nframe = \"hub\"\nshape = { type = \"disc\", radius_m = 0.3 }\nmaterial = \"grey\"\n",
    )
    .refused(&["scene.frames.hub.rolls.radius_m", "at most 1e12 can be traced"]);
}

fn chain(count: usize, first: &str, each: &str) -> String {
    let frames: String = (0..count)
        .map(|i| {
            let parent = if i > 0 { format!("parent = \"f{}\"\n", i - 1) } else { first.to_owned() };
            format!("[[scene.frames]]\nname = \"f{i}\"\n{parent}{each}")
        })
        .collect();
    format!(
        "{frames}[[scene.objects]]\nname = \"last\"\nframe = \"f{}\"\nshape = {{ type = \"sphere\", radius_m = 0.3 }}\nmaterial = \"grey\"\n",
        count - 1
    )
}

/// 30 000 nested frames took minutes, and more than a thread's stack. In quadratic time these take an hour.
#[test]
fn frames_in_frames_take_time_in_proportion_to_their_depth() {
    let place = tempfile::tempdir().expect("a temporary folder");
    plan_of(place.path(), &chain(30_000, "", "")).ok();
    let circle = plan_of(place.path(), &chain(30_000, "parent = \"f29999\"\n", ""));
    circle
        .refused(&["scene.frames.f0.parent", "frames form a cycle: f0 -> f29999 -> f29998"])
        .says(&["and 29950 more; 30000 errors in total"]);
    let lost = plan_of(place.path(), &chain(20_000, "", "rolls = { radius_m = 1 }\n"));
    lost.refused(&["\"rolls\" has no effect"]).says(&["errors in total"]);
    let unknown =
        (0..20_000).map(|i| format!("[[scene.frames]]\nname = \"f{i}\"\nparent = \"g{i}\"\n")).collect::<String>();
    let refusal = plan_of(place.path(), &unknown).refused(&["there is no frame \"g0\""]);
    assert!(refusal.err.lines().count() <= 52 && refusal.err.len() < 100_000, "{} bytes", refusal.err.len());
}

/// The side-car of an image is read as any description: up to its limit.
#[test]
fn a_side_car_beyond_the_limit_is_refused_by_its_size() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let folder = place.path().join("out");
    fs::create_dir(&folder).expect("made");
    let checker = crate::support::tests().join("jobs/small/checker.png");
    let image = folder.join("picture.0000.png");
    fs::copy(checker, &image).expect("copied");
    let sparse = fs::File::create(folder.join("camera.json")).expect("a file");
    sparse.set_len(3 << 30).expect("sparse");
    let message = ["camera.json", "the file has 3072 MiB", "--limit description-mib=3072"];
    etendue(["view", &text(&folder), "-o", &text(&place.path().join("page")), "--no-open"]).refused(&message);
    etendue(["inspect", &text(&folder.join("camera.json"))]).refused(&["camera.json", "3072 MiB"]);
    etendue(["measure", "sfr", &text(&image)]).refused(&message);
    fs::write(folder.join("camera.json"), "{ \"program\": \"etendue\", ").expect("written");
    etendue(["view", &text(&folder), "-o", &text(&place.path().join("page")), "--no-open"])
        .refused(&["camera.json", "not JSON"]);
    etendue(["measure", "sfr", &text(&image)]).refused(&["camera.json", "not JSON"]);
}
