//! `[[meshes]]`: triangle meshes from files.

use std::path::PathBuf;

use glam::{DMat3, DVec3};

use super::vertex_animation::VertexAnimation;
use crate::asset::is_gltf;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, keyed, number, path, record, text, words};

record! {
    /// A triangle mesh. Objects place it in the world, any number of times.
    pub struct Mesh check(check) {
        /// Name.
        required name: Placed<String> = text("the name of the mesh");
        /// Source of its vertices and faces.
        inside source: MeshSource;
        /// Axis of the file that points up. Required except for glTF, which states it.
        optional up_axis: Placed<Axis> = choice();
        /// Axis of the file that points forward. Default: the next in the cycle x, y, z.
        optional forward_axis: Placed<Axis> = choice();
        /// Metres per unit of the file. Default: 1.
        optional scale: Placed<f64> = number("m").above(0.0);
    }
}

keyed! {
    /// Source of the vertices and faces of a mesh.
    pub enum MeshSource {
        /// Wavefront OBJ, glTF 2.0 or PLY; precision 3e-8 of the mesh's extent at any distance.
        file => File(Placed<PathBuf>) = path(&["obj", "glb", "gltf", "ply", "stl"]);
        /// Moving vertices, from several files.
        vertex_animation => VertexAnimation(Box<VertexAnimation>) = record();
    }
}

words! {
    /// An axis of a file, with its sign.
    pub enum Axis {
        /// +x.
        "x" => X,
        /// +y.
        "y" => Y,
        /// +z.
        "z" => Z,
        /// −x.
        "-x" => MinusX,
        /// −y.
        "-y" => MinusY,
        /// −z.
        "-z" => MinusZ,
    }
}

impl From<&str> for MeshSource {
    fn from(file: &str) -> Self {
        Self::File(file.into())
    }
}

impl Axis {
    /// The unit vector.
    #[must_use]
    pub fn vector(self) -> DVec3 {
        match self {
            Self::X => DVec3::X,
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
            Self::MinusX => DVec3::NEG_X,
            Self::MinusY => DVec3::NEG_Y,
            Self::MinusZ => DVec3::NEG_Z,
        }
    }

    /// The default forward axis of a file that does not state one.
    fn default_forward(self) -> Self {
        match self {
            Self::X | Self::MinusX => Self::Y,
            Self::Y | Self::MinusY => Self::Z,
            Self::Z | Self::MinusZ => Self::X,
        }
    }
}

impl Mesh {
    /// File with the faces and materials: of moving vertices the first one.
    #[must_use]
    pub fn file(&self) -> Placed<PathBuf> {
        match &self.source {
            MeshSource::File(file) => file.clone(),
            MeshSource::VertexAnimation(animation) => animation.frame_files().swap_remove(0),
        }
    }

    /// Motion of its vertices; `None` if they do not move.
    #[must_use]
    pub fn animation(&self) -> Option<&VertexAnimation> {
        match &self.source {
            MeshSource::File(_) => None,
            MeshSource::VertexAnimation(animation) => Some(animation),
        }
    }

    /// Axis of the file that becomes the world's +z; by default that of glTF.
    #[must_use]
    pub fn up(&self) -> Axis {
        self.up_axis.as_ref().map_or(Axis::Y, |a| a.value)
    }

    /// Axis of the file that becomes the world's +x.
    #[must_use]
    pub fn forward(&self) -> Axis {
        self.forward_axis.as_ref().map_or(self.up().default_forward(), |a| a.value)
    }

    /// Matrix from the axes and units of the file to an object's (x forward, y left, z up; m): a rotation times the scale.
    #[must_use]
    pub fn to_object(&self) -> DMat3 {
        self.axes() * self.scale.as_ref().map_or(1.0, |s| s.value)
    }

    /// Rotation from the axes of the file to an object's.
    #[must_use]
    pub fn axes(&self) -> DMat3 {
        let (forward, up) = (self.forward().vector(), self.up().vector());
        DMat3::from_cols(forward, up.cross(forward), up).transpose()
    }
}

fn check(mesh: &Mesh, errors: &mut DescriptionErrors) {
    check_up(mesh, errors);
    let Some(forward) = &mesh.forward_axis else { return };
    if forward.vector().dot(mesh.up().vector()).abs() > 0.5 {
        errors.add(
            ErrorCode::Degenerate,
            &forward.place,
            "\"forward_axis\" is parallel to \"up_axis\"",
            "give one of the four axes perpendicular to it",
        );
    }
}

/// Checks that "up_axis" is given, except for a glTF file, which states its axes.
fn check_up(mesh: &Mesh, errors: &mut DescriptionErrors) {
    let file = mesh.file();
    match (&mesh.up_axis, is_gltf(&file)) {
        (Some(up), true) if up.value != Axis::Y => errors.add(
            ErrorCode::Contradiction,
            &up.place,
            "\"up_axis\" contradicts the file: +y points upwards in every glTF file",
            "remove it, and rotate the object that uses the mesh",
        ),
        (None, false) => {
            errors.add(
                ErrorCode::MissingKey,
                &mesh.place,
                "the key \"up_axis\" is missing",
                "add it: \"x\", \"y\", \"z\", \"-x\", \"-y\" or \"-z\"",
            );
        }
        _ => {}
    }
}
