"""What data can tell: before they are measured, and after they have been fitted."""
