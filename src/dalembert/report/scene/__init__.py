"""The picture of a model as data, which all renderers take."""
