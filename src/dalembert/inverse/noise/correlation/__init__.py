"""Correlated residuals: tests of whiteness, fitted noise processes, and the covariance that follows from them."""
