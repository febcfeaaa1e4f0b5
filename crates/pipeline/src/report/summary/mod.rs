//! The plan as text: what is modelled, what is left out and why, and the estimated cost.

mod effects_table;
mod front;
pub(super) mod lens;
mod light;
mod precipitation;
mod processing;
mod time;
mod words;

use crate::plan::note::{Severity, grouped};
use crate::plan::{AdaptiveSampling, CameraPlan, Passes, Plan, Products, Route, Settings, SkyFacts};
use crate::render::{light_counts, training};
use crate::report::FrameCost;
use crate::report::cpu_time::FilmWork;
use crate::report::effects::lens::irradiance_effect_status;
use crate::report::memory::TextureUse;
use crate::report::{FilmBytes, RunMemory};
use crate::report::{MeshSize, mesh_sizes};
use crate::sizes::block::Blocks;
use effects_table::effects_table;
use etendue_core::{Accelerator, Bands, EffectStatus, Integrator};
use etendue_optics::effects::Effect;
use etendue_sensor::SensorEffect;
use etendue_sensor::figures::db;
use etendue_sensor::figures::{CaptureTransition, DynamicRange};
use etendue_tracer::geometry::Shape;
use std::fmt::{self, Display, Formatter};
use words::{count, figure, line, list, seconds};

/// Displays a plan as text.
#[derive(Clone, Copy, Debug)]
pub struct Summary<'a>(pub &'a Plan);

impl Display for Summary<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let plan = self.0;
        writeln!(f, "plan {}", &plan.hash_text()[..16])?;
        world(plan, f)?;
        for camera in &plan.cameras {
            writeln!(f)?;
            self::camera(plan, camera, f)?;
        }
        writeln!(f)?;
        memory(plan, f)?;
        writeln!(f, "\n{LEGEND}")?;
        section(f, "warnings", &plan.warnings())?;
        let notes = grouped(&plan.notes).into_iter().filter(|note| note.weight == Severity::Note);
        section(f, "notes", &notes.map(|note| note.to_string()).collect::<Vec<_>>())
    }
}

/// Writes the memory of the whole run.
fn memory(plan: &Plan, f: &mut Formatter<'_>) -> fmt::Result {
    let memory = RunMemory::from_plan(plan);
    line(f, "memory", format!("{:.0} MB for the whole run: {}", memory.bytes() / 1e6, memory.parts()))
}

fn section(f: &mut Formatter<'_>, heading: &str, sentences: &[String]) -> fmt::Result {
    if !sentences.is_empty() {
        writeln!(f, "\n{heading}")?;
    }
    sentences.iter().try_for_each(|sentence| writeln!(f, "  {sentence}"))
}

/// Explanation of the tables.
const LEGEND: &str = "required: the scene or camera needs the effect; it always runs.\n\
                      guarded: a fast test for each ray or pixel decides whether the effect runs.\n\
                      if dropped: CPU time saved per frame, and the error that results.\n\
                      always on: no key of the job disables the effect.\n\
                      error unknown: no closed form; the tradeoff command measures it (`ablate`).\n\
                      –: unknown. Shares overlap, as some effects are parts of others.\n\
                      Keys, reasons and all skipped effects: JSON output (`json`)";

fn world(plan: &Plan, f: &mut Formatter<'_>) -> fmt::Result {
    writeln!(f, "\nscene")?;
    let stored: usize = plan.world.meshes().iter().map(|m| m.triangles().len()).sum();
    let (mut visible_triangles, mut spheres) = (0, 0);
    for instance in plan.world.instances() {
        match instance.shape {
            Shape::Mesh(id) => visible_triangles += plan.world.mesh(id).triangles().len(),
            Shape::Sphere { .. } => spheres += 1,
        }
    }
    let instances = plan.world.instances().len();
    let triangles = format!("{} ({stored} stored)", count(visible_triangles, "triangle"));
    let trees = match plan.world.tree_quality() {
        Accelerator::Fast => "; acceleration structure built fast: rays take longer",
        Accelerator::Default => "",
        Accelerator::Best => "; acceleration structure built for fast rays",
    };
    let (instances, spheres) = (count(instances, "instance"), count(spheres, "sphere"));
    line(f, "geometry", format!("{instances}, {triangles}, {spheres}{trees}"))?;
    meshes(plan, f)?;
    let textures = count(plan.material_table.textures().len(), "texture");
    line(f, "materials", format!("{}, {textures}", plan.materials.len()))?;
    if let Some(tiles) = TextureUse::from_materials(&plan.material_table).tiles() {
        line(f, "textures", tiles)?;
    }
    if let Some(sky) = &plan.sky {
        line(f, "sky", self::sky(sky))?;
    }
    if let Some(precipitation) = &plan.precipitation {
        line(f, "weather", precipitation::field(precipitation))?;
    }
    let left_out = if plan.media.is_empty() {
        "air: clear; polarisation and fluorescence: not modelled"
    } else {
        "polarisation and fluorescence: not modelled"
    };
    match time::motion(plan) {
        None if plan.precipitation.is_some() => line(f, "left out", format!("motion of objects: none; {left_out}")),
        None => line(f, "left out", format!("motion: none; {left_out}")),
        Some(motion) => {
            line(f, "motion", motion)?;
            line(f, "left out", left_out)
        }
    }
}

