"""Samples side by side on processors with AVX2 alone have the bits that they have on this one."""

import os
import platform
import subprocess
import sys

import numpy as np
import pytest

SCRIPT = """
import sys
import numpy as np
import dalembert.multibody as mb

def build(angle, stiffness):
    system = mb.System(gravity=(0.0, -9.81))
    section = {"poisson_ratio": 0.3, "density": 5540.0, "height": 0.04, "width": 0.02}
    arm = system.add(mb.RigidBar("arm", 0.5, 1.0, angle=angle))
    beam = system.add(mb.AncfBeam("beam", 1.0, 2, stiffness, angle=-angle, start=arm.end, **section))
    system.add(mb.RevoluteJoint("O", system.ground, arm.start, viscous=0.1, coulomb=0.2))
    system.add(mb.RevoluteJoint("A", arm.end, beam.start))
    return system

ranges = {"angle": (-0.4, 0.9), "stiffness": (1e7, 1e8)}
channels = ("beam.end.x", "beam.end.vy", "A.force_x")
model = mb.TimeResponse(build, ranges, channels, np.linspace(0.0, 0.2, 5), mb.GeneralizedAlpha(1e-3), 1)
chance = np.random.default_rng(4)
batch = np.stack([chance.uniform(*limits, 9) for limits in ranges.values()], axis=1)
np.save(sys.argv[1], model.evaluate(batch).only())
"""


@pytest.mark.slow
@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="processors of another family")
def test_lanes_without_avx512_have_the_same_bits(tmp_path, record_evidence) -> None:
    results = []
    for name in ("", "haswell"):
        variables = {"DALEMBERT_CPU": name, "DALEMBERT_CACHE_DIR": str(tmp_path)} if name else {}
        file = tmp_path / f"{name}.npy"
        subprocess.run([sys.executable, "-c", SCRIPT, str(file)], check=True, env=os.environ | variables)
        results.append(np.load(file))
    assert any(tmp_path.rglob("*lanes*.o"))
    assert np.ptp(results[0], axis=0).max() > 0.1  # the samples differ
    record_evidence(
        "nine samples of a mechanism in lanes, on this processor and without AVX-512", *results,
        tolerance=0.0, topic="Samples side by side", kind="other method", source="kernels compiled for AVX2",
    )  # fmt: skip
