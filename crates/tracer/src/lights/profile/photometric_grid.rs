//! Measured intensities on a grid of angles.
//!
//! Angles are those of ANSI/IES LM-63 (2002, section 3), unit directions in the lamp's frame (x forward, y left, z up):
//! - type C: all planes share the vertical axis; the vertical angle γ is counted from straight down, the horizontal one C
//!   anticlockwise seen from above, C = 0 towards +x: (sin γ cos C, sin γ sin C, −cos γ);
//! - type A: all planes share the vertical axis; V is counted from the horizontal upwards, H clockwise seen from above
//!   (to the right): (cos V cos H, −cos V sin H, sin V). The sphere of UN regulations for headlamps is this one;
//! - type B: all planes share the horizontal axis; V turns the plane about it, H lies in the plane, to the right:
//!   (cos H cos V, −sin H, cos H sin V).
//!
//! The axis (0, 0) of types A and B is the lamp's +x. In LM-63 that of type B points straight down; this is a matter of the lamp's placement.
//!
//! The function is linear in each angle between neighbours, so exact at the points of the grid, and zero outside it. A grid of a single horizontal
//! angle is the same at all horizontal angles of its type. A grid of type C whose last plane is below 360° and whose first is 0° closes. Fluxes are
//! exact integrals of this function: ∫ (a + b φ) sin φ dφ along the polar angle, the mean across it.

use etendue_core::maths::f32::{acos, asin, atan2};
use etendue_core::maths::f64::sin_cos;
use glam::{DVec3, Vec3};

use super::spread::{DirectionalExtent, GAUSS, ProfileNode};

/// Meaning of the two angles of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotometricAxes {
    /// Vertical polar axis, zero straight ahead.
    A,
    /// Horizontal polar axis, zero straight ahead.
    B,
    /// Vertical polar axis, zero straight down.
    C,
}

/// Legal angles of a grid.
#[derive(Clone, Copy)]
struct AngleLimits {
    low_deg: f64,
    high_deg: f64,
    max_span_deg: f64,
}

/// Angles from one to another.
#[derive(Clone, Copy)]
struct AngleInterval {
    from_deg: f64,
    to_deg: f64,
}

impl AngleInterval {
    fn length_deg(self) -> f64 {
        self.to_deg - self.from_deg
    }

    /// The angle at a fraction of the interval.
    fn at(self, fraction: f64) -> f64 {
        self.from_deg + fraction * (self.to_deg - self.from_deg)
    }

    /// The interval shifted by an angle.
    fn shifted(self, angle_deg: f64) -> Self {
        Self { from_deg: angle_deg + self.from_deg, to_deg: angle_deg + self.to_deg }
    }
}

#[derive(Clone, Copy)]
struct GridCell {
    vertical: AngleInterval,
    horizontal: AngleInterval,
}

/// Error of a grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PhotometricGridError {
    /// Angles are missing, out of order or out of range.
    #[error("the {which} angles of the grid must increase, lie between {low}° and {high}°, and span at most {span}°")]
    Angles {
        /// "vertical" or "horizontal".
        which: &'static str,
        /// Minimum legal angle, degrees.
        low: f64,
        /// Maximum legal angle, degrees.
        high: f64,
        /// Maximum legal difference, degrees.
        span: f64,
    },
    /// The values do not fill the grid.
    #[error(
        "the grid of {vertical} vertical × {horizontal} horizontal angles has {actual} values; give one for each pair of angles"
    )]
    Size {
        /// Vertical angles.
        vertical: usize,
        /// Horizontal angles.
        horizontal: usize,
        /// Number of values given.
        actual: usize,
    },
    /// A value is negative or not finite.
    #[error("value {value} of the grid is negative or not a finite number; correct it")]
    Value {
        /// Its index, from 0, vertical angles first.
        value: usize,
    },
}

/// Intensities on a grid of angles. Its `Debug` text leaves out the values.
#[derive(Clone, PartialEq)]
pub struct PhotometricGrid {
    axes: PhotometricAxes,
    vertical_deg: AngleAxis,
    horizontal_deg: AngleAxis,
    /// All vertical angles of the first horizontal one, then of the next.
    values: Vec<f32>,
    spread: DirectionalExtent,
}

impl core::fmt::Debug for PhotometricGrid {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let size = (self.vertical_deg.nodes().len(), self.horizontal_deg.nodes().len());
        f.debug_struct("PhotometricGrid")
            .field("axes", &self.axes)
            .field("size", &size)
            .field("spread", &self.spread)
            .finish_non_exhaustive()
    }
}

