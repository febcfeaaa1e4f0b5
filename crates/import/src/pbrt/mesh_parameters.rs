//! Points, normals, texture coordinates and indices of meshes.

use super::parameters::Parameters;
use crate::scenery::Triangles;

impl Triangles {
    pub(super) fn from_parameters(parameters: Parameters<'_>) -> Result<Self, String> {
        let mesh = Self::points(parameters)?;
        let triangles = indices::<3>(parameters, mesh.positions.len())?;
        Ok(Self { triangles, ..mesh })
    }

    pub(super) fn points(parameters: Parameters<'_>) -> Result<Self, String> {
        let positions = tuples::<3, f64>("P", parameters.numbers("P")?.ok_or("no \"P\"")?)?.to_vec();
        let normals = tuples::<3, f64>("N", parameters.numbers("N")?.unwrap_or_default())?.to_vec();
        let uvs = match parameters.numbers("uv")? {
            Some(uvs) => Some(uvs),
            None => parameters.numbers("st")?,
        };
        let uvs = tuples::<2, f64>("uv", uvs.unwrap_or_default())?.to_vec();
        for (name, count) in [("N", normals.len()), ("uv", uvs.len())] {
            if count != 0 && count != positions.len() {
                return Err(format!(
                    "{count} values of \"{name}\" for {} values of \"P\"; expected as many",
                    positions.len()
                ));
            }
        }
        Ok(Self { positions, normals, uvs, triangles: Vec::new() })
    }
}

/// Corner indices of faces with `N` corners; if the file states none, those of one face in order.
pub(super) fn indices<const N: usize>(parameters: Parameters<'_>, vertices: usize) -> Result<Vec<[u32; N]>, String> {
    match parameters.numbers("indices")? {
        Some(stated) => {
            let legal = stated.iter().map(|i| index(*i, vertices)).collect::<Result<Vec<u32>, _>>()?;
            tuples::<N, u32>("indices", &legal).map(<[_]>::to_vec)
        }
        None if vertices == N => Ok(vec![std::array::from_fn(|i| i as u32)]),
        None => Err("\"indices\" is missing".to_owned()),
    }
}

fn index(value: f64, vertices: usize) -> Result<u32, String> {
    match value.fract() == 0.0 && value >= 0.0 && value < vertices as f64 {
        true => Ok(value as u32),
        false => Err(format!("index {value} is out of range: there are {vertices} points")),
    }
}

fn tuples<'a, const N: usize, T>(name: &str, values: &'a [T]) -> Result<&'a [[T; N]], String> {
    match values.as_chunks::<N>() {
        (chunks, []) => Ok(chunks),
        _ => Err(format!("\"{name}\": {} numbers; expected a multiple of {N}", values.len())),
    }
}
