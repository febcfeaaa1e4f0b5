//! A lens known only by its ray-transfer functions.

use super::super::context::Context;
use crate::compile::stated::{focus_m, transmittance};
use etendue_optics::ray_transfer::{
    PassCircle, PassEllipse, PassRegion, Polynomial, RayPass, RayTransfer, RayTransferError, Term, Transfer,
};
use etendue_optics::{Lens, OpticsError, RayTransferLens, SensorPlace};
use etendue_projection::Raster;
use etendue_scene::Place;
use etendue_scene::asset::{PassAsset, RayTransferAsset, TermAsset, TransferAsset};
use etendue_scene::record::lens::ray_transfer::{self as record, SensorPlace as StatedPlace};
use glam::DVec2;

/// Lens for an image, and for the film around it.
pub(super) fn lens(
    record: &record::RayTransfer,
    raster: &Raster,
    film: &Raster,
    context: &mut Context<'_>,
) -> Option<Lens> {
    let assets = context.assets;
    let asset = assets.ray_transfers.get(&record.file.value)?;
    let transfer = context.accept(&record.file.place, functions(asset))?;
    let (sensor, place) = sensor(&record.sensor, &record.place);
    let transmittance = transmittance(record.transmittance.as_ref());
    let lens = RayTransferLens::new(transfer, sensor, transmittance, film.max_radius_mm());
    let at = match &lens {
        Err(OpticsError::RayTransfer(RayTransferError::Focus { .. } | RayTransferError::SensorTooNear { .. })) => place,
        _ => &record.file.place,
    };
    let lens = context.accept(at, lens)?;
    asset.notes.iter().for_each(|note| context.note_on(record.file.value.display(), note));
    context.note_on(record.file.value.display(), domain_text(&lens));
    let (lit_mm, needed) = (lens.lit_radius_mm(), raster.max_radius_mm());
    if lit_mm < needed * (1.0 - 1e-9) {
        let message = format!(
            "the ray transfer functions cover the sensor to {lit_mm:.3} mm from the axis, but the image extends to \
             {needed:.3} mm"
        );
        context.warn_on(&record.place, message);
    }
    Some(Lens::ray_transfer(lens))
}

fn sensor<'a>(record: &'a StatedPlace, record_place: &'a Place) -> (SensorPlace, &'a Place) {
    match record {
        StatedPlace::Distance(distance) => (SensorPlace::Distance(distance.value), &distance.place),
        StatedPlace::Focus(focus) => (SensorPlace::Focus(focus_m(focus)), record_place),
    }
}

/// Domain in which the functions are known.
fn domain_text(lens: &RayTransferLens) -> String {
    let transfers = lens.transfer().transfers();
    let wavelengths = match transfers {
        [only] => format!("{} nm, used for all wavelengths", only.wavelength_nm),
        [first, .., last] => format!(
            "{} wavelengths from {} to {} nm, linear between them and constant beyond",
            transfers.len(),
            first.wavelength_nm,
            last.wavelength_nm
        ),
        [] => String::new(),
    };
    let height_mm = transfers.iter().map(|t| t.pass.max_height_mm()).fold(0.0, f64::max);
    let reach = match height_mm.is_finite() {
        true => format!("rays that cross its input plane within {height_mm} mm of the axis"),
        false => "rays at any height, as circles set no limit".to_owned(),
    };
    let sensor_mm = lens.sensor_distance_mm();
    format!("fitted to {wavelengths}; valid for {reach}; the sensor is {sensor_mm:.4} mm behind its last surface")
}

fn functions(asset: &RayTransferAsset) -> Result<RayTransfer, RayTransferError> {
    let transfers = asset.transfers.iter().map(transfer).collect::<Result<_, _>>()?;
    RayTransfer::new(asset.thickness_mm, asset.input_offset_mm, transfers)
}

fn transfer(asset: &TransferAsset) -> Result<Transfer, RayTransferError> {
    let [x, y, z, dx, dy] = [0, 1, 2, 3, 4].map(|i| polynomial(&asset.outputs[i]));
    Ok(Transfer {
        wavelength_nm: asset.wavelength_nm,
        pass: RayPass::new(asset.pass_plane_mm, region(&asset.pass))?,
        point: [x?, y?, z?],
        direction: [dx?, dy?],
        forwards: asset.forwards.as_deref().map(polynomial).transpose()?,
    })
}

fn polynomial(terms: &[TermAsset]) -> Result<Polynomial, RayTransferError> {
    let term = |t: &TermAsset| Term { coefficient: t.coefficient, powers: t.powers };
    Polynomial::new(terms.iter().map(term).collect())
}

fn region(asset: &PassAsset) -> PassRegion {
    match asset {
        PassAsset::Ellipses(list) => {
            let ellipse = |&(height_mm, centre, radii): &(f64, [f64; 2], [f64; 2])| PassEllipse {
                height_mm,
                centre_mm: DVec2::from_array(centre),
                radii_mm: DVec2::from_array(radii),
            };
            PassRegion::Ellipses(list.iter().map(ellipse).collect())
        }
        PassAsset::Circles(list) => {
            let circle = |&(radius_mm, sensitivity): &(f64, f64)| PassCircle { radius_mm, sensitivity };
            PassRegion::Circles(list.iter().map(circle).collect())
        }
    }
}
