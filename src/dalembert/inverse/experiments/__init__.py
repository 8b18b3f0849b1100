"""Several experiments in one fit, and validation with held-out data."""
