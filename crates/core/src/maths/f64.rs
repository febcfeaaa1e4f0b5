//! Functions of one `f64`.
#![allow(missing_docs)]

#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

#[must_use]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

#[must_use]
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}

#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

#[must_use]
pub fn exp2(x: f64) -> f64 {
    libm::exp2(x)
}

#[must_use]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

#[must_use]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

#[must_use]
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

#[must_use]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

#[must_use]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}
