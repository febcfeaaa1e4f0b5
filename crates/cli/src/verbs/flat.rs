//! `etendue flat`: even light on a camera's bare sensor.

use super::render::{claim, commit, open};
use crate::camera_file;
use crate::facts;
use crate::failure::Failure;
use crate::files::Files;
use crate::machine;
use crate::photographs::{Wanted, encoded_raw, photographs};
use crate::results::Results;
use crate::sensor_args;
use crate::tell;
use etendue_io::Provenance;
use etendue_pipeline::flat::{self, FlatLight, PhotonTransfer, Stack};
use etendue_pipeline::plan::{CameraBody, Products, RawFormat};
use etendue_sensor::{FrameAddress, Sensor, SensorState};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The series as the standard's reference program reads it.
const DESCRIPTOR: &str = "emva1288.txt";

/// Electrons are whole numbers up to here, 2⁵³.
const MOST_E: f32 = 9_007_199_254_740_992.0;

pub fn run(arguments: &sensor_args::Flat) -> Result<(), Failure> {
    let body = body(arguments)?;
    let name = camera_file::name(&arguments.camera);
    let mut folder = open(&arguments.output)?;
    let task = Task { arguments, body: &body, sensor: body.sensor.as_ref().expect("checked above") };
    let pool = machine::pool(None)?;
    match &arguments.light.photon_transfer {
        None => {
            let files = Files::of(&task.products(), &body, &arguments.frames);
            claim(&folder, files.keys().map(String::as_str).chain([Files::SIDECAR]).map(|f| format!("{name}/{f}")))?;
            pool.install(|| task.frames(&files, &mut Results { prefix: name, folder: &mut folder }))?;
        }
        Some(levels) => {
            let series = flat::photon_transfer(task.sensor, arguments.wavelength_nm, *levels, arguments.stack)
                .map_err(|error| Failure::input(format!("{}: {error}", arguments.camera.display())))?;
            let frames = series.stacks.iter().flat_map(|stack| stack.frames.clone()).map(|n| task.file(n));
            let files = frames.chain([DESCRIPTOR.to_owned(), Files::SIDECAR.to_owned()]);
            claim(&folder, files.map(|f| format!("{name}/{f}")))?;
            pool.install(|| task.series(&series, &mut Results { prefix: name, folder: &mut folder }))?;
        }
    }
    commit(folder)
}

fn body(arguments: &sensor_args::Flat) -> Result<CameraBody, Failure> {
    let body = camera_file::load(&arguments.camera, &arguments.set)?;
    let lack = || Failure::input(format!("{}: the sensor has no electronics: add them", arguments.camera.display()));
    flat::bare(&body).ok_or_else(lack)
}

/// What was asked for.
struct Task<'a> {
    arguments: &'a sensor_args::Flat,
    body: &'a CameraBody,
    sensor: &'a Sensor,
}

