"""Pictures of models: what they contain, and what they cost."""

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from dalembert.multibody import Force, RevoluteJoint, RigidBar, Spring, System
from dalembert.report.look import DARK, LIGHT
from dalembert.report.pictures import picture
from dalembert.report.pictures.canvas import COLOURS, INK
from dalembert.structure import Material, lumped, plate
from dalembert.study import load
from dalembert.study.picture import study_picture
from dalembert.study.template import TEMPLATES
from dalembert.vibration import FrictionContact, HarmonicForce, VibrationSystem

STUDIES = Path(__file__).parents[3] / "studies"


def parts(svg):
    """Names of the parts by their roles."""
    found = {}
    for group in ET.fromstring(svg).iter("{http://www.w3.org/2000/svg}g"):
        found.setdefault(group.get("class"), []).append(group.get("data-part"))
    return found


def pendulum():
    system = System()
    rod = system.add(RigidBar("rod & co", length=1.0, mass=1.0))
    system.add(RevoluteJoint("pin", system.ground, rod.start))
    system.add(Spring("coil", system.ground.point(1.0, -1.0), rod.end, stiffness=3.0))
    system.add(Force("push", rod.end, x=1.0))
    return system


def test_each_part_of_a_mechanism_is_a_group_with_its_name():
    svg = picture(pendulum(), "A pendulum")
    assert parts(svg) == {
        "body": ["rod & co"],
        "load": ["coil", "push"],
        "joint": ["pin"],
        "gravity": ["gravity"],
    }
    assert ET.fromstring(svg).get("aria-label") == "A pendulum"


def test_the_picture_has_equal_scales_and_holds_the_bodies():
    svg = picture(pendulum())
    line = re.search(r'data-part="rod &amp; co">.*?<path d="M([\d.]+) ([\d.]+)L([\d.]+) ([\d.]+)"', svg)
    x0, y0, x1, y1 = map(float, line.groups())
    assert y0 == y1
    assert x1 - x0 == pytest.approx(225 - 2 * 26, abs=0.2)  # the spring is as high as the rod is long


def test_masses_springs_and_contacts_without_nodes_are_a_row():
    structure = lumped({"a": 1.0, "b": 1.0}, [("a", None, 1.0, 0.0), ("a", "b", 1.0, 0.0)])
    system = VibrationSystem(structure)
    system.add(HarmonicForce("b", 1.0))
    system.add(FrictionContact("foot", "b", friction=0.5, preload=1.0))
    assert parts(picture(system)) == {
        "spring": ["a – ground", "a – b"],
        "contact": ["foot"],
        "body": ["a", "b"],
        "force": ["b.x" if system.forces[0].dof == "b.x" else "b"],
    }


def test_a_mesh_has_its_edges_and_forces():
    square = plate((0.4, 0.4), 2e-3, Material(210e9, 0.3, 7800.0), (4, 4))
    system = VibrationSystem(square)
    system.add(HarmonicForce(f"{square.nodes.nearest((0.2, 0.2))}.z", 1.0))
    svg = picture(system)
    assert set(parts(svg)) == {"body", "force"}
    assert svg.count("Z") == 16 + 1  # faces, and the head of the arrow


def test_large_meshes_stay_small_files():
    fine = plate((0.4, 0.4), 2e-3, Material(210e9, 0.3, 7800.0), (50, 50))
    assert len(picture(VibrationSystem(fine))) < 150_000


def test_what_has_no_shape_has_no_picture():
    assert picture(object()) is None
    assert picture(System()) is None


@pytest.mark.parametrize("colour", [INK, *COLOURS])
def test_colours_can_be_seen_on_light_and_on_dark_pages(colour):
    def brightness(text):
        parts = np.array([int(text[k : k + 2], 16) for k in (1, 3, 5)]) / 255
        return np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4) @ (0.2126, 0.7152, 0.0722)

    for ground in (LIGHT.surface, DARK.surface):
        high, low = sorted((brightness(colour), brightness(ground)), reverse=True)
        assert (high + 0.05) / (low + 0.05) >= 3.0


@pytest.mark.parametrize("folder", sorted(entry.name for entry in TEMPLATES.iterdir()))
def test_each_template_has_a_picture(folder):
    study = load(Path(str(TEMPLATES / folder / "study.toml")))
    assert {"body"} <= set(parts(study_picture(study)))


@pytest.mark.slow
def test_a_reduced_structure_is_drawn_with_its_whole_mesh():
    svg = study_picture(load(STUDIES / "patched-plate" / "sweep.toml"))
    assert parts(svg)["body"] == ["structure"]


def test_a_python_function_has_no_picture(tmp_path):
    (tmp_path / "slow.py").write_text(
        "import numpy as np\nfrom dalembert.forward import PythonModel\n\n\n"
        "def decay(parameters):\n    return PythonModel(lambda rate: rate * np.ones(2), parameters, ['x'], [0.0, 1.0])\n"
    )
    study = tmp_path / "study.toml"
    study.write_text(
        "[parameters]\nrate = { lower = 0.5, upper = 2.0 }\n[model]\nforward = 'slow.py:decay'\n"
        "[sweep]\nat = 0.5\nchannels = ['x']\nsensitivities = false\nover = { rate = { count = 3 } }\n"
    )
    assert study_picture(load(study)) is None
