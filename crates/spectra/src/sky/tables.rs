//! The authors' tables, parsed once.

use super::BANDS;
use crate::table;
use std::sync::LazyLock;

/// One row of a table: a number for each band.
pub(super) type Row = [f64; BANDS];

fn rows(text: &str) -> Vec<Row> {
    let rows = table::rows::<BANDS>(text).expect("a table of the crate has a number for each band");
    rows.into_iter().map(|(_, row)| row).collect()
}

/// Coefficients of the sky's shape: albedo {0, 1} × turbidity {1 … 10} × 6 control points × 9 (fastest).
pub(super) static SHAPES: LazyLock<Vec<Row>> =
    LazyLock::new(|| rows(include_str!("../../data/hosek_wilkie/sky_coefficients.csv")));

/// Mean radiances of the sky: albedo {0, 1} × turbidity {1 … 10} × 6 control points (fastest), W·m⁻²·sr⁻¹·nm⁻¹.
pub(super) static MEANS: LazyLock<Vec<Row>> =
    LazyLock::new(|| rows(include_str!("../../data/hosek_wilkie/sky_radiance.csv")));

/// The Sun's radiance: turbidity {1 … 10} × 45 pieces × 4 coefficients, highest power first (fastest).
pub(super) static SUN: LazyLock<Vec<Row>> =
    LazyLock::new(|| rows(include_str!("../../data/hosek_wilkie/sun_radiance.csv")));

/// Limb darkening: for each band the coefficients of powers 0 to 5.
pub(super) static LIMB: LazyLock<Vec<[f64; 6]>> = LazyLock::new(|| {
    let text = include_str!("../../data/hosek_wilkie/limb_darkening.csv");
    let rows = table::rows::<7>(text).expect("a table of the crate has seven columns");
    rows.into_iter().map(|(_, [_nm, powers @ ..])| powers).collect()
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_whole() {
        assert_eq!((SHAPES.len(), MEANS.len(), SUN.len(), LIMB.len()), (1080, 120, 1800, BANDS));
    }
}
