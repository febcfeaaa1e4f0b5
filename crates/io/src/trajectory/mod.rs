//! Trajectories: places over time, as loggers write them.
//!
//! **CSV**: a line of column names, then rows; `#` comments and blank lines allowed; cells divided by commas, or by blanks where a
//! line has no comma. **JSON**: a list of objects whose keys are the names.
//!
//! | names | |
//! | --- | --- |
//! | `time_s` | s by the logger's clock, rising, each time once; in JSON a number, or text if a number would be rounded |
//! | `x_m`, `y_m`, `z_m` | place, m |
//! | `qw`, `qx`, `qy`, `qz` | rotation, a quaternion of length 1 to a hundredth |
//! | `yaw_deg`, `pitch_deg`, `roll_deg` | or rotation about z, then y, then x of what turns, degrees |
//!
//! Without a rotation nothing turns. Other names are not read, and told.

mod columns;
mod csv;
mod json;
#[cfg(test)]
mod tests;

use std::path::Path;

use etendue_scene::asset::TrajectoryAsset;

use crate::source::{decode_text, read_bytes, read_description_bytes};
use crate::{Error, ErrorCode, hash};

/// Reads a trajectory.
///
/// # Errors
/// The first fault, with its line.
pub fn read_trajectory(file: &Path) -> Result<TrajectoryAsset, Error> {
    let is_json = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
    let bytes = if is_json { read_description_bytes(file, "trajectory") } else { read_bytes(file, "trajectory") }?;
    let text = decode_text(file, &bytes)?;
    let (rows, unread) = if is_json { json::read(file, text) } else { csv::read(file, text) }?;
    if rows.is_empty() {
        return Err(Error::coded(ErrorCode::Empty, file, "holds no place; expected one at least, with a time"));
    }
    for pair in rows.windows(2) {
        let [(before_line, before), (line, row)] = [pair[0], pair[1]];
        if row.time <= before.time {
            let (time, before) = (row.time, before.time);
            let what = format!(
                "the time {time} s follows {before} s of line {before_line}: sort the rows by rising time, each once"
            );
            return Err(Error::at(file, line, what));
        }
    }
    let rows = rows.into_iter().map(|(_, row)| row).collect();
    Ok(TrajectoryAsset { rows, unread, hash: hash::of_bytes(&bytes) })
}
