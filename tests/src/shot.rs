//! The light of a camera of a job.

use etendue_core::SpectralCube;
use etendue_core::quantity::{Quantity, Variance};
use etendue_pipeline::film::{CubeEstimate, Film};
use etendue_pipeline::photograph::Light;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::pupil_depth::pupil_depth;
use etendue_pipeline::render::{LightRequest, light};
use etendue_pipeline::truth::{GroundTruth, ground_truth};
use etendue_pipeline::{NullObserver, Plan};
use etendue_spectra::observer;
use etendue_stats::EstimatedPlane;
use etendue_tracer::accel::Simd;

/// The light of a camera of a job. Every sample was finite.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The plan.
    pub plan: Plan,
    /// What the camera gathered.
    pub film: Film,
    /// Which camera it is.
    index: usize,
}

impl Shot {
    /// Renders a plan's first camera.
    ///
    /// # Panics
    /// Where a sample is not finite.
    #[must_use]
    pub fn render(plan: Plan) -> Self {
        Self::render_camera(plan, 0)
    }

    /// Renders one of a plan's cameras, counted from 0. Replicates are independent, as for a camera that delivers variance.
    ///
    /// # Panics
    /// Where a sample is not finite, or there is no such camera.
    #[must_use]
    pub fn render_camera(mut plan: Plan, index: usize) -> Self {
        plan.cameras.iter_mut().for_each(|camera| camera.products.variance |= camera.settings.replicates > 1);
        let film = light(&plan, &plan.cameras[index], LightRequest::default(), &NullObserver).expect("nobody cancels");
        assert_eq!(film.not_finite_samples(), 0, "samples that are not finite");
        Self { plan, film, index }
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &CameraPlan {
        &self.plan.cameras[self.index]
    }

    /// The light, sorted by what it is.
    #[must_use]
    pub fn light(&self) -> Light {
        let depth = pupil_depth(&self.plan, self.camera(), 0, Simd::Auto);
        Light::from_film(self.camera(), self.film.clone(), depth.as_ref()).expect("finite light")
    }

    /// Mean electrons of every pixel.
    ///
    /// # Panics
    /// Where the camera has no electronics.
    #[must_use]
    pub fn electrons(&self) -> Vec<f32> {
        self.light().electrons.expect("the camera has electronics").samples().to_vec()
    }

    /// Spectral radiance, all bands one after the other.
    ///
    /// # Panics
    /// Where no cube is kept.
    #[must_use]
    pub fn radiance(&self) -> Samples {
        Samples::from_cube(&self.film.radiance().expect("a cube is kept"), self.film.replicates)
    }

    /// Luminance, cd/m², of every pixel, by the bands that are kept.
    ///
    /// # Panics
    /// Where no cube is kept.
    #[must_use]
    pub fn luminance(&self) -> Vec<f64> {
        let cube = self.film.radiance().expect("a cube is kept").mean;
        let pixels = self.camera().body.raster.width() * self.camera().body.raster.height();
        let bands = |pixel: usize| cube.planes().iter().map(|p| p.samples()[pixel]).collect::<Vec<f32>>();
        (0..pixels).map(|pixel| observer::xyz_of_bands(&bands(pixel), cube.bands())[1]).collect()
    }

    /// Spectral irradiance on the sensor, all bands one after the other.
    ///
    /// # Panics
    /// Where no cube is kept.
    #[must_use]
    pub fn irradiance(&self) -> Samples {
        Samples::from_cube(self.film.cube().expect("a cube is kept"), self.film.replicates)
    }

    /// The ground truth.
    #[must_use]
    pub fn truth(&self) -> GroundTruth {
        ground_truth(&self.plan, self.camera(), 0, Simd::Auto)
    }
}

/// Means and variances of a cube's planes, one band after the other.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Means.
    pub mean: Vec<f32>,
    /// Variances of the means.
    pub variance: Vec<f32>,
    /// Replicates behind each variance.
    pub replicates: u32,
}

impl Samples {
    fn from_cube<Q: Quantity<Sample = f32>>(cube: &CubeEstimate<Q>, replicates: u32) -> Self {
        Self { mean: joined(&cube.mean), variance: joined::<Variance>(&cube.variance), replicates }
    }

    /// As the statistics want it.
    #[must_use]
    pub fn estimate(&self) -> EstimatedPlane<'_> {
        EstimatedPlane {
            mean: &self.mean,
            variance_of_mean: &self.variance,
            replicates: self.replicates,
            correlated_pixels: 1,
        }
    }
}

fn joined<Q: Quantity<Sample = f32>>(cube: &SpectralCube<Q>) -> Vec<f32> {
    cube.planes().iter().flat_map(|plane| plane.samples().iter().copied()).collect()
}
