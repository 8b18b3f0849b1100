"""Robots from URDF files against an independent derivation, another program, and files of others."""

import re
from pathlib import Path
from xml.dom import minidom

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from dalembert.errors import ModelError
from dalembert.multibody import GeneralizedAlpha, OdeSolver, Partitioning, simulate
from dalembert.multibody.trees import Tree, read_urdf, write_urdf
from robot_files import ARM, POSITIONS, RATES

TOPIC = "Robots"
GRAVITY = np.array([0.0, 0.0, -9.81])


@pytest.fixture(scope="module")
def arm(tmp_path_factory) -> Tree:
    path = tmp_path_factory.mktemp("arm") / "arm.urdf"
    path.write_text(ARM.replace('friction="0.4"', 'friction="0"'))
    return read_urdf(path)


def twist_of(joint) -> np.ndarray:
    """Twist (4, 4) of a joint in its frame."""
    x, y, z = np.array(joint.axis) / np.linalg.norm(joint.axis)
    twist = np.zeros((4, 4))
    if joint.kind == "revolute":
        twist[:3, :3] = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
    elif joint.kind == "prismatic":
        twist[:3, 3] = x, y, z
    return twist


def equations(tree: Tree, q: np.ndarray, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix and right side of T = sum tr(H' P H'^T) / 2 + A q'^2 / 2, from derivatives of the poses H(q).

    dH/dq_i = (product before the joint) S_i (product after it), with exact second derivatives in the same way.
    """
    names = [joint.name for joint in tree.moving]
    chains = {tree.root: []}
    for link in tree.links:
        placed = np.eye(4)
        placed[:3, :3], placed[:3, 3] = link.joint.pose.orientation.matrix, link.joint.pose.position
        k = names.index(link.joint.name) if link.joint.moves else None
        chains[link.name] = [*chains[link.parent], (placed, k, twist_of(link.joint))]
    size = len(names)
    mass, force = np.diag([joint.armature for joint in tree.moving]), np.zeros(size)
    force -= [joint.damping * rate for joint, rate in zip(tree.moving, rates, strict=True)]
    for link in tree.links:
        if link.inertia is None:
            continue

        def derivative(*of, chain=chains[link.name]):
            pose = np.eye(4)
            for placed, k, twist in chain:
                pose = pose @ placed
                if k is not None:
                    pose = pose @ np.linalg.matrix_power(twist, of.count(k)) @ expm(twist * q[k])
            moving = {k for _, k, _ in chain}
            return pose if set(of) <= moving else np.zeros((4, 4))

        order = [1, 2, 3, 0]
        pseudo = link.inertia.pseudo[order][:, order]  # of [s; 1]
        first = [derivative(i) for i in range(size)]
        carried = sum(derivative(i, j) * rates[i] * rates[j] for i in range(size) for j in range(size))
        weight = np.outer(np.append(GRAVITY, 0.0), [0, 0, 0, 1])
        for i in range(size):
            force[i] += np.trace(first[i] @ pseudo @ (weight - carried).T)
            for j in range(size):
                mass[i, j] += np.trace(first[i] @ pseudo @ first[j].T)
    return mass, force


@pytest.mark.slow
def test_motion_of_an_arm(arm, record_evidence):
    """Joint positions after 0.5 s against Lagrange's equations in joint coordinates."""
    names = list(POSITIONS)

    def motion(t, state):
        mass, force = equations(arm, state[:3], state[3:])
        return np.concatenate([state[3:], np.linalg.solve(mass, force)])

    start = [*(POSITIONS[name] for name in names), *(RATES[name] for name in names)]
    independent = solve_ivp(motion, (0.0, 0.5), start, method="DOP853", rtol=1e-11, atol=1e-11)
    ours = simulate(
        arm.system(POSITIONS, RATES), 0.5, OdeSolver("DOP853", 1e-11, 1e-11, Partitioning()), times=np.array([0.0, 0.5])
    )
    record_evidence(
        "Arm with a slide, merged links and armatures: joint positions after 0.5 s (largest difference)",
        0.0,
        float(
            np.abs(ours.channels(["turn.angle", "slide.displacement", "bend.angle"])[-1] - independent.y[:3, -1]).max()
        ),
        tolerance=1e-8,
        topic=TOPIC,
        kind="other method",
        source="joint coordinates, products of exponentials, SciPy's DOP853",
    )
    assert np.abs(ours.energies["balance"]).max() < 1e-7


def robots() -> list[Path]:
    """URDF files of the package example-robot-data."""
    package = Path(pytest.importorskip("pinocchio").__file__).parents[4]
    found = sorted(package.glob("share/example-robot-data/robots/**/*.urdf"))
    if not found:
        pytest.skip("example-robot-data is not installed")
    return found


INERTIAL = ["origin xyz rpy", "mass value", "inertia ixx iyy izz ixy ixz iyz"]
SHAPES = ["box size", "cylinder radius length", "sphere radius", "mesh filename scale"]
MOVING = ["dynamics damping friction armature", "mimic joint multiplier offset", "axis xyz"]
IMPORTED = {
    "robot": "name",
    "robot/link": "name",
    "robot/link/inertial": "",
    **{f"robot/link/inertial/{own.partition(' ')[0]}": own for own in INERTIAL},
}
for _kind in ("visual", "collision"):
    IMPORTED |= {f"robot/link/{_kind}": "", f"robot/link/{_kind}/origin": "xyz rpy", f"robot/link/{_kind}/geometry": ""}
    IMPORTED |= {f"robot/link/{_kind}/geometry/{own.partition(' ')[0]}": own for own in SHAPES}
for _kind in ("fixed", "revolute", "continuous", "prismatic"):
    IMPORTED |= {f"robot/{_kind}": "name type", f"robot/{_kind}/parent": "link", f"robot/{_kind}/child": "link"}
    IMPORTED[f"robot/{_kind}/origin"] = "xyz rpy"
    if _kind != "fixed":
        IMPORTED |= {f"robot/{_kind}/{own.partition(' ')[0]}": own for own in MOVING}
        IMPORTED[f"robot/{_kind}/limit"] = "effort velocity" + " lower upper" * (_kind != "continuous")
LISTED = re.compile(r"not imported \((\d+) elements?, (\d+) attributes?\)$")


def counted(node, path="") -> np.ndarray:
    """Numbers of elements and attributes of a document, then of those that are imported, (2, 2)."""
    path = f"{path}/{node.tagName}".lstrip("/")
    if path == "robot/joint":
        path = f"robot/{node.getAttribute('type')}"
    found = np.array([[1, len(node.attributes)], [0, 0]])
    if path in IMPORTED:
        found[1] = 1, sum(name in IMPORTED[path].split() for name in node.attributes.keys())  # noqa: SIM118
    seen = set()
    for child in node.childNodes:
        if child.nodeType == node.ELEMENT_NODE:
            again = child.tagName in seen and child.tagName not in ("link", "joint", "visual", "collision")
            found += counted(child, "repeated" if again else path)
            seen.add(child.tagName)
    return found


def listed(tree: Tree) -> np.ndarray:
    """Numbers of elements and attributes that are listed, (2,)."""
    whole = [LISTED.search(note) for note in tree.unsupported]
    attributes = sum(note.partition(": ")[2].startswith("attribute ") for note in tree.unsupported)
    return np.sum([[0, attributes], *([int(own[1]), int(own[2])] for own in whole if own)], axis=0)


def collision_shapes(tree: Tree) -> list[tuple]:
    """Link, kind, sizes and file of each collision shape."""
    parts = [(tree.root, tree.collisions), *((link.name, link.collisions) for link in tree.links)]
    return [(name, own.kind, own.sizes, own.file) for name, shapes in parts for own in shapes]


def seen_by_pinocchio(pin, path: Path, meshes) -> tuple[list[tuple], np.ndarray]:
    """Link with sizes of each collision shape, and their places (shapes, 4, 4), by links."""
    model = pin.buildModelFromUrdf(str(path))
    folders = [str(folder) for folder in robots()[0].parents if "share" in folder.parts]
    geometry = pin.buildGeomFromUrdf(model, str(path), pin.GeometryType.COLLISION, None, folders, meshes)
    shapes, places = [], []
    for one in sorted(geometry.geometryObjects, key=lambda one: model.frames[one.parentFrame].name):
        solid = one.geometry
        if one.meshPath and Path(one.meshPath).is_file():
            sizes = (Path(one.meshPath).name, *one.meshScale)
        elif hasattr(solid, "halfSide"):
            sizes = tuple(2 * solid.halfSide)
        else:
            sizes = (solid.radius, *([2 * solid.halfLength] if hasattr(solid, "halfLength") else []))
        shapes.append((model.frames[one.parentFrame].name, *sizes))
        places.append(one.placement.homogeneous)
    return shapes, np.array(places).reshape(-1, 4, 4)


@pytest.mark.slow
def test_collision_shapes_against_pinocchio(record_evidence, tmp_path):
    """Pinocchio sees the same collision shapes in written files as in those of others."""
    pin, written = pytest.importorskip("pinocchio"), tmp_path / "again.urdf"
    meshes = pytest.importorskip("coal").CachedMeshLoader()
    read, gaps, counts, differences = 0, [], np.zeros(2, dtype=int), 0
    for path in robots():
        try:
            theirs, places = seen_by_pinocchio(pin, path, meshes)
            write_urdf(read_urdf(path, impossible="replace"), written)
        except (ValueError, ModelError):  # a mesh that is not there, a joint that follows a missing one
            continue
        ours, again = seen_by_pinocchio(pin, written, meshes)
        read += 1
        counts += len(theirs), len(ours)
        differences += sum(a != b for a, b in zip(theirs, ours, strict=True))
        gaps.append(np.abs(places - again).max() if len(ours) else 0.0)
    assert read >= 67
    evidence = {"topic": TOPIC, "kind": "other code", "source": "Pinocchio 4.1"}
    name = f"{read} robots of example-robot-data, collision shapes"
    record_evidence(f"{name} of written files", counts[0], counts[1], tolerance=0.0, **evidence)
    record_evidence(f"{name} with other sizes in written files", 0.0, differences, tolerance=0.0, **evidence)
    record_evidence(
        f"{name}, places in written files (largest difference)",
        0.0, float(max(gaps)), tolerance=1e-14, noisy=True, **evidence,
    )  # fmt: skip


@pytest.mark.slow
def test_robots_of_others(record_evidence, tmp_path):
    """Total mass is that of the file; every element and attribute is imported or listed; written files are the same."""
    strict, read, gaps, errors, refusals = 0, 0, [], [], []
    for path in robots():
        document = minidom.parse(str(path)).documentElement
        try:
            tree = read_urdf(path)
            strict += 1
        except ModelError as error:
            if "impossible" not in str(error):
                continue  # no links, or a joint that follows a missing one
            refusals.append(str(error))
            try:
                tree = read_urdf(path, impossible="replace")
            except ModelError:
                continue
        read += 1
        total, imported = counted(document)
        gaps.append(total - imported - listed(tree))
        own = [node for node in document.childNodes if node.nodeName == "link"]
        masses = [float(node.getAttribute("value")) for link in own for node in link.getElementsByTagName("mass")]
        inertias = [one for one in [tree.inertia, *(link.inertia for link in tree.links)] if one is not None]
        errors.append(sum(one.mass for one in inertias) - sum(masses))
        write_urdf(tree, tmp_path / "again.urdf")
        again = read_urdf(tmp_path / "again.urdf")
        assert (again.numbers, again.inertia) == (tree.numbers, tree.inertia), path
        assert [link.name for link in again.links] == [link.name for link in tree.links], path
        assert [joint.axis for joint in again.moving] == [joint.axis for joint in tree.moving], path
        assert collision_shapes(again) == collision_shapes(tree), path
    assert (strict, read) >= (51, 67)
    assert all("about (" in sentence or "the mass is 0 kg" in sentence for sentence in refusals)  # axis and amount
    source = "example-robot-data 6.0, counted by another XML parser"
    evidence = {"topic": TOPIC, "kind": "other method", "source": source}
    record_evidence(
        f"{read} URDF robots, total mass against the sum in the file (largest difference)",
        0.0, float(np.abs(errors).max()), unit="kg", tolerance=1e-10, noisy=True, **evidence,
    )  # fmt: skip
    record_evidence(
        f"{read} URDF robots, elements and attributes that are neither imported nor listed",
        0.0, float(np.abs(gaps).sum()), tolerance=0.0, **evidence,
    )  # fmt: skip


ROBOTS = {
    "panda_description/urdf/panda.urdf": {"panda_finger_joint1": 0.01, "panda_finger_joint2": 0.01},
    "ur_description/urdf/ur5_robot.urdf": {},
    "xarm_description/urdf/xarm7.urdf": {},
}


@pytest.mark.slow
@pytest.mark.parametrize("name", ROBOTS)
def test_accelerations_against_pinocchio(name, record_evidence):
    """Accelerations of all links of a robot in motion, with damping and armatures."""
    pin = pytest.importorskip("pinocchio")
    path = next(own for own in robots() if own.as_posix().endswith(name))
    tree = read_urdf(path).with_fixed_joints(ROBOTS[name])
    names = [joint.name for joint in tree.moving]
    own = {f"{joint}.armature": 0.1 * (k + 1) for k, joint in enumerate(names)}
    tree = tree.with_numbers(
        own | {f"{joint}.damping": 0.2 for joint in names} | {f"{joint}.friction": 0.0 for joint in names}
    )
    rng = np.random.default_rng(0)
    positions, rates = (dict(zip(names, rng.uniform(-1, 1, len(names)), strict=True)) for _ in range(2))
    motion = simulate(tree.system(positions, rates), 1e-3, GeneralizedAlpha(step=1e-4))

    whole = pin.buildModelFromUrdf(str(path))
    neutral = pin.neutral(whole)
    for joint, position in ROBOTS[name].items():
        if whole.existJointName(joint):
            neutral[whole.joints[whole.getJointId(joint)].idx_q] = position
    locked = [whole.getJointId(joint) for joint in ROBOTS[name] if whole.existJointName(joint)]
    model = pin.buildReducedModel(whole, locked, neutral)
    data, q, v, torque = model.createData(), pin.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
    for joint in names:
        known = model.joints[model.getJointId(joint)]
        angle = positions[joint]
        q[known.idx_q : known.idx_q + known.nq] = [np.cos(angle), np.sin(angle)] if known.nq == 2 else angle
        v[known.idx_v], torque[known.idx_v] = rates[joint], -0.2 * rates[joint]
        model.armature[known.idx_v] = own[f"{joint}.armature"]
    pin.forwardKinematics(model, data, q, v, pin.aba(model, data, q, v, torque).copy())
    ours, theirs = [], []
    for link in tree.links:
        if link.joint.moves:
            k = model.getJointId(link.joint.name)
            axes, spatial, velocity = data.oMi[k].rotation, data.a[k], data.v[k]
            theirs += [
                *(axes @ spatial.angular),
                *(axes @ (spatial.linear + np.cross(velocity.angular, velocity.linear))),
            ]
            outputs = ("wx_rate", "wy_rate", "wz_rate", "ax", "ay", "az")
            ours += motion.channels([f"{link.name}.origin.{output}" for output in outputs])[0].tolist()
    record_evidence(
        f"{path.stem}: accelerations of all links in motion, with armatures",
        theirs, ours, tolerance=1e-12, relative=True, noisy=True, topic=TOPIC, kind="other code", source="Pinocchio 4.1",
    )  # fmt: skip
