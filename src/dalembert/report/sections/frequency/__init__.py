"""Sections of structures in frequency."""
