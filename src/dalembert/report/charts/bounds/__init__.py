"""Figures of bounds over intervals."""
