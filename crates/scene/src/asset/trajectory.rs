//! Places over time, as a file has them.

use etendue_core::ExactTime;
use glam::{DQuat, DVec3};

/// The rows of a trajectory, in the axes of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrajectoryAsset {
    /// One or more, times rising, each once.
    pub rows: Vec<TrajectoryRow>,
    /// Columns that were not read.
    pub unread: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

/// Where something is at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectoryRow {
    /// Time by the clock of the file.
    pub time: ExactTime,
    /// m.
    pub position_m: DVec3,
    /// From what moves to the file's world; of length 1 to a hundredth.
    pub rotation: DQuat,
}
