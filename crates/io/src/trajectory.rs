//! Trajectories: poses over time, as loggers write them.
//!
//! **CSV**: a line of column names, then rows; `#` comments and blank lines allowed; cells separated by commas, or by blanks if a line has no comma. **JSON**:
//! a list of objects whose keys are the names.
//!
//! | names | |
//! | --- | --- |
//! | `time_s` | s by the logger's clock, increasing, each time once; in JSON a number, or text if a number would be rounded |
//! | `x_m`, `y_m`, `z_m` | position, m |
//! | `qw`, `qx`, `qy`, `qz` | rotation, a quaternion of length 1 to a hundredth |
//! | `yaw_deg`, `pitch_deg`, `roll_deg` | alternative rotation about z, then y, then x of the rotated frame, degrees |
//!
//! Without these columns there is no rotation. Other names are not read, and are reported.

use std::path::Path;

use etendue_core::ExactTime;
use etendue_scene::asset::{TrajectoryAsset, TrajectoryRow};
use etendue_scene::record::transform::yaw_pitch_roll_quaternion;
use glam::{DQuat, DVec3};
use serde_json::{Map, Value};

use crate::source::{decode_text, read_bytes, read_description_bytes};
use crate::table::{number, rows};
use crate::{Error, ErrorCode, hash};

/// Reads a trajectory.
///
/// # Errors
/// The first error, with its line.
pub fn read_trajectory(file: &Path) -> Result<TrajectoryAsset, Error> {
    let is_json = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let bytes = if is_json { read_description_bytes(file, "trajectory") } else { read_bytes(file, "trajectory") }?;
    let text = decode_text(file, &bytes)?;
    let (rows, unread) = if is_json { read_json(file, text) } else { read_csv(file, text) }?;
    if rows.is_empty() {
        return Err(Error::coded(ErrorCode::Empty, file, "contains no position; expected at least one, with a time"));
    }
    for pair in rows.windows(2) {
        let [(before_line, before), (line, row)] = [pair[0], pair[1]];
        if row.time <= before.time {
            let (time, before) = (row.time, before.time);
            let what = format!(
                "the time {time} s follows {before} s of line {before_line}: sort the rows by increasing time, each once"
            );
            return Err(Error::at(file, line, what));
        }
    }
    let rows = rows.into_iter().map(|(_, row)| row).collect();
    Ok(TrajectoryAsset { rows, unread, hash: hash::hash_bytes(&bytes) })
}

const POSITION: [&str; 4] = ["time_s", "x_m", "y_m", "z_m"];
const QUATERNION: [&str; 4] = ["qw", "qx", "qy", "qz"];
const ANGLES: [&str; 3] = ["yaw_deg", "pitch_deg", "roll_deg"];

/// Tolerance of a quaternion's length from 1: loggers write few digits.
const LENGTH_ERROR: f64 = 0.01;

/// Rows with their lines, and the unread names.
type ParsedTrajectory = (Vec<(usize, TrajectoryRow)>, Vec<String>);

/// Columns of the values of a row.
struct TrajectoryColumns {
    place: [usize; 4],
    rotation: RotationColumns,
}

enum RotationColumns {
    None,
    Quaternion([usize; 4]),
    Angles([usize; 3]),
}

/// Returns true if a name is a known column.
fn is_known(name: &str) -> bool {
    POSITION.contains(&name) || QUATERNION.contains(&name) || ANGLES.contains(&name)
}

impl TrajectoryColumns {
    /// Finds the columns by their names.
    fn new(names: &[&str]) -> Result<Self, String> {
        if let Some(twice) = names.iter().enumerate().find(|(i, name)| is_known(name) && names[..*i].contains(name)) {
            return Err(format!("two columns are named \"{}\"; remove one", twice.1));
        }
        let place = find_columns(names, POSITION).ok_or_else(|| missing_columns(names, &POSITION))?;
        let has_any = |wanted: &[&str]| wanted.iter().any(|name| names.contains(name));
        let rotation = match (has_any(&QUATERNION), has_any(&ANGLES)) {
            (false, false) => RotationColumns::None,
            (true, false) => RotationColumns::Quaternion(
                find_columns(names, QUATERNION).ok_or_else(|| missing_columns(names, &QUATERNION))?,
            ),
            (false, true) => {
                RotationColumns::Angles(find_columns(names, ANGLES).ok_or_else(|| missing_columns(names, &ANGLES))?)
            }
            (true, true) => {
                let both = [QUATERNION.join(", "), ANGLES.join(", ")];
                return Err(format!("rotations are given twice, as {} and as {}; remove one", both[0], both[1]));
            }
        };
        Ok(Self { place, rotation })
    }

