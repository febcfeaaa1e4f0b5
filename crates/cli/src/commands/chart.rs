//! `etendue chart`: a chart as a scene ready to render, with its truth beside it.

use crate::args::chart::{self as asked, Chart as Asked, Common, Series as SeriesArgs, Size};
use crate::output::print_paths;
use etendue::Error;
use etendue::chart::design::{
    Backlit, Checkerboard, Circles, ColorChecker, ContrastPatches, DeadLeaves, DepthWedge, Dots, Flare, FlatField,
    GridSize, OecfSteps, Points, SiemensStar, SlantedEdges, SlantedStar,
};
use etendue::chart::{Chart, ChartError, ChartRequest, Exposures, Series, Spacing, make};

/// Exposures of the retro-lighting chart (Gruyer and others 2012).
const FIFTEEN: u32 = 15;
const LOWEST: f64 = 0.003;
const HIGHEST: f64 = 1.3;

pub fn run(arguments: &Asked) -> Result<(), Error> {
    let request = request(arguments).map_err(Error::input)?;
    print_paths(&make(&request, common(arguments).output.folder())?);
    Ok(())
}

fn request(arguments: &Asked) -> Result<ChartRequest, ChartError> {
    let (chart, common) = chart(arguments);
    let plain = ChartRequest {
        distance_m: common.distance_m,
        width_mm: common.width_mm,
        illuminant: common.illuminant.clone(),
        luminance_cd_m2: common.luminance_cd_m2,
        white: common.white,
        seed: common.seed,
        png_dpi: common.png,
        ..ChartRequest::new(chart, common.camera.as_str())
    };
    Ok(match arguments {
        Asked::Dots(a) => ChartRequest { views: a.views.views, ..plain },
        Asked::Checkerboard(a) => ChartRequest { views: a.views.views, ..plain },
        Asked::Circles(a) => ChartRequest { views: a.views.views, ..plain },
        Asked::FlatField(a) => ChartRequest { series: series(&a.series, None)?, ..plain },
        Asked::Backlit(a) => ChartRequest { series: series(&a.series, Some(FIFTEEN))?, dark: a.dark, ..plain },
        _ => plain,
    })
}

fn common(arguments: &Asked) -> &Common {
    chart(arguments).1
}

/// The chart and what it has in common with all.
fn chart(arguments: &Asked) -> (Chart, &Common) {
    match arguments {
        Asked::Dots(a) => (Chart::Dots(Dots { size: size(&a.size), dot_ratio: a.dot_ratio }), &a.common),
        Asked::Checkerboard(a) => (Chart::Checkerboard(Checkerboard { size: size(&a.size) }), &a.common),
        Asked::Circles(a) => (Chart::Circles(Circles { size: size(&a.size), asymmetric: a.asymmetric }), &a.common),
        Asked::FlatField(a) => (Chart::FlatField(FlatField { reflectance: a.reflectance }), &a.common),
        Asked::Backlit(a) => (Chart::Backlit(Backlit), &a.common),
        Asked::SlantedEdges(a) => {
            let chart = SlantedEdges { size: size(&a.size), angle_deg: a.edge.angle_deg, contrast: a.edge.contrast };
            (Chart::SlantedEdges(chart), &a.common)
        }
        Asked::SlantedStar(a) => {
            let (spokes, angle_deg, contrast) = (a.spokes, a.edge.angle_deg, a.edge.contrast);
            (Chart::SlantedStar(SlantedStar { size: size(&a.size), spokes, angle_deg, contrast }), &a.common)
        }
        Asked::SiemensStar(a) => (Chart::SiemensStar(SiemensStar { cycles: a.cycles, binary: a.binary }), &a.common),
        Asked::DeadLeaves(a) => {
            let chart = DeadLeaves { smallest_px: a.smallest_px, largest_ratio: a.largest_ratio };
            (Chart::DeadLeaves(chart), &a.common)
        }
        Asked::OecfSteps(a) => {
            let density = a.density.unwrap_or(if a.backlit { 3.0 } else { 2.0 });
            (Chart::OecfSteps(OecfSteps { steps: a.steps, density, backlit: a.backlit }), &a.common)
        }
        Asked::Colorchecker(a) => (Chart::ColorChecker(ColorChecker), &a.common),
        Asked::ContrastPatches(a) => {
            (Chart::ContrastPatches(ContrastPatches { size: size(&a.size), decades: a.decades }), &a.common)
        }
        Asked::Flare(a) => (Chart::Flare(Flare { size: size(&a.size), trap_ratio: a.trap_ratio }), &a.common),
        Asked::Points(a) => (Chart::Points(Points { size: size(&a.size), diameter_px: a.diameter_px }), &a.common),
        Asked::DepthWedge(a) => (Chart::DepthWedge(DepthWedge { steps: a.steps, far_ratio: a.far_ratio }), &a.common),
    }
}

fn size(size: &Size) -> GridSize {
    GridSize { columns: size.columns, rows: size.rows, pitch_mm: size.pitch_mm }
}

/// The series that is asked for; `usual` exposures where nothing is, which a camera without electronics does without.
fn series(series: &SeriesArgs, usual: Option<u32>) -> Result<Option<Series>, ChartError> {
    let required = series.exposures.is_some() || series.levels.is_some();
    Ok(exposures(series, usual)?.map(|exposures| Series { exposures, required }))
}

fn exposures(series: &SeriesArgs, usual: Option<u32>) -> Result<Option<Exposures>, ChartError> {
    if let Some(levels) = &series.levels {
        return Exposures::listed(levels.clone()).map(Some);
    }
    let Some(count) = series.exposures.or(usual) else {
        let given = [("lowest", series.lowest), ("highest", series.highest)];
        let idle = given.into_iter().find_map(|(name, value)| Some((name, value?.to_string())));
        let idle = idle.or(series.spacing.map(|_| ("spacing", String::new())));
        let told = |(name, value): (&'static str, String)| {
            ChartError::option(name, value, "has no effect without --exposures; give how many")
        };
        return idle.map_or(Ok(None), |idle| Err(told(idle)));
    };
    let spacing = match series.spacing {
        Some(asked::Spacing::Linear) => Spacing::Linear,
        Some(asked::Spacing::Log) | None => Spacing::Log,
    };
    let (lowest, highest) = (series.lowest.unwrap_or(LOWEST), series.highest.unwrap_or(HIGHEST));
    Exposures::spaced(count, spacing, lowest, highest).map(Some)
}
