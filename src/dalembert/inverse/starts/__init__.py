"""Starts of searches: where they are, and how many minima they converged to."""
