"""Sections of fits, of intervals and sets identified, and of what is known beyond a fit."""
