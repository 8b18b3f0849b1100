"""The processor that kernels are compiled for: this one, or another one of its family that a variable names."""

import os

import llvmlite.binding as ll

VARIABLE = "DALEMBERT_CPU"  # environment variable: LLVM's name of a processor, such as haswell


def processor() -> tuple[str, str]:
    """Return LLVM's name of the processor, and its features: empty, those of the name, where the variable names it."""
    named = os.environ.get(VARIABLE, "")
    return (named, "") if named else (ll.get_host_cpu_name(), ll.get_host_cpu_features().flatten())
