//! Access to the parameters of a directive by name.

use crate::syntax::pbrt::{PbrtParameter, PbrtValues};

/// Parameters of one directive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters<'a>(pub(super) &'a [PbrtParameter]);

impl<'a> Parameters<'a> {
    /// The parameter of this name.
    pub(super) fn find(&self, name: &str) -> Option<&'a PbrtParameter> {
        let parameter = self.0.iter().find(|p| p.name == name)?;
        parameter.used.set(true);
        Some(parameter)
    }

    /// Numbers of a parameter; `None` if it is absent.
    pub(super) fn numbers(&self, name: &str) -> Result<Option<&'a [f64]>, String> {
        match self.find(name).map(|p| &p.values) {
            None => Ok(None),
            Some(PbrtValues::Numbers(numbers)) => Ok(Some(numbers)),
            Some(_) => Err(format!("\"{name}\": expected numbers")),
        }
    }

    /// Single number of a parameter, or `default`.
    pub(super) fn number(&self, name: &str, default: f64) -> Result<f64, String> {
        match self.numbers(name)? {
            None => Ok(default),
            Some([number]) => Ok(*number),
            Some(others) => Err(format!("\"{name}\": expected one number, found {}", others.len())),
        }
    }

    /// Three numbers of a parameter, or `default`.
    pub(super) fn triple(&self, name: &str, default: [f64; 3]) -> Result<[f64; 3], String> {
        match self.numbers(name)? {
            None => Ok(default),
            Some(numbers) => {
                let count = numbers.len();
                numbers.try_into().map_err(|_| format!("\"{name}\": expected three numbers, found {count}"))
            }
        }
    }

    /// Text of a parameter.
    pub(super) fn text(&self, name: &str) -> Result<Option<&'a str>, String> {
        match self.texts(name)? {
            None => Ok(None),
            Some([text]) => Ok(Some(text)),
            Some(_) => Err(format!("\"{name}\": expected one string, found several")),
        }
    }

    pub(super) fn texts(&self, name: &str) -> Result<Option<&'a [String]>, String> {
        match self.find(name).map(|p| &p.values) {
            None => Ok(None),
            Some(PbrtValues::Texts(texts)) => Ok(Some(texts)),
            Some(_) => Err(format!("\"{name}\": expected a quoted string")),
        }
    }

    /// Boolean of a parameter, or `default`.
    pub(super) fn flag(&self, name: &str, default: bool) -> Result<bool, String> {
        match self.find(name).map(|p| &p.values) {
            None => Ok(default),
            Some(PbrtValues::Flags(flags)) if flags.len() == 1 => Ok(flags[0]),
            Some(_) => Err(format!("\"{name}\": expected true or false")),
        }
    }

    /// Names of unused parameters.
    pub(super) fn unused(&self) -> impl Iterator<Item = &'a str> {
        self.0.iter().filter(|p| !p.used.get()).map(|p| p.name.as_str())
    }
}
