"""Components of mechanisms in space, for :class:`SpatialSystem`."""

