"""Frequency, damping and amplitude of a mode from its free decay."""
