"""Motions in time: simulation, trajectories, responses, restarts."""
