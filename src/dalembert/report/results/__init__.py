"""Sections of the package's results, by subject."""
