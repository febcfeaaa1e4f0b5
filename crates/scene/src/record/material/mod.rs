//! `[[materials]]`: optical properties of surfaces.

pub mod factor;
pub mod glass;
pub mod glow;
pub mod mix;
pub mod road;
pub mod surface;
pub mod wet;

pub use factor::{Channel, Factor, Green, NormalMap};
pub use glass::{Absorption, Dielectric, Leaf, ThinSheet};
pub use glow::{Sides, SurfaceEmission};
pub use mix::Mix;
pub use road::{
    MarkingClass, MarkingDay, MarkingNight, RoadMarking, Sheeting, SheetingClass, SheetingColour, SheetingTable,
};
pub use surface::*;
pub use wet::{Puddles, WetGround};

use crate::asset::file_list::{FileList, NamesFiles};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::preset;
use crate::reader::{Form, Reader, Record, record, text};
use crate::written::Table;
use factor::any_factor;
use serde_json::json;

record! {
    /// Optical properties of a surface.
    pub struct Material check(check) {
        /// Name.
        required name: Placed<String> = text("the name of the material");
        /// Scattering model.
        inside surface: SurfaceSource;
        /// Emission.
        optional emission: SurfaceEmission = record();
        /// Fraction of the surface present. Default: 1.
        optional opacity: Factor = any_factor();
        /// Normal map.
        optional normal_map: NormalMap = record();
    }
}

impl NamesFiles for Material {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, name: _, surface: SurfaceSource(surface), emission, opacity: _, normal_map: _ } = self;
        surface.name_files(files);
        emission.name_files(files);
    }
}

/// Scattering model, given by its type or by a preset. Presets are expanded before records are read, so that a type is always given here.
#[derive(Clone, Debug)]
pub struct SurfaceSource(pub Surface);

impl Record for SurfaceSource {
    fn read_keys(reader: &mut Reader<'_>, errors: &mut DescriptionErrors) -> Option<Self> {
        Surface::read_keys(reader, errors).map(Self)
    }

    fn forms() -> Vec<Form> {
        let models = Surface::forms();
        let description = "A preset of the list below; keys of its type replace its own.";
        let mut preset = Form::only_with("preset", description, json!({ "enum": preset::names() }));
        for key in models.iter().flat_map(|form| &form.keys).filter(|key| key.name != "type") {
            preset = preset.or_with(key);
        }
        [vec![preset], models].concat()
    }

    fn write_keys(&self, table: &mut Table) {
        self.0.write_keys(table);
    }
}

impl From<Surface> for SurfaceSource {
    fn from(surface: Surface) -> Self {
        Self(surface)
    }
}

fn check(material: &Material, errors: &mut DescriptionErrors) {
    if matches!(material.surface.0, Surface::Emitter(_)) && material.emission.is_none() {
        errors.add(
            ErrorCode::MissingKey,
            &material.place,
            "an \"emitter\" without \"emission\" is black",
            "add \"emission\", or make it \"diffuse\" with reflectance 0",
        );
    }
    let bent = matches!(material.surface.0, Surface::Emitter(_) | Surface::Mix(_));
    if let (Some(map), true) = (&material.normal_map, bent) {
        let problem = "\"normal_map\" has no effect on a surface that does not reflect by itself";
        errors.add(ErrorCode::NoEffect, &map.place, problem, "remove it; of a mix, give it to the parts");
    }
}
