//! A mirror in front of the camera.

use std::path::PathBuf;

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{keyed, known, number, path, record, variants, vector};
use crate::record::material::Metal;
use crate::record::reflectance::{Colour, any_colour};
use etendue_spectra::metal;

record! {
    /// A mirror in front of the camera. Its frame has x to the right, y down and z away from the camera; its vertex is the origin.
    pub struct Mirror check(check) {
        /// Shape of its surface.
        inside shape: MirrorShape;
        /// Distance from the entrance pupil to its vertex (mesh: origin). Default, hyperboloid: pupil at its outer focus.
        optional distance_mm: Placed<f64> = number("mm").above(0.0);
        /// Offset of its vertex, right and down. Default: 0.
        optional offset_mm: Placed<[f64; 2]> = vector::<2>(number("mm"));
        /// Rotation about the camera's x, then y, then z. Default: 0.
        optional rotation_deg: Placed<[f64; 3]> = vector::<3>(number("°"));
        /// Reflectance.
        inside finish: Finish;
    }
}

variants! {
    /// Shape of a mirror. Quadrics are convex towards the camera.
    pub enum MirrorShape by "type" {
        /// A sphere.
        "sphere" => Sphere(Sphere),
        /// A paraboloid; a single viewpoint with a telecentric camera.
        "paraboloid" => Paraboloid(Sphere),
        /// A hyperboloid; a single viewpoint with the pupil at its outer focus.
        "hyperboloid" => Hyperboloid(Hyperboloid),
        /// A cone with its apex towards the camera.
        "cone" => Cone(Cone),
        /// A mesh, with its smooth normals.
        "mesh" => Mesh(MeshFile),
    }
}

record! {
    /// A mesh in the mirror's frame: x to the right, y down, z away from the camera. It reflects on the side from which its triangles are
    /// counter-clockwise.
    pub struct MeshFile {
        /// Wavefront OBJ. Without normals, each corner has the mean normal of its triangles.
        required file: Placed<PathBuf> = path(&["obj"]);
        /// Millimetres per unit of the file. Default: 1.
        optional scale_mm: Placed<f64> = number("mm").above(0.0);
    }
}

record! {
    /// A sphere or a paraboloid.
    pub struct Sphere {
        /// Radius of curvature at the vertex.
        required radius_mm: Placed<f64> = number("mm").above(0.0);
        /// Edges.
        inside edges: Edges;
    }
}

record! {
    /// A hyperboloid r² + (1 + conic) z² = 2 radius_mm z.
    pub struct Hyperboloid {
        /// Radius of curvature at the vertex.
        required radius_mm: Placed<f64> = number("mm").above(0.0);
        /// Conic constant −e². The outer focus lies radius_mm/(e − 1) in front of the vertex.
        required conic: Placed<f64> = number("").at_least(-1000.0).at_most(-1.000_001);
        /// Edges.
        inside edges: Edges;
    }
}

record! {
    /// A cone.
    pub struct Cone {
        /// Angle between axis and surface.
        required half_angle_deg: Placed<f64> = number("°").above(0.0).at_most(89.0);
        /// Edges.
        inside edges: Edges;
    }
}

record! {
    /// Edges of a mirror; rays beyond them pass it.
    pub struct Edges {
        /// Outer radius.
        required rim_radius_mm: Placed<f64> = number("mm").above(0.0);
        /// Radius of a central hole.
        optional hole_radius_mm: Placed<f64> = number("mm").at_least(0.0);
    }
}

keyed! {
    /// Reflectance of a mirror.
    pub enum Finish {
        /// Reflectance at all angles; lists are linear sRGB.
        reflectance => Share(Colour) = any_colour();
        /// A clean metal, by Fresnel's equations.
        metal => Named(Placed<String>) = known("a metal", metal::names());
        /// A clean metal: wavelength in nm, n, k.
        index_file => File(Placed<PathBuf>) = path(&["csv"]);
    }
}

impl Finish {
    /// The metal, if any.
    #[must_use]
    pub fn metal(&self) -> Option<Metal> {
        match self {
            Self::Share(_) => None,
            Self::Named(name) => Some(Metal::Named(name.clone())),
            Self::File(file) => Some(Metal::File(file.clone())),
        }
    }
}

fn check(mirror: &Mirror, errors: &mut DescriptionErrors) {
    if mirror.distance_mm.is_none() && !matches!(mirror.shape, MirrorShape::Hyperboloid(_)) {
        let remedy = "add it: the distance of the mirror's vertex from the centre of the entrance pupil, mm";
        errors.add(ErrorCode::MissingKey, &mirror.place, "the key \"distance_mm\" is missing", remedy);
    }
}
