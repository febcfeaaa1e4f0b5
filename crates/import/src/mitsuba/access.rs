//! Access to the parameters of an element by name.

use etendue_io::Error;
use glam::DVec3;

use crate::syntax::mitsuba::MitsubaElement;

/// Numbers separated by commas and spaces.
pub(super) fn numbers_of(text: &str) -> Result<Vec<f64>, String> {
    let words = text.split(|c: char| c == ',' || c.is_ascii_whitespace()).filter(|word| !word.is_empty());
    words.map(number_of).collect()
}

/// One finite number.
pub(super) fn number_of(word: &str) -> Result<f64, String> {
    let shown: String = word.chars().take(40).collect();
    match word.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("\"{shown}\" is not finite")),
        Err(_) => Err(format!("expected a number, found \"{shown}\"")),
    }
}

/// Number of an attribute, or `default`.
pub(super) fn attribute_number(element: &MitsubaElement, name: &str, default: f64) -> Result<f64, Error> {
    let number = element.attribute(name).map(number_of).transpose().map_err(|problem| element.error(problem))?;
    Ok(number.unwrap_or(default))
}

/// Three numbers of an element: attributes x, y and z, each optional, or one value of three numbers or one.
pub(super) fn triple_of(element: &MitsubaElement, default: f64) -> Result<DVec3, Error> {
    let Some(value) = element.attribute("value") else {
        let [x, y, z] = ["x", "y", "z"].map(|name| attribute_number(element, name, default));
        return Ok(DVec3::new(x?, y?, z?));
    };
    match numbers_of(value).map_err(|problem| element.error(problem))?[..] {
        [one] => Ok(DVec3::splat(one)),
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        ref others => Err(element.error(format!("expected three numbers, found {}", others.len()))),
    }
}

/// The parameter of this name.
pub(super) fn find<'a>(element: &'a MitsubaElement, name: &str) -> Option<&'a MitsubaElement> {
    let child_element = element.children.iter().find(|child| child.attribute("name") == Some(name))?;
    child_element.used.set(true);
    Some(child_element)
}

/// Value of a parameter as text.
fn value<'a>(parameter: &'a MitsubaElement, tags: &[&str]) -> Result<&'a str, Error> {
    match parameter.attribute("value") {
        Some(value) if tags.contains(&parameter.tag) => Ok(value),
        _ => {
            let message = format!("\"{}\": expected <{} value=\"…\"/>", parameter.name(), tags.join("> or <"));
            Err(parameter.error(message))
        }
    }
}

/// Number of a parameter; `None` if it is absent.
pub(super) fn stated(element: &MitsubaElement, name: &str) -> Result<Option<f64>, Error> {
    let Some(parameter) = find(element, name) else { return Ok(None) };
    let text = value(parameter, &["float", "integer"])?;
    number_of(text).map(Some).map_err(|problem| parameter.error(format!("\"{name}\": {problem}")))
}

/// The number of a parameter, or `default`.
pub(super) fn number(element: &MitsubaElement, name: &str, default: f64) -> Result<f64, Error> {
    Ok(stated(element, name)?.unwrap_or(default))
}

/// The text of a parameter.
pub(super) fn text<'a>(element: &'a MitsubaElement, name: &str) -> Result<Option<&'a str>, Error> {
    find(element, name).map(|parameter| value(parameter, &["string"])).transpose()
}

/// Boolean of a parameter, or `default`.
pub(super) fn flag(element: &MitsubaElement, name: &str, default: bool) -> Result<bool, Error> {
    let Some(parameter) = find(element, name) else { return Ok(default) };
    match value(parameter, &["boolean"])?.to_ascii_lowercase().as_str() {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(parameter.error(format!("\"{name}\": expected true or false"))),
    }
}

/// The point or vector of a parameter, or `default`.
pub(super) fn vector(element: &MitsubaElement, name: &str, default: DVec3) -> Result<DVec3, Error> {
    match find(element, name) {
        None => Ok(default),
        Some(parameter) if matches!(parameter.tag, "point" | "vector") => triple_of(parameter, 0.0),
        Some(parameter) => Err(parameter.error(format!("\"{name}\": expected <point> or <vector>"))),
    }
}

/// Child elements of one kind.
pub(super) fn all<'a>(element: &'a MitsubaElement, tag: &'static str) -> impl Iterator<Item = &'a MitsubaElement> {
    element.children.iter().filter(move |child| child.tag == tag).inspect(|child| child.used.set(true))
}
