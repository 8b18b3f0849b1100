"""The posterior distribution of parameters, sampled."""
