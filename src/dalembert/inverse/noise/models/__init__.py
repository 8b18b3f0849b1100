"""Models of the noise of measurements: its deviation, and its correlation from sample to sample."""
