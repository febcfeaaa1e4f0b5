//! A street lamp's photometric file: LM-63-2002, type C, made from a formula.
//!
//! A stand-in for a LED luminaire with a lens over every diode. Intensity towards nadir angle γ rises as 1/cos³ γ, which
//! lights a level road evenly, up to a shoulder, and falls off smoothly beyond it; nothing leaves above 85°. Across the
//! road it leans to the street's side. Along the road (C = 0° and 180°) the shoulder lies at 66°, across at 50°.
//!
//! In the lamp's own frame γ = 0° is down, C = 0° along +x, C = 90° along +y, where the arm points.

use crate::random::step;
use core::fmt::Write as _;
use etendue_core::maths::f64 as maths;

/// Luminous flux of the lamp, lm.
pub const FLUX_LM: f64 = 6000.0;

const GAMMA_STEP_DEG: f64 = 2.5;
const C_STEP_DEG: f64 = 15.0;
const GAMMAS: usize = 37;
const PLANES: usize = 25;

/// Relative intensity, any scale.
fn relative(c_deg: f64, gamma_deg: f64) -> f64 {
    let (sin_c, cos_c) = maths::sin_cos(c_deg.to_radians());
    let shoulder = 50.0 + 16.0 * cos_c * cos_c;
    let cos = maths::cos(gamma_deg.min(shoulder).to_radians());
    let lean = 1.0 + 0.55 * sin_c * step(0.0, 50.0, gamma_deg);
    lean * (1.0 - step(shoulder, 85.0, gamma_deg)) / (cos * cos * cos)
}

/// ∫ I dΩ over the grid's own bilinear intensity, by the midpoint rule in fine steps.
fn relative_flux() -> f64 {
    const FINE_STEPS: usize = 720;
    let (d_gamma, d_c) = (90.0 / FINE_STEPS as f64, 360.0 / FINE_STEPS as f64);
    let cells = (0..FINE_STEPS * FINE_STEPS)
        .map(|i| (((i % FINE_STEPS) as f64 + 0.5) * d_gamma, ((i / FINE_STEPS) as f64 + 0.5) * d_c));
    let solid = d_gamma.to_radians() * d_c.to_radians();
    cells.map(|(gamma, c)| bilinear(c, gamma) * maths::sin(gamma.to_radians()) * solid).sum()
}

fn bilinear(c_deg: f64, gamma_deg: f64) -> f64 {
    let (i, j) = ((c_deg / C_STEP_DEG).floor(), (gamma_deg / GAMMA_STEP_DEG).floor());
    let (s, t) = (c_deg / C_STEP_DEG - i, gamma_deg / GAMMA_STEP_DEG - j);
    let at = |di: f64, dj: f64| relative((i + di) * C_STEP_DEG, (j + dj) * GAMMA_STEP_DEG);
    (at(0.0, 0.0) * (1.0 - t) + at(0.0, 1.0) * t) * (1.0 - s) + (at(1.0, 0.0) * (1.0 - t) + at(1.0, 1.0) * t) * s
}

/// The file.
#[must_use]
pub fn ies() -> String {
    let scale = FLUX_LM / relative_flux();
    let mut text = format!(
        "IESNA:LM-63-2002\n[TEST] none: made from a formula by scenes/generator\n[TESTLAB] none\n[ISSUEDATE] 2026-11-21\n\
         [MANUFAC] none\n[LUMINAIRE] stand-in for a LED street lamp\nTILT=NONE\n\
         1 {FLUX_LM} 1 {GAMMAS} {PLANES} 1 2 -0.22 -0.54 0\n1 1 48\n"
    );
    row(&mut text, (0..GAMMAS).map(|j| format!("{}", j as f64 * GAMMA_STEP_DEG)));
    row(&mut text, (0..PLANES).map(|i| format!("{}", i as f64 * C_STEP_DEG)));
    for i in 0..PLANES {
        let candela = |j: usize| relative(i as f64 * C_STEP_DEG, j as f64 * GAMMA_STEP_DEG) * scale;
        row(&mut text, (0..GAMMAS).map(|j| format!("{:.1}", candela(j))));
    }
    text
}

fn row(text: &mut String, numbers: impl Iterator<Item = String>) {
    let words: Vec<String> = numbers.collect();
    for line in words.chunks(12) {
        let _ = writeln!(text, "{}", line.join(" "));
    }
}
