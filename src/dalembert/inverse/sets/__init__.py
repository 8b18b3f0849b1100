"""All parameters that are consistent with measurements of bounded error."""
