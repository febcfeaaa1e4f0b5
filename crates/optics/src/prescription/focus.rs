//! Opening the stop, and focusing at a distance.
//!
//! In focus means: the paraxial image, at the lens's reference wavelength, of the axial point at the focus distance lies on the sensor (plus the
//! defocus that the prescription states). Distances are from the entrance pupil, as for every lens. Moving a group moves the pupil and changes the
//! focal length (focus breathing); the search takes both into account.

use etendue_spectra::glass::Dispersion;

use super::paraxial::{Matrix, Paraxial, entrance, matrix};
use super::trace::{Element, elements};
use super::{indices::Media, surface::Surface};
use crate::error::PrescriptionError;

/// Millimetres in a metre.
const M: f64 = 1e3;

/// Focus of a lens and its mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Focus {
    /// The sensor is at a given distance behind the last vertex.
    Fixed {
        /// The distance, mm.
        back_focus_mm: f64,
    },
    /// The sensor (or the lens as a whole) moves.
    Sensor {
        /// Distance of the plane in focus from the entrance pupil, m; infinity is legal.
        distance_m: f64,
    },
    /// A group of surfaces moves; the sensor stays where the prescription as given images infinity.
    Group {
        /// Distance of the plane in focus from the entrance pupil, m; infinity is legal.
        distance_m: f64,
        /// First surface of the group, from 0.
        first: usize,
        /// Last surface of the group.
        last: usize,
    },
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FocusedLens {
    /// Sensor position without defocus, mm behind the last vertex.
    pub(super) image_mm: f64,
    /// Distance of the plane in focus from the entrance pupil, m.
    pub(super) distance_m: f64,
    /// Image over object size, positive.
    pub(super) magnification: f64,
}

/// First-order quantities for focusing.
struct State {
    matrix: Matrix,
    entrance_mm: f64,
}

impl State {
    fn new(surfaces: &[Surface], stop: usize, places: &[[usize; 2]], media: &Media) -> Self {
        let elements = elements(surfaces, places);
        let [entrance_mm, _] = entrance(&elements, stop, media);
        Self { matrix: matrix(&elements, media), entrance_mm }
    }

    /// Inverse distance of the plane in focus from the first vertex, 1/mm.
    fn inverse(&self, distance_m: f64) -> f64 {
        1.0 / (distance_m * M - self.entrance_mm)
    }

    fn image_mm(&self, distance_m: f64) -> f64 {
        self.matrix.image_mm(self.inverse(distance_m))
    }

    fn magnification(&self, distance_m: f64) -> f64 {
        let inverse = self.inverse(distance_m);
        (inverse / (self.matrix.c + self.matrix.d * inverse)).abs()
    }
}

/// Closes the stop to an f-number; without one, checks that the lens forms an image.
pub(super) fn open(
    surfaces: &mut [Surface],
    stop: usize,
    f_number: Option<f64>,
    places: &[[usize; 2]],
    media: &Media,
) -> Result<(), PrescriptionError> {
    let elements = elements(surfaces, places);
    let m = matrix(&elements, media);
    let focal_length_mm = -1.0 / m.c;
    // A negative focal length belongs to a diverging lens, or to one that images an intermediate image: behind that, the image is erect and real.
    let forms_image = focal_length_mm > 0.0 || -m.a / m.c > 0.0;
    if !(forms_image && focal_length_mm.is_finite()) {
        return Err(PrescriptionError::NoImage { focal_length_mm });
    }
    let focal_length_mm = focal_length_mm.abs();
    let [entrance_mm, magnified] = entrance(&elements, stop, media);
    if !entrance_mm.is_finite() || entrance_mm.abs() > 1e6 * focal_length_mm {
        return Err(PrescriptionError::Telecentric);
    }
    let Some(f_number) = f_number else { return Ok(()) };
    if !(f_number > 0.0 && f_number.is_finite()) {
        let expected = "it must be positive and finite";
        return Err(PrescriptionError::Number { surface: stop + 1, name: "f_number", value: f_number, expected });
    }
    let open_mm = surfaces[stop].semi_aperture_mm;
    let needed_mm = focal_length_mm / (2.0 * f_number) * magnified.abs();
    // Tolerance for a prescription's own rounded f-number, which opens the stop fully.
    if needed_mm > open_mm * 1.001 {
        let minimum = focal_length_mm * magnified.abs() / (2.0 * open_mm);
        return Err(PrescriptionError::TooFast { f_number, needed_mm, open_mm, least: minimum });
    }
    surfaces[stop].semi_aperture_mm = needed_mm.min(open_mm);
    Ok(())
}

