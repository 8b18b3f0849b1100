"""Intervals of parameters from bands of a response."""
