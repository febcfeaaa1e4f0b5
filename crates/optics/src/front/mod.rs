//! Optics attached to the camera in front of the lens: dirt, and a windscreen or a mirror.
//!
//! # Contract
//!
//! - A lens generates a ray. The front propagates it outwards, against the light, all in f64 and in the camera frame (x right, y down, z forward,
//!   origin at the centre of the entrance pupil). The result is a [`FrontRay`].
//! - Radiance in air is constant along rays. A member therefore changes only a ray's line and, by its losses, its weight: the mean over pupil samples
//!   of weight × radiance stays the irradiance of the sensor point.
//! - A ray that misses a member is unchanged.
//! - A member that must choose ([`Windscreen`]: direct light or light after two reflections) uses part of the pupil sample and rescales the rest to
//!   the whole square; weights are divided by the probability of the choice.
//! - The order of members is dirt, then windscreen (with drops on its outer face) or mirror. A windscreen together with a mirror is not modelled.

mod dirt;
mod drops;
mod mirror;
mod placement;
mod windscreen;

use etendue_core::ray::PupilRay;
use etendue_projection::Raster;
use glam::{DVec2, DVec3};

use crate::{lens::Lens, overlap::PRINCIPAL_NM, pupil::MM};
use placement::{line, outgoing};
use windscreen::LightPath;

pub use crate::error::FrontError;
pub use dirt::{Dirt, DirtParameters, Mask};
pub use drops::{Cap, Course, Droplet, Drops, DropsParameters, Sliding, Wiper};
pub use mirror::{MeshMirror, Mirror, MirrorParameters, MirrorShape, Quadric, QuadricKind, Reflectance};
pub use placement::{Curve, FrontRay, Placement};
pub use windscreen::{Layer, Tint, Windscreen, WindscreenParameters};

pub(crate) use placement::{MemberRay, RayOutcome};

/// Optics in front of a lens.
#[derive(Clone, Debug, PartialEq)]
pub struct Front {
    dirt: Option<Dirt>,
    optic: Option<Optic>,
}

/// The ray-bending members: the closed list.
#[derive(Clone, Debug, PartialEq)]
pub enum Optic {
    /// Glass in the view of the camera.
    Windscreen(Box<Windscreen>),
    /// A mirror in the view of the camera.
    Mirror(Box<Mirror>),
}

impl Optic {
    /// Name in words.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Windscreen(_) => "windscreen",
            Self::Mirror(_) => "mirror",
        }
    }
}

impl Front {
    /// Combines the members in front of a lens; `None` if there are none.
    #[must_use]
    pub fn new(dirt: Option<Dirt>, optic: Option<Optic>) -> Option<Self> {
        (dirt.is_some() || optic.is_some()).then_some(Self { dirt, optic })
    }

    /// The dirt, if any.
    #[must_use]
    pub fn dirt(&self) -> Option<&Dirt> {
        self.dirt.as_ref()
    }

    /// The windscreen or mirror, if any.
    #[must_use]
    pub fn optic(&self) -> Option<&Optic> {
        self.optic.as_ref()
    }

    /// Change of its drops over time; `None` if there is none.
    #[must_use]
    pub fn course(&self) -> Option<&Course> {
        match &self.optic {
            Some(Optic::Windscreen(glass)) => glass.drops()?.parameters().course.as_ref(),
            _ => None,
        }
    }

    /// The same front at a time, s of simulated time; `down` is the direction of gravity in the camera frame.
    #[must_use]
    pub fn at(&self, time_s: f64, down: DVec3) -> Self {
        match &self.optic {
            Some(Optic::Windscreen(glass)) => {
                Self { dirt: self.dirt.clone(), optic: Some(Optic::Windscreen(Box::new(glass.at(time_s, down)))) }
            }
            _ => self.clone(),
        }
    }

    /// The ray of a sensor point (mm) through a lens and this front, as [`Lens::ray`].
    #[must_use]
    pub fn ray(&self, lens: &Lens, sensor_mm: DVec2, pupil: DVec2, wavelength_nm: f64) -> Option<FrontRay> {
        let Some(Optic::Windscreen(glass)) = &self.optic else {
            let ray = self.through_dirt(lens.ray(sensor_mm, pupil, wavelength_nm)?)?;
            return self.through_optic(ray, wavelength_nm);
        };
        let (direction, u, inverse) = glass.choose(pupil.x);
        let mut ray = self.through_dirt(lens.ray(sensor_mm, DVec2::new(u, pupil.y), wavelength_nm)?)?;
        ray.weight_sr *= inverse;
        let outcome = glass.through_wet(line(&ray), wavelength_nm, direction);
        beyond(outcome, ray, direction)
    }

