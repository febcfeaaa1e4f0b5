//! Names of elements and of parameters.

/// The elements of the format.
pub(super) const TAGS: &[&str] = &[
    "alias",
    "boolean",
    "bsdf",
    "default",
    "emitter",
    "film",
    "float",
    "include",
    "integer",
    "integrator",
    "lookat",
    "matrix",
    "medium",
    "object",
    "path",
    "phase",
    "point",
    "ref",
    "rfilter",
    "rgb",
    "rotate",
    "sampler",
    "scale",
    "scene",
    "sensor",
    "shape",
    "spectrum",
    "string",
    "subsurface",
    "texture",
    "transform",
    "translate",
    "vector",
    "volume",
];

/// A name of a version before 2, `diffuseReflectance`, as it is today, `diffuse_reflectance`.
pub(super) fn modern(name: &str) -> String {
    let mut made = String::with_capacity(name.len() + 4);
    for c in name.chars() {
        if c.is_ascii_uppercase() && !made.is_empty() {
            made.push('_');
        }
        made.push(c.to_ascii_lowercase());
    }
    made
}

/// A word of a file in a message.
pub(super) fn shortened(word: &str) -> String {
    const MAX: usize = 40;
    match word.char_indices().nth(MAX) {
        Some((end, _)) => format!("{} …", &word[..end]),
        None => word.to_owned(),
    }
}