impl PhotometricGrid {
    /// A grid: `values` holds all vertical angles of the first horizontal angle, then those of the next (as LM-63 does).
    ///
    /// # Errors
    /// If angles do not rise or leave their range, values do not fill the grid, or one is negative or not finite.
    pub fn new(
        axes: PhotometricAxes,
        vertical_deg: Vec<f32>,
        horizontal_deg: Vec<f32>,
        values: Vec<f32>,
    ) -> Result<Self, PhotometricGridError> {
        let (vertical, horizontal) = (vertical_deg.len(), horizontal_deg.len());
        if values.len() != vertical * horizontal || values.is_empty() {
            return Err(PhotometricGridError::Size { vertical, horizontal, actual: values.len() });
        }
        if let Some(value) = values.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
            return Err(PhotometricGridError::Value { value });
        }
        let (horizontal_deg, values) = closed(axes, horizontal_deg, values, vertical);
        let vertical_deg = checked(vertical_deg, "vertical", axes.vertical_limits())?;
        let horizontal_deg = checked(horizontal_deg, "horizontal", axes.horizontal_limits())?;
        let mut grid = Self { axes, vertical_deg, horizontal_deg, values, spread: DirectionalExtent::EVERYWHERE };
        let sampled = DirectionalExtent::from_nodes(&grid.nodes());
        let peak = grid.values.iter().copied().fold(0.0, f32::max);
        grid.spread = DirectionalExtent { flux_sr: grid.exact_flux_sr(), peak: f64::from(peak), ..sampled };
        Ok(grid)
    }

    /// Meaning of the angles.
    #[must_use]
    pub fn axes(&self) -> PhotometricAxes {
        self.axes
    }

    /// The value at a pair of angles, degrees; 0 outside the grid.
    #[must_use]
    pub fn at_deg(&self, vertical_deg: f32, horizontal_deg: f32) -> f32 {
        let (Some(v), Some(h)) = (self.vertical_deg.find(vertical_deg), self.horizontal_deg.find(horizontal_deg))
        else {
            return 0.0;
        };
        let rows = self.vertical_deg.nodes().len();
        let column = |h: usize| {
            let low = h * rows + v.low;
            v.mix(self.values[low], self.values[(low + 1).min((h + 1) * rows - 1)])
        };
        if h.t > 0.0 { h.mix(column(h.low), column(h.low + 1)) } else { column(h.low) }
    }

    pub(super) fn value(&self, direction: Vec3) -> f32 {
        let (vertical, horizontal) = self.axes.angles_deg(direction);
        let from = self.horizontal_deg.nodes()[0];
        // Angles a turn apart are the same direction.
        let turned = if horizontal < from - EDGE_DEG { horizontal + 360.0 } else { horizontal };
        self.at_deg(vertical, turned)
    }

    pub(super) fn spread(&self) -> &DirectionalExtent {
        &self.spread
    }

    /// Cells of the grid, row by row. A single horizontal angle represents sectors over the whole range.
    fn cells(&self) -> Vec<GridCell> {
        let horizontal = match self.horizontal_deg.nodes() {
            [_] => self.axes.sectors(),
            nodes => intervals(nodes).collect(),
        };
        let of_row = |vertical| horizontal.iter().map(move |horizontal| GridCell { vertical, horizontal: *horizontal });
        intervals(self.vertical_deg.nodes()).flat_map(of_row).collect()
    }

    fn exact_flux_sr(&self) -> f64 {
        self.cells().into_iter().map(|cell| self.cell_flux_sr(cell)).sum()
    }

    fn cell_flux_sr(&self, cell: GridCell) -> f64 {
        let GridCell { vertical: v, horizontal: h } = cell;
        let at = |v: f64, h: f64| f64::from(self.at_deg(v as f32, h as f32));
        let across = |a: AngleInterval, value: &dyn Fn(f64) -> f64| 0.5 * (value(a.from_deg) + value(a.to_deg));
        match self.axes {
            PhotometricAxes::B => {
                let [low, high] = [h.from_deg, h.to_deg].map(|h| across(v, &|v| at(v, h)));
                v.length_deg().to_radians() * polar_integral(h.shifted(90.0), low, high)
            }
            PhotometricAxes::A | PhotometricAxes::C => {
                let zero = if self.axes == PhotometricAxes::A { 90.0 } else { 0.0 };
                let [low, high] = [v.from_deg, v.to_deg].map(|v| across(h, &|h| at(v, h)));
                h.length_deg().to_radians() * polar_integral(v.shifted(zero), low, high)
            }
        }
    }

    /// Four directions per cell.
    pub(super) fn nodes(&self) -> Vec<ProfileNode> {
        self.cells().into_iter().flat_map(|cell| self.cell_nodes(cell)).collect()
    }

    fn cell_nodes(&self, cell: GridCell) -> impl Iterator<Item = ProfileNode> + '_ {
        let GridCell { vertical, horizontal } = cell;
        let size = [vertical.length_deg(), horizontal.length_deg()].map(f64::to_radians);
        let spacing_rad = (0.8 * (size[0] + size[1])) as f32;
        let angles = GAUSS.into_iter().flat_map(move |s| GAUSS.map(|t| (vertical.at(s), horizontal.at(t))));
        angles.map(move |(v, h)| {
            let (direction, stretch) = self.axes.direction(v, h);
            let weight_sr = 0.25 * size[0] * size[1] * stretch;
            ProfileNode { direction, value: self.at_deg(v as f32, h as f32), weight_sr, spacing_rad }
        })
    }
}

