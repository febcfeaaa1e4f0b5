//! Interpreter of directives: the graphics state, and the objects of the scene.

use std::{collections::HashMap, path::Path, rc::Rc};

use etendue_core::maths::f64 as maths;
use glam::{DAffine3, DMat3, DMat4, DVec3};

use super::attributes::Attributes;
use super::camera::{PbrtCamera, PbrtFilm};
use super::parameters::Parameters;
use crate::scenery::{Graphics, SceneBuilder};
use crate::syntax::pbrt::{PbrtDirective, PbrtParameter, PbrtPlace};
use crate::written::{ImportFiles, import_files};

/// Maximum depth of nested blocks and of shapes of instances.
const MAX_DEPTH: usize = 1 << 10;

/// Shape of an object that is instanced later.
#[derive(Clone)]
struct StoredShape {
    kind: String,
    parameters: Rc<Vec<PbrtParameter>>,
    graphics: Graphics,
}

/// State before a block.
struct Block {
    /// True for an attribute block, false for a transform block.
    is_attribute: bool,
    graphics: Graphics,
    attributes: Attributes,
}

pub(super) struct Interpreter {
    scenery: SceneBuilder,
    graphics: Graphics,
    /// Default parameters of the directives that follow.
    attributes: Attributes,
    blocks: Vec<Block>,
    systems: HashMap<String, DAffine3>,
    camera: Option<PbrtCamera>,
    film: PbrtFilm,
    in_world: bool,
    /// True while transforms apply to the start of the exposure.
    at_start: bool,
    objects: HashMap<String, Vec<StoredShape>>,
    open_object: Option<String>,
}

impl Interpreter {
    pub(super) fn new(file: &Path, folder: &Path) -> Self {
        Self {
            scenery: SceneBuilder::new(file, folder),
            graphics: Graphics::plain(),
            attributes: Attributes::default(),
            blocks: Vec::new(),
            systems: HashMap::new(),
            camera: None,
            film: PbrtFilm::default(),
            in_world: false,
            at_start: true,
            objects: HashMap::new(),
            open_object: None,
        }
    }

    pub(super) fn take(&mut self, directive: PbrtDirective, place: PbrtPlace<'_>) -> Result<(), String> {
        let file = place.file.file_name().unwrap_or_default().to_string_lossy();
        self.scenery.report.at(format!("{file}:{}", place.line));
        match directive {
            PbrtDirective::Plain(name) => self.plain(name),
            PbrtDirective::Numbers(name, numbers) => self.transform(name, &numbers),
            PbrtDirective::Named(name, word) => self.named(name, word),
            PbrtDirective::MediumInterface([inside, outside]) => {
                (self.graphics.inside, self.graphics.outside) = (inside.into(), outside.into());
                Ok(())
            }
            PbrtDirective::Typed(name, kind, parameters) => self.typed(name, kind, parameters),
            PbrtDirective::Texture([name, values, kind], parameters) => {
                let parameters = self.attributes.extend("texture", parameters);
                self.scenery.texture(&name, &values, &kind, Parameters(&parameters), &self.graphics)
            }
            PbrtDirective::Setting(option) => {
                self.scenery.report.note(format!("`Option \"{}\"` is not used", option.name));
                Ok(())
            }
            PbrtDirective::Include(name) => {
                self.scenery.report.note(format!("an included file does not exist: `{name}` is used"));
                Ok(())
            }
        }
    }

    fn plain(&mut self, name: &str) -> Result<(), String> {
        match name {
            "WorldBegin" => self.begin_world()?,
            "Identity" => self.set(DAffine3::IDENTITY),
            "ReverseOrientation" => self.graphics.reverse_orientation = !self.graphics.reverse_orientation,
            "AttributeBegin" | "TransformBegin" => {
                if self.blocks.len() >= MAX_DEPTH {
                    return Err(format!("blocks are nested more than {MAX_DEPTH} levels deep"));
                }
                self.blocks.push(Block {
                    is_attribute: name == "AttributeBegin",
                    graphics: self.graphics.clone(),
                    attributes: self.attributes.clone(),
                });
            }
            "AttributeEnd" | "TransformEnd" => match self.blocks.pop() {
                Some(before) if before.is_attribute && name == "AttributeEnd" => {
                    (self.graphics, self.attributes) = (before.graphics, before.attributes);
                }
                Some(before) if !before.is_attribute && name == "TransformEnd" => {
                    self.graphics.to_world = before.graphics.to_world;
                }
                _ => return Err(format!("`{name}` has no matching begin; the file is damaged")),
            },
            "ObjectEnd" => {
                self.open_object.take().ok_or("`ObjectEnd` has no matching `ObjectBegin`; the file is damaged")?;
                return self.plain("AttributeEnd");
            }
            _ => {}
        }
        Ok(())
    }

