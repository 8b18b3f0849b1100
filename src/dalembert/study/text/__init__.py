"""The text of study files: numbers, expressions, places and functions, and messages about them."""
