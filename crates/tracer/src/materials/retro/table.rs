//! Coefficients of retro-reflection over observation and entrance angle.

use etendue_core::maths::f32::{exp, ln};

/// Value that replaces 0 in a table, cd·lx⁻¹·m⁻²: far below that of a dark diffuse surface.
const MIN_COEFFICIENT: f64 = 1e-4;

/// Value that replaces an observation angle of 0, degrees.
const MIN_DEG: f64 = 0.01;

/// R_A (cd·lx⁻¹·m⁻²) over the observation angle α between the directions to lamp and observer, and the entrance angle β between the
/// direction to the lamp and the normal.
///
/// Between entries ln R_A is linear in ln α and in β: along α it is a power law, as profiles of sheetings nearly are. Exact at entries.
/// Outside, the nearest entry's value holds.
#[derive(Clone, Debug, PartialEq)]
pub struct RetroTable {
    observation_deg: Vec<f64>,
    entrance_deg: Vec<f64>,
    /// ln α, radians.
    ln_observation: Vec<f32>,
    /// β, radians.
    entrance: Vec<f32>,
    /// ln R_A, entrance angles of the first observation angle first.
    ln_values: Vec<f32>,
}

impl RetroTable {
    /// A table of observation angles (0 to 180°, rising), entrance angles (0 to below 90°, rising) and R_A: all entrance angles of the
    /// first observation angle, then of the next.
    ///
    /// # Errors
    /// If a list is empty, out of range or does not rise, or the values are too few, too many or negative.
    pub fn new(observation_deg: &[f64], entrance_deg: &[f64], values: &[f64]) -> Result<Self, RetroTableError> {
        check_angles("observation", observation_deg, 180.0)?;
        check_angles("entrance", entrance_deg, 89.0)?;
        if let Some(deg) = observation_deg.iter().skip(1).find(|a| **a <= MIN_DEG) {
            return Err(RetroTableError::TooFine { deg: *deg });
        }
        let expected = observation_deg.len() * entrance_deg.len();
        if values.len() != expected {
            return Err(RetroTableError::Count { actual: values.len(), expected });
        }
        if let Some(value) = values.iter().find(|v| !(v.is_finite() && **v >= 0.0)) {
            return Err(RetroTableError::Value { value: *value });
        }
        Ok(Self {
            ln_observation: observation_deg.iter().map(|a| ln(a.max(MIN_DEG).to_radians() as f32)).collect(),
            entrance: entrance_deg.iter().map(|b| b.to_radians() as f32).collect(),
            ln_values: values.iter().map(|v| ln(v.max(MIN_COEFFICIENT) as f32)).collect(),
            observation_deg: observation_deg.to_vec(),
            entrance_deg: entrance_deg.to_vec(),
        })
    }

    /// The same with all values times a factor above 0.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let shift = ln(factor as f32);
        Self { ln_values: self.ln_values.iter().map(|v| v + shift).collect(), ..self.clone() }
    }

    /// R_A at an observation and an entrance angle, radians.
    #[must_use]
    pub fn at(&self, observation: f32, entrance: f32) -> f32 {
        let (i, x) = place(&self.ln_observation, ln(observation.max(f32::MIN_POSITIVE)));
        let (j, y) = place(&self.entrance, entrance);
        let along = |i: usize| {
            let row = &self.ln_values[i * self.entrance.len()..];
            if y > 0.0 { row[j] + (row[j + 1] - row[j]) * y } else { row[j] }
        };
        let low = along(i);
        exp(if x > 0.0 { low + (along(i + 1) - low) * x } else { low })
    }

    /// Observation angles, degrees.
    #[must_use]
    pub fn observation_deg(&self) -> &[f64] {
        &self.observation_deg
    }

    /// Entrance angles, degrees.
    #[must_use]
    pub fn entrance_deg(&self) -> &[f64] {
        &self.entrance_deg
    }

    /// Entrance angles, radians.
    pub(super) fn entrance(&self) -> &[f32] {
        &self.entrance
    }

    /// The first and last observation angle, radians.
    pub(super) fn observation_range(&self) -> (f32, f32) {
        let at = |deg: f64| deg.max(MIN_DEG).to_radians() as f32;
        (at(self.observation_deg[0]), at(self.observation_deg[self.observation_deg.len() - 1]))
    }
}

/// The entry at or below `x`, and the fraction of the step from it to the next; 0 at the last.
fn place(entries: &[f32], x: f32) -> (usize, f32) {
    let i = entries.partition_point(|e| *e <= x);
    match i.checked_sub(1) {
        None => (0, 0.0),
        Some(last) if i == entries.len() => (last, 0.0),
        Some(below) => (below, (x - entries[below]) / (entries[i] - entries[below])),
    }
}

