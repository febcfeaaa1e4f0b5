//! Built-in catalogues of glass makers, and the search by a glass's name in files.

use std::sync::LazyLock;

use super::agf;
use super::dispersion::{Dispersion, GlassError, LINE_D_NM};

/// A glass of a manufacturer's catalogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CatalogueGlass {
    /// Manufacturer, lower case; `misc` for Zemax's catalogue of plastics, crystals and fused silica.
    pub maker: &'static str,
    /// Catalogue name.
    pub name: &'static str,
    /// Dispersion.
    pub dispersion: Dispersion,
}

/// Manufacturers in the order in which a name without its catalogue is searched.
const MAKERS: [&str; 12] =
    ["schott", "ohara", "hoya", "hikari", "cdgm", "sumita", "lzos", "corning", "heraeus", "misc", "zeon", "topas"];

static CATALOGUE: LazyLock<Vec<CatalogueGlass>> = LazyLock::new(|| {
    let sellmeier = include_str!("../../data/glass_sellmeier.csv").lines().skip(1).map(sellmeier_row);
    let others = include_str!("../../data/glass_catalogues.csv").lines().skip(1).map(formula_row);
    sellmeier.chain(others).collect()
});

fn sellmeier_row(line: &'static str) -> CatalogueGlass {
    let mut fields = line.split(',');
    let [maker, name] = [(); 2].map(|()| fields.next().expect("maker and name"));
    let mut number = || fields.next().and_then(|f| f.parse().ok()).expect("a table of the crate has six numbers a row");
    let dispersion = Dispersion::Sellmeier { b: [(); 3].map(|()| number()), c_um2: [(); 3].map(|()| number()) };
    CatalogueGlass { maker, name, dispersion }
}

fn formula_row(line: &'static str) -> CatalogueGlass {
    let fields: Vec<&'static str> = line.split(',').collect();
    let number = |text: &str| text.parse::<f64>().expect("a table of the crate has numbers");
    let coefficients: Vec<f64> = fields[5].split(' ').map(number).collect();
    let range_um = [number(fields[3]), number(fields[4])];
    let dispersion = agf::formula(number(fields[2]) as u32, &coefficients, range_um).expect("a formula of AGF files");
    CatalogueGlass { maker: fields[0], name: fields[1], dispersion }
}

/// All built-in glasses: first those of Schott and Ohara.
#[must_use]
pub fn built_in() -> &'static [CatalogueGlass] {
    &CATALOGUE
}

/// A glass by its catalogue name; case is ignored, as lens files differ in it. The order of makers is that of [`find`].
///
/// # Errors
/// If no catalogue of the crate has the name: the error lists the nearest ones.
pub fn by_name(name: &str) -> Result<&'static CatalogueGlass, GlassError> {
    let same = |glass: &&CatalogueGlass| glass.name.eq_ignore_ascii_case(name.trim());
    let first = CATALOGUE.iter().filter(same).min_by_key(|glass| rank(glass.maker, &[]));
    first.ok_or_else(|| GlassError::Unknown { name: name.to_owned(), near: near(name) })
}

/// Place of a maker in the search: catalogues that a file names come first, in its order.
fn rank(maker: &str, catalogues: &[&str]) -> usize {
    let stated = catalogues.iter().position(|name| is_catalogue_of(maker, name));
    let default = || catalogues.len() + MAKERS.iter().position(|known| *known == maker).unwrap_or(MAKERS.len());
    stated.unwrap_or_else(default)
}

/// True if a file's name of a catalogue (`SCHOTT`, `NIKON-HIKARI`, `OLD_SCHO`, `HOYA_2013`) is that of a maker.
fn is_catalogue_of(maker: &str, catalogue: &str) -> bool {
    let name = catalogue.to_ascii_lowercase();
    let prefix = maker.get(..4).unwrap_or(maker);
    let words = name.split(['_', '-', '.', ' ']);
    name == maker || words.into_iter().any(|word| word.starts_with(prefix)) || (maker == "hikari" && name == "nikon")
}

