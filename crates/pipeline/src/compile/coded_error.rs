//! Error codes of the models' errors.

use super::context::ErrorCode;
use etendue_optics::OpticsError;
use etendue_scene::Problem;
use std::fmt::Display;

/// An error of a model, with its code.
pub(super) trait CodedError: Display {
    fn code(&self) -> ErrorCode;
}

/// Assigns each code to the error types that it covers.
macro_rules! codes {
    ($($Code:ident: $($Error:ty),*;)*) => {
        $($(impl CodedError for $Error {
            fn code(&self) -> ErrorCode {
                ErrorCode::$Code
            }
        })*)*
    };
}

codes! {
    OutOfRange:
        etendue_core::track::TrackError,
        etendue_core::waveform::WaveformError,
        etendue_isp::colour_matrix::MatrixError,
        etendue_isp::DevelopError,
        etendue_isp::paper::FilterError,
        etendue_isp::correction::ShadingError,
        etendue_isp::tone::ToneError,
        etendue_optics::effects::EffectsError,
        etendue_optics::front::FrontError,
        etendue_projection::RasterError,
        etendue_sensor::cfa::CfaError,
        etendue_spectra::glass::GlassError,
        etendue_spectra::sky::SkyError,
        etendue_tracer::accel::WorldError,
        etendue_tracer::lights::ConeError,
        etendue_tracer::lights::LampError,
        etendue_tracer::lights::OpeningError,
        etendue_tracer::lights::SunError,
        etendue_tracer::lights::sun_position::SunPositionError,
        etendue_tracer::materials::BlinnPhongError,
        etendue_tracer::materials::CarPaintError,
        etendue_tracer::materials::ClothError,
        etendue_tracer::materials::LafortuneError,
        etendue_tracer::materials::MarkingError,
        etendue_tracer::materials::MaterialError,
        etendue_tracer::materials::SheetingError,
        etendue_tracer::media::MediumError,
        etendue_tracer::precipitation::SizeLawError;
    UnsuitableFile:
        etendue_spectra::SpectrumError,
        etendue_tracer::geometry::MeshError,
        etendue_tracer::lights::EnvironmentError,
        etendue_tracer::lights::MaskImageError,
        etendue_tracer::lights::PhotometricGridError,
        etendue_tracer::materials::RetroTableError,
        etendue_tracer::media::SolidError,
        etendue_tracer::textures::TextureError;
    UnusableLens:
        etendue_optics::ray_transfer::RayTransferError,
        etendue_projection::CalibrationError,
        etendue_projection::model::ModelError,
        crate::plan::rectified::RectifiedCameraError;
    Degenerate:
        etendue_isp::colour_matrix::FitError,
        etendue_isp::white_balance::NoResponse;
    NotModelled:
        etendue_isp::MosaicError;
}

impl CodedError for OpticsError {
    fn code(&self) -> ErrorCode {
        match self {
            Self::CalibratedSize { .. } => ErrorCode::UnsuitableFile,
            _ => ErrorCode::UnusableLens,
        }
    }
}

impl CodedError for Problem {
    fn code(&self) -> ErrorCode {
        self.code
    }
}
