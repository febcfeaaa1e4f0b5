//! Measured intensities on a grid of angles.
//!
//! Angles are those of ANSI/IES LM-63 (2002, section 3), unit directions in the lamp's frame (x forward, y left, z up):
//! - type C: all planes share the vertical axis; the vertical angle γ is counted from straight down, the horizontal one C
//!   anticlockwise seen from above, C = 0 towards +x: (sin γ cos C, sin γ sin C, −cos γ);
//! - type A: all planes share the vertical axis; V is counted from the horizontal upwards, H clockwise seen from above
//!   (to the right): (cos V cos H, −cos V sin H, sin V). The sphere of UN regulations for head lamps is this one;
//! - type B: all planes share the horizontal axis; V turns the plane about it, H lies in the plane, to the right:
//!   (cos H cos V, −sin H, cos H sin V).
//!
//! The axis (0, 0) of types A and B is the lamp's +x; LM-63 lets that of type B hang straight down, which is a matter of
//! how the lamp is placed.
//!
//! Linear in each angle between neighbours, so exact at the points of the grid; zero outside it. A grid of a single
//! horizontal angle is the same at all that its type has. One of type C whose last plane is short of 360° and whose first is 0° closes.
//! Fluxes are integrals of just this function, exact: ∫ (a + b φ) sin φ dφ along the polar angle, the mean across it.

use etendue_core::maths::f32::{acos, asin, atan2};
use etendue_core::maths::f64::sin_cos;
use glam::{DVec3, Vec3};

use super::axis::{Axis, EDGE_DEG};
use super::quadrature::{GAUSS, Node};
use super::spread::Spread;

/// What the two angles of a grid mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WebAxes {
    /// Vertical polar axis, zero straight ahead.
    A,
    /// Horizontal polar axis, zero straight ahead.
    B,
    /// Vertical polar axis, zero straight down.
    C,
}

/// Why a grid is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WebError {
    /// Angles are missing, out of order or out of range.
    #[error(
        "the {which} angles of the grid must rise and lie between {low}° and {high}°, within a span of {span}°; correct \
         them"
    )]
    Angles {
        /// "vertical" or "horizontal".
        which: &'static str,
        /// The least legal one, degrees.
        low: f64,
        /// The greatest legal one, degrees.
        high: f64,
        /// The greatest legal difference, degrees.
        span: f64,
    },
    /// The values do not fill the grid.
    #[error(
        "{found} values were given for a grid of {vertical} vertical × {horizontal} horizontal angles; give one each"
    )]
    Size {
        /// Vertical angles.
        vertical: usize,
        /// Horizontal angles.
        horizontal: usize,
        /// Values given.
        found: usize,
    },
    /// A value is negative or not finite.
    #[error("value {value} of the grid is negative or not a finite number; correct it")]
    Value {
        /// Its place, counted from 0, vertical angles first.
        value: usize,
    },
}

/// Intensities on a grid of angles. Its `Debug` text leaves out the values.
#[derive(Clone, PartialEq)]
pub struct Web {
    axes: WebAxes,
    vertical_deg: Axis,
    horizontal_deg: Axis,
    /// All vertical angles of the first horizontal one, then of the next.
    values: Vec<f32>,
    spread: Spread,
}

impl core::fmt::Debug for Web {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let size = (self.vertical_deg.nodes().len(), self.horizontal_deg.nodes().len());
        f.debug_struct("Web")
            .field("axes", &self.axes)
            .field("size", &size)
            .field("spread", &self.spread)
            .finish_non_exhaustive()
    }
}

impl Web {
    /// A grid: `values` holds all vertical angles of the first horizontal angle, then those of the next (as LM-63 does).
    ///
    /// # Errors
    /// Where angles do not rise or leave their range, values do not fill the grid, or one is negative or not finite.
    pub fn new(
        axes: WebAxes,
        vertical_deg: Vec<f32>,
        horizontal_deg: Vec<f32>,
        values: Vec<f32>,
    ) -> Result<Self, WebError> {
        let (vertical, horizontal) = (vertical_deg.len(), horizontal_deg.len());
        if values.len() != vertical * horizontal || values.is_empty() {
            return Err(WebError::Size { vertical, horizontal, found: values.len() });
        }
        if let Some(value) = values.iter().position(|v| !(v.is_finite() && *v >= 0.0)) {
            return Err(WebError::Value { value });
        }
        let (horizontal_deg, values) = closed(axes, horizontal_deg, values, vertical);
        let vertical_deg = checked(vertical_deg, "vertical", axes.vertical_range())?;
        let horizontal_deg = checked(horizontal_deg, "horizontal", axes.horizontal_range())?;
        let mut web = Self { axes, vertical_deg, horizontal_deg, values, spread: Spread::EVERYWHERE };
        let sampled = Spread::of(&web.nodes());
        let peak = web.values.iter().copied().fold(0.0, f32::max);
        web.spread = Spread { flux_sr: web.exact_flux_sr(), peak: f64::from(peak), ..sampled };
        Ok(web)
    }

