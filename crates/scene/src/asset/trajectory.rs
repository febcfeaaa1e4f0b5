//! Positions over time, from a file.

use etendue_core::ExactTime;
use glam::{DQuat, DVec3};

/// The rows of a trajectory, in the axes of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrajectoryAsset {
    /// Rows, one or more, with increasing, distinct times.
    pub rows: Vec<TrajectoryRow>,
    /// Columns that were not read.
    pub unread: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

/// Position and rotation at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectoryRow {
    /// Time by the clock of the file.
    pub time: ExactTime,
    pub position_m: DVec3,
    /// Rotation from the moving object to the file's world; of length 1 to a hundredth.
    pub rotation: DQuat,
}
