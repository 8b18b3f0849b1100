"""Laws that components in the plane and in space share."""
