"""The misfit that is minimised: samples compared, weights, losses, priors, and the space that is searched."""
