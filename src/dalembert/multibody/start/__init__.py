"""Initial states: assembly, equilibrium, velocities, and findings about them."""
