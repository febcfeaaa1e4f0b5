//! The world: meshes with their trees, and instances of them.

use etendue_core::Accelerator;
use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::blas::Blas;
use crate::MaterialId;
use crate::geometry::{Instance, Mesh, MeshId, Shape, uniform_scale};

/// Error of a world.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// An instance names a mesh that does not exist.
    #[error("instance {instance} refers to mesh {mesh}, but the world has {meshes} meshes; add the mesh first")]
    UnknownMesh {
        /// Index of the instance, from 0.
        instance: usize,
        /// The mesh that it names.
        mesh: u32,
        /// Number of meshes of the world.
        meshes: usize,
    },
    /// An instance has fewer materials than its shape has slots.
    #[error(
        "instance {instance} has {actual} materials, but its shape has {expected} material slots; give one material for each slot"
    )]
    MissingMaterials {
        /// Index of the instance, from 0.
        instance: usize,
        /// Number of materials of the instance.
        actual: usize,
        /// Number of slots of the shape.
        expected: usize,
    },
    /// An instance's transform cannot be inverted or is not finite.
    #[error("the transform of instance {instance} is not finite or has a scale of 0; correct it")]
    Transform {
        /// Index of the instance, from 0.
        instance: usize,
    },
    /// The motion of an instance takes a scale to zero or through it.
    #[error(
        "the scale of instance {instance} is 0 at some time of its motion; keep its sign along each axis equal at all keys, and \
         place keys of small scale so close in time that smooth interpolation does not pass through 0"
    )]
    Flattened {
        /// Index of the instance, from 0.
        instance: usize,
    },
    /// A mesh's own unit is too small for the distances of the scene.
    #[error(
        "rays may start {reach:e} units (of the mesh's frame) from instance {instance}, but at most 1e12 can be traced; scale it \
         less, give its mesh a larger unit, or move camera and objects nearer to each other"
    )]
    Reach {
        /// Index of the instance, from 0.
        instance: usize,
        /// Maximum coordinate of a ray's start in the mesh's frame, in its units.
        reach: f64,
    },
    /// A mesh is so large that rounding moves the camera in front of it into it.
    #[error(
        "the camera is {away:.3} units from the bounding box of instance {instance}, but rounding to 32 bits in the mesh's frame \
         moves it by {moved:.3} units; make the mesh smaller, split it, or put its origin near the camera"
    )]
    Rounding {
        /// Index of the instance, from 0.
        instance: usize,
        /// Distance from the box that holds the mesh, along the axis of the largest distance, in units of the mesh's frame.
        away: f64,
        /// Displacement of the camera by rounding, in the same units.
        moved: f64,
    },
    /// A sphere is farther away than distances can be resolved.
    #[error(
        "the sphere of instance {instance} extends to {reach_m:e} m from the camera, but at most 1e12 m can be traced; move it \
         nearer or make it smaller"
    )]
    Sphere {
        /// Index of the instance, from 0.
        instance: usize,
        /// Maximum coordinate of the sphere relative to the camera, m.
        reach_m: f64,
    },
    /// A sphere's radius is not a positive number.
    #[error("the sphere of instance {instance} has a radius of {radius_m} m; it must be positive and finite")]
    Radius {
        /// Index of the instance, from 0.
        instance: usize,
        /// Radius given, m.
        radius_m: f64,
    },
}

/// Collects meshes and instances for a [`World`].
#[derive(Clone, Debug, Default)]
pub struct WorldBuilder {
    meshes: Vec<Mesh>,
    instances: Vec<Instance>,
    tree_quality: Accelerator,
}

impl WorldBuilder {
    /// An empty builder.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the quality of its meshes' trees.
    #[must_use]
    pub fn with_tree_quality(self, tree_quality: Accelerator) -> Self {
        Self { tree_quality, ..self }
    }

    pub fn add_mesh(&mut self, mesh: Mesh) -> MeshId {
        self.meshes.push(mesh);
        MeshId((self.meshes.len() - 1) as u32)
    }

    /// Adds an instance; returns its index, by which hits name it.
    pub fn add_instance(&mut self, instance: Instance) -> u32 {
        self.instances.push(instance);
        (self.instances.len() - 1) as u32
    }

    /// Area of one side of an instance's surfaces of a material, m² in the world. `None` if it changes over time because the instance's
    /// scale does or its vertices move, and for a sphere that it stretches non-uniformly, whose area has no closed form.
    #[must_use]
    pub fn area_m2(&self, instance: &Instance, material: MaterialId) -> Option<f64> {
        let to_world = instance.to_world.keeps_areas().then(|| instance.to_world.at(0.0).matrix3)?;
        match instance.shape {
            Shape::Sphere { radius_m } => {
                let radius_m = radius_m * uniform_scale(&to_world)?;
                Some(4.0 * core::f64::consts::PI * radius_m * radius_m)
            }
            Shape::Mesh(id) => {
                let mesh = Some(&self.meshes[id.0 as usize]).filter(|mesh| mesh.animation().is_none())?;
                Some(mesh_area_m2(mesh, instance, material, &to_world))
            }
        }
    }

    /// Checks the instances and builds the meshes' trees.
    pub fn build(self) -> Result<World, WorldError> {
        for (index, instance) in self.instances.iter().enumerate() {
            check(index, instance, &self.meshes)?;
        }
        let tree = |mesh: &Mesh| match mesh.animation() {
            None => Blas::new(mesh, self.tree_quality),
            // A view builds one for its own interval.
            Some(_) => Blas::over(0, |_| unreachable!("no triangles"), Accelerator::Fast),
        };
        let trees = self.meshes.par_iter().map(tree).collect();
        Ok(World { meshes: self.meshes, trees, instances: self.instances, tree_quality: self.tree_quality })
    }
}

