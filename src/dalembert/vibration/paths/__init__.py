"""Responses over frequency, their continuation, and what follows from them."""
