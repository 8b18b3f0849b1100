"""Several models of the same data: criteria, cross-validation, and whether their difference means anything."""
