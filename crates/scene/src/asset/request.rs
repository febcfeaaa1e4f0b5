//! Which files a description names.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::CalibrationChoice;
use crate::load::Description;
use crate::place::{Place, Placed};
use crate::record::front::mirror::{Finish, MirrorShape};
use crate::record::lens::calibrated::View;
use crate::record::lens::prescription::{IrCutCurve, Source};
use crate::record::light::{Emission, Level, LightColour};
use crate::record::material::{Absorption, Interface, LobeStrength, Metal, Sheeting, SheetingTable};
use crate::record::reflectance::{Colour, Reflectance};
use crate::record::sensor::QuantumEfficiency;
use crate::record::{
    Body, Camera, Curve, Environment, Front, Lens, Light, Material, Object, Processing, Scene, Surface,
};

/// A file to be read, and where it is named.
#[derive(Clone, Debug, PartialEq)]
pub struct AssetRequest {
    /// The file, relative to where the job is read from: the key in [`super::Assets`].
    pub path: PathBuf,
    /// What it is read as.
    pub kind: AssetKind,
    /// Where it is named.
    pub place: Place,
    /// Of a mesh: which of its own materials nobody sees.
    pub covered: Covered,
}

/// Materials that a mesh's file gives its slots and that nobody sees, because the scene gives those slots others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Covered {
    /// All of them.
    All,
    /// Those of these names.
    Slots(BTreeSet<String>),
}

impl Covered {
    const NONE: Self = Self::Slots(BTreeSet::new());

    /// Whether the material of a slot is covered.
    #[must_use]
    pub fn has(&self, slot: &str) -> bool {
        match self {
            Self::All => true,
            Self::Slots(slots) => slots.contains(slot),
        }
    }

    /// What one object covers.
    fn by(object: &Object) -> Self {
        match &object.material {
            Some(_) => Self::All,
            None => Self::Slots(object.materials.iter().map(|(slot, _)| slot.value.clone()).collect()),
        }
    }

    /// What both cover.
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::All, covered) | (covered, Self::All) => covered,
            (Self::Slots(a), Self::Slots(b)) => Self::Slots(a.intersection(&b).cloned().collect()),
        }
    }
}

/// What a file is read as.
#[derive(Clone, Debug, PartialEq, Eq)]
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
    /// [`super::NumbersAsset`].
    Numbers,
    /// [`super::PrescriptionAsset`].
    Prescription,
    /// [`super::CalibrationAsset`] of this camera.
    Calibration(CalibrationChoice),
}

/// What the values of a tabulated spectrum can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// A share of light or of photons, 0 … 1.
    Share,
    /// Light, or a coefficient of absorption, 0 or more.
    Light,
    /// A refractive index, 1 … 4.
    Index,
}

impl Values {
    /// Whether a value is one of these.
    #[must_use]
    pub fn admit(self, value: f64) -> bool {
        match self {
            Self::Share => (0.0..=1.0).contains(&value),
            Self::Light => value >= 0.0,
            Self::Index => (1.0..=4.0).contains(&value),
        }
    }

    /// What they are, in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Share => "a share between 0 and 1",
            Self::Light => "0 or more",
            Self::Index => "a refractive index from 1 to 4",
        }
    }
}

/// Every file that is named, each once.
pub(crate) fn requests(description: &Description) -> Vec<AssetRequest> {
    let mut list = List::default();
    let scene = &description.scene;
    let unused = &description.unused;
    let covered = covered(scene);
    for mesh in scene.meshes.iter().filter(|m| !unused.meshes.contains(&m.name.value)) {
        let covered = covered.get(mesh.name.as_str()).cloned().unwrap_or(Covered::All);
        list.mesh(&mesh.file, covered);
    }
    let textures = scene.textures.iter().filter(|t| !unused.textures.contains(&t.name.value));
    textures.for_each(|t| list.add(AssetKind::Image, &t.file));
    scene.materials.iter().filter(|m| !unused.materials.contains(&m.name.value)).for_each(|m| list.material(m));
    scene.lights.iter().for_each(|l| list.light(l));
    scene.environment.iter().for_each(|e| list.environment(e));
    description.cameras.iter().for_each(|c| list.camera(&c.camera));
    list.0
}

