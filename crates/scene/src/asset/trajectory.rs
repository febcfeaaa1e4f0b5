//! Places over time, as a file has them.

use crate::record::motion::TrajectoryAxes;
use etendue_core::ExactTime;
use glam::{DMat3, DQuat, DVec3};

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

impl TrajectoryAxes {
    /// From the file's axes to x forward, y left, z up.
    #[must_use]
    pub fn to_world(self) -> DMat3 {
        match self {
            Self::Flu => DMat3::IDENTITY,
            Self::Frd => DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
            Self::Rdf => DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X),
        }
    }

    /// A row in axes x forward, y left, z up, of the world and of what moves.
    #[must_use]
    pub fn turned(self, row: &TrajectoryRow) -> TrajectoryRow {
        let turn = DQuat::from_mat3(&self.to_world());
        let rotation = match self {
            Self::Flu => row.rotation,
            Self::Frd | Self::Rdf => turn * row.rotation * turn.conjugate(),
        };
        TrajectoryRow { time: row.time, position_m: self.to_world() * row.position_m, rotation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What goes forward and turns right in each convention does so in the world; a yaw about a z axis that points down turns right.
    #[test]
    fn axes_are_turned_as_a_whole() {
        let quarter = |axis: DVec3| DQuat::from_axis_angle(axis, core::f64::consts::FRAC_PI_2);
        let rows = [
            (TrajectoryAxes::Flu, DVec3::new(3.0, -2.0, 1.0), quarter(DVec3::NEG_Z)),
            (TrajectoryAxes::Frd, DVec3::new(3.0, 2.0, -1.0), quarter(DVec3::Z)),
            (TrajectoryAxes::Rdf, DVec3::new(2.0, -1.0, 3.0), quarter(DVec3::Y)),
        ];
        for (axes, position_m, rotation) in rows {
            let row = axes.turned(&TrajectoryRow { time: 4.0.into(), position_m, rotation });
            assert_eq!((row.time.seconds(), row.position_m), (4.0, DVec3::new(3.0, -2.0, 1.0)));
            assert!((row.rotation * DVec3::X - DVec3::NEG_Y).length() < 1e-15, "{axes:?}");
            assert!((row.rotation * DVec3::Z - DVec3::Z).length() < 1e-15, "{axes:?}");
        }
    }
}
