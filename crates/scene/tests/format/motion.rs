//! Contradictory statements of motion are refused.

use crate::faults::errors_of_job;

#[test]
fn keys_in_their_order() {
    let keys = |times: [&str; 2]| {
        let key = |time: &str| format!("[[scene.objects.keys]]\ntime_s = {time}\nposition_m = [{time}, 0, 0]\n");
        errors_of_job("position_m = [5, 0, 1]", &times.map(key).concat())
    };
    assert_eq!(keys(["0", "1"]), "");
    assert_eq!(
        keys(["2.5", "1"]),
        "job.toml:32:10: scene.objects.wall.keys[1].time_s: the key at 1 s follows the key at 2.5 s; give the keys in order \
         of time"
    );
    assert!(keys(["1", "1.0"]).ends_with("keys[1].time_s: two keys are at 1 s; give each key a different time"));
    let of = |keys: &str| errors_of_job("position_m = [5, 0, 1]", keys);
    assert_eq!(of("keys = [{ time_s = 0, position_m = [5, 0, 1] }]"), "");
    let still = "position_m = [5, 0, 1]\ninterpolation = \"smooth\"";
    assert!(
        of(still).contains("\"interpolation\" has no effect here, there are no keys to interpolate; "),
        "{}",
        of(still)
    );
    let both = "position_m = [5, 0, 1]\ntrajectory = { file = \"drive.csv\" }";
    assert!(of(both).contains(
        "\"trajectory\" contradicts \"position_m\", \"rotation_deg\", \"scale\": both state the position of the object"
    ));
    let wheel = "rolls = { radius_m = 0.3 }\nkeys = [{ time_s = 0 }, { time_s = 1, scale = 2 }]";
    assert!(of(wheel).contains("\"scale\" in the keys of a wheel"), "{}", of(wheel));
}

#[test]
fn frames_that_are_not_there_or_carry_themselves() {
    let framed = |frames: &str| errors_of_job("position_m = [5, 0, 1]", &format!("frame = \"car\"\n{frames}"));
    let frame = |name: &str, parent: &str| format!("[[scene.frames]]\nname = \"{name}\"\n{parent}\n");
    assert!(framed("").contains("there is no frame \"car\"; define the frame; the scene has none"), "{}", framed(""));
    assert_eq!(framed(&frame("car", "position_m = [5, 0, 1]")), "");
    let unknown_parent = framed(&frame("car", "parent = \"roda\"\n[[scene.frames]]\nname = \"road\""));
    assert!(
        unknown_parent.contains("scene.frames.car.parent: there is no frame \"roda\"; did you mean \"road\"?"),
        "{unknown_parent}"
    );
    let circle = framed(&[frame("car", "parent = \"arm\""), frame("arm", "parent = \"car\"")].concat());
    assert!(circle.contains("scene.frames.car.parent: frames form a cycle: car -> arm -> car; give another parent"));
    let own = framed(&frame("car", "parent = \"car\""));
    assert!(own.contains("frames form a cycle: car -> car"), "{own}");
    let twice = framed(&frame("car", "position_m = [0, 0, 1]\nkeys = [{ time_s = 0 }]"));
    assert!(twice.contains("both state the position of the frame"), "{twice}");
}

#[test]
fn cameras_that_move_say_once_where() {
    let of = |pose: &str| errors_of_job("position_m = [0, 0, 1]\nlook_at_m = [10, 0, 1]", pose);
    let key = |time: u8| format!("{{ time_s = {time}, position_m = [{time}, 0, 1], look_at_m = [10, 0, 1] }}");
    let keys = format!("keys = [{}, {}]", key(0), key(1));
    assert_eq!(of(&keys), "");
    assert!(of(&format!("position_m = [0, 0, 1]\n{keys}")).contains("both state the position of the camera"));
    assert!(of("look_at_m = [10, 0, 1]").contains("the key \"position_m\" is missing; add it"), "{}", of(""));
    assert!(of("position_m = [0, 0, 1]").contains("a key is missing; give one of \"look_at_m\", \"rotation_deg\""));
    assert!(of(&format!("{keys}\nup = [0, 0, 1]")).contains("\"up\" has no effect here"));
    let inside = "keys = [{ time_s = 0, position_m = [0, 0, 1], look_at_m = [0, 0, 1] }]";
    assert!(of(inside).contains("the camera looks at its own position"));
}
