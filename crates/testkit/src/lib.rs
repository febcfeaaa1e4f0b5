//! Brute-force and conservation oracles for tests.
