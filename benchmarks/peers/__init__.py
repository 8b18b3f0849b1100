"""The benchmark models written for other packages."""
