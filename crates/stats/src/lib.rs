//! Estimators, confidence, hypothesis tests and error metrics.
