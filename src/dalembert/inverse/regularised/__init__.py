"""Many parameters by regularised least squares: unknown histories and fields that are smooth."""
