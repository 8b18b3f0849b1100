"""Systems of components, and their arrays for the kernels."""
