"""Checks of an identification: each is a function of its optimum that yields findings."""
