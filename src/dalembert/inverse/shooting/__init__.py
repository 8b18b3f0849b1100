"""Multiple shooting: records divided into segments, and the growth of small changes."""
