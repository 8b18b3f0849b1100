"""Results as files that other programs show."""

from dalembert.export.vtk import export_vtk

__all__ = ["export_vtk"]
