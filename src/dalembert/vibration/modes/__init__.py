"""Nonlinear modes."""
