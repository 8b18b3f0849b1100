"""Midpoint methods: energy-momentum and variational."""
