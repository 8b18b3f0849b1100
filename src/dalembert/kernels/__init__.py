"""Compiled kernels: C functions of an address, compiled separately, stored as object files, called by their symbols."""
