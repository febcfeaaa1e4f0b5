//! Glass catalogues as Zemax writes them (`.agf`), as text.
//!
//! | record | read |
//! | --- | --- |
//! | `NM name formula …` | name and number of the dispersion formula |
//! | `CD c₁ c₂ …` | its coefficients, for λ in µm |
//! | `LD min max` | its range, µm |
//! | `CC`, `GC`, `ED`, `TD`, `OD`, `IT`, `MD` | ignored: comments, thermal and mechanical data, transmission |
//!
//! Indices are relative to air at the catalogue's temperature. Thermal coefficients and absorption are left out.

use super::dispersion::{Dispersion, GlassError};
use super::series::DispersionSeries;

/// A glass of a catalogue file.
#[derive(Clone, Debug, PartialEq)]
pub struct AgfGlass {
    /// Name.
    pub name: String,
    /// Dispersion.
    pub dispersion: Dispersion,
    /// Line of its NM record, from 1.
    pub line: usize,
}

/// Error of a catalogue file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{problem}")]
pub struct AgfError {
    /// Line, from 1.
    pub line: usize,
    /// The problem and its remedy.
    pub problem: String,
}

/// Exponents of λ of the polynomial formulas, in the order of their coefficients.
const SCHOTT: &[i32] = &[0, 2, -2, -4, -6, -8];
const EXTENDED: &[i32] = &[0, 2, -2, -4, -6, -8, -10, -12];
const EXTENDED_2: &[i32] = &[0, 2, -2, -4, -6, -8, 4, 6];
const EXTENDED_3: &[i32] = &[0, 2, 4, -2, -4, -6, -8, -10, -12];

/// Curve of a formula by its number in the files, 1 to 13 (Zemax OpticStudio, "Using glass catalogs"). Missing coefficients are 0. `None` for another number.
#[must_use]
pub fn formula(number: u32, coefficients: &[f64], range_um: [f64; 2]) -> Option<Dispersion> {
    let c = |i: usize| coefficients.get(i).copied().unwrap_or(0.0);
    let series = DispersionSeries::new;
    let polynomial = |exponents: &[i32]| {
        let terms = exponents.iter().enumerate();
        terms.fold(series(0.0), |sum, (i, exponent)| sum.with_power(*exponent, c(i)))
    };
    let sellmeier = |count: usize| (0..count).fold(series(1.0), |sum, i| sum.with_resonance(c(2 * i), c(2 * i + 1)));
    let sum = match number {
        1 => polynomial(SCHOTT),
        2 => sellmeier(3),
        3 => return Some(Dispersion::Herzberger { coefficients: core::array::from_fn(c) }),
        // Sellmeier 2: the resonances are given as wavelengths.
        4 => series(1.0 + c(0)).with_resonance(c(1), c(2) * c(2)).with_resonance(c(3), c(4) * c(4)),
        5 => return Some(Dispersion::Conrady { a: c(0), b_um: c(1), c_um35: c(2) }),
        6 => sellmeier(4),
        7 => handbook_1(series(c(0)), c(1), c(2), c(3)),
        8 => series(c(0)).with_resonance(c(1), c(2)).with_power(2, -c(3)),
        9 => series(c(0)).with_resonance(c(1), c(2)).with_resonance(c(3), c(4)),
        10 => polynomial(EXTENDED),
        11 => sellmeier(5),
        12 => polynomial(EXTENDED_2),
        13 => polynomial(EXTENDED_3),
        _ => return None,
    };
    Some(Dispersion::Series(sum.within(range_um)))
}

/// n² = A + B/(λ² − C) − D λ². With B/(λ² − C) = (B/C) (λ²/(λ² − C) − 1), or B λ⁻² for C = 0.
fn handbook_1(constant: DispersionSeries, b: f64, c: f64, d: f64) -> DispersionSeries {
    let sum =
        if c == 0.0 { constant.with_power(-2, b) } else { constant.with_power(0, -b / c).with_resonance(b / c, c) };
    sum.with_power(2, -d)
}

