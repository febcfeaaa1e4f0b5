//! The part of surroundings that is worth sampling: bright patches, which scattered rays rarely hit.

/// Minimum radiance of a bright patch over the mean of all directions.
const MIN_BRIGHT_RATIO: f64 = 8.0;

pub(super) struct EnvironmentCell {
    pub(super) weight: f64,
    pub(super) solid_angle: f64,
}

/// Fraction of light that comes from bright patches beyond [`MIN_BRIGHT_RATIO`] times the mean. The weight of a cell is proportional to radiance and
/// solid angle; its solid angle is in units of the whole sphere.
pub(super) fn patches(cells: impl Iterator<Item = EnvironmentCell> + Clone) -> f64 {
    let all: f64 = cells.clone().map(|cell| cell.weight).sum();
    cells.map(|cell| (cell.weight - MIN_BRIGHT_RATIO * all * cell.solid_angle).max(0.0)).sum::<f64>() / all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lights::{Environment, ImageEnvironment};
    use etendue_core::WavelengthRange;

    #[test]
    fn patches_are_what_is_beyond_eight_times_the_mean() {
        let sphere = |weights: [f64; 4], fractions: [f64; 4]| {
            let cell = |(weight, solid_angle)| EnvironmentCell { weight, solid_angle };
            patches(weights.into_iter().zip(fractions).map(cell))
        };
        assert_eq!(sphere([1.0, 1.0, 1.0, 1.0], [0.25; 4]), 0.0);
        // Half the sphere dark, and a fortieth of it forty times as bright as the rest.
        let (fractions, bright) = ([0.5, 0.475, 0.0125, 0.0125], 0.5 / 0.975);
        let weights = [0.0, 0.475, 0.25, 0.25];
        assert!((sphere(weights, fractions) - (bright - 8.0 * 0.025)).abs() < 1e-12);
    }

    /// Surroundings without suns are sampled by all their light; next to suns, by their patches and the part beyond the suns' irradiance.
    #[test]
    fn surroundings_are_sampled_by_what_suns_and_scattered_rays_leave() {
        let mut texels = vec![[1.0; 3]; 64 * 32];
        let image = |texels: Vec<[f32; 3]>| {
            Environment::Image(ImageEnvironment::new(64, 32, texels, 1.0, 0.0).expect("a picture"))
        };
        let sampled = |surroundings: &Environment, of_suns: f64| {
            surroundings.sampled_irradiance(WavelengthRange { low_nm: 400.0, high_nm: 700.0 }, of_suns)
        };
        let even = image(texels.clone());
        let all = sampled(&even, 0.0);
        assert!(all > 0.0 && (sampled(&even, 0.75 * all) / all - 0.25).abs() < 1e-6 && sampled(&even, all) == 0.0);
        texels[8 * 64 + 20] = [3000.0; 3];
        let patchy = image(texels);
        let all = sampled(&patchy, 0.0);
        let patches = sampled(&patchy, all) / all;
        // The texel has 1.0e-3 of the sphere and thus half of the light; eight times the mean is subtracted from it.
        assert!(patches > 0.4 && patches < 0.6, "{patches}");
        assert!((sampled(&patchy, 0.1 * all) / all - 0.9).abs() < 1e-6);
    }
}
