//! Conversion of prims to a scene.

use std::{collections::HashMap, path::Path, rc::Rc};

use glam::{DAffine3, DMat3, DVec3};

use super::access::{Paths, text};
use super::binding::{Bindings, BoundMaterial, binds_collections, bound};
use super::transform::transform_of;
use crate::scenery::{KnownTexture, SceneBuilder};
use crate::substitutes::{even_sky, whole_view};
use crate::syntax::usd::{UsdAxis, UsdPrim, UsdStage};
use crate::written::{ImportFiles, ImportedCamera, import_files};

/// Maximum visited prims, counting those of each instance.
const MAX_VISITS: usize = 1_000_000;

/// Scene under construction.
pub(super) struct Importer<'a> {
    pub(super) scenery: SceneBuilder,
    pub(super) stage: &'a UsdStage,
    pub(super) paths: Paths<'a>,
    /// Transform from the stage's space to metres.
    root: DAffine3,
    /// Converted materials, by path.
    pub(super) materials: HashMap<String, BoundMaterial>,
    /// Texture transforms of those images of the current material that are black outside u, v = 0 … 1.
    pub(super) black_outside: Vec<[[f64; 2]; 2]>,
    /// Converted images, by all their parameters.
    pub(super) textures: HashMap<String, KnownTexture>,
    /// Names of the files written from a package, by their names in the package.
    pub(super) unpacked: HashMap<String, String>,
    pub(super) cameras: Vec<ImportedCamera>,
    /// Bounding box of all shapes, in the world of the written scene.
    low: DVec3,
    high: DVec3,
    /// True if a surface or light emits.
    pub(super) shines: bool,
    visits: usize,
}

/// State inherited by a prim.
#[derive(Clone)]
pub(super) struct TraversalState<'a> {
    pub(super) to_world: DAffine3,
    is_visible: bool,
    purpose: &'a str,
    /// Material bindings.
    pub(super) bindings: Bindings<'a>,
    /// Number of enclosing instancers.
    pub(super) depth: usize,
}

impl TraversalState<'_> {
    /// Returns true if the prim is visible and its purpose is rendering.
    pub(super) fn is_drawn(&self) -> bool {
        self.is_visible && matches!(self.purpose, "" | "default" | "render")
    }
}

