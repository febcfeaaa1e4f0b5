//! Elements that define surfaces: polygons and strips.

use super::super::vertex::check_range;
use super::header::{PlyElement, PlyProperty};
use super::input::PlyInput;
use crate::Problem;

/// Names of the list of a polygon's corners.
const CORNER_NAMES: [&str; 2] = ["vertex_indices", "vertex_index"];
/// Name of the texture coordinates of a polygon's corners, as MeshLab writes them.
const UV_NAME: &str = "texcoord";
/// Maximum corners of a polygon, which takes much memory while it is cut into triangles.
const MAX_CORNERS: usize = 1 << 16;

/// Corners of a polygon or a strip, with their texture coordinates if any.
#[derive(Debug, Default)]
pub(super) struct PlyFace {
    pub(super) corners: Vec<u32>,
    /// One per corner, or none.
    pub(super) uvs: Vec<[f32; 2]>,
}

/// Returns true if a property holds corners or their texture coordinates.
pub(super) fn is_used(property: &PlyProperty) -> bool {
    property.count.is_some() && (CORNER_NAMES.contains(&&*property.name) || property.name == UV_NAME)
}

/// Returns true if faces have their own texture coordinates.
pub(super) fn has_uvs(element: &PlyElement) -> bool {
    element.properties.iter().any(|p| p.count.is_some() && p.name == UV_NAME)
}

/// Error of a face of too few corners.
pub(super) fn too_few_corners(corners: usize) -> Problem {
    format!("has {corners} corners; expected three or more").into()
}

/// Reads all faces, passes each to `take` (also those of fewer than three corners), and moves the input past them.
pub(super) fn polygons(
    element: &PlyElement,
    input: &mut PlyInput<'_>,
    vertices: usize,
    mut take: impl FnMut(&PlyFace, &PlyInput<'_>) -> Result<(), Problem>,
) -> Result<(), Problem> {
    check(element, input)?;
    let mut face = PlyFace::default();
    for number in 0..element.count {
        let mut read = || {
            face.corners.clear();
            face.uvs.clear();
            for property in &element.properties {
                match is_used(property) {
                    true if property.name == UV_NAME => read_uvs(property, input, &mut face.uvs)?,
                    true => read_corners(property, input, vertices, &mut face.corners)?,
                    false => input.skip(property)?,
                }
            }
            if face.corners.len() < 3 {
                return take(&face, input);
            }
            if !face.uvs.is_empty() && face.uvs.len() != face.corners.len() {
                let (uvs, corners) = (face.uvs.len(), face.corners.len());
                return Err(format!("has texture coordinates of {uvs} corners; expected {corners}").into());
            }
            take(&face, input)
        };
        read().map_err(|what| format!("face {number}: {what}"))?;
    }
    Ok(())
}

/// Reads all strips and passes each triangle to `take`: −1 begins a new strip.
pub(super) fn strips(
    element: &PlyElement,
    input: &mut PlyInput<'_>,
    vertices: usize,
    mut take: impl FnMut([u32; 3]) -> Result<(), Problem>,
) -> Result<(), Problem> {
    check(element, input)?;
    for number in 0..element.count {
        let mut read = || {
            for property in &element.properties {
                if !is_used(property) || property.name == UV_NAME {
                    input.skip(property)?;
                    continue;
                }
                let (mut last, mut count) = ([0; 2], 0_usize);
                for _ in 0..input.list_length(property)? {
                    let index = input.number(property.number)?;
                    if index == -1.0 {
                        count = 0;
                        continue;
                    }
                    let corner = corner(index, vertices, input)?;
                    if count >= 2 {
                        let [a, b] = if count.is_multiple_of(2) { last } else { [last[1], last[0]] };
                        take([a, b, corner])?;
                    }
                    (last, count) = ([last[1], corner], count + 1);
                }
            }
            Ok(())
        };
        read().map_err(|problem: Problem| problem.within(format_args!("strip {number}")))?;
    }
    Ok(())
}

fn check(element: &PlyElement, input: &PlyInput<'_>) -> Result<(), Problem> {
    input.check_rows(element)?;
    let lists = element.properties.iter().filter(|p| p.count.is_some() && CORNER_NAMES.contains(&&*p.name)).count();
    match lists {
        1 => Ok(()),
        0 => Err(format!("the element `{}` has no list `vertex_indices`; export the mesh again", element.name).into()),
        _ => Err(format!("the element `{}` has two lists of corners; export the mesh again", element.name).into()),
    }
}

fn read_corners(
    property: &PlyProperty,
    input: &mut PlyInput<'_>,
    vertices: usize,
    corners: &mut Vec<u32>,
) -> Result<(), Problem> {
    let length = input.list_length(property)?;
    if length > MAX_CORNERS {
        return Err(format!(
            "has {length} corners; at most {MAX_CORNERS} are supported: triangulate the mesh in the modelling program"
        )
        .into());
    }
    corners.reserve(length);
    for _ in 0..length {
        let index = input.number(property.number)?;
        corners.push(corner(index, vertices, input)?);
    }
    Ok(())
}

fn corner(index: f64, vertices: usize, input: &PlyInput<'_>) -> Result<u32, Problem> {
    if index >= 0.0 && index < vertices as f64 && index.fract() == 0.0 {
        return Ok(index as u32);
    }
    let hint = input.byte_order_hint();
    Err(format!(
        "index {index} is out of range: there are {vertices} vertices, counted from 0; the file is damaged{hint}"
    )
    .into())
}

fn read_uvs(property: &PlyProperty, input: &mut PlyInput<'_>, uvs: &mut Vec<[f32; 2]>) -> Result<(), Problem> {
    let length = input.list_length(property)?;
    if !length.is_multiple_of(2) {
        return Err(format!("has {length} texture coordinates; expected two per corner").into());
    }
    if length > 2 * MAX_CORNERS {
        return Err(format!("has texture coordinates of more than {MAX_CORNERS} corners").into());
    }
    uvs.reserve(length / 2);
    for _ in 0..length / 2 {
        let uv = [input.number(property.number)?, input.number(property.number)?];
        check_range(&uv)?;
        uvs.push(uv.map(|v| v as f32));
    }
    Ok(())
}
