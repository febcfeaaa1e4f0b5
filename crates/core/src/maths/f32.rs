//! Functions of one `f32`.
#![allow(missing_docs)]

#[must_use]
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

#[must_use]
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

#[must_use]
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

#[must_use]
pub fn asin(x: f32) -> f32 {
    libm::asinf(x)
}

#[must_use]
pub fn acos(x: f32) -> f32 {
    libm::acosf(x)
}

#[must_use]
pub fn atan(x: f32) -> f32 {
    libm::atanf(x)
}

#[must_use]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

#[must_use]
pub fn exp2(x: f32) -> f32 {
    libm::exp2f(x)
}

#[must_use]
pub fn exp_m1(x: f32) -> f32 {
    libm::expm1f(x)
}

#[must_use]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

#[must_use]
pub fn ln_1p(x: f32) -> f32 {
    libm::log1pf(x)
}

#[must_use]
pub fn log2(x: f32) -> f32 {
    libm::log2f(x)
}

#[must_use]
pub fn log10(x: f32) -> f32 {
    libm::log10f(x)
}

#[must_use]
pub fn cbrt(x: f32) -> f32 {
    libm::cbrtf(x)
}

#[must_use]
pub fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

#[must_use]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

#[must_use]
pub fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

#[must_use]
pub fn hypot(x: f32, y: f32) -> f32 {
    libm::hypotf(x, y)
}
