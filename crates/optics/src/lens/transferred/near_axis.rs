//! First-order properties of a lens given by ray-transfer functions: least squares over rays near the axis, because fits have errors of their own.

use glam::{DVec2, DVec3};

use super::{pupils::Oval, sight::PupilQuery};
use crate::ray_transfer::{RayTransfer, RayTransferError};
use crate::{lens::paraxial_properties::Conjugates, lens::search::towards, overlap::PRINCIPAL_NM, pupil::MM};

/// First-order properties for a sensor position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FirstOrderProperties {
    /// Distance from the rear vertex to the sensor, mm.
    pub(super) sensor_mm: f64,
    pub(super) focal_length_mm: f64,
    /// Distance from the sensor to the entrance pupil, mm.
    pub(super) entrance_mm: f64,
    pub(super) entrance_radius_mm: f64,
    /// Distance from the sensor to the exit pupil, mm.
    pub(super) exit_mm: f64,
    pub(super) principal_distance_mm: f64,
    /// Inverse distance from the entrance pupil to the plane in focus, 1/mm.
    pub(super) vergence_per_mm: f64,
}

/// Fields of the chief rays, relative to the reach of the functions: nearer to the axis the fit errors of the ellipse centres are as large as the
/// effect measured.
const FIELDS: [f64; 5] = [0.1, 0.2, 0.3, 0.4, 0.5];
/// Heights of the rays that give the focal length, relative to the radius of the axial bundle.
const HEIGHTS: [f64; 5] = [0.04, 0.08, 0.12, 0.16, 0.2];
/// Number of zones of the axial bundle: the centres of equal areas.
const ZONES: usize = 16;
const EDGE_DIRECTIONS: usize = 32;
/// The largest sensor distance tried for focus, in focal lengths from the input plane.
const MAX_SENSOR_DISTANCE: f64 = 6.0;
const HALVINGS: usize = 80;

impl FirstOrderProperties {
    /// Properties for a sensor at a distance from the rear vertex; `reach_mm` is the distance from the axis up to which the lens is used.
    pub(super) fn at(transfer: &RayTransfer, sensor_mm: f64, reach_mm: f64) -> Result<Self, RayTransferError> {
        let plane_mm = transfer.input_offset_mm();
        if sensor_mm < plane_mm || sensor_mm <= 0.0 {
            return Err(RayTransferError::SensorTooNear { sensor_mm, plane_mm });
        }
        let dark = || RayTransferError::Dark { sensor_mm };
        if transfer.pupil_distance_mm(sensor_mm) <= 0.0 {
            return Err(RayTransferError::PassPlane { sensor_mm });
        }
        let sight = PupilQuery { transfer, sensor_mm, of: Some(transfer.nearest(PRINCIPAL_NM)) };
        let known_mm = transfer.transfers()[transfer.nearest(PRINCIPAL_NM)].pass.max_height_mm();
        let chiefs =
            ChiefRays::near_axis(&sight, if known_mm.is_finite() { known_mm } else { reach_mm }).ok_or_else(dark)?;
        let oval = Oval::about(&sight, 0.0).ok_or_else(dark)?;
        let radius_mm = oval.axes_mm.x;
        let heights = |zone: f64| {
            let ray = sight.meridian_ray(0.0, radius_mm * zone, PRINCIPAL_NM)?;
            let slope = ray.direction.y / ray.direction.z;
            Some((ray.point_mm.y + slope * (chiefs.entrance_mm - ray.point_mm.z), slope))
        };
        let zones = (0..ZONES).map(|i| ((i as f64 + 0.5) / ZONES as f64).sqrt());
        let bundle: Vec<_> = zones.filter_map(heights).collect();
        let squares: f64 = bundle.iter().map(|(y, _)| y * y).sum();
        let turns: f64 = bundle.iter().map(|(y, slope)| y * slope).sum();
        let edge = (0..EDGE_DIRECTIONS)
            .filter_map(|i| edge_height(&sight, &oval, towards(i, EDGE_DIRECTIONS), chiefs.entrance_mm));
        let edge: Vec<f64> = edge.collect();
        let focal_length_mm = focal_length_mm(transfer, radius_mm).ok_or(RayTransferError::Powerless)?;
        if !(squares > 0.0 && !edge.is_empty() && chiefs.principal_distance_mm > 0.0) {
            return Err(dark());
        }
        Ok(Self {
            sensor_mm,
            focal_length_mm,
            entrance_mm: chiefs.entrance_mm,
            entrance_radius_mm: edge.iter().sum::<f64>() / edge.len() as f64,
            exit_mm: chiefs.exit_mm,
            principal_distance_mm: chiefs.principal_distance_mm,
            vergence_per_mm: -turns / squares,
        })
    }