    /// What the angles mean.
    #[must_use]
    pub fn axes(&self) -> WebAxes {
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

    pub(super) fn spread(&self) -> &Spread {
        &self.spread
    }

    /// Cells of the grid, vertical interval first, as intervals in degrees. A single horizontal angle is that of sectors
    /// over the whole range.
    fn cells(&self) -> Vec<[[f64; 2]; 2]> {
        let horizontal = match self.horizontal_deg.nodes() {
            [_] => self.axes.sectors(),
            nodes => intervals(nodes).collect(),
        };
        let of_row = |v: [f64; 2]| horizontal.iter().map(move |h| [v, *h]);
        intervals(self.vertical_deg.nodes()).flat_map(of_row).collect()
    }

    fn exact_flux_sr(&self) -> f64 {
        self.cells().into_iter().map(|[v, h]| self.cell_flux_sr(v, h)).sum()
    }

    /// Flux of one cell.
    fn cell_flux_sr(&self, v: [f64; 2], h: [f64; 2]) -> f64 {
        let at = |v: f64, h: f64| f64::from(self.at_deg(v as f32, h as f32));
        let across = |a: [f64; 2], value: &dyn Fn(f64) -> f64| 0.5 * (value(a[0]) + value(a[1]));
        match self.axes {
            WebAxes::B => {
                let [low, high] = h.map(|h| across(v, &|v| at(v, h)));
                (v[1] - v[0]).to_radians() * polar_integral([90.0 + h[0], 90.0 + h[1]], [low, high])
            }
            WebAxes::A | WebAxes::C => {
                let zero = if self.axes == WebAxes::A { 90.0 } else { 0.0 };
                let [low, high] = v.map(|v| across(h, &|h| at(v, h)));
                (h[1] - h[0]).to_radians() * polar_integral([zero + v[0], zero + v[1]], [low, high])
            }
        }
    }

    /// Four directions a cell.
    pub(super) fn nodes(&self) -> Vec<Node> {
        self.cells().into_iter().flat_map(|[v, h]| self.cell_nodes(v, h)).collect()
    }

    fn cell_nodes(&self, v: [f64; 2], h: [f64; 2]) -> impl Iterator<Item = Node> + '_ {
        let size = [v[1] - v[0], h[1] - h[0]].map(f64::to_radians);
        let spacing_rad = (0.8 * (size[0] + size[1])) as f32;
        GAUSS.into_iter().flat_map(move |s| GAUSS.map(|t| (v[0] + s * (v[1] - v[0]), h[0] + t * (h[1] - h[0])))).map(
            move |(v, h)| {
                let (direction, stretch) = self.axes.direction(v, h);
                let weight_sr = 0.25 * size[0] * size[1] * stretch;
                Node { direction, value: self.at_deg(v as f32, h as f32), weight_sr, spacing_rad }
            },
        )
    }
}

impl WebAxes {
    fn vertical_range(self) -> [f64; 3] {
        match self {
            Self::A => [-90.0, 90.0, 180.0],
            Self::B => [-180.0, 180.0, 360.0],
            Self::C => [0.0, 180.0, 180.0],
        }
    }

    fn horizontal_range(self) -> [f64; 3] {
        match self {
            Self::A => [-180.0, 180.0, 360.0],
            Self::B => [-90.0, 90.0, 180.0],
            Self::C => [0.0, 360.0, 360.0],
        }
    }

    /// What a single horizontal angle stands for: the whole range in steps of 5°.
    fn sectors(self) -> Vec<[f64; 2]> {
        let [low, high, _] = self.horizontal_range();
        (0..((high - low) / 5.0) as u32).map(|i| [low + 5.0 * f64::from(i), low + 5.0 * f64::from(i + 1)]).collect()
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
fn intervals(nodes: &[f32]) -> impl Iterator<Item = [f64; 2]> + '_ {
    nodes.windows(2).map(|w| [f64::from(w[0]), f64::from(w[1])])
}

/// ∫ of a line from `low` to `high` times sin φ over the polar angles `degrees`.
fn polar_integral(degrees: [f64; 2], [low, high]: [f64; 2]) -> f64 {
    let [a, b] = degrees.map(f64::to_radians);
    let ((sin_a, cos_a), (sin_b, cos_b)) = (sin_cos(a), sin_cos(b));
    // ∫ sin = cos a − cos b; ∫ (φ − a) sin φ = sin b − sin a − (b − a) cos b.
    low * (cos_a - cos_b) + (high - low) * ((sin_b - sin_a) / (b - a) - cos_b)
}

fn checked(angles: Vec<f32>, which: &'static str, [low, high, span]: [f64; 3]) -> Result<Axis, WebError> {
    let fault = WebError::Angles { which, low, high, span };
    let axis = Axis::new(angles).ok_or(fault)?;
    let (first, last) = (f64::from(axis.nodes()[0]), f64::from(axis.nodes()[axis.nodes().len() - 1]));
    let vertical_line = which == "vertical" && axis.nodes().len() == 1;
    if first < low || last > high || last - first > span || vertical_line { Err(fault) } else { Ok(axis) }
}

/// A grid of type C from 0° whose last plane is short of the whole turn gets its first plane there again.
fn closed(axes: WebAxes, mut angles: Vec<f32>, mut values: Vec<f32>, rows: usize) -> (Vec<f32>, Vec<f32>) {
    let open = angles.len() > 1 && angles.first() == Some(&0.0) && angles.last().is_some_and(|l| *l < 360.0);
    if axes == WebAxes::C && open && angles.last().is_some_and(|l| *l > 180.0) {
        angles.push(360.0);
        values.extend_from_within(..rows);
    }
    (angles, values)
}