/// Focuses the lens; moves `surfaces` if a group moves.
pub(super) fn focused(
    surfaces: &mut [Surface],
    stop: usize,
    focus: Focus,
    places: &[[usize; 2]],
    media: &Media,
) -> Result<FocusedLens, PrescriptionError> {
    match focus {
        Focus::Fixed { back_focus_mm } => {
            let state = State::new(surfaces, stop, places, media);
            let image_mm = behind(back_focus_mm)?;
            let distance_m = conjugate_m(&state, image_mm);
            Ok(FocusedLens { image_mm, distance_m, magnification: state.magnification(distance_m) })
        }
        Focus::Sensor { distance_m } => at(&State::new(surfaces, stop, places, media), legal(distance_m)?),
        Focus::Group { distance_m, first, last } => {
            let sensor_position_mm = behind(State::new(surfaces, stop, places, media).image_mm(f64::INFINITY))?;
            let group = Group::new(surfaces, first, last, sensor_position_mm)?;
            group.solve_group(surfaces, legal(distance_m)?, |s| State::new(s, stop, places, media))
        }
    }
}

fn legal(focus_m: f64) -> Result<f64, PrescriptionError> {
    if focus_m > 0.0 { Ok(focus_m) } else { Err(PrescriptionError::FocusDistance { focus_m }) }
}

fn behind(distance_mm: f64) -> Result<f64, PrescriptionError> {
    let real = distance_mm > 0.0 && distance_mm.is_finite();
    if real { Ok(distance_mm) } else { Err(PrescriptionError::ImageInside { distance_mm }) }
}

fn at(state: &State, distance_m: f64) -> Result<FocusedLens, PrescriptionError> {
    let image_mm = behind(state.image_mm(distance_m))?;
    Ok(FocusedLens { image_mm, distance_m, magnification: state.magnification(distance_m) })
}

/// The distance from the entrance pupil that is sharp on a sensor at `image_mm`: infinity if there is none in front.
fn conjugate_m(state: &State, image_mm: f64) -> f64 {
    let m = state.matrix;
    let inverse = -(m.a + image_mm * m.c) / (m.b + image_mm * m.d);
    let distance_mm = 1.0 / inverse + state.entrance_mm;
    // An image of infinity may be off by rounding.
    if inverse > 1e-12 && distance_mm > 0.0 { distance_mm / M } else { f64::INFINITY }
}

/// Surfaces that move together.
struct Group {
    first: usize,
    last: usize,
    /// Sensor position from the first and from the last vertex as given, mm.
    sensor_position_mm: f64,
    back_mm: f64,
    /// Travel towards the scene and the sensor, mm.
    low_mm: f64,
    high_mm: f64,
    /// The last spaces before and behind the group.
    spaces_mm: [f64; 2],
    /// True if light leaves the group towards the scene: after an odd number of mirrors.
    turns_back: bool,
}

impl Group {
    fn new(surfaces: &[Surface], first: usize, last: usize, back_mm: f64) -> Result<Self, PrescriptionError> {
        let count = surfaces.len();
        let air = |i: usize| surfaces[i].glass == Dispersion::AIR;
        // A group begins and ends in air.
        if first > last || last >= count || (first > 0 && !air(first - 1)) || !air(last) {
            return Err(PrescriptionError::Group { first: first + 1, last: last + 1, count });
        }
        let before = if first == 0 { f64::INFINITY } else { surfaces[first - 1].thickness_mm };
        let after = if last + 1 == count { back_mm } else { surfaces[last].thickness_mm };
        let total: f64 = surfaces[..count - 1].iter().map(|s| s.thickness_mm).sum();
        let low_mm = -before.min(total + back_mm);
        let turns_back = surfaces[first..=last].iter().filter(|s| s.is_mirror()).count() % 2 == 1;
        Ok(Self {
            first,
            last,
            sensor_position_mm: total + back_mm,
            back_mm,
            low_mm,
            high_mm: if turns_back { total + back_mm } else { after },
            spaces_mm: [before, after],
            turns_back,
        })
    }

