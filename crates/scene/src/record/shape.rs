//! Shapes without a file.

use crate::place::Placed;
use crate::reader::{number, record, variants, vector};

variants! {
    /// A shape in the frame of its object.
    pub enum Shape by "type" {
        /// A rectangle in the plane z = 0, centred, with its front towards +z; u runs along x and v along y, 0 … 1.
        "quad" => Quad(Quad),
        /// A cuboid, centred, with its faces outward; every face has u, v = 0 … 1.
        "box" => Box(Cuboid),
        /// A sphere about the origin.
        "sphere" => Sphere(Sphere),
        /// A disc in the plane z = 0, centred, with its front towards +z: a regular polygon of 256 sides and equal area; u runs along x and v along
        /// y, 0 … 1 over its diameter.
        "disc" => Disc(Disc),
    }
}

record! {
    /// A rectangle.
    pub struct Quad {
        /// Extents along x and y, m, above 0.
        required size_m: Placed<[f64; 2]> = vector::<2>(number("m").above(0.0));
    }
}

record! {
    /// A cuboid.
    pub struct Cuboid {
        /// Extents along x, y and z, m, above 0.
        required size_m: Placed<[f64; 3]> = vector::<3>(number("m").above(0.0));
    }
}

record! {
    /// A sphere.
    pub struct Sphere {
        /// Radius, m, above 0.
        required radius_m: Placed<f64> = number("m").above(0.0);
    }
}

record! {
    /// A disc.
    pub struct Disc {
        /// Radius, m, above 0.
        required radius_m: Placed<f64> = number("m").above(0.0);
    }
}
