"""Radau IIA with adaptive steps."""
