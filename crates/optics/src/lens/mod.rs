//! Lenses.
//!
//! # Contract
//!
//! - All arithmetic is f64. Rays are in the camera frame (x right, y down, z forward, m) whose origin is the centre of the
//!   **entrance pupil**. Sensor points are mm of the erect picture from the principal point.
//! - [`Lens::ray`] makes a ray of a sensor point and a pupil sample; the mean over pupil samples of `weight_sr` × radiance
//!   is the irradiance of the sensor point. `None` means no light by this sample: it counts as zero.
//! - [`Lens::projected_solid_angle_sr`] is the mean of the weights, computed without samples: a closed form, or a quadrature to 1e-9
//!   (through a prescription, whose clear apertures have no closed form, at 587.56 nm and to 1e-5).
//! - [`Lens::principal_ray`] goes through the centre of the pupil (of the real stop) at 587.56 nm, and [`Lens::project`] is
//!   its inverse.
//! - A calibrated camera and a parallel one say their own (`calibrated.rs`, `parallel.rs`).
//! - A radial distortion, where there is one, maps the observed sensor point to the ideal one before the ray is made; the
//!   weight is that of the observed point, where the light arrives. A lateral colour ([`LateralColour`]) acts before it.
//! - f-number, of the paraxial lenses: a flat pupil disc, tan θ′ = 1/2N at infinity focus, so E = π τ L / (1 + 4N²) on the axis. (The pinhole is
//!   the limit of small pupils: π τ L / 4N².)

mod body;
mod calibrated;
mod course;
mod falloff;
mod focus;
mod lateral_colour;
mod measures;
mod pinhole;
mod prescribed;
mod statements;
mod telecentric;
mod thick;
mod thin;

use crate::error::{OpticsError, PRINCIPAL_NM};
use etendue_core::maths::f64::atan2;
use etendue_core::ray::PupilRay;
use etendue_projection::{RadialDistortion, Raster, Rectilinear};
use glam::{DVec2, DVec3};
use std::sync::Arc;

pub use calibrated::{Calibrated, CalibratedParameters, PupilStance};
pub use falloff::Falloff;
pub use lateral_colour::LateralColour;
pub use pinhole::{Pinhole, PinholeParameters};
pub(crate) use prescribed::DIRECTIONS;
pub use prescribed::{FieldReport, ImageReport, LateralShift, LensReport, OtherBundle, Prescribed, Spot};
pub use statements::PupilStatements;
pub use telecentric::{Telecentric, TelecentricParameters};
pub use thick::{ConstantPupil, Rim, Thick, ThickParameters};
pub use thin::{Thin, ThinParameters};

/// A lens: the closed list.
#[derive(Clone, Debug, PartialEq)]
pub enum Lens {
    /// Everything sharp, nominal brightness.
    Pinhole(Pinhole),
    /// One refracting plane, finite pupil.
    Thin(Thin),
    /// Principal planes, pupils and rims.
    Thick(Thick),
    /// Surfaces, glasses, a stop: traced.
    Prescription(Arc<Prescribed>),
    /// Each pixel looks where a projection says.
    Calibrated(Arc<Calibrated>),
    /// Every pixel looks along the axis.
    Telecentric(Telecentric),
}

/// The ray by which ground truth looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthRay {
    /// The ray.
    pub ray: PupilRay,
    /// Whether the chief ray is clipped and this one goes through the centroid of the open part of the pupil instead.
    pub off_centre: bool,
}

/// The same for the paraxial lenses, and what the others do.
macro_rules! each {
    ($self:expr, $lens:ident => $body:expr, $($other:ident($it:pat) => $does:expr),+ $(,)?) => {
        match $self {
            Lens::Pinhole($lens) => $body,
            Lens::Thin($lens) => $body,
            Lens::Thick($lens) => $body,
            $(Lens::$other($it) => $does,)+
        }
    };
}

impl Lens {
    /// A pinhole.
    ///
    /// # Errors
    /// As [`Pinhole::new`].
    pub fn pinhole(parameters: PinholeParameters) -> Result<Self, OpticsError> {
        Pinhole::new(parameters).map(Self::Pinhole)
    }

