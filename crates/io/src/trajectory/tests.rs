use super::*;
use glam::{DQuat, DVec3};
use std::path::PathBuf;

/// A file of this name and content.
fn written(name: &str, content: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("temporary folder");
    let file = folder.path().join(name);
    std::fs::write(&file, content).expect("write");
    (folder, file)
}

fn read(name: &str, content: &str) -> Result<TrajectoryAsset, String> {
    let (_folder, file) = written(name, content);
    read_trajectory(&file).map_err(|error| error.to_string().rsplit_once('/').expect("a path").1.to_owned())
}

#[test]
fn columns_are_found_by_their_names() {
    let csv = "# a drive\nspeed_m_s, z_m, time_s, y_m, x_m, roll_deg, pitch_deg, yaw_deg, note\n\
               3.5, 0.5, 10.25, -2, 1, 0, 0, 90, start\n\n3.6, 0.5, 11, -2, 4.5, 0, 0, 0, # no note\n";
    let json = "[{\"time_s\": 10.25, \"x_m\": 1, \"y_m\": -2.0, \"z_m\": 0.5, \"speed_m_s\": {\"a\": 1},\n\"note\": \"}[\\\"{\",\n\
                \"qw\": 0.70710678118654757, \"qx\": 0, \"qy\": 0, \"qz\": 0.70710678118654757},\n\
                {\"time_s\": 11, \"x_m\": 4.5, \"y_m\": -2, \"z_m\": 0.5, \"qw\": 1, \"qx\": 0, \"qy\": 0, \"qz\": 0}]";
    let blanks = "time_s x_m y_m z_m qx qy qz qw\n10.25 1 -2 0.5 0 0 0.70710678118654757 0.70710678118654757\n11 4.5 -2 0.5 0 0 0 1\n";
    for (name, content) in [("a.csv", csv), ("a.json", json), ("b.csv", blanks)] {
        let asset = read(name, content).expect("legal");
        let [first, second] = asset.rows[..] else { panic!("two rows") };
        assert_eq!((first.time.seconds(), first.position_m), (10.25, DVec3::new(1.0, -2.0, 0.5)));
        assert_eq!(
            (second.time.seconds(), second.position_m, second.rotation),
            (11.0, DVec3::new(4.5, -2.0, 0.5), DQuat::IDENTITY)
        );
        assert!((first.rotation * DVec3::X - DVec3::Y).length() < 1e-15);
        let expected: &[&str] = if name == "b.csv" { &[] } else { &["speed_m_s", "note"] };
        assert!(
            asset.unread.len() == expected.len() && expected.iter().all(|name| asset.unread.iter().any(|n| n == name))
        );
    }
    let unturned = read("c.csv", "time_s,x_m,y_m,z_m\n0,1,2,3\n").expect("legal");
    assert_eq!(unturned.rows[0].rotation, DQuat::IDENTITY);
}

#[test]
fn faults_name_file_and_line() {
    let told = |name: &str, content: &str| read(name, content).expect_err("a fault");
    assert_eq!(
        told("a.csv", "time_s,x_m,y_m,z_m\n0,1,2,3\n\n2,1,2,3\n1.5,1,2,3\n"),
        "a.csv:5: the time 1.5 s follows 2 s of line 4: sort the rows by rising time, each once"
    );
    assert_eq!(
        told("a.csv", "time_s,x_m,y_m\n0,1,2\n"),
        "a.csv:1: nothing is called z_m; expected time_s, x_m, y_m, z_m and, of what turns, qw, qx, qy, qz or yaw_deg, pitch_deg, roll_deg"
    );
    assert!(told("a.csv", "0,1,2,3\n").starts_with("a.csv:1: nothing is called time_s, x_m, y_m, z_m;"));
    assert!(told("a.csv", "time_s,x_m,y_m,z_m,qw,qx\n").starts_with("a.csv:1: nothing is called qy, qz;"));
    assert!(
        told("a.csv", "time_s,x_m,y_m,z_m,yaw_deg\n").starts_with("a.csv:1: nothing is called pitch_deg, roll_deg;")
    );
    assert_eq!(
        told("a.csv", "time_s,x_m,y_m,z_m,x_m\n0,1,2,3,4\n"),
        "a.csv:1: two columns are called \"x_m\"; leave one out"
    );
    assert_eq!(
        told("a.csv", "time_s,x_m,y_m,z_m\n0,1,nan,3\n"),
        "a.csv:2: found \"nan\" as \"y_m\"; expected a number"
    );
    assert_eq!(told("a.csv", "time_s,x_m,y_m,z_m\n0,1\n"), "a.csv:2: the row ends before \"y_m\"");
    assert_eq!(
        told("a.csv", "time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,1,2,3,2,0,0,0\n"),
        "a.csv:2: a quaternion of length 2; expected a rotation, of length 1"
    );
    assert_eq!(told("a.csv", "time_s,x_m,y_m,z_m\n"), "a.csv: holds no place; expected one at least, with a time");
    let entry = |x: &str| format!("{{\"time_s\": 1, \"x_m\": {x}, \"y_m\": 0, \"z_m\": 0}}");
    assert_eq!(
        told("a.json", &format!("[{},\n\n{}]", entry("1"), entry("\"one\""))),
        "a.json:3: found \"one\" as \"x_m\"; expected a number"
    );
    assert_eq!(
        told("a.json", &format!("[{},\n{}]", entry("1"), entry("1, \"qw\": 1"))),
        "a.json:2: gives \"qw\", which the first does not; give it in all or in none"
    );
    assert_eq!(
        told("a.json", &format!("[{},\n{}]", entry("1"), entry("2"))),
        "a.json:2: the time 1 s follows 1 s of line 1: sort the rows by rising time, each once"
    );
    assert!(told("a.json", "[\n{\"time_s\": 0,,}]").starts_with("a.json:2: no list of objects of numbers by name: "));
    assert_eq!(told("a.json", "[]"), "a.json: holds no place; expected one at least, with a time");
}
