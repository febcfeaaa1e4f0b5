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

/// A name of a version before 2, `intIOR`, as it is today, `int_ior`: a run of capitals behind a small letter is parted from it and made small.
pub(super) fn modern(name: &str) -> String {
    let mut made = String::with_capacity(name.len() + 4);
    let mut letters = name.chars().peekable();
    while let Some(c) = letters.next() {
        made.push(c);
        if c.is_ascii_lowercase() && letters.peek().is_some_and(char::is_ascii_uppercase) {
            made.push('_');
            while let Some(capital) = letters.next_if(char::is_ascii_uppercase) {
                made.push(capital.to_ascii_lowercase());
            }
            // Mitsuba's own loop steps over the letter behind the run.
            made.extend(letters.next());
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_names_are_spelt_as_mitsuba_spells_them() {
        let names = ["intIOR", "diffuseReflectance", "toWorld", "alphaU", "RGB", "uv", "", "aBcD"].map(modern);
        assert_eq!(names, ["int_ior", "diffuse_reflectance", "to_world", "alpha_u", "RGB", "uv", "", "a_bcD"]);
    }
}
