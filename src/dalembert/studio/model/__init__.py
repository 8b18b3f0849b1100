"""The drawing of a study's model beside its text."""
