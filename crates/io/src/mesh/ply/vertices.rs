//! The element `vertex`.

use super::super::vertex::{check_range, unit};
use super::header::Element;
use super::input::Input;
use crate::Problem;

/// Names of texture coordinates, as writers have them.
const UV_NAMES: [[&str; 2]; 4] = [["u", "v"], ["s", "t"], ["texture_u", "texture_v"], ["texture_s", "texture_t"]];

/// The vertices of a file.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    pub(super) positions: Vec<[f64; 3]>,
    /// One a vertex, or none.
    pub(super) normals: Vec<[f32; 3]>,
    /// One a vertex, or none.
    pub(super) uvs: Vec<[f32; 2]>,
}

/// What a property is used for: nothing, or a coordinate of something.
#[derive(Clone, Copy)]
enum Use {
    Nothing,
    Position(usize),
    Normal(usize),
    Uv(usize),
}

/// The uses of the properties of an element.
struct Uses {
    each: Vec<Use>,
    has_normals: bool,
    has_uvs: bool,
}

impl Uses {
    fn of(element: &Element) -> Result<Self, Problem> {
        let has = |name: &str| element.properties.iter().any(|p| p.name == name && p.count.is_none());
        if let Some(missing) = ["x", "y", "z"].into_iter().find(|name| !has(name)) {
            return Err(format!("its element `vertex` has no property `{missing}`; export the mesh again").into());
        }
        let has_normals = ["nx", "ny", "nz"].into_iter().all(has);
        let uv = UV_NAMES.into_iter().find(|pair| pair.iter().all(|name| has(name)));
        let place = |names: &[&str], name: &str| names.iter().position(|n| *n == name);
        let use_of = |name: &str| {
            place(&["x", "y", "z"], name)
                .map(Use::Position)
                .or_else(|| place(&["nx", "ny", "nz"], name).filter(|_| has_normals).map(Use::Normal))
                .or_else(|| uv.and_then(|pair| place(&pair, name)).map(Use::Uv))
                .unwrap_or(Use::Nothing)
        };
        let each = element.properties.iter().map(|p| use_of(&p.name)).collect();
        Ok(Self { each, has_normals, has_uvs: uv.is_some() })
    }
}

impl Vertices {
    /// Reads the element; what of it is not used, by its names.
    pub(super) fn read(element: &Element, input: &mut Input<'_>) -> Result<(Self, Vec<String>), Problem> {
        input.check_rows(element)?;
        if element.count > u32::MAX as usize {
            return Err(format!("{} vertices, where a mesh has at most {}", element.count, u32::MAX).into());
        }
        let uses = Uses::of(element)?;
        let of = |has: bool| if has { element.count } else { 0 };
        let mut vertices = Self {
            positions: Vec::with_capacity(element.count),
            normals: Vec::with_capacity(of(uses.has_normals)),
            uvs: Vec::with_capacity(of(uses.has_uvs)),
        };
        for number in 0..element.count {
            vertices.row(element, &uses, input).map_err(|what| format!("vertex {number}: {what}"))?;
        }
        let unused = element.properties.iter().zip(&uses.each).filter(|(_, used)| matches!(used, Use::Nothing));
        Ok((vertices, unused.map(|(p, _)| p.name.clone()).collect()))
    }

    fn row(&mut self, element: &Element, uses: &Uses, input: &mut Input<'_>) -> Result<(), Problem> {
        let (mut position, mut normal, mut uv) = ([0.0; 3], [0.0_f64; 3], [0.0_f64; 2]);
        for (property, used) in element.properties.iter().zip(&uses.each) {
            match used {
                Use::Nothing => input.skip(property)?,
                Use::Position(axis) => position[*axis] = input.number(property.number)?,
                Use::Normal(axis) => normal[*axis] = input.number(property.number)?,
                Use::Uv(axis) => uv[*axis] = input.number(property.number)?,
            }
        }
        check_range(&position)?;
        self.positions.push(position);
        if uses.has_normals {
            let is_zero = normal == [0.0; 3];
            self.normals.push(if is_zero { [0.0; 3] } else { unit(normal) });
        }
        if uses.has_uvs {
            check_range(&uv)?;
            self.uvs.push(uv.map(|v| v as f32));
        }
        Ok(())
    }
}
