"""The coordinates that elements see: arrays of a system, and its condensation to them."""
