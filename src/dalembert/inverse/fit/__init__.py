"""The result of an identification, its intervals, its text and its file."""
