"""Methods for the equations of index 1."""
