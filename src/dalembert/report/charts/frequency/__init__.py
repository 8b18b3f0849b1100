"""Figures of structures in frequency."""
