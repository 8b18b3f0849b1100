"""A mechanism with sliders for its parameters, as a widget for Jupyter and marimo."""

from dalembert.widget.sliders import sliders

__all__ = ["sliders"]