    /// Builds a row from the values of its columns; `exact` returns the time.
    fn row(
        &self,
        value: impl Fn(usize) -> Result<f64, String>,
        exact: impl Fn(usize) -> Result<ExactTime, String>,
    ) -> Result<TrajectoryRow, String> {
        let [time, x, y, z] = self.place;
        let rotation = match self.rotation {
            RotationColumns::None => DQuat::IDENTITY,
            RotationColumns::Angles([yaw, pitch, roll]) => {
                yaw_pitch_roll_quaternion([value(yaw)?, value(pitch)?, value(roll)?])
            }
            RotationColumns::Quaternion([w, x, y, z]) => {
                let quaternion = DQuat::from_xyzw(value(x)?, value(y)?, value(z)?, value(w)?);
                let length = quaternion.length();
                if (length - 1.0).abs().is_nan() || (length - 1.0).abs() > LENGTH_ERROR {
                    return Err(format!("the quaternion has length {length}; expected a rotation, of length 1"));
                }
                quaternion
            }
        };
        Ok(TrajectoryRow { time: exact(time)?, position_m: DVec3::new(value(x)?, value(y)?, value(z)?), rotation })
    }
}

/// Indices of the wanted names, if all are present.
fn find_columns<const N: usize>(names: &[&str], wanted: [&str; N]) -> Option<[usize; N]> {
    let at = wanted.map(|wanted| names.iter().position(|name| *name == wanted));
    at.iter().all(Option::is_some).then(|| at.map(Option::unwrap_or_default))
}

fn missing_columns(names: &[&str], wanted: &[&str]) -> String {
    let missing: Vec<&str> = wanted.iter().filter(|name| !names.contains(name)).copied().collect();
    format!(
        "missing {}; expected {} and, for rotation, {} or {}",
        missing.join(", "),
        POSITION.join(", "),
        QUATERNION.join(", "),
        ANGLES.join(", ")
    )
}

fn read_csv(file: &Path, text: &str) -> Result<ParsedTrajectory, Error> {
    let mut rows = rows(text);
    let head = rows.next().ok_or_else(|| {
        Error::coded(ErrorCode::Empty, file, "contains no row; expected a line of column names first")
    })?;
    let columns = TrajectoryColumns::new(&head.cells).map_err(|what| Error::at(file, head.line, what))?;
    let unread = head.cells.iter().filter(|name| !is_known(name)).map(|name| (*name).to_owned()).collect();
    let read_csv = rows.map(|row| {
        let cell = |column: usize| {
            let cell = row.cells.get(column).copied();
            cell.ok_or_else(|| format!("the row ends before \"{}\"", head.cells[column]))
        };
        let wrong =
            |column: usize, cell: &str| format!("found \"{cell}\" as \"{}\"; expected a number", head.cells[column]);
        let value =
            |column: usize| number(cell(column)?).ok_or_else(|| wrong(column, cell(column).unwrap_or_default()));
        let exact = |column: usize| cell(column)?.parse().map_err(|_| wrong(column, cell(column).unwrap_or_default()));
        let trajectory_row = columns.row(value, exact).map_err(|what| Error::at(file, row.line, what))?;
        Ok((row.line, trajectory_row))
    });
    Ok((read_csv.collect::<Result<_, _>>()?, unread))
}

fn read_json(file: &Path, text: &str) -> Result<ParsedTrajectory, Error> {
    let entries: Vec<Map<String, Value>> = serde_json::from_str(text).map_err(|cause| {
        let what = format!("not a list of objects with named numbers: {cause}");
        if cause.line() > 0 { Error::at(file, cause.line(), what) } else { Error::new(file, what) }
    })?;
    let lines = entry_lines(text);
    let Some(first) = entries.first() else { return Ok((Vec::new(), Vec::new())) };
    let names: Vec<&str> = first.keys().map(String::as_str).collect();
    let columns = TrajectoryColumns::new(&names).map_err(|what| Error::at(file, lines[0], what))?;
    let unread = names.iter().filter(|name| !is_known(name)).map(|name| (*name).to_owned()).collect();
    let read_json = entries.iter().zip(&lines).map(|(entry, line)| {
        let error = |what: String| Error::at(file, *line, what);
        if let Some(other) = entry.keys().find(|key| is_known(key) && !names.contains(&key.as_str())) {
            return Err(error(format!("has \"{other}\", which the first object does not; give it in all or in none")));
        }
        let entry_value = |column: usize| {
            let name = names[column];
            entry.get(name).ok_or_else(|| format!("lacks \"{name}\", which the first object has"))
        };
        let wrong =
            |column: usize, actual: &Value| format!("found {actual} as \"{}\"; expected a number", names[column]);
        let value = |column: usize| {
            let json = entry_value(column)?;
            json.as_f64().ok_or_else(|| wrong(column, json))
        };
        let exact = |column: usize| {
            let stated = entry_value(column)?;
            let read_json = stated
                .as_str()
                .map_or_else(|| stated.as_f64().and_then(ExactTime::from_seconds), |text| text.parse().ok());
            read_json.ok_or_else(|| wrong(column, stated))
        };
        Ok((*line, columns.row(value, exact).map_err(error)?))
    });
    Ok((read_json.collect::<Result<_, _>>()?, unread))
}

