//! Sums of powers of a ray's three numbers.

use super::error::RayTransferError;

/// The highest power that is evaluated.
pub const MAX_POWER: usize = 32;

/// c ρ^a dx^b dy^d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// The coefficient, in the unit of the value over mm^a.
    pub coefficient: f64,
    /// Powers of the height ρ (mm), of dx and of dy.
    pub powers: [u8; 3],
}

/// A polynomial in the height ρ on the input plane (mm) and in the direction's components dx and dy.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polynomial {
    terms: Vec<Term>,
}

impl Polynomial {
    /// The sum of terms.
    ///
    /// # Errors
    /// Where a coefficient is not finite or a power is above [`MAX_POWER`].
    pub fn new(terms: Vec<Term>) -> Result<Self, RayTransferError> {
        let legal = |t: &Term| t.coefficient.is_finite() && t.powers.iter().all(|p| usize::from(*p) <= MAX_POWER);
        if terms.iter().all(legal) { Ok(Self { terms }) } else { Err(RayTransferError::Polynomial) }
    }

    /// A number.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self { terms: vec![Term { coefficient: value, powers: [0; 3] }] }
    }

    #[inline]
    pub(super) fn at(&self, powers: &Powers) -> f64 {
        let value = |t: &Term| t.coefficient * powers.of(0, t) * powers.of(1, t) * powers.of(2, t);
        self.terms.iter().map(value).sum()
    }

    pub(super) fn greatest_power(&self) -> usize {
        self.terms.iter().flat_map(|t| t.powers).max().map_or(0, usize::from)
    }
}

/// Powers of ρ, dx and dy.
pub(super) struct Powers([[f64; MAX_POWER + 1]; 3]);

impl Powers {
    #[inline]
    pub(super) fn new(numbers: [f64; 3], greatest: usize) -> Self {
        Self(numbers.map(|number| {
            let mut powers = [1.0; MAX_POWER + 1];
            (1..=greatest).for_each(|i| powers[i] = powers[i - 1] * number);
            powers
        }))
    }

    #[inline]
    fn of(&self, which: usize, term: &Term) -> f64 {
        self.0[which][usize::from(term.powers[which])]
    }
}
