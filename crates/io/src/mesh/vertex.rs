//! Vertex data: unit normals, and the origin relative to which positions are stored.

use etendue_scene::limits::CORNERS;

use crate::{ErrorCode, Problem};

/// Unit vector in 32 bits; z for a face of zero area, which no ray hits.
pub(super) fn unit(v: [f64; 3]) -> [f32; 3] {
    let largest = v.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if largest == 0.0 {
        return [0.0, 0.0, 1.0];
    }
    let scaled = v.map(|c| c / largest);
    let length = scaled.iter().map(|c| c * c).sum::<f64>().sqrt();
    scaled.map(|c| (c / length) as f32)
}

/// Refuses too many corners of faces.
pub(super) fn check_corners(corners: u64) -> Result<(), Problem> {
    let max = CORNERS.current().min(u64::from(u32::MAX));
    if corners <= max {
        return Ok(());
    }
    let remedy = CORNERS.remedy(corners);
    let words =
        format!("the faces have {corners} corners; at most {max} are supported: make the mesh smaller, {remedy}");
    Err(Problem::new(ErrorCode::TooLarge, words))
}

/// Refuses coordinates that 32 bits cannot hold.
pub(super) fn check_range(coordinates: &[f64]) -> Result<(), String> {
    match coordinates.iter().find(|v| v.abs() > f64::from(f32::MAX)) {
        Some(far) => Err(format!("coordinate {far:e} is beyond the range of 32-bit floats")),
        None => Ok(()),
    }
}

/// Position of a file relative to the mesh's origin, as a mesh stores it.
pub(super) fn relative(place: [f64; 3], origin: [f64; 3]) -> [f32; 3] {
    std::array::from_fn(|axis| (place[axis] - origin[axis]) as f32)
}

/// Centre of a mesh that lies further from the file's origin than twice its extent, as in maps and surveys; zero for others. Relative to it 32 bits hold every
/// vertex to 3e-8 of the extent.
pub(super) fn middle_of_far<I: Iterator<Item = f64>>(coordinates: impl Fn(usize) -> I) -> [f64; 3] {
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| coordinates(axis).reduce(pick).unwrap_or(0.0);
    let bounds = [0, 1, 2].map(|axis| [bound(axis, f64::min), bound(axis, f64::max)]);
    let extent = bounds.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    let farthest = bounds.iter().flatten().fold(0.0_f64, |largest, v| largest.max(v.abs()));
    if farthest > 2.0 * extent { bounds.map(|[low, high]| 0.5 * low + 0.5 * high) } else { [0.0; 3] }
}
