"""Compiled kernels: one file a kind of component, and what is common to all."""
