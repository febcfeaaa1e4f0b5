//! First order: thin bundles near the axis (Gauss 1841), by matrices of height and reduced angle.
//!
//! With ν = n u, a surface of power φ = (n′ − n) c maps (y, ν) to (y, ν − φ y) and a space of thickness t maps it to (y + t ν/n, ν). For the whole
//! lens in air, M = [[A, B], [C, D]]: f = −1/C, the rear focal point at −A/C behind the last vertex, the front one at D/C from the first. The pupils
//! are the stop's images through the surfaces before and behind it. In the unfolded lens a mirror of curvature c has the power −2 n c; a thin lens has
//! its own.

use super::surface::SurfaceKind;
use super::{indices::Media, trace::Element};

/// First-order quantities at one wavelength. Positions in mm along the axis towards the sensor: object-side positions from the first vertex,
/// image-side positions from the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraxial {
    /// Focal length, mm; negative for a lens whose image is erect: it images an intermediate image once more.
    pub focal_length_mm: f64,
    /// Front focal point from the first vertex, mm.
    pub front_focus_mm: f64,
    /// Rear focal point from the last vertex, mm (the back focal distance).
    pub back_focus_mm: f64,
    /// Front principal point from the first vertex, mm; in air also the front nodal point.
    pub front_principal_mm: f64,
    /// Rear principal point from the last vertex, mm; in air also the rear nodal point.
    pub rear_principal_mm: f64,
    /// Entrance pupil from the first vertex, mm.
    pub entrance_pupil_position_mm: f64,
    /// Its radius, mm: that of the bundle on the axis, which a clear aperture other than the stop's may limit.
    pub entrance_radius_mm: f64,
    /// Exit pupil from the last vertex, mm; infinite for an image-side telecentric lens.
    pub exit_pupil_position_mm: f64,
    pub exit_radius_mm: f64,
    /// Radius of the Petzval surface, mm, with the sign convention of lens surfaces: 1/R = −Σ φ/(n n′) with n′ = −n for a mirror; negative if the edges
    /// of the Petzval surface are nearer to the lens than its vertex.
    pub petzval_radius_mm: f64,
}

/// Treatment of a clear aperture other than the stop's that clips the bundle on the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxialClipping {
    /// Refused: that clear aperture would be the stop.
    Refused,
    /// It clips, as edges and baffles in manufacturers' files do: pupils and f-number are those of the remaining bundle, their positions those of the
    /// stop's images.
    Clip,
}

/// The opening of the bundle on the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxialOpening {
    /// Its radius at the entrance pupil over that of the stop's image.
    pub(super) radius_ratio: f64,
    /// The surface whose clear aperture limits it, if that is not the stop.
    pub(super) limit: Option<usize>,
    /// Radius of its obscured part over its own.
    pub(super) obscured_ratio: f64,
}

impl AxialOpening {
    /// Limited by the stop.
    pub(super) const STOP: Self = Self { radius_ratio: 1.0, limit: None, obscured_ratio: 0.0 };
}

impl Paraxial {
    /// |f|/(2 · entrance radius).
    #[must_use]
    pub fn f_number(&self) -> f64 {
        self.focal_length_mm.abs() / (2.0 * self.entrance_radius_mm)
    }

    /// The same for a bundle reduced to a fraction of the pupil radii.
    pub(super) fn clipped(self, fraction: f64) -> Self {
        Self {
            entrance_radius_mm: fraction * self.entrance_radius_mm,
            exit_radius_mm: fraction * self.exit_radius_mm,
            ..self
        }
    }

    /// Exit over entrance diameter.
    #[must_use]
    pub fn pupil_magnification(&self) -> f64 {
        self.exit_radius_mm / self.entrance_radius_mm
    }
}

/// [[a, b], [c, d]].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Matrix {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) c: f64,
    pub(super) d: f64,
}

impl Matrix {
    pub(super) const IDENTITY: Self = Self { a: 1.0, b: 0.0, c: 0.0, d: 1.0 };

    pub(super) fn refracted(self, power: f64) -> Self {
        Self { c: self.c - power * self.a, d: self.d - power * self.b, ..self }
    }

    pub(super) fn moved(self, reduced_mm: f64) -> Self {
        Self { a: self.a + reduced_mm * self.c, b: self.b + reduced_mm * self.d, ..self }
    }

    /// Distance behind the last vertex of the image of an axial point; `inverse` is the inverse of its distance before the first vertex (1/mm; 0 at
    /// infinity).
    pub(super) fn image_mm(&self, inverse: f64) -> f64 {
        -(self.a + self.b * inverse) / (self.c + self.d * inverse)
    }
}

/// Power of a surface, 1/mm.
pub(super) fn power(element: &Element, media: &Media) -> f64 {
    let [before, after] = element.media.map(|i| media[i]);
    match element.kind {
        SurfaceKind::Refracting => (after - before) * element.shape.vertex_curvature(),
        SurfaceKind::Mirror => -2.0 * before * element.shape.vertex_curvature(),
        SurfaceKind::ThinLens { focal_length_mm } => before / focal_length_mm,
    }
}

/// The matrix from before the first of `elements` (at its vertex) to behind the last.
pub(super) fn matrix(elements: &[Element], media: &Media) -> Matrix {
    let mut m = Matrix::IDENTITY;
    for (i, element) in elements.iter().enumerate() {
        if i > 0 {
            m = m.moved((element.z_mm - elements[i - 1].z_mm) / media[element.media[0]]);
        }
        m = m.refracted(power(element, media));
    }
    m
}

/// Position from the first vertex and magnification (stop's radius over the pupil's) of the entrance pupil.
pub(super) fn entrance(elements: &[Element], stop: usize, media: &Media) -> [f64; 2] {
    let front = matrix(&elements[..stop], media);
    let gap_mm = if stop == 0 { 0.0 } else { elements[stop].z_mm - elements[stop - 1].z_mm };
    let m = front.moved(gap_mm / media[elements[stop].media[0]]);
    [m.b / m.a, m.a]
}

/// First-order quantities of a lens in air whose stop is `stop`, of radius `stop_mm`.
pub(super) fn paraxial(elements: &[Element], stop: usize, stop_mm: f64, media: &Media) -> Paraxial {
    let m = matrix(elements, media);
    let focal_length_mm = -1.0 / m.c;
    let [entrance_pupil_position_mm, magnified] = entrance(elements, stop, media);
    // From the stop's plane on; a stop on a refracting surface refracts behind its opening.
    let rear = matrix(&elements[stop..], media);
    let petzval = |e: &Element| {
        let term = power(e, media) / (media[e.media[0]] * media[e.media[1]]);
        if e.kind == SurfaceKind::Mirror { -term } else { term }
    };
    Paraxial {
        focal_length_mm,
        front_focus_mm: m.d / m.c,
        back_focus_mm: -m.a / m.c,
        front_principal_mm: m.d / m.c + focal_length_mm,
        rear_principal_mm: -m.a / m.c - focal_length_mm,
        entrance_pupil_position_mm,
        entrance_radius_mm: stop_mm / magnified.abs(),
        exit_pupil_position_mm: -rear.b / rear.d,
        exit_radius_mm: (stop_mm / rear.d).abs(),
        petzval_radius_mm: -1.0 / elements.iter().map(petzval).sum::<f64>(),
    }
}
