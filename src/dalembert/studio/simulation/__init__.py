"""What the process of a study computes at the current values of its parameters."""
