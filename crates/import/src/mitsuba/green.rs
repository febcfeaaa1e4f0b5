//! Which way green of normal maps points on a mesh.
//!
//! Mitsuba's points along n × ∂p/∂u, whatever v does: up in a picture that lies as it is, down in one that lies mirrored, as on its rectangle and on PLY
//! files, whose v points down in pictures, and on meshes whose texture is mirrored. Ours points up in its picture unless it is said to point down
//! (`normal_map.y`); so a surface with a normal map has a second material of ours for meshes with mirrored pictures.

use super::importer::Importer;
use crate::scenery::{Graphics, Triangles};
use etendue_scene::record::material::{Green, Material, NormalMap};
use glam::DVec2;
use std::rc::Rc;

impl Importer<'_> {
    /// A mesh of the material and the light that hold now.
    pub(super) fn mesh(&mut self, mesh: Triangles, graphics: &Graphics) -> Result<(), String> {
        let mut graphics = graphics.clone();
        if self.normal_mapped.contains_key(&graphics.material) && self.is_mirrored(&mesh, &graphics) {
            graphics.material = self.green_down(&graphics.material);
        }
        self.scenery.mesh(mesh, &graphics)
    }

    /// Whether more of a picture lies mirrored on a mesh than as it is, seen in Mitsuba's world from where normals point.
    fn is_mirrored(&self, mesh: &Triangles, graphics: &Graphics) -> bool {
        if mesh.uvs.len() != mesh.positions.len() {
            return false;
        }
        let placed = mesh.clone().placed(self.scenery.placed(graphics), graphics.reverse_orientation);
        // Its triangles turn anticlockwise about their normals, as pictures that lie as they are do.
        let turn = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| DVec2::from_array(placed.uvs[i as usize]));
            (b - a).perp_dot(c - a)
        };
        placed.triangles.iter().map(turn).sum::<f64>() * self.scenery.to_ours.determinant() < 0.0
    }

    /// The name of a material with its green down.
    fn green_down(&mut self, name: &Rc<str>) -> Rc<str> {
        if let Some(Some(known)) = self.normal_mapped.get(name) {
            return known.clone();
        }
        let Some(found) = self.scenery.scene.materials.iter().find(|material| material.name.value == **name) else {
            return name.clone();
        };
        let normal_map = found.normal_map.clone().map(|map| NormalMap { y: Some(Green::Down.into()), ..map });
        let own = self.scenery.names.take(&format!("{name}-mirrored"), "material");
        let made = Material { name: own.as_str().into(), normal_map, ..found.clone() };
        self.scenery.scene.materials.push(made);
        let own: Rc<str> = own.as_str().into();
        self.normal_mapped.insert(name.clone(), Some(own.clone()));
        own
    }
}
