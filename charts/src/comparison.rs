//! What `measure compare` says of a measurement (A) beside what a camera file declares (B).

use crate::bounds::Bound;
use serde_json::Value;

/// A comparison's report.
pub(crate) struct Comparison(pub(crate) Value);

/// A bound and what was reached.
#[derive(Clone, Debug)]
pub(crate) struct BoundResult {
    pub(crate) quantity: String,
    pub(crate) bound: Bound,
    /// In the bound's unit; none where nothing is declared to be 0.
    pub(crate) error: Option<f64>,
    pub(crate) e_n: Option<f64>,
}

impl BoundResult {
    pub(crate) fn holds(&self) -> bool {
        self.bound.holds(self.error, self.e_n)
    }
}

impl Comparison {
    /// Rows of its quantities that are wanted.
    pub(crate) fn rows<'a>(&'a self, includes: impl Fn(&str) -> bool + 'a) -> impl Iterator<Item = &'a Value> {
        let rows = self.0["tables"]["quantities"].as_array().into_iter().flatten();
        rows.filter(move |row| row["quantity"].as_str().is_some_and(&includes))
    }

    /// The quantities beside their bound, by their relative errors.
    pub(crate) fn reached(&self, bound: Bound, includes: impl Fn(&str) -> bool) -> Vec<BoundResult> {
        let one = |row: &Value| BoundResult {
            quantity: row["quantity"].as_str().unwrap_or_default().to_owned(),
            bound,
            error: row["relative_error_percent"].as_f64(),
            e_n: row["e_n"].as_f64(),
        };
        self.rows(includes).map(one).collect()
    }

    pub(crate) fn curves(&self) -> impl Iterator<Item = &Value> {
        self.0["tables"]["curves"].as_array().into_iter().flatten()
    }

    /// The first curve beside its bound: an entry of its row, times a factor.
    pub(crate) fn curve(
        &self,
        quantity: &str,
        bound: Bound,
        entry: &str,
        factor: f64,
    ) -> Result<BoundResult, etendue::Error> {
        let row = self.curves().next().ok_or_else(|| {
            etendue::Error::coded(etendue::ErrorCode::NotMeasurable, format!("{quantity}: no curve was compared"))
        })?;
        let error = row[entry].as_f64().map(|e| factor * e);
        Ok(BoundResult { quantity: quantity.to_owned(), bound, error, e_n: row["e_n"].as_f64() })
    }

    /// A table of the quantities that are wanted.
    pub(crate) fn quantities(&self, includes: impl Fn(&str) -> bool) -> String {
        let mut text =
            "\n| quantity | unit | declared | measured | error % | E_n |\n| --- | --- | --- | --- | --- | --- |\n"
                .to_owned();
        for row in self.rows(includes) {
            let word = |key: &str| row[key].as_str().unwrap_or_default().to_owned();
            let (declared, measured) = (number(row["b"]["value"].as_f64()), estimate(&row["a"]));
            let (error, e_n) = (rounded(row["relative_error_percent"].as_f64(), 3), rounded(row["e_n"].as_f64(), 2));
            text +=
                &format!("| `{}` | {} | {declared} | {measured} | {error} | {e_n} |\n", word("quantity"), word("unit"));
        }
        text
    }

    /// Where this is a simulated camera beside a measured one, and `measured` that beside what is declared: a table of all three.
    pub(crate) fn three_columns(&self, measured: &Self, includes: impl Fn(&str) -> bool) -> String {
        let mut text = "\n| quantity | declared | measured | simulated | simulated less measured, % | E_n |\n| --- | --- | --- | --- | --- | --- |\n".to_owned();
        for row in self.rows(includes) {
            let key = row["quantity"].as_str().unwrap_or_default();
            let declared = measured.rows(|k| k == key).next().map_or(Value::Null, |row| row["b"]["value"].clone());
            let (declared, measured_value, measured_estimate) =
                (number(declared.as_f64()), estimate(&row["b"]), estimate(&row["a"]));
            let (error, e_n) = (rounded(row["relative_error_percent"].as_f64(), 3), rounded(row["e_n"].as_f64(), 2));
            text += &format!("| `{key}` | {declared} | {measured_value} | {measured_estimate} | {error} | {e_n} |\n");
        }
        text
    }

    /// A sentence a curve.
    pub(crate) fn result_lines(&self, words: &str) -> String {
        let line = |row: &Value| {
            format!(
                "\n{words}, {} points: largest difference {} ({} %), |E_n| up to {} (limit {}).\n",
                row["points"].as_f64().unwrap_or_default(),
                number(row["largest_difference"].as_f64()),
                rounded(row["largest_relative_error_percent"].as_f64(), 4),
                rounded(row["e_n"].as_f64().map(f64::abs), 2),
                rounded(row["limit"].as_f64(), 2),
            )
        };
        self.curves().map(line).collect()
    }
}

/// To some decimals; a dash for none.
pub(crate) fn rounded(x: Option<f64>, decimals: usize) -> String {
    let Some(x) = x else { return "–".to_owned() };
    let text = format!("{x:.decimals$}");
    let nothing = text.bytes().all(|b| !b.is_ascii_digit() || b == b'0');
    if nothing { text.trim_start_matches('-').to_owned() } else { text }
}

/// To five significant digits.
pub(crate) fn number(x: Option<f64>) -> String {
    let Some(x) = x else { return "–".to_owned() };
    let text = rounded(Some(x), (4 - magnitude(x)).clamp(0, 9) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Value ± standard uncertainty, to two digits of it.
pub(crate) fn estimate(cell: &Value) -> String {
    match (cell["value"].as_f64(), cell["standard_uncertainty"].as_f64()) {
        (Some(value), Some(u)) if u > 0.0 => {
            let decimals = (1 - magnitude(u)).clamp(0, 9) as usize;
            format!("{} ± {u:.decimals$}", rounded(Some(value), decimals))
        }
        (value, _) => number(value),
    }
}

/// The exponent of a number's first digit.
fn magnitude(x: f64) -> i32 {
    format!("{x:e}").split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}
