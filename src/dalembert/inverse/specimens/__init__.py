"""Parameters that vary from one specimen to the next."""
