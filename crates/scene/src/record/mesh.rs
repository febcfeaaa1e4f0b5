//! `[[meshes]]`: triangle meshes from files.

use std::path::PathBuf;

use glam::{DMat3, DVec3};

use super::vertex_animation::VertexAnimation;
use crate::asset::is_gltf;
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{choice, keyed, number, path, record, text, words};

record! {
    /// A triangle mesh. Objects place it in the world; it may be placed many times.
    pub struct Mesh check(check) {
        /// The name by which objects call it.
        required name: Placed<String> = text("the name of the mesh");
        /// Where its vertices and faces stand.
        inside source: MeshSource;
        /// Which axis of the file points upwards. A glTF file says it itself, +y, and forward is +z: there it is left out; other files need it.
        optional up_axis: Placed<Axis> = choice();
        /// Which axis of the file points forward (the world's +x). Default: the axis that follows the up axis in the
        /// circle x, y, z (up z: forward x; up y: forward z; up x: forward y), with a plus.
        optional forward_axis: Placed<Axis> = choice();
        /// Metres per unit of the file. Default: 1.
        optional scale: Placed<f64> = number("m").above(0.0);
    }
}

keyed! {
    /// Where the vertices and faces of a mesh stand.
    pub enum MeshSource {
        /// The file: Wavefront OBJ, glTF 2.0, or PLY. Its coordinates may be a survey's or a map's: they are kept to 3e-8 of the mesh's own
        /// extent however far from the file's origin it lies.
        file => File(Placed<PathBuf>) = path(&["obj", "glb", "gltf", "ply"]);
        /// Vertices that move, from several files.
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

    /// The forward axis where the file is silent.
    fn default_forward(self) -> Self {
        match self {
            Self::X | Self::MinusX => Self::Y,
            Self::Y | Self::MinusY => Self::Z,
            Self::Z | Self::MinusZ => Self::X,
        }
    }
}

impl Mesh {
    /// The file that says its faces and materials: of vertices that move the first one.
    #[must_use]
    pub fn file(&self) -> Placed<PathBuf> {
        match &self.source {
            MeshSource::File(file) => file.clone(),
            MeshSource::VertexAnimation(animation) => animation.frame_files().swap_remove(0),
        }
    }

    /// How its vertices move; `None` where they do not.
    #[must_use]
    pub fn animation(&self) -> Option<&VertexAnimation> {
        match &self.source {
            MeshSource::File(_) => None,
            MeshSource::VertexAnimation(animation) => Some(animation),
        }
    }

    /// The axis of the file that becomes the world's +z: that of glTF where nothing is said.
    #[must_use]
    pub fn up(&self) -> Axis {
        self.up_axis.as_ref().map_or(Axis::Y, |a| a.value)
    }

    /// The axis of the file that becomes the world's +x.
    #[must_use]
    pub fn forward(&self) -> Axis {
        self.forward_axis.as_ref().map_or(self.up().default_forward(), |a| a.value)
    }

    /// From the axes and units of the file to an object's (x forward, y left, z up; m): a rotation times the scale.
    #[must_use]
    pub fn to_object(&self) -> DMat3 {
        self.axes() * self.scale.as_ref().map_or(1.0, |s| s.value)
    }

    /// The rotation from the axes of the file to an object's.
    #[must_use]
    pub fn axes(&self) -> DMat3 {
        let (forward, up) = (self.forward().vector(), self.up().vector());
        DMat3::from_cols(forward, up.cross(forward), up).transpose()
    }
}

fn check(mesh: &Mesh, faults: &mut Faults) {
    check_up(mesh, faults);
    let Some(forward) = &mesh.forward_axis else { return };
    if forward.vector().dot(mesh.up().vector()).abs() > 0.5 {
        faults.add(
            ErrorCode::Degenerate,
            &forward.place,
            "\"forward_axis\" lies along \"up_axis\"",
            "give one of the four axes at right angles to it",
        );
    }
}

/// A glTF file says its axes, other files do not.
fn check_up(mesh: &Mesh, faults: &mut Faults) {
    let file = mesh.file();
    match (&mesh.up_axis, is_gltf(&file)) {
        (Some(up), true) if up.value != Axis::Y => faults.add(
            ErrorCode::Contradiction,
            &up.place,
            "\"up_axis\" contradicts the file: +y points upwards in every glTF file",
            "remove it, and turn the object that shows the mesh",
        ),
        (None, false) => {
            faults.add(
                ErrorCode::MissingKey,
                &mesh.place,
                "the key \"up_axis\" is missing",
                "add it: \"x\", \"y\", \"z\", \"-x\", \"-y\" or \"-z\"",
            );
        }
        _ => {}
    }
}