impl PhotometricAxes {
    fn vertical_limits(self) -> AngleLimits {
        match self {
            Self::A => AngleLimits { low_deg: -90.0, high_deg: 90.0, max_span_deg: 180.0 },
            Self::B => AngleLimits { low_deg: -180.0, high_deg: 180.0, max_span_deg: 360.0 },
            Self::C => AngleLimits { low_deg: 0.0, high_deg: 180.0, max_span_deg: 180.0 },
        }
    }

    fn horizontal_limits(self) -> AngleLimits {
        match self {
            Self::A => AngleLimits { low_deg: -180.0, high_deg: 180.0, max_span_deg: 360.0 },
            Self::B => AngleLimits { low_deg: -90.0, high_deg: 90.0, max_span_deg: 180.0 },
            Self::C => AngleLimits { low_deg: 0.0, high_deg: 360.0, max_span_deg: 360.0 },
        }
    }

    /// The range of a single horizontal angle: the whole range in steps of 5°.
    fn sectors(self) -> Vec<AngleInterval> {
        let AngleLimits { low_deg, high_deg, .. } = self.horizontal_limits();
        let edge_deg = |i: u32| low_deg + 5.0 * f64::from(i);
        let sector = |i| AngleInterval { from_deg: edge_deg(i), to_deg: edge_deg(i + 1) };
        (0..((high_deg - low_deg) / 5.0) as u32).map(sector).collect()
    }

    /// Vertical and horizontal angle (degrees) of a unit direction.
    fn angles_deg(self, d: Vec3) -> (f32, f32) {
        let (vertical, horizontal) = match self {
            Self::A => (asin(d.z.clamp(-1.0, 1.0)), atan2(-d.y, d.x)),
            Self::B => (atan2(d.z, d.x), asin((-d.y).clamp(-1.0, 1.0))),
            Self::C => (acos((-d.z).clamp(-1.0, 1.0)), atan2(d.y, d.x)),
        };
        (vertical.to_degrees(), horizontal.to_degrees())
    }

    /// The direction at a pair of angles (degrees), and solid angle over the product of their steps.
    fn direction(self, vertical_deg: f64, horizontal_deg: f64) -> (Vec3, f64) {
        let (sin_v, cos_v) = sin_cos(vertical_deg.to_radians());
        let (sin_h, cos_h) = sin_cos(horizontal_deg.to_radians());
        match self {
            Self::A => (DVec3::new(cos_v * cos_h, -cos_v * sin_h, sin_v).as_vec3(), cos_v),
            Self::B => (DVec3::new(cos_h * cos_v, -sin_h, cos_h * sin_v).as_vec3(), cos_h),
            Self::C => (DVec3::new(sin_v * cos_h, sin_v * sin_h, -cos_v).as_vec3(), sin_v),
        }
    }
}

/// From each number of a grid to the next.
fn intervals(nodes: &[f32]) -> impl Iterator<Item = AngleInterval> + '_ {
    nodes.windows(2).map(|w| AngleInterval { from_deg: f64::from(w[0]), to_deg: f64::from(w[1]) })
}