/// A built-in glass, and others of the same name with a different index.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassMatch {
    /// The glass.
    pub glass: &'static CatalogueGlass,
    /// Other makers' glasses of this name whose n_d differs by more than 1e-4: none if the catalogue was stated.
    pub others: Vec<&'static CatalogueGlass>,
}

/// Difference of n_d from which two glasses of one name are noted as different.
const SAME_INDEX: f64 = 1e-4;

/// Finds a glass by its name in a file: hyphens, blanks and capitals differ between programs, and a catalogue may follow after an underscore (`SF6_SCHOTT`).
/// `catalogues` are those that the file names, in order; the search continues with the other makers.
#[must_use]
pub fn find(name: &str, catalogues: &[&str]) -> Option<GlassMatch> {
    find_among(name, catalogues, |_| true)
}

/// As [`find`], but only in the catalogues that the file names and in those of Schott and Ohara, whose names other makers use for glasses of their own.
#[must_use]
pub fn find_first(name: &str, catalogues: &[&str]) -> Option<GlassMatch> {
    let is_stated = |maker: &str| catalogues.iter().any(|catalogue| is_catalogue_of(maker, catalogue));
    find_among(name, catalogues, |maker| ["schott", "ohara"].contains(&maker) || is_stated(maker))
}

fn find_among(name: &str, catalogues: &[&str], is_admitted: impl Fn(&str) -> bool) -> Option<GlassMatch> {
    let complete = plain(name);
    let (stem, suffix) = match name.split_once('_') {
        // A name such as F_SILICA has an underscore of its own.
        Some((stem, suffix)) if !CATALOGUE.iter().any(|glass| plain(glass.name) == complete) => {
            (plain(stem), Some(suffix))
        }
        _ => (complete, None),
    };
    let same_name = CATALOGUE.iter().filter(|glass| plain(glass.name) == stem);
    let mut glasses: Vec<&CatalogueGlass> = same_name.filter(|glass| is_admitted(glass.maker)).collect();
    if let Some(suffix) = suffix
        && MAKERS.iter().any(|maker| is_catalogue_of(maker, suffix))
    {
        glasses.retain(|glass| is_catalogue_of(glass.maker, suffix));
    }
    glasses.sort_by_key(|glass| rank(glass.maker, catalogues));
    let (first, rest) = glasses.split_first()?;
    let is_stated = suffix.is_some() || catalogues.iter().any(|catalogue| is_catalogue_of(first.maker, catalogue));
    let n_d = |glass: &CatalogueGlass| glass.dispersion.index(LINE_D_NM);
    let differs = |other: &&&CatalogueGlass| !is_stated && (n_d(other) - n_d(first)).abs() > SAME_INDEX;
    Some(GlassMatch { glass: first, others: rest.iter().filter(differs).copied().collect() })
}

/// Letters and digits of a glass's name, in capitals: hyphens, blanks and capitals differ between files.
#[must_use]
pub fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).collect::<String>().to_ascii_uppercase()
}

/// Prefixes by which makers renamed glasses when they removed lead and arsenic.
const SUCCESSOR_PREFIXES: [(&str, &[&str]); 4] =
    [("schott", &["N", "P"]), ("ohara", &["S"]), ("cdgm", &["H"]), ("hikari", &["J", "E"])];

/// Catalogue glass that replaced an older one of that name: Schott's N-SK16 for the lead glass SK16, Ohara's S-LAH66 for LAH66, CDGM's H-ZF6 for ZF6. For a
/// name with its catalogue (SK16_SCHOTT) only that maker's.
#[must_use]
pub fn successor(name: &str, catalogues: &[&str]) -> Option<&'static CatalogueGlass> {
    let (stem, suffix) = name.split_once('_').map_or((name, None), |(stem, suffix)| (stem, Some(suffix)));
    let is_admitted = |maker: &str| suffix.is_none_or(|suffix| is_catalogue_of(maker, suffix));
    let mut makers: Vec<_> = SUCCESSOR_PREFIXES.iter().filter(|(maker, _)| is_admitted(maker)).collect();
    makers.sort_by_key(|(maker, _)| rank(maker, catalogues));
    makers.into_iter().find_map(|(maker, prefixes)| {
        let renamed = |prefix: &&str| plain(&format!("{prefix}{stem}"));
        let is_renamed = |glass: &&CatalogueGlass| prefixes.iter().any(|prefix| renamed(prefix) == plain(glass.name));
        CATALOGUE.iter().find(|glass| glass.maker == *maker && is_renamed(glass))
    })
}

