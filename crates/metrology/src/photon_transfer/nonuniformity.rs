//! DSNU and PRNU.
//!
//! ```text
//! DSNU = s_dark/K                                    e⁻
//! PRNU = √(s_50² − s_dark²)/(μ_50 − μ_dark)          of the mean, both parts of rows, columns and pixels
//! ```
//!
//! (EMVA 1288 release 4.0 linear, section on spatial nonuniformity; stacks of L frames without light and at 50 % of saturation.)

use super::spatial::{Parts, Pattern};
use super::{TransferData, TransferError};
use crate::Estimate;
use crate::propagate::{propagate, root};

/// Fixed patterns of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nonuniformity {
    /// Dark signal nonuniformity, e⁻.
    pub dsnu_e: Parts<Estimate>,
    /// Dark signal nonuniformity, DN.
    pub dsnu_dn: Parts<Estimate>,
    /// Photo response nonuniformity, of the mean.
    pub prnu: Parts<Estimate>,
    /// Temporal noise that rows share in the dark, DN (no figure of the standard).
    pub row_noise_dn: f64,
    /// Temporal noise that columns share in the dark, DN (no figure of the standard).
    pub column_noise_dn: f64,
}

/// DSNU and PRNU from stacks without light and at about half of saturation.
///
/// # Errors
/// Where the bright stack is saturated or no brighter than the dark one.
pub fn nonuniformity(
    dark: &Pattern,
    bright: &Pattern,
    gain_dn_per_e: Estimate,
    data: &TransferData,
) -> Result<Nonuniformity, TransferError> {
    let saturation_dn = data.bright()[data.saturation()].statistics.mean_dn.value;
    let mean_dn = bright.mean_dn.value;
    if data.saturation_reached() && mean_dn >= saturation_dn {
        return Err(TransferError::SaturatedStack { mean_dn, saturation_dn });
    }
    if mean_dn <= dark.mean_dn.value {
        return Err(TransferError::NotBrighter);
    }
    let quotient = |a: Estimate, b: Estimate| propagate(&[a, b], |x| [x[0] / x[1]])[0];
    let [signal] = propagate(&[bright.mean_dn, dark.mean_dn], |x| [x[0] - x[1]]);
    let dsnu_dn = dark.variances_dn2().map(root);
    let (row, column) = dark.shared_temporal_dn2();
    Ok(Nonuniformity {
        dsnu_dn,
        dsnu_e: dsnu_dn.map(|s| quotient(s, gain_dn_per_e)),
        prnu: bright.less(dark).map(|s| quotient(root(s), signal)),
        row_noise_dn: row.sqrt(),
        column_noise_dn: column.sqrt(),
    })
}
