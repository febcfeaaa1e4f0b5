//! How many lights of each kind there are.

/// What is lit by what: for the plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightCounts {
    /// Emissive triangles.
    pub triangles: usize,
    /// Emissive spheres.
    pub spheres: usize,
    /// Lamps without an opening.
    pub lamps: usize,
    /// Lamps with a luminous opening.
    pub openings: usize,
    /// Suns.
    pub suns: usize,
    /// Whether an environment of one radiance above 0 surrounds the scene.
    pub uniform_environment: bool,
    /// Whether a picture surrounds the scene.
    pub image_environment: bool,
    /// Whether a clear sky surrounds the scene.
    pub sky: bool,
}

impl LightCounts {
    /// Whether nothing gives light.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        let environment = self.uniform_environment || self.image_environment || self.sky;
        self.triangles + self.spheres + self.lamps + self.openings + self.suns == 0 && !environment
    }
}
