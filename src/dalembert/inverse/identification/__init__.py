"""The steps of an identification, each from one record to the next."""