/// n_d and V_d of a glass given by its number: digits of n_d − 1, then those of V_d, as six digits (517642) or separated by a point (516800.641673).
#[must_use]
pub fn by_number(text: &str) -> Option<[f64; 2]> {
    let (index, abbe) = text.split_once('.').or_else(|| (text.len() == 6).then(|| text.split_at_checked(3))?)?;
    let digits = |part: &str| part.len() >= 3 && part.bytes().all(|b| b.is_ascii_digit());
    let fraction = |part: &str| format!("0.{part}").parse::<f64>().ok();
    let (index, abbe) = (digits(index) && digits(abbe)).then_some((fraction(index)?, fraction(abbe)?))?;
    Some([1.0 + index, 100.0 * abbe])
}

/// Names that contain the letters and digits of `name` (such as the new N- or S- glass for an old name).
fn near(name: &str) -> Vec<&'static str> {
    let target = plain(name);
    if target.len() < 2 {
        return Vec::new();
    }
    let mut names: Vec<&str> =
        CATALOGUE.iter().map(|glass| glass.name).filter(|known| plain(known).contains(&target)).collect();
    names.dedup();
    names.truncate(4);
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    /// n_d and V_d of the makers' data sheets (5 and 2 decimals): HOYA 2017, HIKARI 2017, CDGM 2022, SUMITA 2017, Handbook of Optics II for the plastics.
    #[test]
    fn glasses_of_all_makers_have_their_index_and_abbe_number() {
        for (name, maker, n, v) in [
            ("FCD1", "hoya", 1.497_00, 81.61),
            ("TAFD25", "hoya", 1.903_66, 31.32),
            ("J-SF6", "hikari", 1.805_18, 25.45),
            ("H-K9L", "cdgm", 1.516_80, 64.20),
            ("H-ZF6", "cdgm", 1.755_20, 27.55),
            ("K-PBK40", "sumita", 1.517_60, 63.5),
            ("F_SILICA", "misc", 1.458_46, 67.82),
            ("CaF2", "misc", 1.433_85, 95.0),
            ("PMMA", "misc", 1.491_76, 57.44),
            ("POLYCARB", "misc", 1.585_47, 29.91),
        ] {
            let GlassMatch { glass, .. } = find(name, &[]).unwrap_or_else(|| panic!("{name}"));
            let (index, abbe) = (glass.dispersion.index(LINE_D_NM), glass.dispersion.abbe());
            assert_eq!(glass.maker, maker, "{name}");
            assert!((index - n).abs() < 2e-5 && (abbe / v - 1.0).abs() < 2e-3, "{name} {index} {abbe}");
        }
    }

    #[test]
    fn the_catalogue_of_a_file_comes_first_and_differences_are_listed() {
        let maker = |name: &str, catalogues: &[&str]| find(name, catalogues).expect("a glass").glass.maker;
        assert_eq!((maker("F2", &[]), maker("F2", &["HOYA"]), maker("F2_HOYA", &[])), ("schott", "hoya", "hoya"));
        let baf4 = find("BAF4", &[]).expect("a glass");
        let stated = find("BAF4", &["CDGM"]).expect("a glass");
        assert!(stated.others.is_empty() && stated.glass.maker == "cdgm");
        assert!(baf4.glass.maker != "cdgm" && baf4.others.iter().any(|glass| glass.maker == "cdgm"), "{baf4:?}");
    }

    #[test]
    fn old_names_have_successors() {
        let name = |old: &str| successor(old, &[]).map(|glass| glass.name);
        assert_eq!((name("SK16"), name("LAH66"), name("SK16_OHARA")), (Some("N-SK16"), Some("S-LAH66"), None));
        assert_eq!(successor("ZF52", &["CDGM"]).map(|glass| glass.name), Some("H-ZF52"));
        assert_eq!(by_number("517642"), Some([1.517, 64.2]));
    }
}
