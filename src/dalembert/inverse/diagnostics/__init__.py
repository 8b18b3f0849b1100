"""Diagnostics of the residuals of a fit: tests, outliers, and the influence of single samples."""
