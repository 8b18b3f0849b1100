"""Collocation as a minimisation."""
