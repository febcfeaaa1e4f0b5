//! What a ray finds.

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where, in lengths of the ray's direction.
    pub t: f32,
    /// Index of the instance in the world.
    pub instance: u32,
    /// Primitive within the instance's shape: the triangle, or 0 for a sphere.
    pub primitive: u32,
    /// Barycentric weight of the triangle's vertex 1.
    pub u: f32,
    /// Barycentric weight of the triangle's vertex 2.
    pub v: f32,
}
