//! Errors of a prescription.

/// A prescription that is invalid, or cannot be focused as requested. Surfaces are counted from 1 at the scene, as in lens files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PrescriptionError {
    /// A prescription without surfaces.
    #[error("the prescription has no surface; give at least one refracting surface and a stop")]
    Empty,
    /// A number of stops other than one.
    #[error("{count} surfaces are the stop; exactly one must be: set `stop = true` at one of them")]
    Stops {
        /// Number of stops.
        count: usize,
    },
    /// An invalid number of a surface.
    #[error("surface {surface}: {name} is {value}; {expected}")]
    Number {
        surface: usize,
        /// The key.
        name: &'static str,
        value: f64,
        /// The legal range.
        expected: &'static str,
    },
    /// A clear aperture larger than the surface.
    #[error(
        "surface {surface}: semi_aperture_mm is {semi_aperture_mm} but the surface ends at its equator before that; make it smaller than the radius of curvature"
    )]
    Equator {
        surface: usize,
        /// Its clear semi-aperture, mm.
        semi_aperture_mm: f64,
    },
    /// Two surfaces that cross.
    #[error(
        "surfaces {first} and {second} overlap: {height_mm:.4} mm from the axis, inside both clear apertures, the second lies {overlap_mm:.6} mm before the first; reduce an aperture or enlarge the thickness"
    )]
    Overlap {
        /// The one nearer to the scene.
        first: usize,
        /// The next refracting one.
        second: usize,
        /// Distance from the axis, mm.
        height_mm: f64,
        /// Distance of the second surface before the first, mm.
        overlap_mm: f64,
    },
    /// A wavelength outside the modelled range.
    #[error("the reference wavelength is {nm} nm; it must be from 300 to 1100 nm")]
    Wavelength {
        /// The wavelength, nm.
        nm: f64,
    },
    /// More glasses than the tracer's table holds.
    #[error("the prescription has {count} different media; at most {most} are possible")]
    Media {
        /// Number of glasses.
        count: usize,
        /// The limit.
        most: usize,
    },
    /// A sensor that is not in air.
    #[error(
        "the medium behind the last surface is glass, but the sensor is in air: add the last surface of the glass (a plane for a cover glass)"
    )]
    LastMedium,
    /// A lens without a real image.
    #[error(
        "the prescription has a focal length of {focal_length_mm} mm and no real image of a distant scene, which a sensor needs"
    )]
    NoImage {
        /// Focal length at the reference wavelength, mm.
        focal_length_mm: f64,
    },
    /// A sensor inside the lens.
    #[error(
        "the paraxial image is {distance_mm:.6} mm behind the last surface; the distance must be positive, since the sensor is placed there"
    )]
    ImageInside {
        /// Distance of the image from the last vertex, mm.
        distance_mm: f64,
    },
    /// A pupil at infinity.
    #[error(
        "the entrance pupil is at infinity (the stop is in the front group's focal plane): an object-side telecentric lens is not modelled"
    )]
    Telecentric,
    /// Total reflection in the axial bundle.
    #[error(
        "surface {surface} totally reflects rays of the axial bundle (which cross the stop about {height_mm:.4} mm from its centre): check the radii and glasses, or stop down"
    )]
    TotalReflection {
        surface: usize,
        /// Height at the stop, mm.
        height_mm: f64,
    },
    /// A surface other than the stop that limits the axial bundle.
    #[error(
        "surface {surface} clips the axial bundle (rays that cross the stop about {height_mm:.4} mm from its centre; it opens to {stop_mm} mm): it would be the stop; enlarge its aperture or stop down"
    )]
    NotTheStop {
        /// The surface that clips.
        surface: usize,
        /// Height at the stop, mm.
        height_mm: f64,
        /// The stop's semi-aperture, mm.
        stop_mm: f64,
    },
    /// An obscuration as large as the axial bundle.
    #[error("surface {surface} obscures the whole axial bundle; reduce its obscured radius (obscured_radius_mm)")]
    Blocked {
        /// The surface.
        surface: usize,
    },
    /// An f-number beyond the opening of the stop.
    #[error(
        "f_number {f_number} needs a stop of {needed_mm:.4} mm semi-aperture, but it opens to {open_mm} mm (f/{least:.3})"
    )]
    TooFast {
        /// The requested f-number.
        f_number: f64,
        /// The semi-aperture it needs, mm.
        needed_mm: f64,
        /// The available semi-aperture, mm.
        open_mm: f64,
        /// The f-number fully open.
        least: f64,
    },
    /// A cone of light that no point of the object emits.
    #[error(
        "the aperture requires a cone of half-angle sine {sine:.4} from an object {distance_m} m in front of the entrance pupil; the sine must be \
         below 1, and the object in front of the pupil"
    )]
    Cone {
        /// Sine of its half angle at the object.
        sine: f64,
        /// Distance of the object from the entrance pupil, m.
        distance_m: f64,
    },
    /// An invalid focus distance.
    #[error("the focus distance is {focus_m} m; it must be positive or infinity")]
    FocusDistance {
        /// The distance, m.
        focus_m: f64,
    },
    /// An invalid focusing group.
    #[error(
        "the focusing group {first} to {last} is invalid; expected a range of the {count} surfaces, counted from 1, that begins and ends in air"
    )]
    Group {
        /// Its first surface.
        first: usize,
        /// Its last surface.
        last: usize,
        /// Number of surfaces.
        count: usize,
    },
    /// A focusing group without enough travel.
    #[error(
        "moving surfaces {first} to {last} within their available travel ({low_mm:.4} to {high_mm:.4} mm) does not focus the lens at {focus_m} m"
    )]
    GroupRange {
        /// Its first surface.
        first: usize,
        /// Its last surface.
        last: usize,
        /// Maximum travel towards the scene (negative), mm.
        low_mm: f64,
        /// Maximum travel towards the sensor, mm.
        high_mm: f64,
        /// The focus distance, m.
        focus_m: f64,
    },
    /// A sensor without light.
    #[error(
        "no ray from the middle of the sensor passes through the lens at {nm} nm: check glasses, radii and clear apertures"
    )]
    Dark {
        /// The wavelength, nm.
        nm: f64,
    },
}

impl PrescriptionError {
    /// The surface (from 1) concerned, if any.
    #[must_use]
    pub fn surface(&self) -> Option<usize> {
        match *self {
            Self::Number { surface, .. }
            | Self::Equator { surface, .. }
            | Self::TotalReflection { surface, .. }
            | Self::NotTheStop { surface, .. }
            | Self::Blocked { surface } => Some(surface),
            Self::Overlap { second, .. } => Some(second),
            _ => None,
        }
    }
}
