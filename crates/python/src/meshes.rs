//! Files made in Python: texts, and meshes from arrays.

use crate::error::exception;
use crate::toml;
use etendue::{MemoryFiles, MeshTriangles};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;
use std::path::Path;

/// Arrays of a mesh, by their names in Python.
const ARRAYS: [&str; 4] = ["positions", "triangles", "normals", "uvs"];

/// Files by the names that the job uses, which are relative to its folder.
pub(crate) fn files(
    folder: &Path,
    texts: Option<&Bound<'_, PyAny>>,
    meshes: Option<&Bound<'_, PyAny>>,
) -> PyResult<MemoryFiles> {
    let mut files = MemoryFiles::new();
    for (name, text) in named("files", texts)? {
        let text = match toml::mapping(&text)? {
            Some(keys) => toml::file(&keys)?,
            None if text.is_instance_of::<PyString>() => text.extract()?,
            None => return Err(PyTypeError::new_err(format!("files[{name:?}]: expected a dict or a str (TOML)"))),
        };
        files.add_text(folder.join(name), text);
    }
    for (name, mesh) in named("meshes", meshes)? {
        add_mesh(&mut files, folder, &name, &mesh)?;
    }
    Ok(files)
}

/// Items of an argument that is a mapping, by name.
fn named<'py>(
    argument: &str,
    argument_value: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let Some(value) = argument_value else { return Ok(Vec::new()) };
    let type_error = || PyTypeError::new_err(format!("{argument}: expected a dict from names to values"));
    let value = toml::mapping(value)?.ok_or_else(type_error)?;
    value.iter().map(|(name, element)| Ok((name.extract().map_err(|_| type_error())?, element))).collect()
}

fn add_mesh(files: &mut MemoryFiles, folder: &Path, name: &str, mesh: &Bound<'_, PyAny>) -> PyResult<()> {
    let array_dict = toml::mapping(mesh)?.ok_or_else(|| {
        PyTypeError::new_err(format!("meshes[{name:?}]: expected a dict of arrays: {}", ARRAYS.join(", ")))
    })?;
    if let Some(unknown_key) =
        array_dict.keys().iter().map(|key| key.to_string()).find(|key| !ARRAYS.contains(&key.as_str()))
    {
        return Err(PyValueError::new_err(format!(
            "meshes[{name:?}]: unknown array {unknown_key:?}; expected {}",
            ARRAYS.join(", ")
        )));
    }
    let array = |key: &str| match array_dict.get_item(key)? {
        Some(array) if !array.is_none() => Ok(Some(NamedArray { array, place: format!("meshes[{name:?}][{key:?}]") })),
        _ => Ok::<_, PyErr>(None),
    };
    let needed = |key: &str| {
        array(key)?.ok_or_else(|| PyValueError::new_err(format!("meshes[{name:?}]: the array {key:?} is missing")))
    };
    let positions = floats::<3>(needed("positions")?)?;
    let triangles = indices(needed("triangles")?)?;
    let normals = array("normals")?.map(floats::<3>).transpose()?.unwrap_or_default();
    let uvs = array("uvs")?.map(floats::<2>).transpose()?.unwrap_or_default();
    let mesh = MeshTriangles { positions: &positions, triangles: &triangles, normals: &normals, uvs: &uvs };
    files.add_mesh(folder.join(name), &mesh).map_err(|error| exception(array_dict.py(), error))
}

/// Array of a dict, and its place in words.
struct NamedArray<'py> {
    array: Bound<'py, PyAny>,
    place: String,
}

/// Rows of `N` numbers.
fn floats<const N: usize>(NamedArray { array, place }: NamedArray<'_>) -> PyResult<Vec<[f32; N]>> {
    let array = rows(&array, N, "fiu", "numbers", &place)?;
    let bytes = bytes(&array, "float32")?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|b| f32::from_ne_bytes(*b)).collect::<Vec<_>>().as_chunks().0.to_vec())
}

/// Rows of three indices.
fn indices(NamedArray { array, place }: NamedArray<'_>) -> PyResult<Vec<[u32; 3]>> {
    let array = rows(&array, 3, "iu", "whole numbers", &place)?;
    if array.getattr("size")?.extract::<usize>()? > 0 {
        let fits_u32 = |method: &str| array.call_method0(method)?.extract::<i128>().map(|i| u32::try_from(i).is_ok());
        if !(fits_u32("min")? && fits_u32("max")?) {
            return Err(PyValueError::new_err(format!("{place}: expected vertex indices from 0 to 2^32 − 1")));
        }
    }
    let bytes = bytes(&array, "uint32")?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|b| u32::from_ne_bytes(*b)).collect::<Vec<_>>().as_chunks().0.to_vec())
}

/// Two-dimensional array with rows of `n` numbers of one of these kinds.
fn rows<'py>(
    array_like: &Bound<'py, PyAny>,
    n: usize,
    kinds: &str,
    content: &str,
    place: &str,
) -> PyResult<Bound<'py, PyAny>> {
    let array = array_like.py().import("numpy")?.call_method1("asarray", (array_like,))?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    if !matches!(shape[..], [_, columns] if columns == n) {
        return Err(PyValueError::new_err(format!("{place}: expected an array of shape (n, {n}), not {shape:?}")));
    }
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    match kinds.contains(&kind) {
        true => Ok(array),
        false => Err(PyTypeError::new_err(format!("{place}: expected {content}, not {}", array.getattr("dtype")?))),
    }
}

fn bytes(array: &Bound<'_, PyAny>, number: &str) -> PyResult<Vec<u8>> {
    array.call_method1("astype", (number,))?.call_method0("tobytes")?.extract()
}
