//! Tone curves.

use super::super::context::Context;
use super::correction::table;
use etendue_isp::{Oecf, SCurve, Table, ToneCurve};
use etendue_scene::record::processing as description;
use etendue_scene::record::processing::tone::{CurveKind, NamedCurve};

pub(super) fn tone_curve(record: &description::ToneCurve, context: &mut Context<'_>) -> Option<ToneCurve> {
    let curve = match record {
        description::ToneCurve::Named(name) => {
            return Some(match name.value {
                NamedCurve::Srgb => ToneCurve::Srgb,
                NamedCurve::Linear => ToneCurve::Gamma(1.0),
            });
        }
        description::ToneCurve::Curve(curve) => curve,
    };
    match &curve.kind {
        CurveKind::Gamma(gamma) => context.accept(&gamma.place, ToneCurve::gamma(gamma.value)),
        CurveKind::Contrast(contrast) => {
            let midpoint = curve.midpoint.as_ref().map_or(0.5, |m| m.value);
            context.accept(&contrast.place, SCurve::new(contrast.value, midpoint)).map(ToneCurve::SCurve)
        }
        CurveKind::Table(file) => {
            let points = table(file, 2, "linear light and output", context)?.rows().map(|r| (r[0], r[1])).collect();
            context.accept(&file.place, Table::new(points)).map(ToneCurve::Table)
        }
        CurveKind::Oecf(file) => {
            let points = table(file, 2, "exposure and output", context)?.rows().map(|r| (r[0], r[1])).collect();
            let largest = curve.largest_output.as_ref().map_or(255.0, |l| l.value);
            context.accept(&file.place, Oecf::new(points, largest)).map(ToneCurve::Oecf)
        }
    }
}
