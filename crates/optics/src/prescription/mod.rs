//! Prescriptions: lenses described surface by surface, as published by their designers, and traced in double precision.
//!
//! **Modelled**: refraction by Snell's law at spheres, conics, even aspheres and planes; mirrors of these shapes; thin lenses without aberrations; a
//! real stop, real clear apertures and central obscurations; dispersion of every glass; losses by reflection; focusing by moving the sensor or a group
//! of surfaces. A wavelength that is totally reflected, misses a surface, falls outside a clear aperture or inside an obscuration is blocked.
//!
//! Surfaces are numbered in the order in which light meets them. Mirrors are unfolded ([`surface`]), and other parts of a folded lens stop no light
//! but where a surface states an obscured radius. An erect image (of a negative focal length) is turned like the inverted one, so that both show the
//! scene upright.
//!
//! **Left out**: absorption in glass, light that is reflected twice (see [`ghost`]: a separate layer) or more, scatter, diffraction, tilts and
//! decentres.
//!
//! A [`Prescription`] is checked at construction; afterwards only individual rays can fail.

mod check;
pub mod clear_apertures;
pub mod coating;
mod focus;
pub mod ghost;
pub(crate) mod indices;
pub mod paraxial;
pub mod published;
pub mod surface;
pub mod trace;

use glam::DVec3;

use crate::overlap::PRINCIPAL_NM;
use indices::{IndexTable, Media};
use paraxial::{AxialOpening, Paraxial};
use trace::{
    ApertureFillingVisitor, ApertureTest, Element, LensRay, RayLoss, TransmittanceVisitor, TravelDirection, walk,
};

pub use crate::error::PrescriptionError;
pub use focus::Focus;
pub use paraxial::AxialClipping;
pub use surface::{Surface, SurfaceKind};

/// Parameters of a prescription.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescriptionParameters {
    /// Surfaces, from the scene to the sensor.
    pub surfaces: Vec<Surface>,
    /// Opening of the stop: an f-number at infinity focus, or `None` for the stop's own clear aperture.
    pub f_number: Option<f64>,
    /// Focus and its mechanism.
    pub focus: Focus,
    /// Distance of the sensor behind the paraxial image at the reference wavelength, mm: best focus of an aberrated lens.
    pub defocus_mm: f64,
    /// The wavelength of first-order quantities, of focusing and of the f-number, nm.
    pub reference_nm: f64,
    /// Treatment of a clear aperture other than the stop's that clips the bundle on the axis.
    pub axial_clipping: AxialClipping,
}

impl PrescriptionParameters {
    /// Surfaces as given, in focus at 587.56 nm: fully open, without defocus; a clear aperture that clips before the stop is refused.
    #[must_use]
    pub fn new(surfaces: Vec<Surface>, focus: Focus) -> Self {
        Self {
            surfaces,
            f_number: None,
            focus,
            defocus_mm: 0.0,
            reference_nm: PRINCIPAL_NM,
            axial_clipping: AxialClipping::Refused,
        }
    }
}

/// A focused lens of surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescription {
    surfaces: Vec<Surface>,
    elements: Vec<Element>,
    table: IndexTable,
    stop: usize,
    reference_nm: f64,
    paraxial: Paraxial,
    axial_opening: AxialOpening,
    sensor_position_mm: f64,
    focus_distance_m: f64,
    magnification: f64,
    principal_distance_mm: f64,
}

impl Prescription {
    /// The surfaces after opening and focusing.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Index of the stop surface, from 0.
    #[must_use]
    pub fn stop(&self) -> usize {
        self.stop
    }

    /// The wavelength of [`Self::paraxial`], of focusing and of the f-number, nm: 587.56, or a lens file's primary wavelength.
    #[must_use]
    pub fn reference_nm(&self) -> f64 {
        self.reference_nm
    }

    /// First-order quantities at the reference wavelength.
    #[must_use]
    pub fn paraxial(&self) -> &Paraxial {
        &self.paraxial
    }

    /// First-order quantities at a wavelength.
    #[must_use]
    pub fn paraxial_at(&self, nm: f64) -> Paraxial {
        let paraxial_nm = paraxial::paraxial(&self.elements, self.stop, self.stop_mm(), &self.table.at(nm));
        paraxial_nm.clipped(self.axial_opening.radius_ratio)
    }