    /// The ground-truth ray, as [`Lens::truth_ray`], and whether it is off the pupil's centre.
    #[must_use]
    pub fn truth_ray(&self, lens: &Lens, sensor_mm: DVec2) -> Option<(FrontRay, bool)> {
        let truth = lens.truth_ray(sensor_mm)?;
        Some((self.through_optic(truth.ray, PRINCIPAL_NM)?, truth.off_centre))
    }

    /// True if a ray or its weight depends on the wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        match &self.optic {
            None => false,
            Some(Optic::Windscreen(glass)) => glass.disperses(),
            Some(Optic::Mirror(mirror)) => mirror.reflectance().varies(),
        }
    }

    /// Refuses a front that does not fit the camera's view.
    ///
    /// # Errors
    /// If the image sees nothing of a mirror, or sees its back; if a windscreen is not in front of the lens.
    pub fn check(&self, lens: &Lens, raster: &Raster) -> Result<(), FrontError> {
        let sights = sensor_points(raster).filter_map(|s_mm| lens.truth_ray(s_mm));
        let lines: Vec<MemberRay> = sights.map(|truth| line(&truth.ray)).collect();
        // Rays through a prescription start at its first surface, before the entrance pupil.
        let rays = self::sensor_points(raster).filter_map(|s_mm| lens.ray(s_mm, DVec2::splat(0.5), PRINCIPAL_NM));
        let starts: Vec<MemberRay> = rays.map(|ray| line(&ray)).collect();
        if self.dirt.as_ref().is_some_and(|dirt| !starts.iter().all(|start| dirt.is_after(*start))) {
            return Err(FrontError::DirtInLens);
        }
        match &self.optic {
            None => Ok(()),
            Some(Optic::Windscreen(glass)) => {
                let radius_mm = lens.entrance_pupil_radius_m() / MM;
                let discs = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y].map(|side| side * radius_mm);
                let all = lines.iter().chain(&starts);
                let points: Vec<DVec3> = all.map(|line| line.point_mm).chain(discs).collect();
                glass.check(&points, &lines)
            }
            Some(Optic::Mirror(mirror)) => mirror.check(&lines).and_then(|()| mirror.check(&starts)),
        }
    }

    /// A ray attenuated by the dirt; `None` if nothing is left.
    fn through_dirt(&self, ray: PupilRay) -> Option<PupilRay> {
        let Some(dirt) = &self.dirt else { return Some(ray) };
        let weight_sr = ray.weight_sr * dirt.transmittance_along(line(&ray));
        (weight_sr > 0.0).then_some(PupilRay { weight_sr, ..ray })
    }

    /// The ray for ground truth and for uses without a choice. It ignores drops.
    fn through_optic(&self, ray: PupilRay, nm: f64) -> Option<FrontRay> {
        match &self.optic {
            None => Some(FrontRay::without_front(ray)),
            Some(Optic::Windscreen(glass)) => {
                beyond(glass.through(line(&ray), nm, LightPath::Direct), ray, LightPath::Direct)
            }
            Some(Optic::Mirror(mirror)) => reflected(mirror, ray, nm),
        }
    }
}

/// A ray beyond glass, by its fate there. Its distances count from its point nearest to where it left the lens.
fn beyond(outcome: RayOutcome, ray: PupilRay, direction: LightPath) -> Option<FrontRay> {
    let from = line(&ray);
    match outcome {
        // Past the glass, only direct light arrives.
        RayOutcome::Missed => (direction == LightPath::Direct).then(|| FrontRay::without_front(ray)),
        RayOutcome::Absorbed => None,
        RayOutcome::Transmitted(to, fraction) => {
            let path_m = (to.point_mm - from.point_mm).dot(to.direction) * MM;
            Some(FrontRay { ray: outgoing(to, ray.weight_sr * fraction), path_m, mirror_m: None })
        }
    }
}

fn reflected(mirror: &Mirror, ray: PupilRay, nm: f64) -> Option<FrontRay> {
    let from = line(&ray);
    match mirror.reflect(from, nm) {
        RayOutcome::Missed => Some(FrontRay::without_front(ray)),
        RayOutcome::Absorbed => None,
        RayOutcome::Transmitted(to, fraction) => {
            let ray = outgoing(to, ray.weight_sr * fraction);
            let path_m = (to.point_mm - from.point_mm).length() * MM;
            Some(FrontRay { ray, path_m, mirror_m: Some(ray.origin_m) })
        }
    }
}

/// Points of the image, edges included, at which a front is checked.
fn sensor_points(raster: &Raster) -> impl Iterator<Item = DVec2> {
    const SIDE: u32 = 48;
    let size = DVec2::new(raster.width() as f64, raster.height() as f64);
    let raster = *raster;
    let at = |i: u32| f64::from(i) / f64::from(SIDE);
    (0..=SIDE).flat_map(move |y| (0..=SIDE).map(move |x| raster.sensor_mm(size * DVec2::new(at(x), at(y)))))
}
