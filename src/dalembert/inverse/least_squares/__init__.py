"""Least squares from one start, and the standard deviations that follow."""