impl<'a> Importer<'a> {
    pub(super) fn new(file: &Path, folder: &Path, stage: &'a UsdStage) -> Self {
        let mut scenery = SceneBuilder::new(file, folder);
        scenery.to_ours = match stage.up {
            UsdAxis::Y => DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X),
            UsdAxis::Z => DMat3::IDENTITY,
        };
        Self {
            scenery,
            stage,
            paths: Paths::new(&stage.roots),
            root: DAffine3::from_scale(DVec3::splat(stage.metres_per_unit)),
            materials: HashMap::new(),
            black_outside: Vec::new(),
            textures: HashMap::new(),
            unpacked: HashMap::new(),
            cameras: Vec::new(),
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
            shines: false,
            visits: 0,
        }
    }

    /// Converts all prims.
    pub(super) fn read(&mut self) -> Result<(), String> {
        let metres = self.stage.metres_per_unit;
        let by = if self.stage.says_metres { "as stated" } else { "the default, as it is not stated" };
        let up = if self.stage.up == UsdAxis::Y { "y" } else { "z" };
        self.scenery.report.note(format!("one unit is {metres} m ({by}); {up} is up"));
        self.stage.notes.iter().for_each(|note| self.scenery.report.note(note.as_str()));
        let bindings = Bindings::default();
        let state = TraversalState { to_world: self.root, is_visible: true, purpose: "", bindings, depth: 0 };
        for prim in &self.stage.roots {
            self.prim(prim, &state)?;
        }
        self.scenery.report.at(String::new());
        Ok(())
    }

    /// Files of the scene.
    pub(super) fn finish(mut self, file: &Path) -> Result<ImportFiles, String> {
        self.read()?;
        let SceneBuilder { scene, report, .. } = &mut self.scenery;
        if scene.lights.is_empty() && scene.environment.is_none() && !self.shines {
            let message = even_sky(scene);
            report.note(message);
        }
        if self.cameras.is_empty() {
            report.note("it has no cameras: \"view\" is added, which shows the whole scene from the front");
            let is_empty = self.low.x > self.high.x;
            let [low, high] = if is_empty { [DVec3::ZERO; 2] } else { [self.low, self.high] };
            self.cameras.push(whole_view(low, high));
        }
        let counts = [scene.objects.len(), scene.materials.len(), scene.textures.len(), scene.lights.len()];
        let [objects, materials, textures, lights] = counts;
        report.note(format!("written: objects {objects}, materials {materials}, textures {textures}, lights {lights}"));
        let mut result = import_files(file, &self.scenery.scene, &self.cameras, self.scenery.report.lines());
        result.files.extend(self.scenery.files);
        Ok(result)
    }

    /// Converts a prim and all its descendants.
    pub(super) fn prim(&mut self, prim: &'a UsdPrim, about: &TraversalState<'a>) -> Result<(), String> {
        self.visits += 1;
        if self.visits > MAX_VISITS {
            return Err(format!("it has more than {MAX_VISITS} prims, counting each instance; use fewer instances"));
        }
        self.scenery.report.at(prim.path.clone());
        let (own, is_reset) = transform_of(prim)?;
        let mut state = about.clone();
        state.to_world = if is_reset { self.root } else { about.to_world } * own;
        state.is_visible &= text(prim, "visibility") != "invisible";
        let purpose = text(prim, "purpose");
        if !purpose.is_empty() {
            state.purpose = purpose;
        }
        state.bindings = self.bindings(prim, &about.bindings);
        match prim.kind.as_str() {
            "PointInstancer" => return self.instancer(prim, &state),
            // Converted with the prims that refer to them.
            "Material" | "Shader" | "NodeGraph" | "GeomSubset" => return Ok(()),
            "Camera" => self.camera(prim, &state)?,
            "" | "Xform" | "Scope" | "SkelRoot" => {}
            _ if !state.is_drawn() => self.note_undrawn(prim),
            kind if kind.ends_with("Light") || kind == "DomeLight_1" => self.light(prim, &state)?,
            _ => self.shape(prim, &state)?,
        }
        self.note_unused(prim);
        prim.children.iter().try_for_each(|child| self.prim(child, &state))
    }

    /// Material bindings of a prim, with those inherited from its parent.
    pub(super) fn bindings(&mut self, prim: &'a UsdPrim, about: &Bindings<'a>) -> Bindings<'a> {
        if binds_collections(prim) {
            self.scenery.report.note("material bindings of collections are not used");
        }
        let paths = &self.paths;
        let is_material = |path: &str| paths.prim(path).is_some_and(|prim| prim.kind == "Material");
        for path in bound(prim).filter(|path| !is_material(path)) {
            self.scenery.report.note(format!("the material <{path}> does not exist: its bindings are ignored"));
        }
        about.within(prim, is_material)
    }

    /// Notes that a prim is not drawn.
    pub(super) fn note_undrawn(&mut self, prim: &UsdPrim) {
        super::access::mark_used(prim);
        let message = "prims that are invisible, or have a purpose other than rendering (guide, proxy), are left out";
        self.scenery.report.note(message);
    }

    /// Name of a shape.
    pub(super) fn name(prim: &UsdPrim) -> Rc<str> {
        prim.name().into()
    }

    /// Extends the bounding box to a position in metres in the axes of the file.
    pub(super) fn extend_bounds(&mut self, place: DVec3) {
        let ours = self.scenery.to_ours * place;
        (self.low, self.high) = (self.low.min(ours), self.high.max(ours));
    }

    /// Reports attributes and relationships that are not used, and attributes that are animated.
    pub(super) fn note_unused(&mut self, prim: &UsdPrim) {
        let time = self.stage.start_time;
        self.scenery.report.at(prim.path.clone());
        let kind = if prim.kind.is_empty() { "prim" } else { &prim.kind };
        for (name, attribute) in prim.attributes.iter().filter(|(_, attribute)| attribute.value.is_some()) {
            if !attribute.used.get() {
                if !is_aside(name) {
                    self.scenery.report.note(format!("{kind}: \"{name}\" is not used"));
                }
            } else if attribute.varies {
                self.scenery
                    .report
                    .note(format!("{kind}: \"{name}\" is animated: its value at time code {time} is used"));
            }
        }
        for (name, relation) in prim.relations.iter().filter(|(_, relation)| !relation.targets.is_empty()) {
            if !relation.used.get() && !is_aside(name) {
                self.scenery.report.note(format!("{kind}: the relationship \"{name}\" is not used"));
            }
        }
    }
}

/// Returns true for attributes and relationships that need no report: they do not affect an image, or other code evaluates them.
fn is_aside(name: &str) -> bool {
    matches!(name, "extent" | "doubleSided" | "extentsHint" | "visibility" | "purpose" | "xformOpOrder")
        || matches!(name, "proxyPrim" | "familyName")
        || [
            "ui:",
            "userProperties:",
            "outputs:",
            "xformOp:",
            "collection:",
            "primvars:displayColor",
            "primvars:displayOpacity",
        ]
        .iter()
        .any(|start| name.starts_with(start))
}
