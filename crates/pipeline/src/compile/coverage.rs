//! Wavelength ranges of tables, and their coverage of the rendered range.

use etendue_core::WavelengthRange;
use etendue_spectra::Extrapolation;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Wavelength range of a table.
#[derive(Debug)]
struct CoveredRange {
    range: WavelengthRange,
    /// Values beyond the range.
    outside: Extrapolation,
}

/// Tables over wavelength in use, each once.
#[derive(Debug, Default)]
pub(super) struct SpectralCoverage {
    tables: BTreeMap<PathBuf, CoveredRange>,
}

/// Maximum number of tables that are named; more are counted.
const MAX_NAMED_TABLES: usize = 4;

/// Returns the smallest range that contains both.
pub(super) fn union(a: WavelengthRange, b: WavelengthRange) -> WavelengthRange {
    WavelengthRange::new(a.low_nm.min(b.low_nm), a.high_nm.max(b.high_nm))
}

impl SpectralCoverage {
    /// Registers a table.
    pub(super) fn add(&mut self, file: &Path, range: WavelengthRange, outside: Extrapolation) {
        self.tables.insert(file.to_path_buf(), CoveredRange { range, outside });
    }

    /// Note on tables that do not cover the rendered wavelengths; `None` if all do.
    pub(super) fn note(&self, rendered: WavelengthRange) -> Option<String> {
        let is_short = |range: &WavelengthRange| range.low_nm > rendered.low_nm || range.high_nm < rendered.high_nm;
        let tables: Vec<_> = self.tables.iter().filter(|(_, table)| is_short(&table.range)).collect();
        let names: Vec<String> =
            tables.iter().take(MAX_NAMED_TABLES).map(|(file, table)| describe(file, table)).collect();
        let more = match tables.len().saturating_sub(MAX_NAMED_TABLES) {
            0 => String::new(),
            n => format!("; and {n} more"),
        };
        let WavelengthRange { low_nm, high_nm } = rendered;
        (!names.is_empty()).then(|| {
            format!("{low_nm} to {high_nm} nm are rendered, but tables cover less: {}{more}", names.join("; "))
        })
    }
}

fn describe(file: &Path, table: &CoveredRange) -> String {
    let WavelengthRange { low_nm, high_nm } = table.range;
    let beyond = match table.outside {
        Extrapolation::Zero => "zero",
        Extrapolation::Hold => "end values",
    };
    format!("{} ({low_nm} to {high_nm} nm, outside: {beyond})", file.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_tables_that_end_within_the_rendered_range_are_reported_in_one_note() {
        let mut coverage = SpectralCoverage::default();
        (0..28).for_each(|i| {
            coverage.add(Path::new(&format!("{i:02}.csv")), WavelengthRange::new(380.0, 780.0), Extrapolation::Hold);
        });
        assert_eq!(coverage.note(WavelengthRange::new(390.0, 710.0)), None);
        coverage.add(Path::new("led.csv"), WavelengthRange::new(400.0, 700.0), Extrapolation::Zero);
        let message = "390 to 710 nm are rendered, but tables cover less: led.csv (400 to 700 nm, outside: zero)";
        assert_eq!(coverage.note(WavelengthRange::new(390.0, 710.0)).as_deref(), Some(message));
        let all = coverage.note(WavelengthRange::new(300.0, 1100.0)).expect("all are short");
        assert!(all.ends_with("03.csv (380 to 780 nm, outside: end values); and 25 more"), "{all}");
        assert_eq!(
            union(WavelengthRange::new(400.0, 700.0), WavelengthRange::new(390.0, 650.0)),
            WavelengthRange::new(390.0, 700.0)
        );
    }
}
