//! Benchmarks of Étendue.