/// ∫ of a line from `low` to `high` times sin φ over an interval of polar angles.
fn polar_integral(interval: AngleInterval, low: f64, high: f64) -> f64 {
    let [a, b] = [interval.from_deg, interval.to_deg].map(f64::to_radians);
    let ((sin_a, cos_a), (sin_b, cos_b)) = (sin_cos(a), sin_cos(b));
    // ∫ sin = cos a − cos b; ∫ (φ − a) sin φ = sin b − sin a − (b − a) cos b.
    low * (cos_a - cos_b) + (high - low) * ((sin_b - sin_a) / (b - a) - cos_b)
}

fn checked(angles: Vec<f32>, which: &'static str, limits: AngleLimits) -> Result<AngleAxis, PhotometricGridError> {
    let AngleLimits { low_deg: low, high_deg: high, max_span_deg: span } = limits;
    let error = PhotometricGridError::Angles { which, low, high, span };
    let axis = AngleAxis::new(angles).ok_or(error)?;
    let (first, last) = (f64::from(axis.nodes()[0]), f64::from(axis.nodes()[axis.nodes().len() - 1]));
    let vertical_line = which == "vertical" && axis.nodes().len() == 1;
    if first < low || last > high || last - first > span || vertical_line { Err(error) } else { Ok(axis) }
}

/// Closes a grid of type C from 0° whose last plane is below 360°: its first plane is added at 360°.
fn closed(axes: PhotometricAxes, mut angles: Vec<f32>, mut values: Vec<f32>, rows: usize) -> (Vec<f32>, Vec<f32>) {
    let open = angles.len() > 1 && angles.first() == Some(&0.0) && angles.last().is_some_and(|l| *l < 360.0);
    if axes == PhotometricAxes::C && open && angles.last().is_some_and(|l| *l > 180.0) {
        angles.push(360.0);
        values.extend_from_within(..rows);
    }
    (angles, values)
}

/// Maximum distance beyond the outermost angles by which rounding may move an f32 angle computed from a direction.
pub(super) const EDGE_DEG: f32 = 1e-4;

/// Increasing numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AngleAxis {
    nodes: Vec<f32>,
    /// For each of equal steps from the first to the last number, the interval in which the step begins.
    guide: Vec<u16>,
    steps_per_unit: f32,
}

/// A position between node `low` and the next, at the fraction `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GridPosition {
    pub(super) low: usize,
    pub(super) t: f32,
}

impl AngleAxis {
    /// `None` if there are none or too many, one is not finite, or they do not increase.
    pub(super) fn new(nodes: Vec<f32>) -> Option<Self> {
        let rise = nodes.windows(2).all(|w| w[0] < w[1]) && nodes.iter().all(|n| n.is_finite());
        if nodes.is_empty() || nodes.len() > usize::from(u16::MAX) || !rise {
            return None;
        }
        let range = nodes[nodes.len() - 1] - nodes[0];
        let steps_per_unit = if range > 0.0 { (nodes.len() - 1) as f32 / range } else { 0.0 };
        let guide = (0..nodes.len()).map(|step| begin(&nodes, step)).collect();
        Some(Self { nodes, guide, steps_per_unit })
    }

    pub(super) fn nodes(&self) -> &[f32] {
        &self.nodes
    }

    /// Position of `x`; `None` outside. A single number holds everywhere.
    pub(super) fn find(&self, x: f32) -> Option<GridPosition> {
        let last = self.nodes.len() - 1;
        if last == 0 {
            return Some(GridPosition { low: 0, t: 0.0 });
        }
        let (first, end) = (self.nodes[0], self.nodes[last]);
        let inside = (first - EDGE_DEG..=end + EDGE_DEG).contains(&x);
        inside.then(|| self.interval(x.clamp(first, end), last))
    }

    fn interval(&self, x: f32, last: usize) -> GridPosition {
        let step = ((x - self.nodes[0]) * self.steps_per_unit) as usize;
        let mut low = usize::from(self.guide[step.min(last)]).min(last - 1);
        while low > 0 && self.nodes[low] > x {
            low -= 1;
        }
        while low + 1 < last && self.nodes[low + 1] <= x {
            low += 1;
        }
        GridPosition { low, t: (x - self.nodes[low]) / (self.nodes[low + 1] - self.nodes[low]) }
    }
}

/// The interval in which step `step` begins; there are as many steps as numbers.
fn begin(nodes: &[f32], step: usize) -> u16 {
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let x = first + (last - first) * step as f32 / (nodes.len() - 1).max(1) as f32;
    nodes.partition_point(|n| *n <= x).saturating_sub(1) as u16
}

impl GridPosition {
    /// Linear between two values.
    pub(super) fn mix(self, low: f32, high: f32) -> f32 {
        low + self.t * (high - low)
    }
}
