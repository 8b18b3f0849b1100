"""Robots and other trees of rigid bodies: description, import, inverse dynamics, linear regressor."""
