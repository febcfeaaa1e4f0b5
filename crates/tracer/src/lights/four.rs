//! Four numbers side by side: small steps without branches, each over all four, which the compiler makes one instruction.

/// What goes side by side.
pub(super) type Four = [f32; 4];

/// Each of the four by its place.
#[inline(always)]
pub(super) fn each(f: impl Fn(usize) -> f32) -> Four {
    [f(0), f(1), f(2), f(3)]
}

/// The greater of two numbers, as one instruction.
#[inline(always)]
pub(super) fn at_least(x: f32, low: f32) -> f32 {
    if x > low { x } else { low }
}

/// The smaller of two numbers, as one instruction.
#[inline(always)]
pub(super) fn at_most(x: f32, high: f32) -> f32 {
    if x < high { x } else { high }
}
