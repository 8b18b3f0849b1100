"""Torques, mass matrices and regressors of robots against closed forms, conservation, simulations and Pinocchio."""

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dalembert.errors import InputError, ModelError
from dalembert.multibody import RadauIIA, simulate
from dalembert.multibody.spatial import Inertia, Orientation, Pose
from dalembert.multibody.trees.dynamics import bias_forces, inverse_dynamics, mass_matrix, poses, regressor
from dalembert.multibody.trees.parameters import parameters_of
from dalembert.multibody.trees.tree import Link, Tree, TreeJoint
from dalembert.multibody.trees.urdf_reader import read_urdf
from robots import random_motion, random_robot, six_joints, system_of

TOPIC = "Mechanisms in space"
GRAVITY = 9.81


def two_link_arm(lengths, masses, centres, moments) -> Tree:
    """Links along x that turn about z."""
    links = []
    for k, (mass, centre, moment) in enumerate(zip(masses, centres, moments, strict=True)):
        joint = TreeJoint(f"joint{k + 1}", pose=Pose((lengths[0] if k else 0.0, 0.0, 0.0)))
        inertia = Inertia(mass, (0.5 * moment, 0.7 * moment, moment), centre=(centre, 0.0, 0.0))
        links.append(Link(f"link{k + 1}", f"link{k}" if k else "base", joint, inertia))
    return Tree("arm", "base", tuple(links))


def test_two_link_arm(record_evidence):
    """Spong, Hutchinson and Vidyasagar, Robot Modeling and Control, section 7.4: planar elbow manipulator."""
    (l1, l2), (m1, m2), (c1, c2), (i1, i2) = (0.7, 0.5), (3.0, 1.7), (0.3, 0.28), (0.2, 0.06)
    tree = two_link_arm((l1, l2), (m1, m2), (c1, c2), (i1, i2))
    q, v, a = random_motion(tree, 50)
    (q1, q2), (v1, v2), (a1, a2) = q.T, v.T, a.T
    d11 = m1 * c1**2 + m2 * (l1**2 + c2**2 + 2 * l1 * c2 * np.cos(q2)) + i1 + i2
    d12, d22 = m2 * (c2**2 + l1 * c2 * np.cos(q2)) + i2, m2 * c2**2 + i2
    h = -m2 * l1 * c2 * np.sin(q2)
    g2 = m2 * c2 * GRAVITY * np.cos(q1 + q2)
    g1 = (m1 * c1 + m2 * l1) * GRAVITY * np.cos(q1) + g2
    first = d11 * a1 + d12 * a2 + h * (2 * v1 * v2 + v2**2) + g1
    second = d12 * a1 + d22 * a2 - h * v1**2 + g2
    torques = inverse_dynamics(tree, q, v, a, (0.0, -GRAVITY, 0.0))
    record_evidence(
        "Two-link arm, torques of 50 random motions (largest difference)",
        0.0,
        float(np.abs(torques - np.column_stack([first, second])).max()),
        unit="N m",
        tolerance=1e-12,
        topic=TOPIC,
        kind="closed form",
        source="Spong, Hutchinson and Vidyasagar, Robot Modeling and Control, 7.4",
        noisy=True,
    )


def test_power_is_the_rate_of_energy(record_evidence):
    """v . torque = d/dt (v . M v / 2 + V) of a branched robot; V from the centres of mass."""
    tree = six_joints()
    q, v, a = random_motion(tree, 50)

    def energy(q, v):
        place, axes = poses(tree, q)
        centres = place + np.einsum("slij,lj->sli", axes, np.array([link.inertia.centre for link in tree.links]))
        masses = np.array([link.inertia.mass for link in tree.links])
        return 0.5 * np.einsum("si,sij,sj->s", v, mass_matrix(tree, q), v) + GRAVITY * centres[:, :, 2] @ masses

    step = 1e-30
    rate = energy(q + 1j * step * v, v + 1j * step * a).imag / step
    power = np.sum(v * inverse_dynamics(tree, q, v, a), axis=1)
    record_evidence(
        "Branched robot with six joints: power of the torques less the rate of the energy, of its largest",
        0.0,
        float(np.abs(power - rate).max() / np.abs(power).max()),
        tolerance=1e-12,
        topic=TOPIC,
        kind="conservation law",
        source="d/dt (T + V) = v · τ",
        noisy=True,
    )


