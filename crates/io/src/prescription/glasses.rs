//! Glasses that lens files name.
//!
//! A name is, in this order: a glass of the catalogues given with the lens, of the built-in catalogues that the file names, of Schott or Ohara, a glass by its
//! number (517642), the maker's successor of that name (N-SK2 for SK2; noted), and a glass of another maker.

use etendue_scene::asset::{GlassAsset, GlassCatalogueAsset, NamedGlass};
use etendue_spectra::glass::{self, CatalogueGlass, GlassMatch, LINE_D_NM};

use super::text::Words;
use crate::{Error, ErrorCode};

/// Catalogues in which the glasses of a file are searched.
pub(super) struct GlassSearch<'a> {
    /// Those given with the lens.
    own: &'a [GlassCatalogueAsset],
    /// Names of catalogues in the file (GCAT), in order.
    stated: Vec<String>,
}

/// A glass, and a note on it.
pub(super) struct NotedGlass {
    pub(super) glass: GlassAsset,
    pub(super) note: Option<String>,
    /// True if it is the successor of the named glass.
    pub(super) is_successor: bool,
}

impl NotedGlass {
    pub(super) fn plain(glass: GlassAsset) -> Self {
        Self { glass, note: None, is_successor: false }
    }

    /// A built-in glass, with a note if other makers have a different one of that name.
    fn built_in(name: &str, matched: &GlassMatch) -> Self {
        let note = (!matched.others.is_empty()).then(|| same_name(name, matched));
        Self { glass: named(NamedGlass::built_in(matched.glass)), note, is_successor: false }
    }

    fn successor(name: &str, today: &CatalogueGlass) -> Self {
        let note = format!("{name} is discontinued: its successor {} is used", today.name);
        Self { glass: named(NamedGlass::built_in(today)), note: Some(note), is_successor: true }
    }
}

impl<'a> GlassSearch<'a> {
    pub(super) fn new(own: &'a [GlassCatalogueAsset]) -> Self {
        Self { own, stated: Vec::new() }
    }

    /// Catalogues that the file names.
    pub(super) fn prefer(&mut self, catalogues: &[&str]) {
        self.stated = catalogues.iter().map(|name| (*name).to_owned()).collect();
    }

    /// The glass that a line names; `None` if no catalogue has it and it is no number.
    ///
    /// # Errors
    /// A given catalogue has the glass, but its record cannot be used.
    pub(super) fn find(&self, name: &str, w: &Words<'_>) -> Result<Option<NotedGlass>, Error> {
        if let Some(own) = self.own_glass(name, w)? {
            return Ok(Some(NotedGlass::plain(named(own))));
        }
        let stated: Vec<&str> = self.stated.iter().map(String::as_str).collect();
        let first = || glass::find_first(name, &stated).map(|matched| NotedGlass::built_in(name, &matched));
        let number = || by_number(name).map(NotedGlass::plain);
        let successor = || glass::successor(name, &stated).map(|today| NotedGlass::successor(name, today));
        let other = || glass::find(name, &stated).map(|matched| NotedGlass::built_in(name, &matched));
        Ok(first().or_else(number).or_else(successor).or_else(other))
    }

    fn own_glass(&self, name: &str, w: &Words<'_>) -> Result<Option<NamedGlass>, Error> {
        let stem = name.split_once('_').map_or(name, |(stem, _)| stem);
        for catalogue in self.own {
            for spelling in [name, stem] {
                let error = |cause: glass::agf::AgfError| {
                    w.error(format!("{} (line {} of {})", cause.problem, cause.line, catalogue.file.display()))
                };
                if let Some(glass) = catalogue.find(spelling).map_err(error)? {
                    return Ok(Some(glass));
                }
            }
        }
        Ok(None)
    }
}

fn named(glass: NamedGlass) -> GlassAsset {
    GlassAsset::Named(Box::new(glass))
}

/// Note on a name that several makers use for different glasses.
fn same_name(name: &str, matched: &GlassMatch) -> String {
    let words = |glass: &CatalogueGlass| format!("{} n_d {:.5}", glass.maker, glass.dispersion.index(LINE_D_NM));
    let others: Vec<String> = matched.others.iter().map(|glass| words(glass)).collect();
    format!("{name} is a glass of several makers: that of {} is used, not {}", words(matched.glass), others.join(", "))
}

/// Glass by its number.
fn by_number(text: &str) -> Option<GlassAsset> {
    glass::by_number(text).map(|[index, abbe]| GlassAsset::Abbe { index, abbe })
}

/// Error of a glass that is in no catalogue; `remedy` is the program's own way to define it.
pub(super) fn unknown(w: &Words<'_>, name: &str, remedy: &str) -> Error {
    let what = format!("unknown glass `{name}`; give its catalogue as a file (\"glasses\"), {remedy}");
    w.error(what).with_code(ErrorCode::UnknownName)
}
