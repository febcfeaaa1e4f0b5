//! From the command line to a chart, its light and its exposures.

use crate::chart_args::{self, Common, Series, Size};
use etendue_charts::design::{
    Backlit, Checkerboard, Circles, ColorChecker, ContrastPatches, DeadLeaves, DepthWedge, Dots, Flare, FlatField,
    GridSize, OecfSteps, Points, SiemensStar, SlantedEdges, SlantedStar,
};
use etendue_charts::{Chart, ChartError, Drawing, Exposures, Light, Meter, Spacing};

/// What is asked for.
pub(super) struct Choice<'a> {
    /// The chart.
    pub(super) chart: Chart,
    /// What all charts have in common.
    pub(super) common: &'a Common,
    /// How many cameras look at it.
    pub(super) views: u32,
    /// Whether each exposure has a dark frame.
    pub(super) dark: bool,
    exposures: Option<Exposures>,
    /// Whether the series is the chart's own wish.
    usual: bool,
}

/// Exposures of the retro-lighting chart (Gruyer and others 2012).
const FIFTEEN: u32 = 15;
const LOWEST: f64 = 0.003;
const HIGHEST: f64 = 1.3;

impl<'a> Choice<'a> {
    /// What the arguments ask for.
    pub(super) fn of(arguments: &'a chart_args::Chart) -> Result<Self, ChartError> {
        use chart_args::Chart as Asked;
        let (chart, common) = chart(arguments);
        let plain = Self { chart, common, views: 1, dark: false, exposures: None, usual: false };
        Ok(match arguments {
            Asked::Dots(a) => Self { views: a.views.views, ..plain },
            Asked::Checkerboard(a) => Self { views: a.views.views, ..plain },
            Asked::Circles(a) => Self { views: a.views.views, ..plain },
            Asked::FlatField(a) => Self { exposures: exposures(&a.series, None)?, ..plain },
            Asked::Backlit(a) => {
                let usual = a.series.exposures.is_none() && a.series.levels.is_none();
                Self { exposures: exposures(&a.series, Some(FIFTEEN))?, usual, dark: a.dark, ..plain }
            }
            _ => plain,
        })
    }

    /// The light: as bright as asked for, or as fills the sensor as far as asked for.
    pub(super) fn light(&self, meter: Option<&Meter<'_>>, otherwise_cd_m2: f64) -> Result<Light, ChartError> {
        let named = |luminance_cd_m2| Light::named(&self.common.illuminant, luminance_cd_m2);
        if let Some(luminance_cd_m2) = self.common.luminance_cd_m2 {
            return named(luminance_cd_m2);
        }
        let white = self.common.white;
        if !(white.is_finite() && white > 0.0) {
            return Err(ChartError::option("white", white, "expected a share of saturation above 0"));
        }
        let unit = named(1.0)?;
        let share = meter.map(|meter| meter.share(unit.radiance())).filter(|share| *share > 0.0);
        named(share.map_or(otherwise_cd_m2, |share| white / share))
    }
}

/// The chart and what it has in common with all.
fn chart(arguments: &chart_args::Chart) -> (Chart, &Common) {
    use chart_args::Chart as Asked;
    match arguments {
        Asked::Dots(a) => (Chart::Dots(Dots { size: size(&a.size), dot_share: a.dot_share }), &a.common),
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
            let chart = DeadLeaves { smallest_px: a.smallest_px, largest_share: a.largest_share };
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
        Asked::Flare(a) => (Chart::Flare(Flare { size: size(&a.size), trap_share: a.trap_share }), &a.common),
        Asked::Points(a) => (Chart::Points(Points { size: size(&a.size), diameter_px: a.diameter_px }), &a.common),
        Asked::DepthWedge(a) => (Chart::DepthWedge(DepthWedge { steps: a.steps, far_ratio: a.far_ratio }), &a.common),
    }
}

fn size(size: &Size) -> GridSize {
    GridSize { columns: size.columns, rows: size.rows, pitch_mm: size.pitch_mm }
}

impl Choice<'_> {
    /// The exposures of the series, s; none where there is no series.
    pub(super) fn exposures_s(
        &self,
        light: &Light,
        drawing: &Drawing,
        meter: Option<&Meter<'_>>,
    ) -> Result<Vec<f64>, ChartError> {
        let Some(exposures) = &self.exposures else { return Ok(Vec::new()) };
        let share = meter.map(|meter| meter.share(&drawing.inks[0].radiance(light))).filter(|share| *share > 0.0);
        let (Some(meter), Some(share)) = (meter, share) else {
            let told = || {
                "this camera has no electronics that respond to the light; give one with a sensor of its own".to_owned()
            };
            return if self.usual {
                Ok(Vec::new())
            } else {
                Err(ChartError::Camera(format!("--exposures, --levels: {}", told())))
            };
        };
        let exposures_s: Vec<f64> = exposures.shares.iter().map(|s| meter.exposure_s * s / share).collect();
        let longest_s = exposures_s.iter().copied().fold(0.0, f64::max);
        match meter.longest_s {
            Some(limit_s) if longest_s > limit_s => Err(ChartError::Camera(format!(
                "the longest exposure would be {longest_s:.3e} s, more than the camera's frame period of {limit_s} s: give more light \
                 by --luminance-cd-m2 or --white, or a lower --highest"
            ))),
            _ => Ok(exposures_s),
        }
    }
}

fn exposures(series: &Series, usual: Option<u32>) -> Result<Option<Exposures>, ChartError> {
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
        Some(chart_args::Spacing::Linear) => Spacing::Linear,
        Some(chart_args::Spacing::Log) | None => Spacing::Log,
    };
    let (lowest, highest) = (series.lowest.unwrap_or(LOWEST), series.highest.unwrap_or(HIGHEST));
    Exposures::spaced(count, spacing, lowest, highest).map(Some)
}
