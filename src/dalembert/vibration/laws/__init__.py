"""Laws of contacts and springs, and their sums over a period."""
