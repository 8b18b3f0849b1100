"""The way from a data file to the table `[data]`."""
