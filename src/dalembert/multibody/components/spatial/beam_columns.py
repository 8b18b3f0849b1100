"""Columns of beam elements in space: stiffness and reference strains at points of the strains, inertia at its points.

A point of the strains has the upper triangle of the section's stiffness C by rows, and the reference strains e0; a
point of the inertia the entries of the section's pseudo-inertia, per length, without those of the axis.
"""

from dalembert.kernels.kernel import inlined

STRAINS = 6
ENTRIES = tuple(f"c{i}{j}" for i in range(1, 7) for j in range(i, 7))
REFERENCES = tuple(f"e{i}" for i in range(1, 7))
MASSES = ("mass", "first_2", "first_3", "second_22", "second_23", "second_33")


def columns(points: int) -> tuple[str, ...]:
    """Return the names of the columns of an element with ``points`` of the strains, and one more of the inertia.
    >>> len(columns(2))
    72
    """
    strains = [f"{name}_{g}" for g in range(1, points + 1) for name in (*ENTRIES, *REFERENCES)]
    return (*strains, *(f"{name}_{g}" for g in range(1, points + 2) for name in MASSES))


def reference_columns(points: int) -> tuple[str, ...]:
    """Return the names of the columns of the reference strains, point by point."""
    return tuple(f"{name}_{g}" for g in range(1, points + 1) for name in REFERENCES)


# Records have no columns by number, and kernels no names as variables: so each point has its function.


@inlined
def _point_1(p):
    return (
        p.c11_1, p.c12_1, p.c13_1, p.c14_1, p.c15_1, p.c16_1, p.c22_1, p.c23_1, p.c24_1, p.c25_1, p.c26_1, p.c33_1,
        p.c34_1, p.c35_1, p.c36_1, p.c44_1, p.c45_1, p.c46_1, p.c55_1, p.c56_1, p.c66_1, p.e1_1, p.e2_1, p.e3_1,
        p.e4_1, p.e5_1, p.e6_1,
    )  # fmt: skip


@inlined
def _point_2(p):
    return (
        p.c11_2, p.c12_2, p.c13_2, p.c14_2, p.c15_2, p.c16_2, p.c22_2, p.c23_2, p.c24_2, p.c25_2, p.c26_2, p.c33_2,
        p.c34_2, p.c35_2, p.c36_2, p.c44_2, p.c45_2, p.c46_2, p.c55_2, p.c56_2, p.c66_2, p.e1_2, p.e2_2, p.e3_2,
        p.e4_2, p.e5_2, p.e6_2,
    )  # fmt: skip


@inlined
def _point_3(p):
    return (
        p.c11_3, p.c12_3, p.c13_3, p.c14_3, p.c15_3, p.c16_3, p.c22_3, p.c23_3, p.c24_3, p.c25_3, p.c26_3, p.c33_3,
        p.c34_3, p.c35_3, p.c36_3, p.c44_3, p.c45_3, p.c46_3, p.c55_3, p.c56_3, p.c66_3, p.e1_3, p.e2_3, p.e3_3,
        p.e4_3, p.e5_3, p.e6_3,
    )  # fmt: skip


@inlined
def _point_4(p):
    return (
        p.c11_4, p.c12_4, p.c13_4, p.c14_4, p.c15_4, p.c16_4, p.c22_4, p.c23_4, p.c24_4, p.c25_4, p.c26_4, p.c33_4,
        p.c34_4, p.c35_4, p.c36_4, p.c44_4, p.c45_4, p.c46_4, p.c55_4, p.c56_4, p.c66_4, p.e1_4, p.e2_4, p.e3_4,
        p.e4_4, p.e5_4, p.e6_4,
    )  # fmt: skip


@inlined
def _mass_1(p):
    return p.mass_1, p.first_2_1, p.first_3_1, p.second_22_1, p.second_23_1, p.second_33_1


@inlined
def _mass_2(p):
    return p.mass_2, p.first_2_2, p.first_3_2, p.second_22_2, p.second_23_2, p.second_33_2


@inlined
def _mass_3(p):
    return p.mass_3, p.first_2_3, p.first_3_3, p.second_22_3, p.second_23_3, p.second_33_3


@inlined
def _mass_4(p):
    return p.mass_4, p.first_2_4, p.first_3_4, p.second_22_4, p.second_23_4, p.second_33_4


@inlined
def _mass_5(p):
    return p.mass_5, p.first_2_5, p.first_3_5, p.second_22_5, p.second_23_5, p.second_33_5


POINTS = (_point_1, _point_2, _point_3, _point_4)
"""Stiffness and reference strains, 27 numbers, at each point of the strains."""
INERTIAS = (_mass_1, _mass_2, _mass_3, _mass_4, _mass_5)
"""Pseudo-inertia, 6 numbers, at each point of the inertia."""
