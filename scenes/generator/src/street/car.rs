//! Cars: a body lofted through cross-sections, with wheel arches, glazing, lamps, plates and mirrors.
//!
//! The proportions are those of common European cars; no make is copied. x forward, origin on the ground under the
//! middle of the car.

use super::curve::Curve;
use super::wheel;
use crate::mesh::{Mesh, place};
use crate::paint::plates;
use glam::{DAffine3, DMat3, DVec2, DVec3};

/// The lines that shape a body: each a curve over x, m.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// Height of the upper surface in the middle of the car.
    pub(super) top: Curve,
    /// Height of the shoulder under the side windows.
    pub(super) belt: Curve,
    /// Height of the underside.
    pub(super) floor: Curve,
    /// Half the width at the shoulder.
    pub(super) half_width: Curve,
    /// Half the width of the roof at its rail.
    pub(super) rail: Curve,
    /// x of the axles, front and rear.
    pub(super) axles: [f64; 2],
    /// Radius of the tyres.
    pub(super) wheel_radius: f64,
    /// x where the windscreen starts (below) and ends (above).
    pub(super) windscreen: [f64; 2],
    /// x where the rear window starts (above) and ends (below); none in a van, whose rear window stands upright.
    pub(super) rear_window: Option<[f64; 2]>,
    /// Stretches of x with side glass.
    pub(super) side_glass: &'static [[f64; 2]],
    /// x of the gaps of doors and lids.
    pub(super) gaps: &'static [f64],
    /// x of the front and rear end.
    pub(super) ends: [f64; 2],
}

/// Width of a gap between panels.
const GAP_M: f64 = 0.008;
/// How far a wheel arch stands off its tyre.
const ARCH_M: f64 = 0.055;
/// Rings of a half cross-section: where along the way from sill to belt the side's points lie, and how far in.
const SIDE: [[f64; 2]; 6] = [[0.0, 0.03], [0.06, 0.012], [0.32, 0.0], [0.55, -0.008], [0.80, 0.004], [1.0, 0.03]];

/// Names of the cells between points of a half cross-section, from the underside to the roof's middle.
const FLOOR_CELLS: usize = 3;
const BELT_CELL: usize = FLOOR_CELLS + SIDE.len() - 1;
const GLASS_CELL: usize = BELT_CELL + 1;
const RAIL_CELL: usize = GLASS_CELL + 1;
const PILLAR_CELL: usize = RAIL_CELL + 1;

impl Shape {
    /// The whole car.
    #[must_use]
    pub(super) fn mesh(&self) -> Mesh {
        self.assembled(true)
    }

    /// The car without its wheels.
    #[must_use]
    pub(super) fn body(&self) -> Mesh {
        self.assembled(false)
    }

    /// Where the wheels' axles are: front left and right, rear left and right, m.
    pub(super) fn hubs(&self) -> impl Iterator<Item = [f64; 3]> {
        self.axles.into_iter().flat_map(|axle| {
            let reach = self.half_width.at(axle) - 0.125;
            [[axle, reach, self.wheel_radius], [axle, -reach, self.wheel_radius]]
        })
    }

