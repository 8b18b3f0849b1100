"""Studies: their cards, their pages, templates and pictures."""
