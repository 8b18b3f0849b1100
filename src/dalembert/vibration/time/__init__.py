"""Periodic motions by integration in time."""
