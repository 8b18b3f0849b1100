"""Units, zeros and times of data that the response at the first guesses makes suspect."""
