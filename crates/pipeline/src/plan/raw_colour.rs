//! Colour metadata of a sensor for raw converters.
//!
//! The matrix from XYZ to the camera's colours is the least-squares fit C ≈ M X over the patches of the colour chart under D65, C the camera's responses and
//! X the tristimulus values. The camera's neutral is its responses to D65, with maximum 1. Raw converters scale M themselves so that neutral is neutral.

use etendue_sensor::Sensor;
use etendue_spectra::{Spectrum, illuminant, observer, reflectance};
use glam::{DMat3, DVec3};

/// Colour metadata of a raw.
#[derive(Clone, Debug, PartialEq)]
pub struct RawColour {
    /// Columns of the filter tile, and its colours row by row: 0 red, 1 green, 2 blue; `None` for a monochrome sensor.
    pub tile: Option<(usize, Vec<usize>)>,
    /// Matrix from XYZ to the camera's colours, by rows.
    pub xyz_to_camera: [[f64; 3]; 3],
    /// Camera colours of neutral under D65, with maximum 1.
    pub neutral: [f64; 3],
}

impl RawColour {
    /// Metadata of a sensor of one channel, or of red, green and blue; `None` for others.
    #[must_use]
    pub fn new(sensor: &Sensor) -> Option<Self> {
        let p = sensor.parameters();
        let names: Vec<&str> = p.channels.iter().map(|c| c.name.as_str()).collect();
        match names.as_slice() {
            [_] => Some(Self { tile: None, xyz_to_camera: DMat3::IDENTITY.to_cols_array_2d(), neutral: [1.0; 3] }),
            ["red", "green", "blue"] => {
                let measured = sensor.image_responsivities();
                let channels = [0, 1, 2].map(|c| &measured[c]);
                let white = DVec3::from_array(channels.map(|c| response(c, None)));
                let scale = 1.0 / white.max_element();
                Some(Self {
                    tile: Some((p.cfa.width(), p.cfa.channels().to_vec())),
                    xyz_to_camera: fitted(channels, scale)?,
                    neutral: (white * scale).to_array(),
                })
            }
            _ => None,
        }
    }
}

/// M = (Σ c xᵀ)(Σ x xᵀ)⁻¹, by rows.
fn fitted(channels: [&Spectrum; 3], scale: f64) -> Option<[[f64; 3]; 3]> {
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    let (mut cx, mut xx) = (DMat3::ZERO, DMat3::ZERO);
    for patch in reflectance::colorchecker() {
        let camera = DVec3::from_array(channels.map(|c| scale * response(c, Some(&patch.reflectance))));
        let light = illuminant::d65().product(&patch.reflectance);
        let xyz = DVec3::from_array(observer::xyz(&light)) / observer::xyz(illuminant::d65())[1];
        cx += outer(camera, xyz);
        xx += outer(xyz, xyz);
    }
    let matrix = cx * xx.inverse();
    matrix.is_finite().then(|| matrix.transpose().to_cols_array_2d())
}

/// Response to D65, directly or reflected.
fn response(channel: &Spectrum, reflectance: Option<&Spectrum>) -> f64 {
    let light = channel.product(illuminant::d65());
    reflectance.map_or(light.clone(), |r| light.product(r)).integral(300.0, 1100.0)
}
