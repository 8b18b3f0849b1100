"""What data determine: before they are measured, and after they have been fitted."""
