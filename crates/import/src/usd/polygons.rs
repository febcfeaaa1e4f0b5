//! Meshes of polygons; one of our meshes for each of their materials.

use std::{collections::BTreeMap, rc::Rc};

use super::access::{flag, indices, text};
use super::binding::is_bound;
use super::importer::{Importer, TraversalState};
use super::mesh::{PolygonMesh, Primvar, Scheme};
use crate::scenery::{AreaLight, Graphics, Triangles};
use crate::syntax::usd::UsdPrim;

/// Faces of a mesh.
struct FaceGroups<'a> {
    /// Faces of subsets, by the paths of their materials.
    by_material: BTreeMap<&'a str, Vec<usize>>,
    /// Faces of no subset, which have the mesh's own material.
    rest: Vec<usize>,
}

/// Prim that is a mesh.
struct MeshPrim<'p, 'a> {
    prim: &'a UsdPrim,
    state: &'p TraversalState<'a>,
    mesh: PolygonMesh<'a>,
    /// Texture coordinates requested by materials, by name.
    uvs: BTreeMap<String, Option<Primvar<'a, 2>>>,
    light: Option<Rc<AreaLight>>,
}

impl<'a> MeshPrim<'_, 'a> {
    /// Triangles of some faces, and the number of polygons without any.
    fn triangles(&mut self, faces: Vec<usize>, uv: &str) -> Result<(Triangles, usize), String> {
        if !self.uvs.contains_key(uv) {
            self.uvs.insert(uv.to_owned(), self.mesh.uvs(self.prim, uv)?);
        }
        Ok(self.mesh.triangles(faces.into_iter(), self.uvs[uv].as_ref()))
    }
}

impl<'a> Importer<'a> {
    pub(super) fn polygons(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>) -> Result<(), String> {
        let mesh = PolygonMesh::read(prim)?;
        let FaceGroups { by_material, rest } = self.parts(prim, state, mesh.faces())?;
        self.scenery.report.at(prim.path.clone());
        self.note_scheme(mesh.scheme);
        let light = self.light_of_shape(prim).map(|light| self.normalised_light(light, &mesh, prim, state));
        let mut mesh_prim = MeshPrim { prim, state, mesh, uvs: BTreeMap::new(), light };
        if !rest.is_empty() || by_material.is_empty() {
            self.part(&mut mesh_prim, state.bindings.material(), rest)?;
        }
        by_material.into_iter().try_for_each(|(path, faces)| self.part(&mut mesh_prim, Some(path), faces))
    }

    fn parts(&mut self, prim: &'a UsdPrim, state: &TraversalState<'a>, faces: usize) -> Result<FaceGroups<'a>, String> {
        let mut by_material: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        let mut assigned = vec![false; faces];
        for subset in prim.children.iter().filter(|child| child.kind == "GeomSubset") {
            let bindings = self.bindings(subset, &state.bindings);
            let Some(path) = bindings.material().filter(|_| is_bound(subset)) else { continue };
            if !matches!(text(subset, "elementType"), "" | "face") {
                self.scenery.report.note("a GeomSubset of elements other than faces is not used");
                continue;
            }
            for face in
                indices(subset, "indices").ok_or_else(|| format!("{}: \"indices\" has a value below 0", subset.path))?
            {
                if assigned.get(face) == Some(&false) {
                    assigned[face] = true;
                    by_material.entry(path).or_default().push(face);
                }
            }
            self.note_unused(subset);
        }
        let rest = (0..assigned.len()).filter(|face| !assigned[*face]).collect();
        Ok(FaceGroups { by_material, rest })
    }

    fn note_scheme(&mut self, scheme: Scheme) {
        self.scenery.report.note(match scheme {
            Scheme::None => return,
            Scheme::Bilinear => "a bilinear subdivision surface becomes its control mesh with flat faces",
            Scheme::Smooth => {
                "a subdivision surface becomes its control mesh with smooth normals; subdivide it first, or set subdivisionScheme = \"none\""
            }
        });
    }

    /// Adds the faces of a mesh with one material.
    fn part(
        &mut self,
        mesh_prim: &mut MeshPrim<'_, 'a>,
        material: Option<&str>,
        faces: Vec<usize>,
    ) -> Result<(), String> {
        let (graphics, material) = self.graphics(mesh_prim.prim, mesh_prim.state, material)?;
        let (mut triangles, refused) = mesh_prim.triangles(faces, material.primvar())?;
        if material.has_images() && triangles.uvs.is_empty() {
            let name = material.primvar();
            let message = format!(
                "a mesh lacks the texture coordinates \"{name}\": its textures have the value of their corner everywhere"
            );
            self.scenery.report.note(message);
            triangles.uvs = vec![[0.0; 2]; triangles.positions.len()];
        }
        if material.shows_outside(&triangles.uvs) {
            self.note_outside();
        }
        if refused > 0 {
            self.scenery.report.note(format!("{refused} self-intersecting polygons are left out"));
        }
        // Normals define the front; those of a control mesh follow its winding.
        let has_own = !triangles.normals.is_empty() && mesh_prim.mesh.scheme == Scheme::None;
        let reverse_orientation = mesh_prim.mesh.is_left_handed && !has_own;
        self.add(triangles, &Graphics { reverse_orientation, area_light: mesh_prim.light.clone(), ..graphics })
    }

    /// Light of a mesh; with "normalize" divided by the area of all its faces in the world of the stage.
    fn normalised_light(
        &self,
        light: Rc<AreaLight>,
        mesh: &PolygonMesh<'a>,
        prim: &UsdPrim,
        state: &TraversalState<'a>,
    ) -> Rc<AreaLight> {
        if !flag(prim, "inputs:normalize", false) {
            return light;
        }
        let metres = self.stage.metres_per_unit;
        let area = mesh.area(state.to_world) / (metres * metres);
        if area > 0.0 { Rc::new(AreaLight { luminance: light.luminance / area, ..(*light).clone() }) } else { light }
    }
}