/// Area of one side of the triangles of a mesh that have a material on an instance, m² in the world.
fn mesh_area_m2(mesh: &Mesh, instance: &Instance, material: MaterialId, to_world: &DMat3) -> f64 {
    let of_it =
        |primitive: &u32| instance.materials.get(usize::from(mesh.slots()[*primitive as usize])) == Some(&material);
    let area = |primitive| {
        let [a, b, c] = mesh.corners(primitive).map(glam::Vec3::as_dvec3);
        0.5 * (*to_world * (b - a)).cross(*to_world * (c - a)).length()
    };
    (0..mesh.triangles().len() as u32).filter(of_it).map(area).sum()
}

fn check(index: usize, instance: &Instance, meshes: &[Mesh]) -> Result<(), WorldError> {
    let expected = slots(index, instance, meshes)?;
    if instance.materials.len() < expected {
        return Err(WorldError::MissingMaterials { instance: index, actual: instance.materials.len(), expected });
    }
    match (instance.to_world.is_invertible(), instance.to_world.as_constant()) {
        (true, _) => Ok(()),
        (false, Some(_)) => Err(WorldError::Transform { instance: index }),
        (false, None) => Err(WorldError::Flattened { instance: index }),
    }
}

fn slots(index: usize, instance: &Instance, meshes: &[Mesh]) -> Result<usize, WorldError> {
    match instance.shape {
        Shape::Mesh(MeshId(mesh)) => meshes.get(mesh as usize).map(Mesh::slot_count).ok_or(WorldError::UnknownMesh {
            instance: index,
            mesh,
            meshes: meshes.len(),
        }),
        Shape::Sphere { radius_m } if radius_m > 0.0 && radius_m.is_finite() => Ok(1),
        Shape::Sphere { radius_m } => Err(WorldError::Radius { instance: index, radius_m }),
    }
}

/// Meshes with their trees, and instances of them. Immutable.
#[derive(Clone, Debug)]
pub struct World {
    meshes: Vec<Mesh>,
    trees: Vec<Blas>,
    instances: Vec<Instance>,
    tree_quality: Accelerator,
}

impl World {
    /// The meshes, in the order of their ids.
    #[must_use]
    pub fn meshes(&self) -> &[Mesh] {
        &self.meshes
    }

    /// One mesh. Panics on an id of another world.
    #[must_use]
    pub fn mesh(&self, id: MeshId) -> &Mesh {
        &self.meshes[id.0 as usize]
    }

    /// Returns the size of meshes, acceleration structures and instances, bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let meshes: usize = self.meshes.iter().map(Mesh::bytes).sum();
        let trees: usize = self.trees.iter().map(Blas::bytes).sum();
        meshes + trees + size_of_val(self.instances.as_slice())
    }

    /// Quality of the trees.
    #[must_use]
    pub fn tree_quality(&self) -> Accelerator {
        self.tree_quality
    }

    /// The tree of a mesh whose vertices do not move.
    pub(crate) fn tree(&self, id: MeshId) -> &Blas {
        &self.trees[id.0 as usize]
    }

    /// The instances, in the order of their indices.
    #[must_use]
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Area of one side of an instance's surfaces of a material at the time 0, m²; for a stretched sphere that of one whose squared radius
    /// is the mean of its squared half axes.
    #[must_use]
    pub fn area_at_start_m2(&self, instance: &Instance, material: MaterialId) -> f64 {
        let to_world = instance.to_world.at(0.0).matrix3;
        match instance.shape {
            Shape::Mesh(id) => mesh_area_m2(self.mesh(id), instance, material, &to_world),
            Shape::Sphere { .. } if instance.materials.first() != Some(&material) => 0.0,
            Shape::Sphere { radius_m } => {
                let squares: f64 =
                    [to_world.x_axis, to_world.y_axis, to_world.z_axis].map(DVec3::length_squared).iter().sum();
                4.0 * core::f64::consts::PI * radius_m * radius_m * squares / 3.0
            }
        }
    }

    /// Radius of a ball about all instances at the time 0, m; 0 if there are none.
    #[must_use]
    pub fn radius_at_start_m(&self) -> f64 {
        let ends = self.instances.iter().flat_map(|instance| self.corners_at_start_m(instance));
        let bounds = ends.fold(None, |box_so_far: Option<(DVec3, DVec3)>, at| match box_so_far {
            None => Some((at, at)),
            Some((low, high)) => Some((low.min(at), high.max(at))),
        });
        bounds.map_or(0.0, |(low, high)| 0.5 * (high - low).length())
    }

    /// Corners of the box of an instance's shape in its own frame, in the world at the time 0.
    fn corners_at_start_m(&self, instance: &Instance) -> [DVec3; 8] {
        let (low, high) = match instance.shape {
            Shape::Sphere { radius_m } => (DVec3::splat(-radius_m), DVec3::splat(radius_m)),
            Shape::Mesh(id) => self
                .mesh(id)
                .bounds()
                .map_or((DVec3::ZERO, DVec3::ZERO), |(low, high)| (low.as_dvec3(), high.as_dvec3())),
        };
        let to_world = instance.to_world.at(0.0);
        core::array::from_fn(|i| {
            let pick = |bit: usize, axis: usize| if i >> bit & 1 == 0 { low[axis] } else { high[axis] };
            to_world.transform_point3(DVec3::new(pick(0, 0), pick(1, 1), pick(2, 2)))
        })
    }
}
