"""Figures of motions in time."""
