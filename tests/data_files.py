"""The same motion in files of every format."""

import gc
import warnings
from pathlib import Path

import numpy as np
import pyuff

TIMES = np.array([0.0, 0.01, 0.02, 0.05, 0.1, 0.125])
ANGLE = np.array([0.5, 0.25, -0.125, -0.5, -0.75, -1.0])
WAY = np.array([[1.0, 0.0], [0.9, 0.1], [0.8, 0.3], [0.5, 0.6], [0.2, 0.7], [0.1, 0.75]])


def csv(path: Path) -> dict[str, str]:
    rows = [",".join(map(repr, row)) for row in np.column_stack([TIMES, ANGLE, WAY]).tolist()]
    path.write_text("\n".join(["t,angle,x,y", *rows]))
    return {"angle": "angle", "x": "x", "y": "y"}


def parquet(path: Path) -> dict[str, str]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = {"t": TIMES, "note": ["a"] * len(TIMES), "angle": ANGLE, "x": WAY[:, 0], "y": WAY[:, 1]}
    pq.write_table(pa.table(table), path)
    return {"angle": "angle", "x": "x", "y": "y"}


def mat(path: Path) -> dict[str, str]:
    from scipy.io import savemat

    savemat(path, {"t": TIMES, "note": "a run", "run": {"angle": ANGLE, "place": WAY}})
    return {"angle": "run.angle", "x": "run.place(:,1)", "y": "run.place(:,2)"}


def mat73(path: Path) -> dict[str, str]:
    """As MATLAB writes it: a vector is a matrix of one column, and all are transposed."""
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, array in {"t": TIMES[None], "run/angle": ANGLE[None], "run/place": WAY.T}.items():
            file.create_dataset(name, data=array).attrs["MATLAB_class"] = np.bytes_("double")
        file.create_dataset("note", data=np.array([[97]], dtype=np.uint16)).attrs["MATLAB_class"] = np.bytes_("char")
    return {"angle": "run.angle", "x": "run.place(:,1)", "y": "run.place(:,2)"}


def uff(path: Path) -> dict[str, str]:
    functions = [function(1, -6, ANGLE, "the angle"), function(2, 1, WAY[:, 0]), function(2, 2, WAY[:, 1], binary=1)]
    universal(path, functions)
    return {"angle": "the angle", "x": "2:+X", "y": "2:+Y"}


def universal(path: Path, sets: list[dict], **more) -> None:
    """Write a universal file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)  # the library leaves the file to be closed by itself
        pyuff.UFF(str(path)).write_sets(sets, "overwrite", **more)
        gc.collect()


def netcdf(path: Path, engine: str = "h5netcdf") -> dict[str, str]:
    from xarray import Dataset

    place = (("sample", "axis"), WAY) if engine == "h5netcdf" else (("axis", "sample"), WAY.T)
    Dataset({"angle": ("sample", ANGLE), "place": place}, {"t": ("sample", TIMES), "axis": ["x", "y"]}).to_netcdf(
        path, engine=engine
    )
    return {"angle": "angle", "x": "place[x]", "y": "place[y]"}


def function(node: int, direction: int, values: np.ndarray, line: str = "NONE", x: np.ndarray = TIMES, **more) -> dict:
    """Dataset 58 of a universal file: a response at a node, unevenly spaced and in double precision."""
    given = {
        "type": 58,
        "binary": 0,
        "func_type": 1,
        "rsp_node": node,
        "rsp_dir": direction,
        "ref_node": 0,
        "ref_dir": 0,
    }
    form = {"ord_data_type": 4, "num_pts": len(values), "abscissa_spacing": 0, "abscissa_min": 0.0, "abscissa_inc": 0.0}
    kinds = {f"{name}_spec_data_type": 0 for name in ("ordinate", "orddenom", "z_axis")}
    return {**given, **form, **kinds, "abscissa_spec_data_type": 17, "id1": line, "x": x, "data": values, **more}


WRITERS = {
    "motion.csv": csv,
    "motion.parquet": parquet,
    "motion.mat": mat,
    "motion73.mat": mat73,
    "motion.uff": uff,
    "motion.nc": netcdf,
    "motion3.nc": lambda path: netcdf(path, "scipy"),
}
