"""Steady motions: bodies that turn at constant rates, and small vibrations about them."""