    /// A thin lens.
    ///
    /// # Errors
    /// As [`Thin::new`].
    pub fn thin(parameters: ThinParameters) -> Result<Self, OpticsError> {
        Thin::new(parameters).map(Self::Thin)
    }

    /// A thick lens.
    ///
    /// # Errors
    /// As [`Thick::new`].
    pub fn thick(parameters: ThickParameters) -> Result<Self, OpticsError> {
        Thick::new(parameters).map(Self::Thick)
    }

    /// A prescription.
    #[must_use]
    pub fn prescription(lens: Prescribed) -> Self {
        Self::Prescription(Arc::new(lens))
    }

    /// A calibrated camera.
    ///
    /// # Errors
    /// As [`Calibrated::new`].
    pub fn calibrated(parameters: CalibratedParameters) -> Result<Self, OpticsError> {
        Calibrated::new(parameters).map(|lens| Self::Calibrated(Arc::new(lens)))
    }

    /// A telecentric camera.
    ///
    /// # Errors
    /// As [`Telecentric::new`].
    pub fn telecentric(parameters: TelecentricParameters) -> Result<Self, OpticsError> {
        Telecentric::new(parameters).map(Self::Telecentric)
    }

    /// The same lens with a radial distortion. A distortion whose radius unit is the focal length is made with
    /// [`Lens::principal_distance_mm`] of the lens without it.
    ///
    /// # Errors
    /// For a prescription, a calibrated and a telecentric camera, which have their own.
    pub fn with_distortion(mut self, distortion: RadialDistortion) -> Result<Self, OpticsError> {
        each!(&mut self,
            lens => lens.body.distortion = Some(distortion),
            Prescription(_) => return Err(OpticsError::OwnDistortion),
            Calibrated(_) => return Err(OpticsError::OwnDistortion),
            Telecentric(_) => return Err(OpticsError::OwnDistortion),
        );
        Ok(self)
    }

    /// The radial distortion that was laid over the lens, where there is one.
    #[must_use]
    pub fn distortion(&self) -> Option<&RadialDistortion> {
        each!(self, lens => lens.body.distortion.as_ref(), Prescription(_) => None, Calibrated(_) => None, Telecentric(_) => None)
    }

    /// The same lens with lateral colour.
    ///
    /// # Errors
    /// For a prescription, which has its own, and a telecentric camera, which has no principal point to be large about.
    pub fn with_lateral_colour(mut self, colour: LateralColour) -> Result<Self, OpticsError> {
        each!(&mut self,
            lens => lens.body.lateral_colour = Some(Arc::new(colour)),
            Prescription(_) => return Err(OpticsError::OwnColour { kind: "prescription" }),
            Calibrated(lens) => Arc::make_mut(lens).lateral_colour = Some(colour),
            Telecentric(_) => return Err(OpticsError::OwnColour { kind: "telecentric camera" }),
        );
        Ok(self)
    }

    /// The lateral colour that was laid over the lens, where there is one.
    #[must_use]
    pub fn lateral_colour(&self) -> Option<&LateralColour> {
        each!(self,
            lens => lens.body.lateral_colour.as_deref(),
            Prescription(_) => None,
            Calibrated(lens) => lens.lateral_colour.as_ref(),
            Telecentric(_) => None,
        )
    }