/// Records of a glass as far as they are read.
struct Record<'a> {
    name: &'a str,
    formula: u32,
    line: usize,
    coefficients: Vec<f64>,
    range_um: [f64; 2],
}

impl Record<'_> {
    fn glass(self) -> Result<AgfGlass, AgfError> {
        let Self { name, formula: number, line, coefficients, range_um } = self;
        let error = |problem: String| AgfError { line, problem: format!("the glass {name}: {problem}") };
        let dispersion = formula(number, &coefficients, range_um)
            .ok_or_else(|| error(format!("the dispersion formula has number {number}; expected 1 to 13")))?;
        let dispersion = dispersion.checked().map_err(|cause: GlassError| error(cause.to_string()))?;
        Ok(AgfGlass { name: name.to_owned(), dispersion, line })
    }
}

/// Range of a glass without LD, µm.
const UNSTATED_RANGE_UM: [f64; 2] = [0.3, 1.2];

/// Catalogue read from a text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AgfCatalogue {
    /// Glasses in the order of the file.
    pub glasses: Vec<AgfGlass>,
    /// Glasses that cannot be used, each with its reason: an error only if a lens uses one.
    pub unusable: Vec<(String, AgfError)>,
}

/// Reads a catalogue.
///
/// # Errors
/// The text has no glass, or a number of a record is none.
pub fn read(text: &str) -> Result<AgfCatalogue, AgfError> {
    let mut catalogue = AgfCatalogue::default();
    let mut current: Option<Record<'_>> = None;
    for (i, line) in text.lines().enumerate() {
        let line_number = i + 1;
        let words: Vec<&str> = line.split_whitespace().collect();
        let numbers = |from: usize| numbers(line_number, &words, from);
        match (words.first().copied(), &mut current) {
            (Some("NM"), current) => {
                current.take().into_iter().for_each(|record| add(&mut catalogue, record));
                let name = words.get(1).copied().ok_or_else(|| AgfError {
                    line: line_number,
                    problem: "NM has no name; expected NM, the name and the number of a formula".to_owned(),
                })?;
                let number = numbers(2)?.first().copied().unwrap_or(0.0);
                *current = Some(Record {
                    name,
                    formula: number as u32,
                    line: line_number,
                    coefficients: Vec::new(),
                    range_um: UNSTATED_RANGE_UM,
                });
            }
            (Some("CD"), Some(record)) => record.coefficients = numbers(1)?,
            (Some("LD"), Some(record)) => {
                if let [min, max, ..] = numbers(1)?[..]
                    && 0.0 < min
                    && min < max
                {
                    record.range_um = [min, max];
                }
            }
            _ => {}
        }
    }
    current.take().into_iter().for_each(|record| add(&mut catalogue, record));
    if catalogue.glasses.is_empty() && catalogue.unusable.is_empty() {
        let problem = "no glass; expected a glass catalogue of Zemax (records NM and CD)".to_owned();
        return Err(AgfError { line: 1, problem });
    }
    Ok(catalogue)
}

fn add(catalogue: &mut AgfCatalogue, record: Record<'_>) {
    let name = record.name.to_owned();
    match record.glass() {
        Ok(glass) => catalogue.glasses.push(glass),
        Err(error) => catalogue.unusable.push((name, error)),
    }
}

