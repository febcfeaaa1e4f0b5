//! The flux of a lamp against what its file says it is.
//!
//! ∫ I dΩ over the grid is exact for what is rendered. An IES file rates the lamps, not the luminaire, so that less
//! light is the luminaire's light output ratio; EULUMDAT states that ratio. Beyond 2 % a sentence goes to the report.
//! A lamp that gives more than 3 times what it should, or by EULUMDAT less than a third, has a wrong unit somewhere and
//! is refused.

use std::path::Path;

use etendue_scene::asset::PhotometryAsset;

use crate::Error;

/// The greatest difference that is not told: numbers in files have three or four digits, grids have steps of degrees.
const TOLD_BEYOND: f64 = 0.02;

/// The greatest ratio of what is found to what is stated, or the other way round.
const ABSURD_BEYOND: f64 = 3.0;

/// Checks, and reports.
pub(super) fn check(file: &Path, asset: &mut PhotometryAsset) -> Result<(), Error> {
    let flux = asset.flux_lm();
    if flux.is_nan() || flux <= 0.0 {
        return Err(Error::new(file, "gives no light in any direction; expected an intensity above 0"));
    }
    let Some(stated) = asset.stated_flux_lm() else { return Ok(()) };
    let ratio = flux / stated;
    if ratio > ABSURD_BEYOND || (asset.output_ratio.is_some() && ratio < 1.0 / ABSURD_BEYOND) {
        return Err(Error::new(file, absurd(asset, flux, stated)));
    }
    if (ratio - 1.0).abs() > TOLD_BEYOND {
        asset.report.push(remark(asset, flux, stated));
    }
    Ok(())
}

fn absurd(asset: &PhotometryAsset, flux: f64, stated: f64) -> String {
    let (source, remedy) = match asset.output_ratio {
        Some(share) => (
            format!("lumens of the lamps × light output ratio ({share})"),
            "times as much or as little: correct the lumens, the conversion factor or the light output ratio (in per cent)",
        ),
        None => (
            "lumens of the lamps".to_owned(),
            "times as much: correct the lumens or the multiplier; lumens of -1 say that the luminaire was measured by itself",
        ),
    };
    format!("its intensities make {flux:.4} lm, its {source} {stated:.4} lm; expected at most {ABSURD_BEYOND} {remedy}")
}

fn remark(asset: &PhotometryAsset, flux: f64, stated: f64) -> String {
    let ratio = flux / stated;
    let reason = match (asset.output_ratio, ratio < 1.0) {
        (Some(_), _) => {
            "the lumens of its lamps × its light output ratio: one of them is wrong, or directions are missing"
        }
        (None, true) => "the lumens of its lamps: the luminaire keeps the rest, or directions are missing",
        (None, false) => {
            "the lumens of its lamps, and no luminaire gives more than its lamps: check lumens and multiplier"
        }
    };
    format!(
        "its intensities make {flux:.1} lm, {ratio:.3} times the {stated:.1} lm that are {reason}; the intensities are used"
    )
}