    fn begin_world(&mut self) -> Result<(), String> {
        if std::mem::replace(&mut self.in_world, true) {
            return Err("duplicate `WorldBegin`; remove one".to_owned());
        }
        let camera = self.camera.get_or_insert_with(PbrtCamera::at_origin);
        self.scenery.to_ours = camera.to_ours();
        self.graphics.to_world = DAffine3::IDENTITY;
        self.systems.insert("world".to_owned(), DAffine3::IDENTITY);
        Ok(())
    }

    fn set(&mut self, to_world: DAffine3) {
        if self.at_start {
            self.graphics.to_world = to_world;
        } else {
            self.scenery
                .report
                .note("motion (`ActiveTransform`) is not used: everything is placed as at the start of the exposure");
        }
    }

    fn transform(&mut self, name: &str, numbers: &[f64]) -> Result<(), String> {
        let now = self.graphics.to_world;
        let next = match (name, numbers) {
            ("Translate", [x, y, z]) => now * DAffine3::from_translation(DVec3::new(*x, *y, *z)),
            ("Scale", [x, y, z]) => now * DAffine3::from_scale(DVec3::new(*x, *y, *z)),
            ("Rotate", [angle, x, y, z]) => now * DAffine3::from_mat3(rotation(*angle, DVec3::new(*x, *y, *z))?),
            ("LookAt", [ex, ey, ez, lx, ly, lz, ux, uy, uz]) => {
                let [eye, look, up] = [[*ex, *ey, *ez], [*lx, *ly, *lz], [*ux, *uy, *uz]].map(DVec3::from_array);
                now * look_at(eye, look, up)?.inverse()
            }
            ("Transform", numbers) => affine(numbers)?,
            ("ConcatTransform", numbers) => now * affine(numbers)?,
            _ => {
                self.scenery.report.note("motion (`TransformTimes`) is not used");
                return Ok(());
            }
        };
        if !next.is_finite() || next.matrix3.determinant() == 0.0 {
            return Err(format!("`{name}` makes the transform singular; correct its numbers"));
        }
        self.set(next);
        Ok(())
    }

    fn named(&mut self, name: &str, word: String) -> Result<(), String> {
        match name {
            "CoordinateSystem" => {
                self.systems.insert(word, self.graphics.to_world);
            }
            "CoordSysTransform" => match self.systems.get(&word) {
                Some(system) => self.set(*system),
                None => return Err(format!("the coordinate system \"{word}\" is not defined before this")),
            },
            "NamedMaterial" => self.graphics.material = self.scenery.named_material(&word),
            "ObjectBegin" => {
                self.plain("AttributeBegin")?;
                if self.open_object.is_some() {
                    return Err("objects cannot be nested".to_owned());
                }
                self.objects.insert(word.clone(), Vec::new());
                self.open_object = Some(word);
            }
            "ObjectInstance" => return self.instance(&word),
            "ActiveTransform" => self.at_start = word != "EndTime",
            "ColorSpace" if word != "srgb" => {
                self.scenery.report.note(format!("colours of \"{word}\" are read as sRGB"));
            }
            _ => {}
        }
        Ok(())
    }

    fn typed(&mut self, name: &'static str, kind: String, parameters: Vec<PbrtParameter>) -> Result<(), String> {
        let parameters = self.attributes.extend(name, parameters);
        let arguments = Parameters(&parameters);
        let message = |what: String| format!("{name} \"{kind}\": {what}");
        match name {
            "Camera" => {
                let camera = self.scenery.pbrt_camera(&kind, arguments, &self.graphics).map_err(message)?;
                self.systems.insert("camera".to_owned(), self.graphics.to_world.inverse());
                self.camera = Some(camera);
            }
            "Film" => {
                self.film = PbrtFilm::read(arguments).map_err(message)?;
                self.scenery
                    .report
                    .note(format!("of the film \"{kind}\" only the image size and the diagonal are used"));
            }
            "Sampler" | "Integrator" | "PixelFilter" | "Accelerator" => {
                self.scenery.report.note(format!("{name} \"{kind}\" is not used: the job has its own settings"));
            }
            "Attribute" => return self.attributes.add(&kind, parameters),
            "Material" => self.graphics.material = self.scenery.material(&kind, arguments, None).map_err(message)?,
            "MakeNamedMaterial" => {
                let surface_kind = arguments.text("type").map_err(message)?.unwrap_or("").to_owned();
                self.scenery.material(&surface_kind, arguments, Some(&kind)).map_err(message)?;
            }
            "MakeNamedMedium" => self.scenery.medium(&kind, arguments).map_err(message)?,
            "LightSource" => self.scenery.light_source(&kind, arguments, &self.graphics).map_err(message)?,
            "AreaLightSource" => {
                self.graphics.area_light = self.scenery.area_light(&kind, arguments).map_err(message)?.map(Rc::new);
            }
            _ => return self.shape(kind, parameters),
        }
        self.scenery.note_unused(&format!("{name} \"{kind}\""), arguments.unused());
        Ok(())
    }

