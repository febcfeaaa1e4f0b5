//! Which wavelengths tables cover, and which of them are rendered.

use etendue_spectra::Outside;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// First and last wavelength, nm.
type RangeNm = (f64, f64);

/// The tables over the wavelength that are used, each once.
#[derive(Debug, Default)]
pub(super) struct Coverage {
    tables: BTreeMap<PathBuf, (RangeNm, Outside)>,
}

/// Tables that are told one by one; more are counted.
const TOLD: usize = 4;

/// The range around both.
pub(super) fn around(a: RangeNm, b: RangeNm) -> RangeNm {
    (a.0.min(b.0), a.1.max(b.1))
}

impl Coverage {
    /// Notes a table.
    pub(super) fn add(&mut self, file: &Path, range_nm: RangeNm, outside: Outside) {
        self.tables.insert(file.to_path_buf(), (range_nm, outside));
    }

    /// What is to be told of tables that do not cover the wavelengths that are rendered; `None` where all do.
    pub(super) fn remark(&self, rendered_nm: RangeNm) -> Option<String> {
        let short =
            |table: &(&PathBuf, &(RangeNm, Outside))| table.1.0.0 > rendered_nm.0 || table.1.0.1 < rendered_nm.1;
        let tables: Vec<_> = self.tables.iter().filter(short).collect();
        let told: Vec<String> = tables.iter().take(TOLD).map(|(file, table)| words(file, table)).collect();
        let more = match tables.len().saturating_sub(TOLD) {
            0 => String::new(),
            n => format!("; and {n} more"),
        };
        let (first, last) = rendered_nm;
        (!told.is_empty())
            .then(|| format!("{first} to {last} nm are rendered, and tables end before: {}{more}", told.join("; ")))
    }
}

fn words(file: &Path, ((first, last), outside): &(RangeNm, Outside)) -> String {
    let beyond = match outside {
        Outside::Zero => "zero",
        Outside::Hold => "its end values",
    };
    format!("{} ({first} to {last} nm, beyond that {beyond})", file.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_tables_that_end_within_what_is_rendered_are_told_and_in_one_remark() {
        let mut coverage = Coverage::default();
        (0..28).for_each(|i| coverage.add(Path::new(&format!("{i:02}.csv")), (380.0, 780.0), Outside::Hold));
        assert_eq!(coverage.remark((390.0, 710.0)), None);
        coverage.add(Path::new("led.csv"), (400.0, 700.0), Outside::Zero);
        let told = "390 to 710 nm are rendered, and tables end before: led.csv (400 to 700 nm, beyond that zero)";
        assert_eq!(coverage.remark((390.0, 710.0)).as_deref(), Some(told));
        let all = coverage.remark((300.0, 1100.0)).expect("all are short");
        assert!(all.ends_with("03.csv (380 to 780 nm, beyond that its end values); and 25 more"), "{all}");
        assert_eq!(around((400.0, 700.0), (390.0, 650.0)), (390.0, 700.0));
    }
}