    /// Properties for the sensor position at which a distance (m, infinity is legal) is sharp.
    pub(super) fn focused(transfer: &RayTransfer, focus_m: f64, reach_mm: f64) -> Result<Self, RayTransferError> {
        let power_per_mm = MM / focus_m;
        let radius_mm = transfer.transfers()[transfer.nearest(PRINCIPAL_NM)].pass.radius_on_axis_mm();
        let focal_mm = focal_length_mm(transfer, radius_mm).ok_or(RayTransferError::Powerless)?;
        let low_mm = transfer.input_offset_mm().max(0.0) + 1e-6 * focal_mm;
        let mut places = [low_mm, low_mm + MAX_SENSOR_DISTANCE * focal_mm];
        let off =
            |sensor_mm: f64| Self::at(transfer, sensor_mm, reach_mm).map(|near| near.vergence_per_mm - power_per_mm);
        // A sensor too far away or too near may be dark: the bracket lies where both ends are defined.
        let known: Vec<(f64, f64)> = (0..=48)
            .map(|i| places[0] + (places[1] - places[0]) * f64::from(i * i) / f64::from(48 * 48))
            .filter_map(|sensor_mm| Some((sensor_mm, off(sensor_mm).ok()?)))
            .collect();
        let crossing = known.windows(2).find(|pair| pair[0].1 <= 0.0 && pair[1].1 > 0.0);
        let none = RayTransferError::Focus { focus_m, low_mm, high_mm: places[1] };
        places = crossing.map(|pair| [pair[0].0, pair[1].0]).ok_or(none)?;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (places[0] + places[1]);
            places[usize::from(off(middle)? > 0.0)] = middle;
        }
        Ok(Self { vergence_per_mm: power_per_mm, ..Self::at(transfer, places[0], reach_mm)? })
    }

    /// First-order focusing, in the terms of the paraxial lenses.
    pub(super) fn conjugates(&self) -> Conjugates {
        Conjugates {
            magnification: self.principal_distance_mm * self.vergence_per_mm.max(0.0),
            principal_distance_mm: self.principal_distance_mm,
            inverse_focus_per_mm: self.vergence_per_mm,
        }
    }
}

/// Distance from the axis at which a marginal ray of the axial bundle meets the plane of the entrance pupil, mm.
fn edge_height(sight: &PupilQuery<'_>, oval: &Oval, direction: DVec2, entrance_mm: f64) -> Option<f64> {
    let centre = DVec2::new(oval.centre_mm, 0.0);
    let step = direction * oval.axes_mm;
    let q = centre + step * sight.reach(0.0, centre, step, 1.5);
    let entry = sight.transfer.entry(DVec2::ZERO, q, sight.sensor_mm);
    let ray = sight.transfer.exit_ray(&entry, sight.sensor_mm, PRINCIPAL_NM)?;
    let at: DVec3 = ray.point_mm + ray.direction * ((entrance_mm - ray.point_mm.z) / ray.direction.z);
    Some(at.truncate().length())
}

/// f from rays parallel to the axis: they leave at −ρ/f. `None` if they are not refracted towards it.
fn focal_length_mm(transfer: &RayTransfer, radius_mm: f64) -> Option<f64> {
    // The sensor is far enough behind for the rays to be parallel, at the height of each.
    let sensor_mm = transfer.input_offset_mm().max(0.0) + radius_mm;
    let sight = PupilQuery { transfer, sensor_mm, of: None };
    let slope = |height_mm: f64| {
        let ray = sight.meridian_ray(height_mm, height_mm, PRINCIPAL_NM)?;
        Some((height_mm, ray.direction.y / ray.direction.z))
    };
    let rays: Vec<(f64, f64)> = HEIGHTS.iter().filter_map(|part| slope(part * radius_mm)).collect();
    let squares: f64 = rays.iter().map(|(height, _)| height * height).sum();
    let turned: f64 = rays.iter().map(|(height, slope)| height * slope).sum();
    Some(-squares / turned).filter(|f| f.is_finite() && *f > 0.0)
}

/// Axis crossing of chief rays near the axis, and the scale of tangents.
struct ChiefRays {
    entrance_mm: f64,
    exit_mm: f64,
    principal_distance_mm: f64,
}

impl ChiefRays {
    fn near_axis(sight: &PupilQuery<'_>, reach_mm: f64) -> Option<Self> {
        let distance_mm = sight.distance_mm();
        // Sums of squares of slopes in front and of their products with the axis crossings; of slopes behind; of heights and slopes.
        let (mut front, mut crossings, mut behind, mut exits, mut heights, mut products) =
            (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for height in FIELDS.map(|part| part * reach_mm) {
            let [low, high] = sight.meridional(height)?;
            let along = 0.5 * (low + high);
            let ray = sight.meridian_ray(height, along, PRINCIPAL_NM)?;
            let slope = ray.direction.y / ray.direction.z;
            front += slope * slope;
            crossings += slope * (slope * ray.point_mm.z - ray.point_mm.y);
            behind += (height - along) * (height - along);
            exits += height * (height - along) * distance_mm;
            heights += height * height;
            products -= height * slope;
        }
        Some(Self {
            entrance_mm: crossings / front,
            // The sign of a nearly infinite value is a fit error.
            exit_mm: if behind > 0.0 { (exits / behind).abs() } else { f64::INFINITY },
            principal_distance_mm: heights / products,
        })
    }
}
