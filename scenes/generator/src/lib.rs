//! The generator of the scenes that ship with Étendue.
