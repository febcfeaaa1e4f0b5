//! Street trees: a trunk, branches that fork, and a crown of leaf sprays.
//!
//! A leaf is a rhombus of 0.2 m, about a spray of natural leaves, so that one or two thousand of them close the crown
//! as real foliage does (leaf area index about 3).

use crate::mesh::Mesh;
use crate::random::RandomStream;
use etendue_core::maths::f64 as maths;
use glam::DVec3;
use rand::RngExt;

/// The size of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    /// Height of the trunk below the first branches, m.
    pub(super) trunk: f64,
    /// Height and half width of the crown, m.
    pub(super) crown: [f64; 2],
    /// Number of leaf sprays.
    pub(super) leaves: usize,
    /// Key of its random numbers.
    pub(super) key: u32,
}

impl Growth {
    /// The tree's mesh, its foot at the origin.
    #[must_use]
    pub(super) fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let mut dice = RandomStream::new(self.key);
        let fork = DVec3::new(dice.random_range(-0.15..0.15), dice.random_range(-0.15..0.15), self.trunk);
        let foot = [(DVec3::ZERO, 0.24), (DVec3::Z * 0.25, 0.17), (fork * 0.6, 0.145), (fork, 0.13)];
        mesh.tube("bark", &foot, 8);
        let tips = self.branches(fork, &mut mesh, &mut dice);
        for _ in 0..self.leaves {
            let tip = tips[dice.random_range(0..tips.len())];
            leaf(tip, self.crown[1] * 0.36, &mut mesh, &mut dice);
        }
        mesh
    }

    /// Main branches and their forks; the ends carry the leaves.
    fn branches(&self, fork: DVec3, mesh: &mut Mesh, dice: &mut RandomStream) -> Vec<DVec3> {
        let mut tips = Vec::new();
        let [height, spread] = self.crown;
        for i in 0..9 {
            let azimuth = f64::from(i) * 2.4 + dice.random_range(-0.3..0.3);
            let up = (f64::from(i) + 0.6) / 9.0;
            // A round crown: widest below its middle, closing towards the top.
            let reach = spread * 0.72 * (1.0 - (2.0 * up - 0.75) * (2.0 * up - 0.75) * 0.5).max(0.1);
            let end = fork
                + DVec3::new(reach * maths::cos(azimuth), reach * maths::sin(azimuth), height * (0.12 + 0.72 * up));
            let start = fork + DVec3::Z * height * 0.25 * up;
            let knee = start + (end - start) * 0.5 + DVec3::Z * 0.25;
            mesh.tube("bark", &[(start, 0.085), (knee, 0.055), (end, 0.02)], 6);
            tips.push(end);
            for _ in 0..3 {
                let jump = DVec3::new(
                    dice.random_range(-1.0..1.0),
                    dice.random_range(-1.0..1.0),
                    dice.random_range(-0.5..0.9),
                );
                let twig = knee + (end - knee) * dice.random_range(0.2..0.9) + jump * spread * 0.38;
                mesh.tube("bark", &[(knee, 0.04), (twig, 0.012)], 4);
                tips.push(twig);
            }
        }
        tips
    }
}

/// One spray of leaves near a branch's end, more often lying than upright.
fn leaf(tip: DVec3, reach: f64, mesh: &mut Mesh, dice: &mut RandomStream) {
    let mut jump =
        || DVec3::new(dice.random_range(-1.0..1.0), dice.random_range(-1.0..1.0), dice.random_range(-0.8..0.8));
    let mut offset = jump();
    while offset.length() > 1.0 {
        offset = jump();
    }
    let centre = tip + offset * reach;
    let normal = (jump() * DVec3::new(1.0, 1.0, 0.5) + DVec3::Z * 0.5 + offset * 0.4).normalize_or(DVec3::Z);
    let along = normal.cross(jump()).normalize_or(DVec3::X) * dice.random_range(0.12..0.19);
    let across = normal.cross(along) * dice.random_range(0.45..0.7);
    let slot = if dice.random_bool(0.5) { "leaf" } else { "leaf-light" };
    let corner = |p: DVec3| (p * 100.0).round() / 100.0;
    mesh.flat(slot, &[centre - along, centre + across, centre + along, centre - across].map(corner));
}