/// What all objects of a mesh cover of its own materials, by the mesh's name.
fn covered(scene: &Scene) -> BTreeMap<&str, Covered> {
    let mut covered: BTreeMap<&str, Covered> = BTreeMap::new();
    for object in &scene.objects {
        if let Body::Mesh(name) = &object.body {
            let before = covered.remove(name.as_str()).unwrap_or(Covered::All);
            covered.insert(name, before.and(Covered::by(object)));
        }
    }
    covered
}

/// Every file that a camera names, each once.
#[must_use]
pub fn of_camera(camera: &Camera) -> Vec<AssetRequest> {
    let mut list = List::default();
    list.camera(camera);
    list.0
}

/// Whether a material names files itself.
pub(crate) fn names_files(material: &Material) -> bool {
    let mut list = List::default();
    list.material(material);
    !list.0.is_empty()
}

#[derive(Default)]
struct List(Vec<AssetRequest>);

impl List {
    fn add(&mut self, kind: AssetKind, path: &Placed<PathBuf>) {
        if !self.0.iter().any(|r| r.kind == kind && r.path == path.value) {
            let (path, place) = (path.value.clone(), path.place.clone());
            self.0.push(AssetRequest { path, kind, place, covered: Covered::NONE });
        }
    }

    /// A mesh; of a file that several meshes name, what all cover.
    fn mesh(&mut self, path: &Placed<PathBuf>, covered: Covered) {
        let known = self.0.iter_mut().find(|r| r.kind == AssetKind::Mesh && r.path == path.value);
        if let Some(known) = known {
            known.covered = std::mem::replace(&mut known.covered, Covered::All).and(covered);
            return;
        }
        let (path, place) = (path.value.clone(), path.place.clone());
        self.0.push(AssetRequest { path, kind: AssetKind::Mesh, place, covered });
    }

    fn material(&mut self, material: &Material) {
        match &material.surface.0 {
            Surface::Diffuse(d) => self.reflectance(&d.reflectance),
            Surface::Coated(c) => self.reflectance(&c.reflectance),
            Surface::Conductor(c) => self.metal(&c.metal),
            Surface::BlinnPhong(b) => {
                self.reflectance(&b.reflectance);
                self.share(&b.specular);
            }
            Surface::Lafortune(l) => {
                self.reflectance(&l.reflectance);
                l.lobes.iter().for_each(|lobe| self.lobe(&lobe.strength));
            }
            Surface::CarPaint(p) => {
                self.reflectance(&p.reflectance);
                self.metal(&p.metal);
                p.flake_tint.iter().for_each(|tint| self.share(tint));
            }
            Surface::Cloth(c) => {
                self.reflectance(&c.reflectance);
                c.sheen.iter().for_each(|sheen| self.share(sheen));
            }
            Surface::CookTorrance(c) => self.interface(&c.interface),
            Surface::Sheeting(s) => self.sheeting(s),
            Surface::RoadMarking(m) => m.colour.iter().for_each(|c| self.share(c)),
            Surface::Dielectric(d) => self.absorption(d.absorption.as_ref()),
            Surface::ThinSheet(s) => self.absorption(s.absorption.as_ref()),
            Surface::Leaf(l) => [&l.reflectance, &l.transmittance].into_iter().for_each(|r| self.reflectance(r)),
            Surface::Mix(_) | Surface::Emitter(_) => {}
        }
        material.emission.iter().for_each(|e| self.emission(&e.light));
    }

    fn lobe(&mut self, strength: &LobeStrength) {
        match strength {
            LobeStrength::Albedo(colour) => self.share(colour),
            LobeStrength::Weight(curve) => self.curve(curve, Values::Light),
        }
    }

    fn interface(&mut self, interface: &Interface) {
        match interface {
            Interface::Named(_) => {}
            Interface::File(file) => self.add(AssetKind::ComplexIndex, file),
            Interface::Index(curve) => self.curve(curve, Values::Index),
        }
    }

    fn sheeting(&mut self, sheeting: &Sheeting) {
        if let SheetingTable::File(file) = &sheeting.table {
            self.add(AssetKind::RetroTable, file);
        }
        sheeting.reflectance.iter().chain(&sheeting.retro_colour).for_each(|c| self.share(c));
        sheeting.print.iter().for_each(|print| self.reflectance(print));
    }

