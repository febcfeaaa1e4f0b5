//! Transcendental functions with the same bits on every machine.
//!
//! `+ − × ÷ sqrt` are exact everywhere and stay with the standard library; what the platform's library computes
//! differently from machine to machine is computed here.

pub mod f32;
pub mod f64;