    /// Moves the group by `shift_mm` along the light that enters it; returns the sensor's distance behind the last vertex.
    fn shift(&self, surfaces: &mut [Surface], shift_mm: f64) -> f64 {
        let count = surfaces.len();
        if self.first > 0 {
            surfaces[self.first - 1].thickness_mm = self.spaces_mm[0] + shift_mm;
        }
        if self.last + 1 < count {
            surfaces[self.last].thickness_mm = self.spaces_mm[1] - if self.turns_back { -shift_mm } else { shift_mm };
        }
        if self.turns_back {
            return self.back_mm + if self.last + 1 == count { shift_mm } else { 0.0 };
        }
        let total: f64 = surfaces[..count - 1].iter().map(|s| s.thickness_mm).sum();
        // The lens frame moves with the first surface.
        let origin = if self.first == 0 { shift_mm } else { 0.0 };
        self.sensor_position_mm - origin - total
    }

    /// The smallest shift that focuses the distance, by scanning outwards and bisection.
    fn solve_group(
        &self,
        surfaces: &mut [Surface],
        focus_m: f64,
        state: impl Fn(&[Surface]) -> State,
    ) -> Result<FocusedLens, PrescriptionError> {
        const STEPS: i32 = 400;
        let mut error = |shift_mm: f64| {
            let back_mm = self.shift(surfaces, shift_mm);
            state(surfaces).image_mm(focus_m) - back_mm
        };
        let start = error(0.0);
        // Fine steps near the start, where most lenses focus, coarse at the ends.
        let reach = |limit: f64, i: i32| limit * (f64::from(i) / f64::from(STEPS)) * (f64::from(i) / f64::from(STEPS));
        let sign_change = (1..=STEPS).flat_map(|i| [(self.low_mm, i), (self.high_mm, i)]).find_map(|(limit, i)| {
            let bracket = [reach(limit, i - 1), reach(limit, i)];
            let ends = bracket.map(&mut error);
            let crosses = ends[0] * ends[1] <= 0.0 && (ends[0] - ends[1]).abs() < 1e3;
            crosses.then_some((bracket, ends))
        });
        let shift_mm = match (start.abs() < 1e-12, sign_change) {
            (true, _) => 0.0,
            (false, Some((bracket, ends))) => bisect(&mut error, bracket, ends),
            (false, None) => {
                let (first, last, low_mm, high_mm) = (self.first + 1, self.last + 1, self.low_mm, self.high_mm);
                return Err(PrescriptionError::GroupRange { first, last, low_mm, high_mm, focus_m });
            }
        };
        let image_mm = behind(self.shift(surfaces, shift_mm))?;
        Ok(FocusedLens { image_mm, distance_m: focus_m, magnification: state(surfaces).magnification(focus_m) })
    }
}

fn bisect(error: &mut impl FnMut(f64) -> f64, bracket: [f64; 2], ends: [f64; 2]) -> f64 {
    let [mut a, mut b] = bracket;
    for _ in 0..80 {
        let middle = 0.5 * (a + b);
        if error(middle) * ends[0] > 0.0 { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}

/// Height on the sensor per tangent at the entrance pupil, mm, positive also for an erect image.
pub(super) fn principal_distance_mm(elements: &[Element], p: &Paraxial, image_mm: f64, media: &Media) -> f64 {
    let m = matrix(elements, media).moved(image_mm);
    (m.b - m.a * p.entrance_pupil_position_mm) * p.focal_length_mm.signum()
}