/// Maximum number of listed meshes.
const LISTED_MESHES: usize = 12;

fn meshes(plan: &Plan, f: &mut Formatter<'_>) -> fmt::Result {
    let sizes = mesh_sizes(plan);
    for MeshSize { object, objects, triangles, size_m: [x, y, z] } in sizes.iter().take(LISTED_MESHES) {
        let of = if *objects > 1 { format!(" ({objects} objects)") } else { String::new() };
        let (x, y, z) = (figure(*x), figure(*y), figure(*z));
        line(
            f,
            "mesh",
            format!("{object}{of}: {x} × {y} × {z} m (x forward, y left, z up), {}", count(*triangles, "triangle")),
        )?;
    }
    match sizes.len().saturating_sub(LISTED_MESHES) {
        0 => Ok(()),
        more => line(f, "mesh", format!("and {more} more, listed in the JSON output (`json`)")),
    }
}

fn sky(sky: &SkyFacts) -> String {
    let SkyFacts { turbidity, sun_elevation_deg, sun_azimuth_deg, sky_lx, sun_lx } = sky;
    let lux = |lx: &f64| if *lx >= 100.0 { format!("{lx:.0} lx") } else { format!("{lx:.3} lx") };
    let sun = match (*sun_lx > 0.0, *sun_elevation_deg <= 0.0) {
        (true, _) => format!("and {} from the sun", lux(sun_lx)),
        (false, true) => "and none from the sun, which is below the horizon".to_owned(),
        (false, false) => "and none from the sun, which is left out".to_owned(),
    };
    format!(
        "turbidity {turbidity}, sun at elevation {sun_elevation_deg:.2}° and azimuth {sun_azimuth_deg:.2}°; level \
         ground receives {} from the sky {sun}",
        lux(sky_lx)
    )
}

fn camera(plan: &Plan, camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    writeln!(f, "camera {}", camera.name)?;
    if let Some(text) = light::light(plan, camera) {
        line(f, "light", text)?;
    }
    if let Some(frames) = time::frames(camera) {
        line(f, "frames", frames)?;
    }
    if let Some(shutter) = time::shutter(camera) {
        line(f, "shutter", shutter)?;
    }
    if let Some(text) = precipitation::near(plan, camera) {
        line(f, "weather", text)?;
    }
    lights(plan, camera, f)?;
    light_paths(camera, f)?;
    lens::lens(camera, f)?;
    effects(camera, f)?;
    sensor(camera, f)?;
    processing::processing(camera, f)?;
    line(f, "delivers", products(&camera.products))?;
    cost(plan, camera, f)?;
    effects_table(plan, camera, f)
}

fn lights(plan: &Plan, camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let counts = light_counts(plan, camera);
    let counted = [
        (counts.suns, "sun disc"),
        (counts.lamps, "lamp"),
        (counts.openings, "lamp opening"),
        (counts.triangles, "emissive triangle"),
        (counts.spheres, "emissive sphere"),
        (usize::from(counts.image_environment), "environment map"),
        (usize::from(counts.sky), "clear sky"),
        (usize::from(counts.uniform_environment), "uniform environment"),
    ];
    let list: Vec<String> = counted.iter().filter(|(n, _)| *n > 0).map(|(n, name)| count(*n, name)).collect();
    let over_time = if plan.is_modulated() { "; strengths change over time" } else { "" };
    let none = "none: the image will be black".to_owned();
    line(f, "lights", if list.is_empty() { none } else { list.join(", ") + over_time })
}

