"""Sections of bounds over intervals."""