/// Numbers from a word on, up to the first word that is none.
fn numbers(line: usize, words: &[&str], from: usize) -> Result<Vec<f64>, AgfError> {
    let list: Vec<f64> = words.iter().skip(from).map_while(|word| word.parse().ok()).collect();
    if list.is_empty() && words.len() > from {
        let problem = format!("{}: found `{}`; expected a number", words[0], words[from]);
        return Err(AgfError { line, problem });
    }
    Ok(list)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each formula at 0.5876 µm against its definition, evaluated by hand with simple coefficients.
    #[test]
    fn formulas_are_their_definitions() {
        let um: f64 = 0.5876;
        let s = um * um;
        let range = [0.3, 2.0];
        let c = [2.2, 0.01, 0.02, 0.003, 0.04, 0.005, 0.006, 0.0007, 0.0008, 0.009];
        let sellmeier = |count: usize| (0..count).map(|i| c[2 * i] * s / (s - c[2 * i + 1])).sum::<f64>();
        let l = 1.0 / (s - 0.028);
        // λᵖ for even p.
        let power = |p: i32| {
            let product: f64 = (0..p.abs() / 2).map(|_| s).product();
            if p < 0 { 1.0 / product } else { product }
        };
        let powers = |list: &[i32]| list.iter().zip(c).map(|(p, a)| a * power(*p)).sum::<f64>();
        let expected = [
            (1, powers(&[0, 2, -2, -4, -6, -8]).sqrt()),
            (2, (1.0 + sellmeier(3)).sqrt()),
            (3, c[0] + c[1] * l + c[2] * l * l + c[3] * s + c[4] * s * s + c[5] * s * s * s),
            (4, (1.0 + c[0] + c[1] * s / (s - c[2] * c[2]) + c[3] * s / (s - c[4] * c[4])).sqrt()),
            (5, c[0] + c[1] / um + c[2] / (um * s * um.sqrt())),
            (6, (1.0 + sellmeier(4)).sqrt()),
            (7, (c[0] + c[1] / (s - c[2]) - c[3] * s).sqrt()),
            (8, (c[0] + c[1] * s / (s - c[2]) - c[3] * s).sqrt()),
            (9, (c[0] + c[1] * s / (s - c[2]) + c[3] * s / (s - c[4])).sqrt()),
            (10, powers(&[0, 2, -2, -4, -6, -8, -10, -12]).sqrt()),
            (11, (1.0 + sellmeier(5)).sqrt()),
            (12, powers(&[0, 2, -2, -4, -6, -8, 4, 6]).sqrt()),
            (13, powers(&[0, 2, 4, -2, -4, -6, -8, -10, -12]).sqrt()),
        ];
        for (number, n) in expected {
            let index = formula(number, &c, range).expect("a formula").index(1e3 * um);
            // Rounding of up to ten terms.
            assert!((index - n).abs() < 1e-13 * n, "formula {number}: {index} {n}");
        }
        assert!(formula(0, &c, range).is_none() && formula(14, &c, range).is_none());
    }

    #[test]
    fn a_catalogue_is_read_and_tangents_continue_the_range() {
        let text = "CC a comment\nNM GLASS-A 1 517642 1.5168 64.2 0 1 0\nGC note\nED 7.1 8.3 2.51 0 0 0\n\
            CD 2.25 0 0.01 0 0 0 0 0 0 0\nTD 0 0 0 0 0 0 20\nLD 4.0E-1 7.0E-1\nNM ODD 99 0 1.5 60\nCD 1 2\n";
        let catalogue = read(text).expect("a catalogue");
        let [glass] = &catalogue.glasses[..] else { panic!("{catalogue:?}") };
        assert_eq!((glass.name.as_str(), glass.line), ("GLASS-A", 2));
        let n = |nm: f64| glass.dispersion.index(nm);
        assert!((n(500.0) - f64::sqrt(2.25 + 0.04)).abs() < 1e-15);
        // d n/d(1/λ²) = 0.01/(2 n) at 0.4 and 0.7 µm.
        let beyond = |end: f64, nm: f64| n(end) + 0.005 / n(end) * (1e6 / (nm * nm) - 1e6 / (end * end));
        assert!((n(350.0) - beyond(400.0, 350.0)).abs() < 1e-14 && (n(900.0) - beyond(700.0, 900.0)).abs() < 1e-14);
        let [(name, error)] = &catalogue.unusable[..] else { panic!("{catalogue:?}") };
        assert!(name == "ODD" && error.line == 8 && error.problem.contains("number 99; expected 1 to 13"), "{error}");
    }

    #[test]
    fn another_text_is_refused() {
        let error = read("# no catalogue\n").expect_err("no glass");
        assert!(error.problem.contains("NM and CD"), "{error}");
        assert_eq!(read("NM A x\n").expect_err("a word").line, 1);
    }
}