    fn metal(&mut self, metal: &Metal) {
        if let Metal::File(file) = metal {
            self.add(AssetKind::ComplexIndex, file);
        }
    }

    fn absorption(&mut self, absorption: Option<&Absorption>) {
        match absorption {
            Some(Absorption::Coefficient(curve)) => self.curve(curve, Values::Light),
            Some(Absorption::Transmittance(share)) => self.share(share),
            None => {}
        }
    }

    fn reflectance(&mut self, reflectance: &Reflectance) {
        if let Reflectance::Plain(colour) = reflectance {
            self.share(colour);
        }
    }

    fn share(&mut self, colour: &Colour) {
        if let Colour::Spectrum(file) = colour {
            self.add(AssetKind::Spectrum(Values::Share), file);
        }
    }

    fn light(&mut self, light: &Light) {
        let mask = match light {
            Light::Sun(_) => None,
            Light::Point(lamp) => lamp.mask.as_ref(),
            Light::Spot(lamp) => lamp.mask.as_ref(),
            Light::Measured(lamp) => lamp.mask.as_ref(),
            Light::HeadLamp(lamp) => lamp.mask.as_ref(),
        };
        mask.into_iter().for_each(|mask| self.add(AssetKind::Image, &mask.file));
        if let Light::Measured(lamp) = light {
            self.add(AssetKind::Photometry, &lamp.file);
        }
        light.colour().into_iter().for_each(|colour| self.colour(colour));
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
            Environment::Sky(_) => {}
        }
    }

    fn lens(&mut self, lens: &Lens) {
        match lens {
            Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) | Lens::Telecentric(_) => {}
            Lens::Prescription(lens) => {
                if let Source::File(file) = &lens.source {
                    self.add(AssetKind::Prescription, file);
                }
                if let Some(IrCutCurve::Spectrum(file)) = lens.ir_cut.as_ref().map(|filter| &filter.normal) {
                    self.add(AssetKind::Spectrum(Values::Share), file);
                }
            }
            Lens::Calibrated(lens) => {
                if let View::Calibration(calibration) = &lens.view {
                    self.add(AssetKind::Calibration(calibration.choice()), &calibration.file);
                }
            }
        }
    }

    fn front(&mut self, front: &Front) {
        if let Some(glass) = &front.windscreen {
            glass.layers.iter().flatten().for_each(|layer| self.curve(&layer.index, Values::Index));
            glass.internal_transmittance.iter().for_each(|colour| self.share(colour));
        }
        front.dirt.iter().for_each(|dirt| self.add(AssetKind::Image, &dirt.mask));
        if let Some(mirror) = &front.mirror {
            if let MirrorShape::Mesh(mesh) = &mirror.shape {
                self.mesh(&mesh.file, Covered::All);
            }
            match &mirror.finish {
                Finish::Share(colour) => self.share(colour),
                Finish::File(file) => self.add(AssetKind::ComplexIndex, file),
                Finish::Named(_) => {}
            }
        }
    }

    fn camera(&mut self, camera: &Camera) {
        self.lens(&camera.lens);
        camera.external_optics.iter().for_each(|front| self.front(front));
        let psf = camera.effects.as_ref().and_then(|effects| effects.psf.as_ref());
        psf.and_then(|psf| psf.image.as_ref()).into_iter().for_each(|image| self.add(AssetKind::Image, image));
        camera.isp.iter().flat_map(Processing::files).for_each(|file| self.add(AssetKind::Numbers, file));
        match camera.sensor.electronics.as_ref().map(|e| &e.quantum_efficiency) {
            Some(QuantumEfficiency::Same(curve)) => self.curve(curve, Values::Share),
            Some(QuantumEfficiency::PerChannel(curves)) => curves.iter().for_each(|c| self.curve(c, Values::Share)),
            Some(QuantumEfficiency::Named(list)) => list.iter().for_each(|(_, c)| self.curve(c, Values::Share)),
            Some(QuantumEfficiency::Measured { .. }) | None => {}
        }
    }
}