fn samples(camera: &CameraPlan) -> String {
    let s = &camera.settings;
    let replicates = count(s.replicates as usize, "replicate");
    match s.adaptive {
        None => match camera.passes.as_ref().map(Passes::list) {
            None => format!("{} per pixel in {replicates}", count(s.spp as usize, "sample")),
            Some(passes) => {
                let spp: f64 = passes.iter().map(|pass| pass.number()).sum();
                let list: Vec<String> = passes.iter().map(|pass| pass.number().to_string()).collect();
                let each = if passes.len() == 1 { "pass" } else { "passes" };
                format!(
                    "{spp} samples per pixel in {} {each} ({}), each in {replicates}",
                    passes.len(),
                    list.join(", ")
                )
            }
        },
        Some(AdaptiveSampling { threshold, min_spp }) => {
            let by_sensor = s.route == Route::Lens && camera.body.sensor.is_some();
            let of = if by_sensor { "the sensor's noise" } else { "its mean" };
            format!("{min_spp} to {} samples per pixel in {replicates}, until its error is {threshold} of {of}", s.spp)
        }
    }
}

fn light_paths(camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let s = &camera.settings;
    let samples = samples(camera);
    let alone = if s.wavelengths == 1 && camera.body.disperses() { ", as the optics are dispersive" } else { "" };
    let wavelength_count = count(s.wavelengths as usize, "wavelength");
    line(f, "sampling", format!("{samples}, seed {}, {wavelength_count} per path{alone}", s.seed))?;
    if let Some(text) = light::wavelengths(camera) {
        line(f, "wavelengths", text)?;
    }
    line(f, "paths", path_depth(s))?;
    if s.blocks != Blocks::SINGLE {
        let text = format!("blocks of {} pixels share path tails, so their errors are correlated", s.blocks.len_px());
        line(f, "path reuse", text)?;
    }
    if !s.paths.caustics {
        line(
            f,
            "left out",
            "caustics of suns and lamps (light that smooth surfaces cast on diffuse ones), as requested",
        )?;
    }
    if s.guiding {
        let paths = count(training::paths_of(camera) as usize, "path");
        line(f, "path guiding", format!("directions at diffuse surfaces, learned from {paths} before rendering"))?;
    }
    if s.paths.branches > 1 {
        line(
            f,
            "branched",
            format!("{0} lights are sampled and {0} paths continue at each sample's first surface", s.paths.branches),
        )?;
    }
    if s.paths.regularize {
        let text = "lobes of metals, coats, glass and paint are roughened after a wider lobe (biased), as requested";
        line(f, "regularised", text)?;
    }
    let cube = |bands: Bands| {
        let noise = light::band_noise(camera, bands);
        format!("{} band means of {} nm are stored{noise}", bands.count(), bands.width_nm())
    };
    let storage = match (s.bands, s.accumulates_electrons) {
        (Some(bands), false) => cube(bands),
        (Some(bands), true) => format!("{}; electrons are accumulated as well", cube(bands)),
        (None, true) => "not stored: pixels accumulate electrons directly".to_owned(),
        (None, false) => "not stored".to_owned(),
    };
    line(f, "spectrum", format!("{} to {} nm; {storage}", s.range.low_nm, s.range.high_nm))
}

fn path_depth(settings: &Settings) -> String {
    match settings.paths.integrator {
        Integrator::Flat => {
            "none: local shading by lamps, suns and sky (integrator flat); shadows, reflections and indirect light are \
             missing"
                .to_owned()
        }
        Integrator::Direct => {
            "none: direct light with shadows (integrator direct); reflections and indirect light are missing".to_owned()
        }
        Integrator::Path => {
            format!("at most {} bounces (light scattered more often is missing)", settings.paths.max_bounces)
        }
    }
}

/// Irradiance effects, each with its status.
fn effects(camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let effects = &camera.body.effects;
    let [columns, rows] = effects.margin_px();
    let area = match (effects.is_idle(), columns + rows) {
        (true, _) => "none applied to the image irradiance".to_owned(),
        (false, 0) => "applied to the image irradiance; light from outside the image is missing".to_owned(),
        (false, _) => {
            format!("applied to the image irradiance, with {columns} columns and {rows} rows rendered beyond each edge")
        }
    };
    line(f, "lens effects", area)?;
    for effect in Effect::ALL {
        let status = irradiance_effect_status(camera, effect);
        line(f, "", format!("{}: {status}: {}", effect.name(), status.reason()))?;
    }
    Ok(())
}

