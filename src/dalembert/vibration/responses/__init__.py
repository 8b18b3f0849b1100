"""Responses over frequency: curves, families of curves, tracked peaks, and the forward model."""
