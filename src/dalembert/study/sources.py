"""What the files of a study's data were taken to be."""

from collections.abc import Iterator

from dalembert.study.study import Study


def source_lines(study: Study) -> Iterator[str]:
    """Yield a line on each file of measured data: its layout, which is found from its lines if it is text."""
    tables = study.file.experiments or ([] if study.file.data is None else [study.file.data])
    origins = (origin for table in tables for origin in table.read().origin.split("; "))
    yield from (f"Data: {origin}" for origin in dict.fromkeys(origins))
