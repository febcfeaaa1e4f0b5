//! Shapes without a file.

use crate::place::Placed;
use crate::reader::{number, record, variants, vector};

variants! {
    /// A shape in the frame of its object.
    pub enum Shape by "type" {
        /// A centred rectangle in z = 0, front towards +z; u along x, v along y.
        "quad" => Quad(Quad),
        /// A centred cuboid, faces outward; u, v = 0 … 1 on every face.
        "box" => Box(Cuboid),
        /// A sphere about the origin.
        "sphere" => Sphere(Sphere),
        /// A centred disc in z = 0, front towards +z: 256 sides, equal area; u, v over its diameter.
        "disc" => Disc(Disc),
    }
}

record! {
    /// A rectangle.
    pub struct Quad {
        /// Extents along x and y.
        required size_m: Placed<[f64; 2]> = vector::<2>(number("m").above(0.0));
    }
}

record! {
    /// A cuboid.
    pub struct Cuboid {
        /// Extents along x, y and z.
        required size_m: Placed<[f64; 3]> = vector::<3>(number("m").above(0.0));
    }
}

record! {
    /// A sphere.
    pub struct Sphere {
        /// Radius.
        required radius_m: Placed<f64> = number("m").above(0.0);
    }
}

record! {
    /// A disc.
    pub struct Disc {
        /// Radius.
        required radius_m: Placed<f64> = number("m").above(0.0);
    }
}