/// Lines, counted from 1, on which the entries of the outermost list begin; the text is valid.
fn entry_lines(text: &str) -> Vec<usize> {
    let (mut lines, mut line, mut depth, mut quoted, mut escaped) = (Vec::new(), 1, 0_u32, false, false);
    for byte in text.bytes() {
        match byte {
            b'\n' => line += 1,
            _ if quoted => {
                quoted = escaped || byte != b'"';
                escaped = !escaped && byte == b'\\';
            }
            b'"' => quoted = true,
            b'{' | b'[' => {
                if depth == 1 {
                    lines.push(line);
                }
                depth += 1;
            }
            b'}' | b']' => depth -= 1,
            _ => {}
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use glam::{DQuat, DVec3};

    use super::*;

    /// Writes a file of this name and content.
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
                asset.unread.len() == expected.len()
                    && expected.iter().all(|name| asset.unread.iter().any(|n| n == name))
            );
        }
        let unturned = read("c.csv", "time_s,x_m,y_m,z_m\n0,1,2,3\n").expect("legal");
        assert_eq!(unturned.rows[0].rotation, DQuat::IDENTITY);
    }

    #[test]
    fn faults_name_file_and_line() {
        let message = |name: &str, content: &str| read(name, content).expect_err("a fault");
        assert_eq!(
            message("a.csv", "time_s,x_m,y_m,z_m\n0,1,2,3\n\n2,1,2,3\n1.5,1,2,3\n"),
            "a.csv:5: the time 1.5 s follows 2 s of line 4: sort the rows by increasing time, each once"
        );
        assert_eq!(
            message("a.csv", "time_s,x_m,y_m\n0,1,2\n"),
            "a.csv:1: missing z_m; expected time_s, x_m, y_m, z_m and, for rotation, qw, qx, qy, qz or yaw_deg, pitch_deg, roll_deg"
        );
        assert!(message("a.csv", "0,1,2,3\n").starts_with("a.csv:1: missing time_s, x_m, y_m, z_m;"));
        assert!(message("a.csv", "time_s,x_m,y_m,z_m,qw,qx\n").starts_with("a.csv:1: missing qy, qz;"));
        assert!(message("a.csv", "time_s,x_m,y_m,z_m,yaw_deg\n").starts_with("a.csv:1: missing pitch_deg, roll_deg;"));
        assert_eq!(
            message("a.csv", "time_s,x_m,y_m,z_m,x_m\n0,1,2,3,4\n"),
            "a.csv:1: two columns are named \"x_m\"; remove one"
        );
        assert_eq!(
            message("a.csv", "time_s,x_m,y_m,z_m\n0,1,nan,3\n"),
            "a.csv:2: found \"nan\" as \"y_m\"; expected a number"
        );
        assert_eq!(message("a.csv", "time_s,x_m,y_m,z_m\n0,1\n"), "a.csv:2: the row ends before \"y_m\"");
        assert_eq!(
            message("a.csv", "time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,1,2,3,2,0,0,0\n"),
            "a.csv:2: the quaternion has length 2; expected a rotation, of length 1"
        );
        assert_eq!(
            message("a.csv", "time_s,x_m,y_m,z_m\n"),
            "a.csv: contains no position; expected at least one, with a time"
        );
        let entry = |x: &str| format!("{{\"time_s\": 1, \"x_m\": {x}, \"y_m\": 0, \"z_m\": 0}}");
        assert_eq!(
            message("a.json", &format!("[{},\n\n{}]", entry("1"), entry("\"one\""))),
            "a.json:3: found \"one\" as \"x_m\"; expected a number"
        );
        assert_eq!(
            message("a.json", &format!("[{},\n{}]", entry("1"), entry("1, \"qw\": 1"))),
            "a.json:2: has \"qw\", which the first object does not; give it in all or in none"
        );
        assert_eq!(
            message("a.json", &format!("[{},\n{}]", entry("1"), entry("2"))),
            "a.json:2: the time 1 s follows 1 s of line 1: sort the rows by increasing time, each once"
        );
        assert!(
            message("a.json", "[\n{\"time_s\": 0,,}]")
                .starts_with("a.json:2: not a list of objects with named numbers: ")
        );
        assert_eq!(message("a.json", "[]"), "a.json: contains no position; expected at least one, with a time");
    }
}
