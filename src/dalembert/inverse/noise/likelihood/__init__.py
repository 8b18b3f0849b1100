"""The likelihood of measurements, with a model and a model of their noise."""
