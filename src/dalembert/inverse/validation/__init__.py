"""Validation with held-out data."""
