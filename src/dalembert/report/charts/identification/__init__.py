"""Figures of what was identified from data."""