    /// What the lens is, in words.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Pinhole(_) => "pinhole",
            Self::Thin(_) => "thin lens",
            Self::Thick(_) => "thick lens",
            Self::Prescription(_) => "prescription",
            Self::Calibrated(_) => "calibrated camera",
            Self::Telecentric(_) => "telecentric camera",
        }
    }

    /// Refuses a picture that the lens cannot image.
    ///
    /// # Errors
    /// Where the distortion folds inside the picture or is none of a lens, the picture reaches farther than a lens sees, or
    /// is not that of the calibration.
    pub fn check(&self, raster: &Raster) -> Result<(), OpticsError> {
        if let Self::Calibrated(lens) = self {
            return lens.check(raster);
        }
        let (radius_mm, focal_mm) = (raster.max_radius_mm(), self.principal_distance_mm());
        match (self, self.distortion()) {
            (_, Some(distortion)) => {
                distortion.check(radius_mm)?;
                course::check(radius_mm, focal_mm, &course::ALL, |r| distortion.ideal_radius_mm(r))
            }
            (Self::Pinhole(_) | Self::Thin(_) | Self::Thick(_), None) => course::check(radius_mm, focal_mm, &[], Some),
            _ => Ok(()),
        }
    }

    /// The ray of a sensor point (mm) through a pupil sample in [0, 1)² at a wavelength; `None` where no light comes.
    #[must_use]
    pub fn ray(&self, sensor_mm: DVec2, pupil: DVec2, wavelength_nm: f64) -> Option<PupilRay> {
        each!(self,
            lens => lens.ray(sensor_mm, pupil, wavelength_nm),
            Prescription(lens) => lens.ray(sensor_mm, pupil, wavelength_nm),
            Calibrated(lens) => lens.ray(sensor_mm, pupil, wavelength_nm),
            Telecentric(lens) => Some(lens.principal_ray(sensor_mm)),
        )
    }

    /// The ray of a sensor point through the centre of the entrance pupil, its weight that of the small-pupil limit;
    /// `None` where it is clipped or the sensor point has no image.
    #[must_use]
    pub fn principal_ray(&self, sensor_mm: DVec2) -> Option<PupilRay> {
        each!(self,
            lens => lens.principal_ray(sensor_mm),
            Prescription(lens) => lens.principal_ray(sensor_mm),
            Calibrated(lens) => lens.principal_ray(sensor_mm),
            Telecentric(lens) => Some(lens.principal_ray(sensor_mm)),
        )
    }

    /// The ray by which ground truth looks: the principal ray, or, where that is clipped but light arrives, the ray through
    /// the centroid of the open part of the pupil. `None` where no light comes.
    #[must_use]
    pub fn truth_ray(&self, sensor_mm: DVec2) -> Option<TruthRay> {
        if let Some(ray) = self.principal_ray(sensor_mm) {
            return Some(TruthRay { ray, off_centre: false });
        }
        match self {
            Self::Pinhole(_) | Self::Thin(_) | Self::Calibrated(_) | Self::Telecentric(_) => None,
            Self::Thick(lens) => lens.centroid_ray(sensor_mm).map(|ray| TruthRay { ray, off_centre: true }),
            Self::Prescription(lens) => lens.centroid_ray(sensor_mm).map(|ray| TruthRay { ray, off_centre: true }),
        }
    }

    /// Where a direction of the camera frame (any length) is seen, mm; `None` outside the field, beyond a fold, and for a
    /// telecentric camera, which sees a single direction. Clipping is not looked at.
    #[must_use]
    pub fn project(&self, direction: DVec3) -> Option<DVec2> {
        let ideal_mm = || self.rectilinear().project(direction);
        each!(self,
            lens => lens.body.observed(ideal_mm()?),
            Prescription(lens) => lens.project(direction),
            Calibrated(lens) => lens.project(direction),
            Telecentric(_) => None,
        )
    }

    /// Irradiance of a sensor point per uniform radiance, sr; 0 where no light comes.
    #[must_use]
    pub fn projected_solid_angle_sr(&self, sensor_mm: DVec2) -> f64 {
        each!(self,
            lens => lens.projected_solid_angle_sr(sensor_mm),
            Prescription(lens) => lens.projected_solid_angle_sr(sensor_mm),
            Calibrated(lens) => lens.projected_solid_angle_sr(sensor_mm),
            Telecentric(lens) => lens.principal_ray(sensor_mm).weight_sr,
        )
    }

    /// Whether a ray or its weight depends on the wavelength: glasses that disperse, coatings, a filter, lateral colour. A
    /// sample's ray then serves one wavelength only.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.lateral_colour().is_some() || matches!(self, Self::Prescription(lens) if lens.disperses())
    }

    /// Whether the chief ray of a sensor point depends on the wavelength: lateral colour.
    #[must_use]
    pub fn spreads_colours(&self) -> bool {
        let traced = matches!(self, Self::Prescription(lens) if lens.prescription().disperses());
        traced || self.lateral_colour().is_some()
    }

    /// Focal length, mm; infinite for a telecentric camera.
    #[must_use]
    pub fn focal_length_mm(&self) -> f64 {
        each!(self,
            lens => lens.parameters().focal_length_mm,
            Prescription(lens) => lens.prescription().paraxial().focal_length_mm,
            Calibrated(lens) => lens.focal_length_mm(),
            Telecentric(_) => f64::INFINITY,
        )
    }

    /// f-number at infinity focus (of a telecentric camera: on the sensor's side).
    #[must_use]
    pub fn f_number(&self) -> f64 {
        each!(self,
            lens => lens.parameters().f_number,
            Prescription(lens) => lens.prescription().paraxial().f_number(),
            Calibrated(lens) => lens.parameters().f_number,
            Telecentric(lens) => lens.parameters().f_number,
        )
    }

    /// Transmittance τ.
    #[must_use]
    pub fn transmittance(&self) -> f64 {
        each!(self,
            lens => lens.parameters().transmittance,
            Prescription(lens) => lens.transmittance(),
            Calibrated(lens) => lens.parameters().transmittance,
            Telecentric(lens) => lens.parameters().transmittance,
        )
    }

    /// T-number N/√τ.
    #[must_use]
    pub fn t_number(&self) -> f64 {
        self.f_number() / self.transmittance().sqrt()
    }

    /// Distance of the plane in focus from the entrance pupil, m; `None` where everything is sharp.
    #[must_use]
    pub fn focus_distance_m(&self) -> Option<f64> {
        match self {
            Self::Pinhole(_) | Self::Telecentric(_) => None,
            Self::Calibrated(lens) => lens.parameters().focus_distance_m,
            Self::Thin(lens) => Some(lens.parameters().focus_distance_m),
            Self::Thick(lens) => Some(lens.parameters().focus_distance_m),
            Self::Prescription(lens) => Some(lens.prescription().focus_distance_m()),
        }
    }

    /// The principal distance c, mm: near the axis a tangent t of object space is seen at c·t on the sensor. Infinite for a
    /// telecentric camera.
    #[must_use]
    pub fn principal_distance_mm(&self) -> f64 {
        match self {
            Self::Pinhole(lens) => lens.principal_distance_mm(),
            Self::Thin(lens) => lens.conjugates.principal_distance_mm,
            Self::Thick(lens) => lens.conjugates.principal_distance_mm,
            Self::Prescription(lens) => lens.prescription().principal_distance_mm(),
            Self::Calibrated(lens) => lens.focal_length_mm(),
            Self::Telecentric(_) => f64::INFINITY,
        }
    }

    /// The projection of the lens without its distortion.
    #[must_use]
    pub fn rectilinear(&self) -> Rectilinear {
        Rectilinear { principal_distance_mm: self.principal_distance_mm() }
    }

    /// The angle between the directions seen at two sensor points, rad; `None` where one sees nothing. The horizontal
    /// field of view is that between the middles of the picture's left and right edges.
    #[must_use]
    pub fn angle_between_rad(&self, a_mm: DVec2, b_mm: DVec2) -> Option<f64> {
        let (a, b) = (self.direction(a_mm)?, self.direction(b_mm)?);
        Some(atan2(a.cross(b).length(), a.dot(b)))
    }

    /// Tangents X/Z and Y/Z of the chief ray of a sensor point, clipped or not; `None` beyond the distortion's fold, and
    /// for a ray that looks sideways or back.
    #[must_use]
    pub fn tangent(&self, sensor_mm: DVec2) -> Option<DVec2> {
        let direction = self.direction(sensor_mm)?;
        (direction.z > 0.0).then(|| direction.truncate() / direction.z)
    }

    /// [`Lens::direction`] at a wavelength where a lateral colour is laid over the lens. (A prescription's own is traced ray by
    /// ray; its chief rays are those of 587.56 nm here.)
    #[must_use]
    pub fn direction_at(&self, sensor_mm: DVec2, nm: f64) -> Option<DVec3> {
        each!(self,
            lens => Some((lens.body.ideal_at(sensor_mm, nm)? / self.principal_distance_mm()).extend(1.0)),
            Prescription(lens) => lens.direction(sensor_mm),
            Calibrated(lens) => lens.direction_at(sensor_mm, nm),
            Telecentric(_) => Some(DVec3::Z),
        )
    }

    /// The direction (of any length) of the chief ray of a sensor point, clipped or not; `None` where there is none.
    #[must_use]
    pub fn direction(&self, sensor_mm: DVec2) -> Option<DVec3> {
        self.direction_at(sensor_mm, PRINCIPAL_NM)
    }
}
