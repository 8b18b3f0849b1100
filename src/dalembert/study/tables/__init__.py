"""The tables of study files, and what a study makes of them: models, data and parameters."""
