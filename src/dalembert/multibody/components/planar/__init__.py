"""Components of mechanisms in the plane: one file a kind."""
