//! `etendue chart`: a chart as a scene ready to render, with its truth beside it.

mod camera;
mod choice;

use super::render::{claim, commit, open};
use crate::chart_args;
use crate::failure::Failure;
use camera::ChartCamera;
use choice::Choice;
use etendue_charts::{ChartError, Contents, Eye, Footprint, Meter, RasterRay, Request, files, picture, stations};
use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;
use etendue_io::OutputFolder;
use etendue_io::photograph::Encoding;
use etendue_io::png::{encode_display, encode_raw16};
use etendue_pipeline::light_meter::LightMeter;
use glam::DVec2;

/// The distance of a sheet before a camera that is focused nowhere in particular, m.
const DISTANCE_M: f64 = 1.0;
/// The luminance of white before a camera without electronics, cd/m².
const LUMINANCE_CD_M2: f64 = 1000.0;

pub fn run(arguments: &chart_args::Chart) -> Result<(), Failure> {
    let choice = Choice::of(arguments).map_err(refused)?;
    let camera = ChartCamera::load(&choice.common.camera)?;
    let body = &camera.body;
    let ray = |at: DVec2| {
        let (front, _) = body.truth_ray(at)?;
        Some(RasterRay { origin_m: front.truth_origin_m(), direction: front.ray.direction })
    };
    let size_px = DVec2::new(body.raster.width() as f64, body.raster.height() as f64);
    let eye = Eye { size_px, ray: &ray };
    let light_meter = LightMeter::of(body);
    let electrons = |radiance: &_| light_meter.as_ref().map_or_else(Vec::new, |meter| meter.electrons(radiance));
    let meter = light_meter.as_ref().zip(body.sensor.as_ref()).map(|(meter, sensor)| Meter {
        exposure_s: sensor.parameters().exposure.exposure_s,
        longest_s: sensor.parameters().exposure.frame_period_s,
        saturation_e: meter.saturation_e(),
        electrons: &electrons,
    });
    // Nothing is measured in no time.
    let meter = meter.filter(|meter| meter.exposure_s > 0.0);
    let seen = footprint(&choice, &camera, &eye)?;
    let drawing = choice.chart.draw(&seen, choice.common.seed).map_err(refused)?;
    let light = choice.light(meter.as_ref(), LUMINANCE_CD_M2).map_err(refused)?;
    let exposures_s = choice.exposures_s(&light, &drawing, meter.as_ref()).map_err(refused)?;
    let stations = stations(seen.distance_m, choice.views, &exposures_s, choice.dark);
    let mut folder = open(&choice.common.output)?;
    let request = Request {
        chart: &choice.chart,
        drawing: &drawing,
        seen,
        eye: &eye,
        meter: meter.as_ref(),
        light: &light,
        stations: &stations,
        camera: &camera.base(folder.path())?,
        without: camera.without(),
        specimen: camera.specimen(&stations),
        seed: choice.common.seed,
    };
    write(&request, &camera, &choice, &mut folder)?;
    commit(folder)
}

fn refused(error: ChartError) -> Failure {
    Failure::input(error)
}

/// What the camera sees at the distance that is asked for, directly or by the width.
fn footprint(choice: &Choice<'_>, camera: &ChartCamera, eye: &Eye<'_>) -> Result<Footprint, Failure> {
    let legal = |option: &'static str, value: f64| match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err(refused(ChartError::option(option, value, "expected a number above 0"))),
    };
    let focused = camera.body.lens.focus_distance_m().filter(|m| m.is_finite());
    let mut distance_m = match choice.common.distance_m {
        Some(distance_m) => legal("distance-m", distance_m)?,
        None => focused.unwrap_or(DISTANCE_M),
    };
    if let Some(width_mm) = choice.common.width_mm {
        let width_mm = legal("width-mm", width_mm)?;
        // The width is all but proportional to the distance.
        for _ in 0..8 {
            distance_m *= width_mm / eye.footprint(distance_m).map_err(refused)?.outer_mm.x;
        }
    }
    eye.footprint(distance_m).map_err(refused)
}

fn write(
    request: &Request<'_>,
    camera: &ChartCamera,
    choice: &Choice<'_>,
    folder: &mut OutputFolder,
) -> Result<(), Failure> {
    let files = files(request);
    let print = choice.common.png.map(|dpi| picture(request.drawing, dpi)).transpose().map_err(refused)?;
    let print = print.map(|plane| encode_display(&plane, &Encoding::Srgb)).transpose().map_err(Failure::run)?;
    let stand_in = camera.stand_in().map(|(name, text)| (name, text.as_bytes().to_vec()));
    let mut all: Vec<(String, Vec<u8>)> = stand_in.into_iter().collect();
    for file in files {
        all.push((file.name, bytes(file.contents)?));
    }
    all.extend(print.map(|bytes| ("chart.png".to_owned(), bytes)));
    claim(folder, all.iter().map(|(name, _)| name.clone()))?;
    all.iter().try_for_each(|(name, bytes)| folder.write(name, bytes).map_err(Failure::run))
}

fn bytes(contents: Contents) -> Result<Vec<u8>, Failure> {
    match contents {
        Contents::Text(text) => Ok(text.into_bytes()),
        Contents::Grey16(width, height, values) => {
            let samples = values.into_iter().map(u32::from).collect();
            let plane: Plane<DigitalNumber> = Plane::from_samples(width, height, samples).expect("one value a texel");
            encode_raw16(&plane).map_err(Failure::run)
        }
    }
}