def test_simulated_motions_need_no_torques(record_evidence):
    """A robot that falls freely, simulated as bodies and joints: its accelerations make the torques zero."""
    tree = random_robot(11, "rrpr")
    q, v = np.array([0.3, -0.4, 0.1, 0.2]), np.array([0.5, -0.2, 0.3, 0.4])
    times = np.linspace(0.0, 1.0, 21)
    motion = simulate(system_of(tree, q, v), 1.0, RadauIIA(tolerance=1e-11), times=times)
    names = [("displacement", "speed") if joint.kind == "prismatic" else ("angle", "rate") for joint in tree.moving]
    found = np.stack(
        [
            motion.channels([f"{joint.name}.{own[k]}" for joint, own in zip(tree.moving, names, strict=True)])
            for k in (0, 1)
        ]
    )
    positions = found[0].copy()
    turning = [k for k, joint in enumerate(tree.moving) if joint.kind == "revolute"]
    positions[:, turning] = np.unwrap(positions[:, turning], axis=0)
    accelerations = accelerations_of(tree, motion, positions, found[1])
    torques = inverse_dynamics(tree, positions, found[1], accelerations)
    holding = np.abs(bias_forces(tree, positions, found[1])).max()
    record_evidence(
        "Robot with a slide that falls freely for 1 s: torques of its simulated motion, of those that hold it",
        0.0,
        float(np.abs(torques).max() / holding),
        tolerance=1e-8,
        topic=TOPIC,
        kind="other method",
        source="simulation with directors as coordinates, Radau IIA",
        noisy=True,
    )


def accelerations_of(tree, motion, q, v):
    """Accelerations of the joints (samples, dofs), from those of the origins and the angular ones of the links.

    Linear and angular velocities of the links are J(q) v; J by the complex step, J' v by differences of it.
    """
    step, found = 1e-30, []
    for s in range(len(q)):

        def velocities(position, rate):
            place, axes = poses(tree, (position + 1j * step * rate)[None, :])
            spins = np.einsum("lij,lkj->lik", axes[0].imag / step, axes[0].real)
            return np.column_stack([place[0].imag / step, spins[:, 2, 1], spins[:, 0, 2], spins[:, 1, 0]]).ravel()

        jacobian = np.column_stack([velocities(q[s], unit) for unit in np.eye(len(tree.moving))])
        h = 1e-4
        rates = [velocities(q[s] + k * h * v[s], v[s]) for k in (-2, -1, 1, 2)]
        drift = (rates[0] - 8 * rates[1] + 8 * rates[2] - rates[3]) / (12 * h)
        names = [
            f"{link.name}.origin.{own}"
            for link in tree.links
            for own in ("ax", "ay", "az", "wx_rate", "wy_rate", "wz_rate")
        ]
        found.append(np.linalg.lstsq(jacobian, motion.channels(names)[s] - drift, rcond=None)[0])
    return np.array(found)


@pytest.fixture
def record(record_evidence):
    """Records the largest differences from Pinocchio of some robots, by quantity."""

    def record(robots: str, worst: dict[str, float]) -> None:
        version = pytest.importorskip("pinocchio").__version__
        for name, difference in worst.items():
            record_evidence(
                f"{robots}, {name} (largest relative difference)",
                0.0,
                difference,
                tolerance=1e-10,
                topic=TOPIC,
                kind="other code",
                source=f"Pinocchio {version}",
                noisy=True,
            )

    return record


