//! Compile a description into a plan, and render the plan.