fn check_angles(kind: &'static str, angles: &[f64], most_deg: f64) -> Result<(), RetroTableError> {
    if angles.is_empty() {
        return Err(RetroTableError::NoAngles { kind });
    }
    if let Some(deg) = angles.iter().find(|a| !(0.0..=most_deg).contains(*a)) {
        return Err(RetroTableError::Range { kind, deg: *deg, most_deg });
    }
    match angles.windows(2).find(|pair| pair[1] <= pair[0]) {
        Some(pair) => Err(RetroTableError::Order { kind, first: pair[0], second: pair[1] }),
        None => Ok(()),
    }
}

/// Error of a table of retro-reflection.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RetroTableError {
    /// There are no angles.
    #[error("the table has no {kind} angles; give at least one")]
    NoAngles {
        /// Kind of the angles.
        kind: &'static str,
    },
    /// An angle is out of range.
    #[error("an {kind} angle is {deg}°; it must be between 0° and {most_deg}°")]
    Range {
        /// Kind of the angle.
        kind: &'static str,
        /// Value given, degrees.
        deg: f64,
        /// Maximum, degrees.
        most_deg: f64,
    },
    /// Angles do not rise.
    #[error("the {kind} angle {second}° follows {first}°, but angles must increase; sort the table")]
    Order {
        /// Kind of the angles.
        kind: &'static str,
        /// The first of the two, degrees.
        first: f64,
        /// The one after, degrees.
        second: f64,
    },
    /// An observation angle next to 0 is too small.
    #[error("an observation angle of {deg}° follows another, but only the first may be below {MIN_DEG}°; remove it")]
    TooFine {
        /// Value given, degrees.
        deg: f64,
    },
    /// The number of values does not fit the angles.
    #[error("the table has {actual} values, but its angles require {expected}; give one for each pair of angles")]
    Count {
        /// Number of values.
        actual: usize,
        /// Number of pairs of angles.
        expected: usize,
    },
    /// A value is negative or no number.
    #[error("a coefficient is {value} cd/lx/m²; it must be finite and 0 or more")]
    Value {
        /// Value given.
        value: f64,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> RetroTable {
        RetroTable::new(&[0.2, 0.5, 2.0], &[5.0, 30.0], &[70.0, 30.0, 30.0, 15.0, 5.0, 2.5]).expect("a table")
    }

    fn at(table: &RetroTable, observation_deg: f32, entrance_deg: f32) -> f32 {
        table.at(observation_deg.to_radians(), entrance_deg.to_radians())
    }

    #[test]
    fn entries_are_exact_and_between_them_is_a_power_law() {
        let table = table();
        for (a, b, value) in [(0.2, 5.0, 70.0), (0.5, 30.0, 15.0), (2.0, 5.0, 5.0), (2.0, 30.0, 2.5)] {
            // Logarithms in f32: a few units of the last place times ln 70.
            assert!((at(&table, a, b) / value - 1.0).abs() < 3e-6, "{a} {b}: {}", at(&table, a, b));
        }
        assert!((at(&table, 1.0, 5.0) - (30.0_f32 * 5.0).sqrt()).abs() < 1e-4, "half-way by ratio: the geometric mean");
        assert!((at(&table, 0.2, 17.5) - (70.0_f32 * 30.0).sqrt()).abs() < 1e-4);
    }

    #[test]
    fn outside_the_nearest_entry_holds() {
        let table = table();
        for (a, b, value) in [(0.0, 0.0, 70.0), (0.1, 5.0, 70.0), (9.0, 5.0, 5.0), (9.0, 80.0, 2.5), (0.2, 89.0, 30.0)]
        {
            assert!((at(&table, a, b) / value - 1.0).abs() < 3e-6, "{a} {b}");
        }
        assert!((at(&table.scaled(0.5), 0.2, 5.0) - 35.0).abs() < 1e-3);
    }

    #[test]
    fn faulty_tables_are_refused() {
        let of = |a: &[f64], b: &[f64], v: &[f64]| RetroTable::new(a, b, v).expect_err("faulty");
        assert_eq!(of(&[], &[5.0], &[]), RetroTableError::NoAngles { kind: "observation" });
        assert!(matches!(of(&[0.2], &[90.0], &[1.0]), RetroTableError::Range { kind: "entrance", .. }));
        assert!(matches!(of(&[0.5, 0.2], &[5.0], &[1.0, 1.0]), RetroTableError::Order { .. }));
        assert!(matches!(of(&[0.0, 0.005], &[5.0], &[1.0, 1.0]), RetroTableError::TooFine { .. }));
        assert_eq!(of(&[0.2], &[5.0], &[1.0, 2.0]), RetroTableError::Count { actual: 2, expected: 1 });
        assert_eq!(of(&[0.2], &[5.0], &[-1.0]), RetroTableError::Value { value: -1.0 });
    }
}