def tree_from(model) -> Tree | None:
    """The tree of a model of Pinocchio; None if it has other joints, or an inertia that no body can have."""
    links = []
    for k in range(1, model.njoints):
        joint, kind = model.joints[k], model.joints[k].shortname()
        if not kind.startswith(("JointModelR", "JointModelP")) or joint.nv != 1:
            return None
        axis = joint.extract().axis if kind.endswith("Unaligned") else np.eye(3)["XYZ".index(kind[-1])]
        place, own = model.jointPlacements[k], model.inertias[k]
        try:
            inertia = Inertia.of(own.mass, own.inertia, own.lever) if own.mass > 0.0 else None
        except InputError:
            return None
        tree_joint = TreeJoint(
            model.names[k],
            "prismatic" if kind.startswith("JointModelP") else "revolute",
            Pose(tuple(place.translation.tolist()), Orientation.of(place.rotation)),
            tuple(axis.tolist()),
            armature=float(model.armature[joint.idx_v]),
        )
        parent = model.parents[k]
        links.append(Link(f"link{k}", f"link{parent}" if parent else "base", tree_joint, inertia))
    return Tree(model.name, "base", tuple(links))


def theirs(model, q):
    """Positions in Pinocchio's order: a joint without limits has cosine and sine."""
    whole = np.empty((len(q), model.nq))
    for k in range(1, model.njoints):
        joint = model.joints[k]
        own = q[:, joint.idx_v]
        whole[:, joint.idx_q] = own
        if joint.nq == 2:
            whole[:, joint.idx_q], whole[:, joint.idx_q + 1] = np.cos(own), np.sin(own)
    return whole


def models(pinocchio, **options):
    """Models of example-robot-data by their files, without those that Pinocchio refuses."""
    wheel = next(own for own in Path(pinocchio.__file__).parents if own.name == "cmeel.prefix")
    found = {}
    for path in sorted((wheel / "share/example-robot-data/robots").rglob("*.urdf")):
        with suppress(ValueError):
            found[path] = pinocchio.buildModelFromUrdf(str(path), **options)
    return found


@pytest.mark.slow
def test_robots_against_pinocchio(record):
    """Mass matrix, bias forces, torques and regressor of the robots of example-robot-data."""
    pinocchio = pytest.importorskip("pinocchio")
    order = [0, 1, 2, 3, 4, 6, 9, 5, 7, 8]  # of Pinocchio's xx, xy, yy, xz, yz, zz
    worst = dict.fromkeys(("mass matrices", "bias forces", "torques", "regressors", "positions"), 0.0)
    compared = 0
    for model in models(pinocchio).values():
        model.armature = np.random.default_rng(model.nv).uniform(0.0, 0.2, model.nv)
        tree = tree_from(model)
        if tree is None or model.nv == 0:
            continue
        assert [model.joints[model.getJointId(joint.name)].idx_v for joint in tree.moving] == list(range(model.nv))
        data, (q, v, a) = model.createData(), random_motion(tree, 5)
        found = {name: [] for name in worst}
        for own, rate, change in zip(theirs(model, q), v, a, strict=True):
            upper = np.triu(pinocchio.crba(model, data, own))
            found["mass matrices"].append(upper + np.triu(upper, 1).T)
            found["bias forces"].append(pinocchio.nle(model, data, own, rate).copy())
            found["torques"].append(pinocchio.rnea(model, data, own, rate, change).copy())
            columns = pinocchio.computeJointTorqueRegressor(model, data, own, rate, change)
            found["regressors"].append(columns.reshape(model.nv, -1, 10)[:, :, order].copy())
            pinocchio.forwardKinematics(model, data, own)
            found["positions"].append([placement.translation.copy() for placement in list(data.oMi)[1:]])
        heavy = [link.inertia is not None for link in tree.links]
        found["regressors"] = [rows[:, heavy].reshape(model.nv, -1) for rows in found["regressors"]]
        whole = regressor(tree, q, v, a)
        ours = {
            "mass matrices": mass_matrix(tree, q),
            "bias forces": bias_forces(tree, q, v),
            "torques": inverse_dynamics(tree, q, v, a),
            "regressors": whole[:, :, : 10 * sum(heavy)],
            "positions": poses(tree, q).positions,
        }
        for name, reference in found.items():
            size = np.abs(reference).max() or 1.0
            worst[name] = max(worst[name], float(np.abs(ours[name] - reference).max() / size))
        difference = np.abs(whole @ parameters_of(tree) - ours["torques"]).max()
        assert difference <= 1e-12 * max(np.abs(ours["torques"]).max(), 1.0)
        compared += 1
    assert compared >= 20
    record(f"{compared} robots of example-robot-data", worst)


