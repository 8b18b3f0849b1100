"""Sections of motions in time, sweeps of a parameter, and comparisons of integrators."""
