//! Camera models as pure maths: projections, radial distortion, their inverses and conventions.