fn sensor(camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let raster = &camera.body.raster;
    let size = format!("{} × {} px of {} µm", raster.width(), raster.height(), 1000.0 * raster.pitch_mm().x);
    let size = size + &scale(camera);
    let Some(sensor) = &camera.body.sensor else {
        return line(f, "sensor", format!("{size}; no electronics are described, so no electrons are computed"));
    };
    let p = sensor.parameters();
    line(
        f,
        "sensor",
        format!(
            "{size}, {} s, {} bits, {} e⁻ full well",
            p.exposure.exposure_s, p.read_out.bits, p.charge.full_well.capacity_e
        ),
    )?;
    let (without_figures, with_figures): (Vec<_>, Vec<_>) =
        sensor.effects().into_iter().partition(|effect| effect.status == EffectStatus::NotDescribed);
    for SensorEffect { name, status, .. } in with_figures {
        line(f, "", format!("{name}: {status}: {}", status.reason()))?;
    }
    let without_figures: Vec<_> = without_figures.into_iter().map(|effect| effect.name).collect();
    line(f, "", format!("left out, as not described: {}", without_figures.join(", ")))?;
    line(f, "", range(&sensor.dynamic_range()))
}

/// Returns the scale and the size of the image of the described sensor, if the pixels are larger than described.
fn scale(camera: &CameraPlan) -> String {
    let (raster, k) = (&camera.body.raster, camera.body.scale);
    let (width, height) = (raster.width() as u64 * k, raster.height() as u64 * k);
    if k == 1 { String::new() } else { format!(" (scale 1/{k} of {width} × {height} px)") }
}

/// Dynamic range of a frame.
fn range(range: &DynamicRange) -> String {
    if range.upper_e <= range.lower_e {
        return "dynamic range: none; the full well or the range of the ADC is below the noise".into();
    }
    let switch = |s: &CaptureTransition| {
        format!("; switch to the next capture at {:.4e} e⁻: S/N {:.1} to {:.1} dB", s.at_e, db(s.before), db(s.after))
    };
    let switches: String = range.switches.iter().map(switch).collect();
    format!("dynamic range: {:.1} dB, {:.4} to {:.4e} e⁻{switches}", range.db(), range.lower_e, range.upper_e)
}

fn products(products: &Products) -> String {
    let listed = products.list().into_iter().filter(|product| product.is_delivered);
    let list: Vec<&str> = listed.filter_map(|product| product.text).collect();
    if list.is_empty() { "nothing".to_owned() } else { list.join(", ") }
}

/// Minimum time, s, or fraction of the whole, of the listed work in addition to the paths.
const MIN_LISTED_CPU_S: f64 = 0.5;
const MIN_LISTED_FRACTION: f64 = 0.05;
/// Total time below which no fractions are stated, s.
const SHORT_CPU_S: f64 = 1.0;

fn cost(plan: &Plan, camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let cost = FrameCost::new(plan, camera);
    if let Some(server) = light::light_provider(plan, camera) {
        line(f, "cost", format!("no separate paths: shares those of camera {}", server.name))?;
        return write_further_cost(&cost.parts, cost.film_cpu_s(), f);
    }
    let upwards = if cost.is_lower_bound { " or more" } else { "" };
    let served = light::other_users(plan, camera);
    line(
        f,
        "cost",
        format!(
            "{:.1} million paths{upwards}, about {:.0} CPU seconds at the path rate of the street scene{served}; film {}",
            cost.paths / 1e6,
            cost.paths_cpu_s,
            film(cost.film)
        ),
    )?;
    write_further_cost(&cost.parts, cost.cpu_s(), f)
}

/// Storage of a film.
fn film(bytes: FilmBytes) -> String {
    let memory = format!("{:.1} MB", bytes.memory / 1e6);
    if bytes.disk == 0.0 {
        return memory;
    }
    let read =
        bytes.all_bands_for.map_or_else(String::new, |what| format!(", all read into memory at once for {what}"));
    format!("{memory} in memory, its bands {:.1} MB on disk{read}", bytes.disk / 1e6)
}

/// Work in addition to the paths, and the total time; empty if it is short.
fn write_further_cost(film_work: &[FilmWork], whole_s: f64, f: &mut Formatter<'_>) -> fmt::Result {
    let min_s = MIN_LISTED_CPU_S.min(MIN_LISTED_FRACTION * whole_s);
    let listed = |work: &&FilmWork| whole_s > SHORT_CPU_S && work.cpu_s > min_s;
    let words = |work: &FilmWork| {
        let why = if work.holds_for.is_empty() { String::new() } else { format!(" ({})", work.holds_for) };
        format!("{} {}{why}", work.name, seconds(work.cpu_s))
    };
    let list: Vec<String> = film_work.iter().filter(|work| work.cpu_s > 0.0).filter(listed).map(words).collect();
    if list.is_empty() {
        return Ok(());
    }
    line(f, "", format!("further CPU seconds: {}; about {} in total", list.join(", "), seconds(whole_s)))
}
