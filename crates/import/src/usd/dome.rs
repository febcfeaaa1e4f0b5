//! Environment light: UsdLux's DomeLight.

use std::path::Path;

use etendue_scene::record::{Emission, Environment, Level, LightColour};
use glam::{DMat3, DVec3};

use super::access::{asset, text};
use super::importer::{Importer, TraversalState};
use crate::scenery::{LightImage, LightUnit, grey, is_upright, linear_pixels};
use crate::syntax::usd::{UsdAxis, UsdFile, UsdPrim};

/// Rotation from the space of a dome, with its top at +y, to that of our images: the middle of its image is seen along +z, the quarter to the left along +x
/// (OpenEXR's convention).
fn image_axes() -> DMat3 {
    DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X)
}

impl<'a> Importer<'a> {
    pub(super) fn dome(
        &mut self,
        prim: &'a UsdPrim,
        state: &TraversalState<'a>,
        unit: LightUnit,
    ) -> Result<(), String> {
        let environment = match asset(prim, "inputs:texture:file") {
            None => {
                self.scenery.report.note(format!("{}: {} cd/m²", prim.kind, unit.luminance));
                let emission = Emission::new(Level::Luminance(unit.luminance.into()));
                Some(Environment::Uniform(Emission { colour: Some(unit.colour), ..emission }))
            }
            Some(_) => self.dome_image(prim, state, &unit)?,
        };
        if let Some(environment) = environment
            && self.scenery.scene.environment.replace(environment).is_some()
        {
            self.scenery.report.note("of several dome lights only the last is used");
        }
        Ok(())
    }

    /// `None`, with a note, for an unused image.
    fn dome_image(
        &mut self,
        prim: &'a UsdPrim,
        state: &TraversalState<'a>,
        unit: &LightUnit,
    ) -> Result<Option<Environment>, String> {
        let Some(stated) = asset(prim, "inputs:texture:file") else { return Ok(None) };
        let shown = stated.stated.as_str();
        if !matches!(text(prim, "inputs:texture:format"), "" | "automatic" | "latlong") {
            self.scenery.report.note(format!("the environment map `{shown}` is left out: expected latlong"));
            return Ok(None);
        }
        if stated.file.is_none() {
            self.scenery.report.note(format!("the environment map `{shown}` does not exist: it emits no light"));
            return Ok(None);
        }
        if let LightColour::Rgb(rgb) = &unit.colour
            && grey(rgb.value).is_none()
        {
            self.scenery.report.note("the colour of a dome light with a texture becomes white of the same luminance");
        }
        let image = self.image(stated)?;
        let Some(pixel) = linear_pixels(&image).filter(|_| is_linear(shown)) else {
            let message = format!("the environment map `{shown}` is left out: expected linear values (EXR, HDR)");
            self.scenery.report.note(message);
            return Ok(None);
        };
        let pole = match text(prim, "poleAxis") {
            "Z" => UsdAxis::Z,
            "scene" if prim.kind == "DomeLight_1" => self.stage.up,
            "" if prim.kind == "DomeLight_1" => self.stage.up,
            _ => UsdAxis::Y,
        };
        // A pole along z is a rotation by 90° about x.
        let pole_axes =
            if pole == UsdAxis::Z { DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y) } else { DMat3::IDENTITY };
        let axes = state.to_world.matrix3;
        let own = DMat3::from_cols(
            axes.x_axis.normalize_or_zero(),
            axes.y_axis.normalize_or_zero(),
            axes.z_axis.normalize_or_zero(),
        );
        let turn = self.scenery.to_ours * own * pole_axes * image_axes().transpose();
        // A resampled image need not also be written next to the scene.
        let path = match (&stated.file, is_upright(&turn)) {
            (Some(UsdFile::Packed(..)), false) => String::new(),
            _ => self.file(stated)?,
        };
        let picture = LightImage { shown, path: &path, columns: image.width as usize, pixel: &*pixel };
        self.scenery.light_image(&picture, image.height as usize, turn, unit.luminance).map(Some)
    }
}

/// Returns true for file extensions of linear images: those of 16 bits are encoded.
fn is_linear(name: &str) -> bool {
    let ending = Path::new(name).extension().unwrap_or_default().to_ascii_lowercase();
    ending == "exr" || ending == "hdr"
}
