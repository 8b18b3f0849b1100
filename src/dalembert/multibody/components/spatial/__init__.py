"""Components of mechanisms in space: one file a kind."""
