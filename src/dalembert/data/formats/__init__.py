"""Formats of data files, one module each. A module here is a format by itself: nothing lists them."""
