"""Runs of studies: their folders, events, progress and duration."""
