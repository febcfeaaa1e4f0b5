//! Town houses: a front with windows set back into the wall, doors, shops, cornices and a roof.
//!
//! A house stands with its front in the plane y = 0, looking towards −y, its left front corner at the origin; x runs
//! along the front, the ground is z = 0. Sizes after common German practice: storeys of 3 m, ground floors of 3.6 m,
//! sills at 0.9 m, wall openings set back by 0.14 m.

use super::house::{GROUND_M, Ground, House, STOREY_M};
use super::opening::{self, Frame};
use super::roof;
use crate::mesh::Mesh;
use crate::random::RandomStream;
use glam::{DVec2, DVec3};

/// Height of a window's sill above its floor, m.
const SILL_M: f64 = 0.9;
/// Metres that a wall texture covers.
const TEXTURE_M: f64 = 1.0;

/// A hole in the front: x and z of its low and high corner.
#[derive(Clone, Copy, Debug)]
struct Hole {
    low: DVec2,
    high: DVec2,
}

impl House {
    /// The house's mesh.
    #[must_use]
    pub(super) fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let mut dice = RandomStream::new(self.key);
        self.ground_floor(&mut mesh, &mut dice);
        for storey in 1..self.storeys {
            self.upper_storey(storey, &mut mesh, &mut dice);
        }
        self.other_walls(&mut mesh);
        self.bands(&mut mesh);
        roof::add(self, &mut mesh);
        mesh
    }

    fn bay_centre(&self, bay: usize) -> f64 {
        self.width * (bay as f64 + 0.5) / self.bays as f64
    }

    fn upper_storey(&self, storey: usize, mesh: &mut Mesh, dice: &mut RandomStream) {
        let floor = GROUND_M + (storey - 1) as f64 * STOREY_M;
        let top = if storey + 1 == self.storeys { self.eaves() } else { floor + STOREY_M };
        let balcony = |bay: usize| self.balconies && bay % 2 == 1;
        let holes: Vec<Hole> = (0..self.bays)
            .map(|bay| {
                self.window_hole(self.bay_centre(bay), floor + if balcony(bay) { 0.05 } else { SILL_M }, floor + SILL_M)
            })
            .collect();
        self.wall_with_holes(&holes, floor, top, mesh);
        for (bay, hole) in holes.iter().enumerate() {
            let frame = if balcony(bay) { Frame::Door } else { Frame::Window };
            opening::window(mesh, hole.low, hole.high, frame, self.surrounds, dice);
            if balcony(bay) {
                opening::balcony(mesh, self.bay_centre(bay), floor, 1.3);
            }
        }
    }

    fn window_hole(&self, centre: f64, bottom: f64, sill: f64) -> Hole {
        let half = self.window[0] / 2.0;
        Hole { low: DVec2::new(centre - half, bottom), high: DVec2::new(centre + half, sill + self.window[1]) }
    }

    fn ground_floor(&self, mesh: &mut Mesh, dice: &mut RandomStream) {
        match self.ground {
            Ground::Home => self.home_floor(mesh, dice),
            Ground::Shop => self.shop_floor(mesh),
        }
    }

    fn home_floor(&self, mesh: &mut Mesh, dice: &mut RandomStream) {
        let door_bay = self.bays / 2;
        let hole = |bay: usize| {
            let centre = self.bay_centre(bay);
            if bay == door_bay {
                Hole { low: DVec2::new(centre - 0.6, 0.15), high: DVec2::new(centre + 0.6, 2.75) }
            } else {
                self.window_hole(centre, 1.25, 1.25)
            }
        };
        let holes: Vec<Hole> = (0..self.bays).map(hole).collect();
        self.wall_with_holes(&holes, 0.0, GROUND_M, mesh);
        for (bay, hole) in holes.iter().enumerate() {
            if bay == door_bay {
                opening::door(mesh, hole.low, hole.high);
            } else {
                opening::window(mesh, hole.low, hole.high, Frame::Window, self.surrounds, dice);
            }
        }
    }

    fn shop_floor(&self, mesh: &mut Mesh) {
        let (door, margin) = (DVec2::new(0.35, 1.45), 0.3);
        let entrance = Hole { low: DVec2::new(door.x, 0.15), high: DVec2::new(door.y, 2.75) };
        let panes = if self.width > 10.0 { 3 } else { 2 };
        let start = door.y + margin;
        let each = (self.width - start - margin) / f64::from(panes);
        let pane = |i: i32| {
            let x = start + f64::from(i) * each;
            Hole { low: DVec2::new(x + 0.12, 0.45), high: DVec2::new(x + each - 0.12, 2.75) }
        };
        let holes: Vec<Hole> = core::iter::once(entrance).chain((0..panes).map(pane)).collect();
        self.wall_with_holes(&holes, 0.0, GROUND_M, mesh);
        opening::door(mesh, entrance.low, entrance.high);
        for hole in &holes[1..] {
            opening::shop_window(mesh, hole.low, hole.high);
        }
        opening::fascia(mesh, "board", start, self.width - margin);
    }

    /// A stretch of the front between two heights: a grid of rectangles that leaves the holes out.
    fn wall_with_holes(&self, holes: &[Hole], bottom: f64, top: f64, mesh: &mut Mesh) {
        let mut left = 0.0;
        for hole in holes {
            self.wall_piece(mesh, [left, hole.low.x], [bottom, top]);
            self.wall_piece(mesh, [hole.low.x, hole.high.x], [bottom, hole.low.y]);
            self.wall_piece(mesh, [hole.low.x, hole.high.x], [hole.high.y, top]);
            opening::reveal(mesh, "wall", hole.low, hole.high);
            left = hole.high.x;
        }
        self.wall_piece(mesh, [left, self.width], [bottom, top]);
    }

    fn wall_piece(&self, mesh: &mut Mesh, x: [f64; 2], z: [f64; 2]) {
        let corner = |x: f64, z: f64| (DVec3::new(x, 0.0, z), DVec2::new(x, z) / TEXTURE_M);
        mesh.textured("wall", &[corner(x[0], z[0]), corner(x[1], z[0]), corner(x[1], z[1]), corner(x[0], z[1])]);
    }

    /// The side and back walls, without windows.
    fn other_walls(&self, mesh: &mut Mesh) {
        let corners = [[self.width, 0.0], [self.width, self.depth], [0.0, self.depth], [0.0, 0.0]];
        for pair in corners.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let length = (a[0] - b[0]).abs() + (a[1] - b[1]).abs();
            let at = |p: [f64; 2], z: f64, u: f64| (DVec3::new(p[0], p[1], z), DVec2::new(u, z) / TEXTURE_M);
            let high = self.eaves();
            mesh.textured("wall", &[at(a, 0.0, 0.0), at(b, 0.0, length), at(b, high, length), at(a, high, 0.0)]);
        }
    }

    /// Plinth, string course and cornice.
    fn bands(&self, mesh: &mut Mesh) {
        if self.ground == Ground::Home {
            let door = self.bay_centre(self.bays / 2);
            band(mesh, [0.0, door - 0.62], [0.0, 0.6], 0.04);
            band(mesh, [door + 0.62, self.width], [0.0, 0.6], 0.04);
        }
        band(mesh, [0.0, self.width], [GROUND_M - 0.02, GROUND_M + 0.16], 0.09);
        let eaves = self.eaves();
        band(mesh, [0.0, self.width], [eaves - 0.28, eaves - 0.14], 0.10);
        band(mesh, [0.0, self.width], [eaves - 0.14, eaves], 0.20);
    }
}

/// A strip of stone that stands out of the front: its four visible long sides and two ends.
fn band(mesh: &mut Mesh, x: [f64; 2], z: [f64; 2], out: f64) {
    let (low, high) = (DVec3::new(x[0], -out, z[0]), DVec3::new(x[1], 0.02, z[1]));
    opening::panel(mesh, "stone", low, high);
    mesh.block_side("stone", low, high, 2, false);
}