    /// The surface other than the stop, from 0, whose clear aperture limits the bundle on the axis; `None` if the stop does.
    #[must_use]
    pub fn axial_limit(&self) -> Option<usize> {
        self.axial_opening.limit
    }

    /// Radius of the bundle on the axis over that passed by the stop alone; 1 if no other clear aperture limits it.
    #[must_use]
    pub fn axial_radius_ratio(&self) -> f64 {
        self.axial_opening.radius_ratio
    }

    /// Radius of the obscured part of the bundle on the axis over that of the bundle; 0 without an obscuration.
    #[must_use]
    pub fn axial_obscured_ratio(&self) -> f64 {
        self.axial_opening.obscured_ratio
    }

    /// True if a surface has an obscured radius.
    pub(crate) fn is_obscured(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.obscured_radius_mm > 0.0)
    }

    /// 1 if the light's image is inverted, as that of most lenses, −1 if it is erect.
    pub(crate) fn inversion(&self) -> f64 {
        self.paraxial.focal_length_mm.signum()
    }

    /// Sensor position in the lens frame: mm from the first vertex.
    #[must_use]
    pub fn sensor_position_mm(&self) -> f64 {
        self.sensor_position_mm
    }

    /// Position of the last vertex in the lens frame, mm.
    #[must_use]
    pub fn last_vertex_mm(&self) -> f64 {
        self.elements.last().map_or(0.0, |element| element.z_mm)
    }

    /// Distance of the plane in focus from the entrance pupil, m; infinite for focus at infinity.
    #[must_use]
    pub fn focus_distance_m(&self) -> f64 {
        self.focus_distance_m
    }

    /// Image size over object size in the plane in focus, positive; 0 at infinity.
    #[must_use]
    pub fn magnification(&self) -> f64 {
        self.magnification
    }

    /// The principal distance c, mm, positive: near the axis a tangent t at the entrance pupil is imaged at c·t on the sensor.
    #[must_use]
    pub fn principal_distance_mm(&self) -> f64 {
        self.principal_distance_mm
    }

    /// Semi-aperture of the stop, mm.
    #[must_use]
    pub fn stop_mm(&self) -> f64 {
        self.surfaces[self.stop].semi_aperture_mm
    }

    /// True if any glass disperses.
    #[must_use]
    pub fn disperses(&self) -> bool {
        self.surfaces.iter().any(|surface| surface.glass.disperses())
    }

    /// Traces a ray from the scene (its direction towards the sensor) to behind the last surface; returns it with the transmittance of the surfaces.
    ///
    /// # Errors
    /// If the ray is lost.
    pub fn to_sensor(&self, ray: LensRay, nm: f64) -> Result<(LensRay, f64), RayLoss> {
        self.through(ray, TravelDirection::ToSensor, nm, ApertureTest::Clip)
    }

    /// Traces a ray from the sensor (its direction towards the scene) to before the first surface; returns it with the transmittance of the surfaces.
    ///
    /// # Errors
    /// If the ray is lost.
    pub fn to_scene(&self, ray: LensRay, nm: f64) -> Result<(LensRay, f64), RayLoss> {
        self.to_scene_tested(ray, nm, ApertureTest::Clip)
    }

    /// The same with another treatment of clear apertures and obscurations.
    #[inline]
    pub(crate) fn to_scene_tested(&self, ray: LensRay, nm: f64, test: ApertureTest) -> Result<(LensRay, f64), RayLoss> {
        self.through(ray, TravelDirection::ToScene, nm, test)
    }

    fn through(
        &self,
        ray: LensRay,
        direction: TravelDirection,
        nm: f64,
        test: ApertureTest,
    ) -> Result<(LensRay, f64), RayLoss> {
        let mut journey = TransmittanceVisitor { nm, test, transmittance: 1.0 };
        let ray = walk(&self.elements, 0, direction, &self.table.at(nm), ray, &mut journey)?;
        Ok((ray, journey.transmittance))
    }

    /// Geometry only: traces a ray from the sensor to before the first surface, clipped or not.
    #[inline]
    pub(crate) fn passes(&self, ray: LensRay, media: &Media, mut test: ApertureTest) -> Result<LensRay, RayLoss> {
        walk(&self.elements, 0, TravelDirection::ToScene, media, ray, &mut test)
    }

    /// Geometry only: traces a ray from the scene to behind the last surface, clipped or not.
    pub(crate) fn arrives(&self, ray: LensRay, media: &Media, mut test: ApertureTest) -> Result<LensRay, RayLoss> {
        walk(&self.elements, 0, TravelDirection::ToSensor, media, ray, &mut test)
    }

    /// Largest ratio of a ray's distance from the axis to the clear aperture's radius over the surfaces on its `way`; above 1 the ray is clipped.
    /// `None` if it misses a surface or is totally reflected.
    pub(crate) fn filling(&self, ray: LensRay, direction: TravelDirection, media: &Media) -> Option<f64> {
        let mut fullness = ApertureFillingVisitor { max_filling: 0.0 };
        walk(&self.elements, 0, direction, media, ray, &mut fullness).ok()?;
        Some(fullness.max_filling.sqrt())
    }

    /// Position of the paraxial image of the plane in focus at a wavelength, mm behind the last vertex.
    #[must_use]
    pub fn image_mm(&self, nm: f64) -> f64 {
        let before = self.focus_distance_m * 1e3 - self.paraxial.entrance_pupil_position_mm;
        paraxial::matrix(&self.elements, &self.media(nm)).image_mm(1.0 / before)
    }

    /// Smallest and largest distance of the last surface's clear aperture from the sensor, mm.
    pub(crate) fn rear_distances_mm(&self) -> [f64; 2] {
        let vertex = self.sensor_position_mm - self.last_vertex_mm();
        let sag_mm = self.surfaces.last().and_then(|s| s.sag_behind(s.semi_aperture_mm)).unwrap_or(0.0);
        [vertex - sag_mm.max(0.0), vertex - sag_mm.min(0.0)]
    }

    /// Distance of the exit pupil before the sensor, mm; infinite for a telecentric lens.
    pub(crate) fn exit_distance_mm(&self) -> f64 {
        self.sensor_position_mm - self.last_vertex_mm() - self.paraxial.exit_pupil_position_mm
    }

    pub(crate) fn media(&self, nm: f64) -> Media {
        self.table.at(nm)
    }

    /// Intersection of a ray from the sensor with the stop's surface, from its vertex, regardless of clear apertures.
    ///
    /// # Errors
    /// If it misses a surface or is totally reflected before.
    pub fn at_stop(&self, ray: LensRay, nm: f64) -> Result<DVec3, RayLoss> {
        self.stop_point(ray, &self.media(nm))
    }

    pub(crate) fn stop_point(&self, ray: LensRay, media: &Media) -> Result<DVec3, RayLoss> {
        let behind = &self.elements[self.stop + 1..];
        let ray = walk(behind, self.stop + 1, TravelDirection::ToScene, media, ray, &mut ApertureTest::Ignore)?;
        self.at_stop_surface(ray, TravelDirection::ToScene)
    }

    /// The same for a ray from the scene.
    pub(crate) fn stop_point_from_scene(&self, ray: LensRay, media: &Media) -> Result<DVec3, RayLoss> {
        let ray =
            walk(&self.elements[..self.stop], 0, TravelDirection::ToSensor, media, ray, &mut ApertureTest::Ignore)?;
        self.at_stop_surface(ray, TravelDirection::ToSensor)
    }

    fn at_stop_surface(&self, ray: LensRay, direction: TravelDirection) -> Result<DVec3, RayLoss> {
        let hit = trace::meet(&self.elements[self.stop], direction, ray);
        hit.map(|h| h.point).map_err(|loss| RayLoss { surface: self.stop, loss })
    }

    /// Transmittance of the coatings on the axis, obscured or not.
    #[must_use]
    pub fn axial_transmittance(&self, nm: f64) -> f64 {
        let axis = LensRay { point: DVec3::new(0.0, 0.0, self.sensor_position_mm), direction: DVec3::NEG_Z };
        self.to_scene_tested(axis, nm, ApertureTest::RimsOnly).map_or(0.0, |(_, transmittance)| transmittance)
    }
}