    fn assembled(&self, with_wheels: bool) -> Mesh {
        let mut mesh = Mesh::default();
        let stations = self.stations();
        let rings: Vec<_> = stations.iter().map(|&x| self.ring(x)).collect();
        let mut half = Mesh::default();
        half.loft(&rings, |i, j| {
            self.cell_slot((stations[i] + stations[i + 1]) / 2.0, stations[i + 1] - stations[i], j)
        });
        self.cap(&rings[rings.len() - 1], true, &mut half);
        self.cap(&rings[0], false, &mut half);
        self.mirror_arm(&mut half);
        self.handles(&mut half);
        mesh.add(&half, DAffine3::IDENTITY);
        mesh.add(&half, DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)));
        if with_wheels {
            self.wheels(&mut mesh);
        }
        self.plates(&mut mesh);
        mesh
    }

    /// Places of the cross-sections: even steps, finer at the ends and round the arches, and every line that must be met.
    fn stations(&self) -> Vec<f64> {
        let [front, rear] = self.ends;
        let length = front - rear;
        let regular = (1..24).map(|i| rear + length * f64::from(i) / 24.0);
        let ends = [0.0, 0.012, 0.035, 0.08].into_iter().flat_map(|s| [rear + s, front - s]);
        let arches = self.axles.into_iter().flat_map(|axle| self.arch_stations(axle));
        let glass = self.side_glass.iter().flatten().copied();
        let windows = self.windscreen.into_iter().chain(self.rear_window.into_iter().flatten());
        let must: Vec<f64> =
            arches.chain(glass).chain(windows).chain(self.gaps.iter().flat_map(|x| [*x, x + GAP_M])).collect();
        let is_separate = |x: f64| must.iter().all(|m| (m - x).abs() > 0.05);
        let mut all: Vec<f64> = regular.filter(|x| is_separate(*x)).chain(ends).chain(must.iter().copied()).collect();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|a, b| (*a - *b).abs() < 0.002);
        all
    }

    fn arch_stations(&self, axle: f64) -> Vec<f64> {
        let radius = self.wheel_radius + ARCH_M;
        let round = [1.0, 0.96, 0.86, 0.66, 0.36];
        let half = round.into_iter().flat_map(|c| [axle + radius * c, axle - radius * c]);
        half.chain([axle, axle + radius + 0.006, axle - radius - 0.006]).collect()
    }

    /// Height of the body's lower edge: the sill, or the arch above a wheel.
    fn sill(&self, x: f64) -> f64 {
        let radius = self.wheel_radius + ARCH_M;
        let low = self.floor.at(x) + 0.05;
        let arch = self.axles.into_iter().map(|axle| (x - axle) / radius).find(|s| s.abs() <= 1.0);
        arch.map_or(low, |s| low.max(self.wheel_radius + radius * (1.0 - s * s).max(0.0).sqrt()))
    }

    /// Half a cross-section, from the underside's middle over the side to the roof's middle.
    fn ring(&self, x: f64) -> Vec<DVec3> {
        let (floor, sill, belt) = (self.floor.at(x), self.sill(x), self.belt.at(x));
        let (width, top) = (self.half_width.at(x), self.top.at(x));
        let well = width - 0.27;
        let mut points = vec![[0.0, floor], [well, floor], [well, floor.max(sill - 0.02)]];
        points.extend(SIDE.map(|[t, inward]| [width - inward, sill + t * (belt - sill)]));
        points.extend(self.upper(x, width, belt, top));
        points.into_iter().map(|[y, z]| DVec3::new(x, y, z)).collect()
    }

    /// The points above the belt: glass, rail, roof.
    fn upper(&self, x: f64, width: f64, belt: f64, top: f64) -> [[f64; 2]; 7] {
        let rise = (top - belt).max(0.0);
        let rail = self.rail.at(x).min(width - 0.06);
        let (low, drop) = (belt + (0.018_f64).min(0.5 * rise), (0.07_f64).min(0.30 * rise));
        let foot = width - 0.055;
        let at = |t: f64| [foot + (rail - foot) * t, low + (top - drop - low) * (t + 0.10 * t * (1.0 - t))];
        let crown = |t: f64| [rail * (1.0 - t), top - drop * (1.0 - t) * (1.0 - t)];
        [[foot, low], at(0.92), at(1.0), crown(0.10), crown(0.32), crown(0.65), [0.0, top]]
    }

    fn cell_slot(&self, x: f64, length: f64, cell: usize) -> &'static str {
        let between = |[a, b]: [f64; 2]| x > a.min(b) && x < a.max(b);
        let screen = between(self.windscreen) || self.rear_window.is_some_and(between);
        match cell {
            0..FLOOR_CELLS => "trim",
            _ if cell < GLASS_CELL
                && cell > FLOOR_CELLS
                && self.gaps.iter().any(|g| (x - g - GAP_M / 2.0).abs() < 1e-3) =>
            {
                "gap"
            }
            FLOOR_CELLS => "trim",
            _ if cell == FLOOR_CELLS + 1 && (x < self.ends[1] + 0.3 || x > self.ends[0] - 0.3) => "trim",
            BELT_CELL if self.side_glass.iter().copied().any(between) => "trim",
            GLASS_CELL if self.side_glass.iter().copied().any(between) => "glass",
            GLASS_CELL if self.cabin(x) && length > 0.0 && self.pillar(x) => "trim",
            _ if cell >= PILLAR_CELL && screen => "glass",
            _ => self.lamp_slot(x, cell).unwrap_or("paint"),
        }
    }

    /// Whether x lies in a narrow pillar between two panes.
    fn pillar(&self, x: f64) -> bool {
        self.side_glass.windows(2).any(|pair| {
            let (low, high) = (pair[0][1].min(pair[1][1]), pair[0][0].max(pair[1][0]));
            x > low.min(high) && x < low.max(high) && (high - low).abs() < 0.2
        })
    }

    fn cabin(&self, x: f64) -> bool {
        self.top.at(x) - self.belt.at(x) > 0.2
    }

    /// Lamps wrap round the corners at both ends.
    fn lamp_slot(&self, x: f64, cell: usize) -> Option<&'static str> {
        let [front, rear] = self.ends;
        let tall = self.rear_window.is_none();
        let rear_cells = if tall { FLOOR_CELLS + 3..=BELT_CELL - 1 } else { FLOOR_CELLS + 4..=BELT_CELL };
        match () {
            () if x > front - 0.36 && x < front - 0.012 && (FLOOR_CELLS + 4..=BELT_CELL).contains(&cell) => {
                Some("headlamp")
            }
            () if x < rear + 0.20 && rear_cells.contains(&cell) => Some("taillamp"),
            () => None,
        }
    }

    /// The flat end of the loft on the left half: strips from side to middle.
    fn cap(&self, ring: &[DVec3], front: bool, half: &mut Mesh) {
        for (j, pair) in ring.windows(2).enumerate() {
            let middle = |p: DVec3| DVec3::new(p.x, 0.0, p.z);
            let mut points = [pair[0], middle(pair[0]), middle(pair[1]), pair[1]];
            if front {
                points.reverse();
            }
            half.flat(self.cap_slot(j, front), &points);
        }
    }

    fn cap_slot(&self, cell: usize, front: bool) -> &'static str {
        let tall_rear = !front && self.rear_window.is_none();
        match cell {
            0..=FLOOR_CELLS => "trim",
            _ if front && (cell == FLOOR_CELLS + 1 || cell == BELT_CELL - 1) => "grille",
            _ if !front && cell == FLOOR_CELLS + 1 => "trim",
            GLASS_CELL if tall_rear => "glass",
            _ => "paint",
        }
    }

    /// A wing mirror: a shell that opens backwards, with its glass, on a foot.
    fn mirror_arm(&self, half: &mut Mesh) {
        let x = self.windscreen[0] - 0.30;
        let base = DVec3::new(x, self.half_width.at(x) + 0.075, self.belt.at(x) + 0.085);
        let size = DMat3::from_cols(DVec3::Z * 0.75, DVec3::NEG_Y * 1.15, DVec3::X);
        let frame = DAffine3 { matrix3: size, translation: base };
        half.lathe("glass", frame, &[[0.012, 0.0], [0.012, 0.074]], 12);
        half.lathe("trim", frame, &[[0.012, 0.074], [0.0, 0.078]], 12);
        half.lathe("paint", frame, &[[0.0, 0.078], [0.05, 0.086], [0.10, 0.074], [0.14, 0.040], [0.15, 0.0]], 12);
        let foot = DVec3::new(x + 0.02, base.y - 0.14, base.z - 0.075);
        half.block("trim", foot, DVec3::new(x + 0.08, base.y, base.z - 0.045));
    }

    fn handles(&self, half: &mut Mesh) {
        for &gap in self.gaps.iter().filter(|gap| self.cabin(**gap)) {
            let (x, z) = (gap + 0.10, self.belt.at(gap) - 0.13);
            let y = self.half_width.at(x);
            half.block("paint", DVec3::new(x, y - 0.02, z - 0.013), DVec3::new(x + 0.18, y + 0.028, z + 0.013));
        }
    }

    fn wheels(&self, mesh: &mut Mesh) {
        let wheel = wheel::mesh(self.wheel_radius);
        for axle in self.axles {
            let reach = self.half_width.at(axle) - 0.125;
            let at = |side: f64| DVec3::new(axle, side * reach, self.wheel_radius);
            mesh.add(&wheel, place(0.0, at(1.0)));
            mesh.add(&wheel, place(180.0, at(-1.0)));
        }
    }

    fn plates(&self, mesh: &mut Mesh) {
        let [front, rear] = self.ends;
        let high = if self.rear_window.is_none() { 0.50 } else { 0.62 };
        plate(mesh, place(0.0, DVec3::new(front + 0.012, 0.0, 0.42)));
        plate(mesh, place(180.0, DVec3::new(rear - 0.012, 0.0, high)));
    }
}

/// A number plate that faces +x of its frame, on a thin board.
fn plate(mesh: &mut Mesh, frame: DAffine3) {
    let [w, h] = plates::SIZE_M;
    let corner =
        |s: f64, t: f64| (frame.transform_point3(DVec3::new(0.0, (s - 0.5) * w, (t - 0.5) * h)), DVec2::new(s, t));
    mesh.textured("plate", &[corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)]);
    let mut board = Mesh::default();
    let (y, z) = (w / 2.0 + 0.012, h / 2.0 + 0.012);
    board.block("trim", DVec3::new(-0.03, -y, -z), DVec3::new(-0.003, y, z));
    mesh.add(&board, frame);
}