    fn shape(&mut self, kind: String, parameters: Vec<PbrtParameter>) -> Result<(), String> {
        if !self.in_world {
            return Err("the shape is before `WorldBegin`".to_owned());
        }
        if let Some(object) = &self.open_object {
            let graphics = self.graphics.clone();
            let stored = StoredShape { kind, parameters: Rc::new(parameters), graphics };
            self.objects.entry(object.clone()).or_default().push(stored);
            return Ok(());
        }
        self.scenery.shape(&kind, Parameters(&parameters), &self.graphics)
    }

    fn instance(&mut self, word: &str) -> Result<(), String> {
        if self.open_object.is_some() {
            return Err("an object cannot contain an instance".to_owned());
        }
        let stored =
            self.objects.get(word).ok_or_else(|| format!("the object \"{word}\" is not defined before this"))?;
        for StoredShape { kind, parameters, graphics } in stored {
            if graphics.area_light.is_some() {
                self.scenery.report.note("shapes of instances emit no light, as in pbrt");
            }
            let to_world = self.graphics.to_world * graphics.to_world;
            let instance_graphics = Graphics { to_world, area_light: None, ..graphics.clone() };
            self.scenery.shape(kind, Parameters(parameters), &instance_graphics)?;
        }
        Ok(())
    }

    /// Files of the scene.
    pub(super) fn finish(mut self, file: &Path) -> Result<ImportFiles, String> {
        if !self.in_world {
            return Err(
                "`WorldBegin` is missing: not a pbrt-v4 scene (upgrade older files with pbrt --upgrade)".to_owned()
            );
        }
        if !self.blocks.is_empty() {
            return Err("a block is not closed; the file may be truncated".to_owned());
        }
        self.scenery.report.at(String::new());
        let camera = self.camera.take().unwrap_or_else(PbrtCamera::at_origin);
        let camera = camera.into_imported(&self.film, self.scenery.to_ours, &mut self.scenery.report);
        self.scenery.fill_air(&camera.outside);
        self.scenery.join_infinite_lights()?;
        let SceneBuilder { scene, mut report, files, .. } = self.scenery;
        let counts =
            [scene.objects.len(), scene.materials.len(), scene.textures.len(), scene.lights.len(), scene.media.len()];
        let [objects, materials, textures, lights, media] = counts;
        report.note(format!(
            "written: objects {objects}, materials {materials}, textures {textures}, lights {lights}, media {media}"
        ));
        let mut result = import_files(file, &scene, &[camera.camera], report.lines());
        result.files.extend(files);
        Ok(result)
    }
}

/// Rotation by Rodrigues' formula; degrees.
fn rotation(degrees: f64, axis: DVec3) -> Result<DMat3, String> {
    let axis = axis.try_normalize().ok_or("the axis of `Rotate` has zero length")?;
    let (s, c) = maths::sin_cos(degrees.to_radians());
    let column = |v: DVec3| c * v + s * axis.cross(v) + (1.0 - c) * axis.dot(v) * axis;
    Ok(DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z)))
}

/// Transform from a camera (x right, y up, z forward) to the world.
fn look_at(eye: DVec3, look: DVec3, up: DVec3) -> Result<DAffine3, String> {
    let ahead = (look - eye).try_normalize().ok_or("the eye and the target of `LookAt` coincide")?;
    let right =
        up.cross(ahead).try_normalize().ok_or("the up vector of `LookAt` is parallel to the viewing direction")?;
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(right, ahead.cross(right), ahead), eye))
}

fn affine(numbers: &[f64]) -> Result<DAffine3, String> {
    let numbers: [f64; 16] = numbers.try_into().map_err(|_| "expected a matrix of 16 numbers")?;
    match [numbers[3], numbers[7], numbers[11], numbers[15]] == [0.0, 0.0, 0.0, 1.0] {
        true => Ok(DAffine3::from_mat4(DMat4::from_cols_array(&numbers))),
        false => Err("the matrix is not affine; expected 0, 0, 0, 1 as every fourth number".to_owned()),
    }
}
