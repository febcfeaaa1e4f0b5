//! A wind-screen in front of the lens.

use super::super::context::Context;
use super::super::lens::coating;
use super::super::spectrum::from_file;
use super::curve;
use super::drops::drops;
use etendue_optics::front::{Curve, Layer, Placement, Tint, Windscreen, WindscreenParameters};
use etendue_optics::prescription::coating::Coating;
use etendue_scene::Placed;
use etendue_scene::record::Curve as CurveRecord;
use etendue_scene::record::front::windscreen as record;
use etendue_spectra::Outside;
use glam::DVec3;

/// Laminated glass as cars have it: 2.1 mm of float glass each side of an interlayer of 0.76 mm. Indices at 588 nm: soda-lime
/// glass 1.52 (M. Rubin, "Optical properties of soda lime silica glasses", Solar Energy Materials 12, 1985), polyvinyl
/// butyral 1.48 (makers' data sheets by ASTM D542).
const LAMINATE: [(f64, f64); 3] = [(2.1, 1.52), (0.76, 1.48), (2.1, 1.52)];

pub(super) fn windscreen(r: &record::Windscreen, context: &mut Context<'_>) -> Option<Windscreen> {
    let number = |given: &Option<Placed<f64>>, default: f64| given.as_ref().map_or(default, |n| n.value);
    let degrees = [number(&r.tilt_deg, 0.0), number(&r.yaw_deg, 0.0), 0.0];
    let doubles = r.double_image.as_ref().is_none_or(|d| d.value);
    let parameters = WindscreenParameters {
        placement: Placement::turned(DVec3::new(0.0, 0.0, r.distance_mm.value), degrees),
        radius_across_mm: number(&r.radius_across_mm, f64::INFINITY),
        radius_upright_mm: number(&r.radius_upright_mm, f64::INFINITY),
        layers: layers(r.layers.as_deref(), context)?,
        wedge_rad: 1e-3 * number(&r.wedge_mrad, 0.0),
        tint: tint(r, context)?,
        coating: r.coating.as_ref().map_or(Coating::Uncoated, coating),
        double_image_fraction: if doubles {
            r.double_image_sample_fraction.as_ref().map(|s| s.value)
        } else {
            Some(0.0)
        },
    };
    let glass = context.accept(&r.place, Windscreen::new(parameters))?;
    match &r.drops {
        Some(record) => {
            let drops = drops(record, context);
            context.accept(&record.place, glass.with_drops(drops))
        }
        None => Some(glass),
    }
}

fn layers(records: Option<&[record::Layer]>, context: &mut Context<'_>) -> Option<Vec<Layer>> {
    let Some(records) = records else {
        let layer = |(thickness_mm, index)| Layer { thickness_mm, index: Curve::Constant(index) };
        return Some(LAMINATE.map(layer).to_vec());
    };
    let index = |record: &CurveRecord, context: &mut Context<'_>| match record {
        CurveRecord::Constant(index) => Some(Curve::Constant(index.value)),
        CurveRecord::File(file) => from_file(file, Outside::Hold, context).map(|s| Curve::Table(Box::new(s))),
    };
    let layer =
        |r: &record::Layer| Some(Layer { thickness_mm: r.thickness_mm.value, index: index(&r.index, context)? });
    records.iter().map(layer).collect()
}

/// `None` with a fault noted, `Some(None)` for clear glass.
fn tint(r: &record::Windscreen, context: &mut Context<'_>) -> Option<Option<Tint>> {
    let Some(colour) = &r.internal_transmittance else { return Some(None) };
    let thickness_mm = r.reference_thickness_mm.as_ref().map(|t| t.value);
    Some(Some(Tint { transmittance: curve(colour, context)?, thickness_mm }))
}
