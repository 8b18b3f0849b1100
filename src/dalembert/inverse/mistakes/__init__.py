"""Mistakes in records that would explain the misfit of a fit: one file each."""
