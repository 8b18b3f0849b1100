"""Compiled kernels: C functions of an address, each compiled alone, kept as an object file, reached by its symbol."""
