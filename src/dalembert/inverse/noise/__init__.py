"""Noise of measurements: its models, their likelihood, correlated residuals, and the misfit that noise explains."""
