//! A scene's description as TOML text, built from meshes, textures, surfaces and objects.

use crate::File;
use crate::mesh::Mesh;
use crate::obj::{Swatch, mtl, number, obj};
use crate::paint::Canvas;
use glam::DVec3;
use std::fmt::Write as _;

/// How a material reflects.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    /// Diffuse, linear sRGB.
    Diffuse([f64; 3]),
    /// Diffuse, by the texture of this name.
    Textured(&'static str),
    /// A diffuse base under a clear coat of index 1.5 and this roughness α.
    Coated([f64; 3], f64),
    /// A bare metal of this roughness α.
    Conductor(&'static str, f64),
    /// Retro-reflective sheeting of this class, printed with the texture of this name.
    Sign(&'static str, &'static str),
    /// A leaf: linear sRGB that it reflects and lets through.
    Leaf([f64; 3], [f64; 3]),
    /// A ready material.
    Preset(&'static str),
}

/// A named surface.
pub type Material = (&'static str, Surface);

/// Where an instance stands: position, m, yaw, degrees, and scale.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Position, m.
    pub at: DVec3,
    /// Turn about the vertical, degrees.
    pub yaw_deg: f64,
    /// Scale of all axes.
    pub scale: f64,
}

impl Placement {
    /// A place of natural size.
    #[must_use]
    pub fn new(x: f64, y: f64, z: f64, yaw_deg: f64) -> Self {
        Self { at: DVec3::new(x, y, z), yaw_deg, scale: 1.0 }
    }
}

/// A mesh of the scene, standing somewhere.
#[derive(Clone, Debug)]
pub struct Object {
    /// Its name.
    pub name: String,
    /// The name of its mesh.
    pub mesh: &'static str,
    /// Its semantic class.
    pub class: &'static str,
    /// Materials of slots, where they are not named like the slot.
    pub dress: Vec<(&'static str, &'static str)>,
    /// Where it stands.
    pub spots: Vec<Placement>,
}

/// Everything of a generated scene.
#[derive(Clone, Debug, Default)]
pub struct Description {
    /// Name and mesh.
    pub meshes: Vec<(&'static str, Mesh)>,
    /// Name and PNG file.
    pub textures: Vec<(&'static str, Vec<u8>)>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Semantic classes and their numbers.
    pub classes: Vec<(&'static str, u32)>,
    /// Objects.
    pub objects: Vec<Object>,
}

impl Description {
    /// A mesh.
    pub fn mesh(&mut self, name: &'static str, mesh: Mesh) {
        self.meshes.push((name, mesh));
    }

    /// A coloured texture.
    pub fn texture(&mut self, name: &'static str, canvas: &Canvas) {
        self.textures.push((name, canvas.png()));
    }

    /// A grey texture in steps of `step` codes.
    pub fn grey_texture(&mut self, name: &'static str, canvas: &Canvas, step: u8) {
        self.textures.push((name, canvas.grey_png(step)));
    }

    /// An object named like its mesh, whose materials are named like its slots.
    pub fn object(&mut self, mesh: &'static str, class: &'static str, spots: Vec<Placement>) {
        self.dressed(mesh.to_owned(), mesh, class, Vec::new(), spots);
    }

    /// An object some of whose slots wear other materials.
    pub fn dressed(
        &mut self,
        name: String,
        mesh: &'static str,
        class: &'static str,
        dress: Vec<(&'static str, &'static str)>,
        spots: Vec<Placement>,
    ) {
        self.objects.push(Object { name, mesh, class, dress, spots });
    }

    /// The mesh, material and texture files in `folder`.
    #[must_use]
    pub fn files(&self, folder: &str) -> Vec<File> {
        let meshes = self
            .meshes
            .iter()
            .map(|(name, mesh)| File::text(format!("{folder}/meshes/{name}.obj"), obj(mesh, "street.mtl")));
        let textures = self
            .textures
            .iter()
            .map(|(name, png)| File { path: format!("{folder}/textures/{name}.png"), bytes: png.clone() });
        let library = File::text(format!("{folder}/meshes/street.mtl"), mtl(&self.swatches()));
        meshes.chain([library]).chain(textures).collect()
    }

    /// Display colours of every slot that a mesh has.
    fn swatches(&self) -> Vec<Swatch> {
        let mut names: Vec<&'static str> =
            self.meshes.iter().flat_map(|(_, mesh)| mesh.slots.iter().copied()).collect();
        names.sort_unstable();
        names.dedup();
        names.into_iter().map(|name| Swatch { name, colour: self.display_colour(name) }).collect()
    }

    fn display_colour(&self, name: &str) -> [f64; 3] {
        let material = self.materials.iter().find(|(known, _)| *known == name);
        match material.map(|(_, surface)| *surface) {
            Some(Surface::Diffuse(colour) | Surface::Coated(colour, _) | Surface::Leaf(colour, _)) => colour,
            Some(Surface::Conductor(..)) => [0.6; 3],
            Some(Surface::Textured(_) | Surface::Sign(..) | Surface::Preset(_)) | None => [0.4; 3],
        }
    }

    /// The scene's tables, without its environment and lights.
    #[must_use]
    pub fn toml(&self) -> String {
        let mut text = String::from("[classes]\n");
        for (name, number) in &self.classes {
            let _ = writeln!(text, "{name} = {number}");
        }
        for (name, _) in &self.textures {
            let _ = write!(
                text,
                "\n[[textures]]\nname = \"{name}\"\nfile = \"textures/{name}.png\"\nencoding = \"srgb\"\n"
            );
        }
        for (name, surface) in &self.materials {
            let _ = write!(text, "\n[[materials]]\nname = \"{name}\"\n{}", surface_text(*surface));
        }
        for (name, _) in &self.meshes {
            let _ = write!(text, "\n[[meshes]]\nname = \"{name}\"\nfile = \"meshes/{name}.obj\"\nup_axis = \"z\"\n");
        }
        for object in &self.objects {
            self.object_text(object, &mut text);
        }
        text
    }

    /// Name, mesh, class and materials of an object; of its own mesh's slots, or of `only` these.
    #[must_use]
    pub fn object_head(&self, object: &Object, mesh: &str, only: Option<&[&'static str]>) -> String {
        let Object { name, class, .. } = object;
        let geometry =
            self.meshes.iter().find(|(known, _)| *known == object.mesh).map(|(_, geometry)| &geometry.slots[..]);
        let slots = only.unwrap_or_else(|| geometry.expect("an object's mesh exists"));
        let wears = |slot: &'static str| {
            let other = object.dress.iter().find(|(dressed, _)| *dressed == slot);
            format!("{slot} = \"{}\"", other.map_or(slot, |(_, material)| *material))
        };
        let materials: Vec<String> = slots.iter().map(|&slot| wears(slot)).collect();
        let materials = materials.join(", ");
        format!(
            "[[objects]]\nname = \"{name}\"\nmesh = \"{mesh}\"\nclass = \"{class}\"\nmaterials = {{ {materials} }}\n"
        )
    }

    fn object_text(&self, object: &Object, text: &mut String) {
        let _ = write!(text, "\n{}instances = [\n", self.object_head(object, object.mesh, None));
        for spot in &object.spots {
            let _ = writeln!(text, "  {},", spot_text(*spot));
        }
        text.push_str("]\n");
    }

    /// Triangles in the files, and triangles in the scene with every instance counted.
    #[must_use]
    pub fn triangle_counts(&self) -> [usize; 2] {
        let triangles_of = |name: &str| {
            self.meshes.iter().find(|(known, _)| *known == name).map_or(0, |(_, mesh)| mesh.triangle_count())
        };
        let unique = self.meshes.iter().map(|(_, mesh)| mesh.triangle_count()).sum();
        [unique, self.objects.iter().map(|object| object.spots.len() * triangles_of(object.mesh)).sum()]
    }
}

fn surface_text(surface: Surface) -> String {
    let colour = |[r, g, b]: [f64; 3]| format!("[{}, {}, {}]", number(r), number(g), number(b));
    match surface {
        Surface::Diffuse(c) => format!("type = \"diffuse\"\nreflectance = {}\n", colour(c)),
        Surface::Textured(name) => format!("type = \"diffuse\"\nreflectance = {{ texture = \"{name}\" }}\n"),
        Surface::Coated(c, alpha) => {
            format!("type = \"coated\"\nreflectance = {}\nalpha = {}\n", colour(c), number(alpha))
        }
        Surface::Conductor(metal, alpha) => {
            format!("type = \"conductor\"\nmetal = \"{metal}\"\nalpha = {}\n", number(alpha))
        }
        Surface::Sign(class, print) => {
            format!("type = \"retro_sheeting\"\nclass = \"{class}\"\nprint = {{ texture = \"{print}\" }}\n")
        }
        Surface::Leaf(reflected, through) => {
            let (reflected, through) = (colour(reflected), colour(through));
            format!("type = \"leaf\"\nreflectance = {reflected}\ntransmittance = {through}\n")
        }
        Surface::Preset(name) => format!("preset = \"{name}\"\n"),
    }
}

fn spot_text(spot: Placement) -> String {
    let [x, y, z] = spot.at.to_array().map(number);
    let mut text = format!("{{ position_m = [{x}, {y}, {z}]");
    if spot.yaw_deg != 0.0 {
        let _ = write!(text, ", rotation_deg = [{}, 0, 0]", number(spot.yaw_deg));
    }
    if (spot.scale - 1.0).abs() > 1e-9 {
        let _ = write!(text, ", scale = {}", number(spot.scale));
    }
    text + " }"
}