@pytest.mark.slow
def test_following_joints_against_pinocchio(record):
    """Mass matrix and torques of robots with joints that follow others, such as grippers."""
    pinocchio = pytest.importorskip("pinocchio")
    compared, worst = 0, {"mass matrices": 0.0, "torques": 0.0}
    free = models(pinocchio)
    for path, model in models(pinocchio, mimic=True).items():
        tree = tree_from(free[path])
        if tree is None or model.nv == free[path].nv:
            continue
        leaders = {}
        for k in range(1, model.njoints):
            if model.joints[k].shortname() != "JointModelMimic":
                leaders[model.joints[k].idx_q] = model.names[k]
        links = []
        for link in tree.links:
            joint = model.joints[model.getJointId(link.joint.name)]
            if joint.shortname() == "JointModelMimic":
                mimic = leaders[joint.idx_q], joint.extract().scaling, joint.extract().offset
                link = replace(link, joint=replace(link.joint, mimic=mimic))
            links.append(link)
        tree = replace(tree, links=tuple(links))
        data, (q, v, a) = model.createData(), random_motion(tree, 5)
        masses, torques = mass_matrix(tree, q), inverse_dynamics(tree, q, v, a)
        for s, own in enumerate(theirs(model, q)):
            upper = np.triu(pinocchio.crba(model, data, own))
            pairs = {
                "mass matrices": (masses[s], upper + np.triu(upper, 1).T),
                "torques": (torques[s], pinocchio.rnea(model, data, own, v[s], a[s])),
            }
            for name, (ours, reference) in pairs.items():
                worst[name] = max(worst[name], float(np.abs(ours - reference).max() / np.abs(reference).max()))
        compared += 1
    assert compared > 0
    record(f"{compared} robots with joints that follow others", worst)


@pytest.mark.slow
def test_robots_of_urdf_files_against_pinocchio(record):
    """Mass matrix, bias forces and torques of robots that both read from the same files, links on fixed joints included."""
    pinocchio = pytest.importorskip("pinocchio")
    compared, worst = 0, {"mass matrices": 0.0, "bias forces": 0.0, "torques": 0.0}
    for path, model in models(pinocchio).items():
        try:
            tree = read_urdf(path)
        except (InputError, ModelError):  # inertias that no body can have
            continue
        tree = replace(tree, links=tuple(replace(link, joint=replace(link.joint, mimic=None)) for link in tree.links))
        order = [model.joints[model.getJointId(joint.name)].idx_v for joint in tree.moving]
        if not order:
            continue
        assert sorted(order) == list(range(model.nv))
        data, (q, v, a) = model.createData(), random_motion(tree, 5)
        ours = {
            "mass matrices": mass_matrix(tree, q[:, order], armature=False),
            "bias forces": bias_forces(tree, q[:, order], v[:, order]),
            "torques": inverse_dynamics(tree, q[:, order], v[:, order], a[:, order], friction=False, armature=False),
        }
        found = {name: [] for name in worst}
        for own, rate, change in zip(theirs(model, q), v, a, strict=True):
            upper = np.triu(pinocchio.crba(model, data, own))
            found["mass matrices"].append((upper + np.triu(upper, 1).T)[np.ix_(order, order)])
            found["bias forces"].append(pinocchio.nle(model, data, own, rate)[order])
            found["torques"].append(pinocchio.rnea(model, data, own, rate, change)[order])
        for name, reference in found.items():
            worst[name] = max(
                worst[name], float(np.abs(ours[name] - reference).max() / (np.abs(reference).max() or 1.0))
            )
        whole = inverse_dynamics(tree, q, v, a)
        difference = np.abs(regressor(tree, q, v, a) @ parameters_of(tree) - whole).max()
        assert difference <= 1e-12 * max(np.abs(whole).max(), 1.0)
        compared += 1
    assert compared >= 20
    record(f"{compared} URDF files of example-robot-data", worst)
