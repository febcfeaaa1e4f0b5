//! Parameters and their values: `<default>`, `$name`, and values given by the caller.

use std::collections::{BTreeMap, BTreeSet};

use etendue_scene::limits;

/// Maximum bytes of a parameter name.
const MAX_NAME: usize = 64;

/// Maximum number of names in a message.
const MAX_NAMES_SHOWN: usize = 12;

struct ParameterValue {
    text: String,
    is_given: bool,
    is_used: bool,
}

pub(super) struct Parameters {
    values: BTreeMap<String, ParameterValue>,
    /// Lengths of the names.
    lengths: BTreeSet<usize>,
}

impl Parameters {
    /// Initial values given by the caller, before any file is read.
    pub(super) fn from_values(pairs: &[(String, String)]) -> Result<Self, String> {
        let mut result = Self { values: BTreeMap::new(), lengths: BTreeSet::new() };
        for (name, text) in pairs {
            check_name(name).map_err(|problem| format!("a value is given to a parameter {problem}"))?;
            result.lengths.insert(name.len());
            let value = ParameterValue { text: text.clone(), is_given: true, is_used: false };
            if result.values.insert(name.clone(), value).is_some() {
                return Err(format!("the parameter \"{name}\" has two values; give one"));
            }
        }
        Ok(result)
    }

    /// Handles a `<default>`: the first value of a name applies.
    pub(super) fn default(&mut self, name: String, text: String) -> Result<(), String> {
        check_name(&name).map_err(|problem| format!("<default> {problem}"))?;
        self.lengths.insert(name.len());
        self.values.entry(name).or_insert(ParameterValue { text, is_given: false, is_used: false });
        Ok(())
    }

    /// Substitutes the parameters in a value (`$spp`), longest names first. `bytes` counts the resulting text.
    pub(super) fn substitute(&mut self, value: &str, bytes: &mut u64) -> Result<String, String> {
        let mut result = String::new();
        let mut rest = value;
        while let Some((before, after)) = rest.split_once('$') {
            result.push_str(before);
            let mut names = self.lengths.iter().rev().filter_map(|length| after.get(..*length));
            let Some(name) = names.find(|name| self.values.contains_key(*name)) else {
                return Err(unknown(after));
            };
            rest = &after[name.len()..];
            if let Some(value) = self.values.get_mut(name) {
                value.is_used = true;
                result.push_str(&value.text);
                *bytes += value.text.len().max(1) as u64;
                limits::DESCRIPTION.check_unpacked(*bytes).map_err(|problem| problem.words)?;
            }
        }
        result.push_str(rest);
        Ok(result)
    }

    /// Checks, when all files are read, that every given value was used.
    pub(super) fn check_used(&self) -> Result<(), String> {
        let Some((name, _)) = self.values.iter().find(|(_, value)| value.is_given && !value.is_used) else {
            return Ok(());
        };
        let used: Vec<String> = self.values.iter().filter(|(_, v)| v.is_used).map(|(n, _)| format!("${n}")).collect();
        let known = match used.len() {
            0 => "the scene has no parameters".to_owned(),
            n if n > MAX_NAMES_SHOWN => format!("its parameters are {}, …", used[..MAX_NAMES_SHOWN].join(", ")),
            _ => format!("its parameters are {}", used.join(", ")),
        };
        Err(format!(
            "a value is given to the parameter \"{name}\", and \"${name}\" does not occur in the scene: {known}"
        ))
    }
}

/// Error in the name of a parameter.
fn check_name(name: &str) -> Result<(), String> {
    match name.len() {
        0 => Err("without a name".to_owned()),
        1..=MAX_NAME => Ok(()),
        long => Err(format!("with a name of {long} bytes; expected {MAX_NAME} at most")),
    }
}

fn unknown(after: &str) -> String {
    let word: String = after.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    let word = shortened(&word);
    format!("\"${word}\" has no <default name=\"{word}\" …> before it; add one, or give a value by -D {word}=…")
}

/// Elements of the format.
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

/// Current spelling (`int_ior`) of a name of a version before 2 (`intIOR`): a run of capitals after a lower-case letter is separated by an underscore and
/// lower-cased.
pub(super) fn modern(name: &str) -> String {
    let mut result = String::with_capacity(name.len() + 4);
    let mut letters = name.chars().peekable();
    while let Some(c) = letters.next() {
        result.push(c);
        if c.is_ascii_lowercase() && letters.peek().is_some_and(char::is_ascii_uppercase) {
            result.push('_');
            while let Some(capital) = letters.next_if(char::is_ascii_uppercase) {
                result.push(capital.to_ascii_lowercase());
            }
            // Mitsuba's own loop skips the letter after the run.
            result.extend(letters.next());
        }
    }
    result
}

/// Word of a file, shortened for a message.
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
