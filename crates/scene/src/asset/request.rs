//! Which files a description names.

use std::path::PathBuf;

use crate::load::Description;
use crate::place::{Place, Placed};
use crate::record::light::{Emission, Level, LightColour};
use crate::record::reflectance::Reflectance;
use crate::record::sensor::QuantumEfficiency;
use crate::record::{Camera, Curve, Environment, Light, Material, Surface};

/// A file to be read, and where it is named.
#[derive(Clone, Debug, PartialEq)]
pub struct AssetRequest {
    /// The file, relative to where the job is read from: the key in [`super::Assets`].
    pub path: PathBuf,
    /// What it is read as.
    pub kind: AssetKind,
    /// Where it is named.
    pub place: Place,
}

/// What a file is read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AssetKind {
    /// [`super::MeshAsset`].
    Mesh,
    /// [`super::ImageAsset`].
    Image,
    /// [`super::SpectrumAsset`] of such values.
    Spectrum(Values),
    /// [`super::PhotometryAsset`].
    Photometry,
    /// [`super::ComplexIndexAsset`].
    ComplexIndex,
    /// [`super::RetroTableAsset`].
    RetroTable,
}

/// What the values of a tabulated spectrum can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// A share of light or of photons, 0 … 1.
    Share,
    /// Light, 0 or more.
    Light,
}

impl Values {
    /// Whether a value is one of these.
    #[must_use]
    pub fn admit(self, value: f64) -> bool {
        match self {
            Self::Share => (0.0..=1.0).contains(&value),
            Self::Light => value >= 0.0,
        }
    }

    /// What they are, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Share => "a share between 0 and 1",
            Self::Light => "0 or more",
        }
    }
}

/// Every file that is named, each once.
pub(crate) fn requests(description: &Description) -> Vec<AssetRequest> {
    let mut list = List::default();
    let scene = &description.scene;
    scene.meshes.iter().for_each(|m| list.add(AssetKind::Mesh, &m.file));
    scene.textures.iter().for_each(|t| list.add(AssetKind::Image, &t.file));
    scene.materials.iter().for_each(|m| list.material(m));
    scene.lights.iter().for_each(|Light::Sun(sun)| list.colour(&sun.colour));
    scene.environment.iter().for_each(|e| list.environment(e));
    description.cameras.iter().for_each(|c| list.camera(&c.camera));
    list.0
}

/// Every file that a camera names, each once.
#[must_use]
pub fn of_camera(camera: &Camera) -> Vec<AssetRequest> {
    let mut list = List::default();
    list.camera(camera);
    list.0
}

#[derive(Default)]
struct List(Vec<AssetRequest>);

impl List {
    fn add(&mut self, kind: AssetKind, path: &Placed<PathBuf>) {
        if !self.0.iter().any(|r| r.kind == kind && r.path == path.value) {
            self.0.push(AssetRequest { path: path.value.clone(), kind, place: path.place.clone() });
        }
    }

    fn material(&mut self, material: &Material) {
        match &material.surface {
            Surface::Diffuse(d) => self.reflectance(&d.reflectance),
            Surface::Coated(c) => self.reflectance(&c.reflectance),
            Surface::Conductor(_) | Surface::Emitter(_) => {}
        }
        material.emission.iter().for_each(|e| self.emission(&e.light));
    }

    fn reflectance(&mut self, reflectance: &Reflectance) {
        if let Reflectance::Spectrum(file) = reflectance {
            self.add(AssetKind::Spectrum(Values::Share), file);
        }
    }

    fn emission(&mut self, emission: &Emission) {
        if let Level::Radiance(curve) = &emission.level {
            self.curve(curve, Values::Light);
        }
        emission.colour.iter().for_each(|c| self.colour(c));
    }

    fn colour(&mut self, colour: &LightColour) {
        if let LightColour::Spectrum(file) = colour {
            self.add(AssetKind::Spectrum(Values::Light), file);
        }
    }

    fn curve(&mut self, curve: &Curve, values: Values) {
        if let Curve::File(file) = curve {
            self.add(AssetKind::Spectrum(values), file);
        }
    }

    fn environment(&mut self, environment: &Environment) {
        match environment {
            Environment::Uniform(emission) => self.emission(emission),
            Environment::Image(image) => self.add(AssetKind::Image, &image.file),
        }
    }

    fn camera(&mut self, camera: &Camera) {
        match camera.sensor.electronics.as_ref().map(|e| &e.quantum_efficiency) {
            Some(QuantumEfficiency::Same(curve)) => self.curve(curve, Values::Share),
            Some(QuantumEfficiency::PerChannel(curves)) => curves.iter().for_each(|c| self.curve(c, Values::Share)),
            Some(QuantumEfficiency::Measured { .. }) | None => {}
        }
    }
}