impl Task<'_> {
    fn products(&self) -> Products {
        Products {
            radiance: false,
            irradiance: false,
            ghosts: false,
            variance: false,
            electrons: false,
            raw: true,
            raw_format: RawFormat::usual(Some(self.sensor)),
            causes: self.arguments.causes,
            picture: self.body.development.is_some(),
            ground_truth: false,
            camera_space_position: false,
            depth_png_per_m: None,
            rays: false,
            undistorted: None,
        }
    }

    fn file(&self, frame: u32) -> String {
        Files::raw(frame, self.products().raw_format)
    }

    fn seed(&self) -> u64 {
        self.arguments.seed.unwrap_or(0)
    }

    fn address(&self, frame: u32) -> FrameAddress {
        FrameAddress { seed: self.seed(), camera: 0, frame, capture: 0 }
    }

    /// The light of single frames.
    fn light(&self) -> Result<FlatLight, Failure> {
        let (wavelength_nm, asked) = (self.arguments.wavelength_nm, &self.arguments.light);
        match (asked.irradiance_w_m2, asked.photons) {
            (None, Some(photons)) => FlatLight::of_photons(self.sensor, wavelength_nm, photons)
                .map_err(|error| Failure::input(format!("--photons {photons}: {error}"))),
            (irradiance_w_m2, _) => Ok(FlatLight { wavelength_nm, irradiance_w_m2: irradiance_w_m2.unwrap_or(0.0) }),
        }
    }

    /// Single frames of one light.
    fn frames(&self, files: &BTreeMap<String, Value>, results: &mut Results<'_>) -> Result<(), Failure> {
        let light = self.light()?;
        let electrons = flat::electrons(self.body, light).expect("it has electronics");
        if let Some(most) = electrons.samples().iter().find(|e| **e > MOST_E) {
            let why = format!("makes {most:.1e} electrons a pixel, and at most {MOST_E:.0e} can be counted: give less");
            let asked = &self.arguments.light;
            let given = match (asked.irradiance_w_m2, asked.photons) {
                (Some(e), _) => format!("--irradiance-w-m2 {e:e}"),
                (None, photons) => format!("--photons {:e}", photons.unwrap_or(0.0)),
            };
            return Err(Failure::input(format!("{given}: {why}")));
        }
        let (products, facts, camera) = (self.products(), self.provenance(results), results.prefix.clone());
        let wanted = Wanted { products: &products, camera: &camera, facts: &facts, undistorted: None };
        let points = photographs(self.body, &electrons, &self.arguments.frames, |n| self.address(n), wanted, results)?;
        let mut facts = self.sidecar(light);
        facts["light"]["photons_per_pixel"] =
            flat::photons(self.sensor, light, self.sensor.parameters().exposure.exposure_s).into();
        facts["files"] = json!(files);
        facts["frames"] = points.into();
        results.json(Files::SIDECAR, &facts)
    }

    /// The standard's series.
    fn series(&self, series: &PhotonTransfer, results: &mut Results<'_>) -> Result<(), Failure> {
        let channels = self.sensor.parameters().channels.len();
        if channels > 1 {
            tell(&format!("warning: the sensor has {channels} kinds of pixel: measure each kind by itself\n"));
        }
        let mut size = (0, 0);
        for stack in &series.stacks {
            size = self.stack(stack, series.light, results)?;
        }
        results.write(DESCRIPTOR, Ok(self.descriptor(series, size).into_bytes()))?;
        let mut facts = self.sidecar(series.light);
        let stack = |s: &Stack| json!({ "exposure_s": s.exposure_s, "photons_per_pixel": s.photons, "frames": [s.frames.start, s.frames.end] });
        facts["stacks"] = series.stacks.iter().map(stack).collect();
        results.json(Files::SIDECAR, &facts)
    }

    /// The frames of a stack, and their size.
    fn stack(&self, stack: &Stack, light: FlatLight, results: &mut Results<'_>) -> Result<(usize, usize), Failure> {
        let lit = f64::from(u8::from(stack.photons > 0.0));
        let light = FlatLight { irradiance_w_m2: lit * light.irradiance_w_m2, ..light };
        let electrons = flat::electrons(self.body, light).expect("it has electronics");
        let (mut state, mut size) = (SensorState::default(), (0, 0));
        for number in stack.frames.clone() {
            let begun = stack.state(self.sensor, state);
            let (next, raw) = self.sensor.step(begun, &electrons, self.address(number));
            state = next;
            let plane = raw.linear().plane;
            size = (plane.width(), plane.height());
            let products = self.products();
            results.write(&self.file(number), encoded_raw(&raw, &plane, products.raw_format))?;
        }
        Ok(size)
    }

    /// The series in the words of the reference program: `n` bits, columns, rows; `b` exposure in ns, photons a pixel; `d`
    /// exposure in the dark; `i` a file.
    fn descriptor(&self, series: &PhotonTransfer, (columns, rows): (usize, usize)) -> String {
        let mut text = format!("v 4.0\nn {} {columns} {rows}\n", self.sensor.delivered_bits());
        for stack in &series.stacks {
            let exposure_ns = 1e9 * stack.exposure_s;
            let head = match stack.photons {
                0.0 => format!("d {exposure_ns:.3}"),
                photons => format!("b {exposure_ns:.3} {photons:.6}"),
            };
            // Writing to a string does not fail.
            let _ = writeln!(text, "{head}");
            stack.frames.clone().for_each(|n| text += &format!("i {}\n", self.file(n)));
        }
        text
    }

    fn provenance(&self, results: &Results<'_>) -> Provenance {
        Provenance {
            plan_hash: String::new(),
            seed: self.seed(),
            version: facts::VERSION.to_owned(),
            camera: results.prefix.clone(),
            frame: 0,
            time_s: 0.0,
            geometry: "even light on the bare sensor, pixel centres at +0.5, x right, y down".to_owned(),
            camera_to_world: None,
            further: BTreeMap::new(),
        }
    }

    fn sidecar(&self, light: FlatLight) -> Value {
        json!({
            "program": "etendue",
            "version": facts::VERSION,
            "seed": self.seed(),
            "light": {
                "wavelength_nm": light.wavelength_nm,
                "irradiance_w_m2": light.irradiance_w_m2,
                "convention": "even light of one wavelength on the bare sensor, along its normal; photons on the whole square of a pixel",
            },
            "sensor": facts::sensor(self.body),
        })
    }
}
