"""What the residuals of a fit say about its model and its data."""
