"""The text of a study: its state on a page, changes in place, forms, completions."""
