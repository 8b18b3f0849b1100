"""The page about study files: its example runs, and it leaves nothing out."""

import re
from pathlib import Path

import pytest

from dalembert.study import json_schema, load, run_study
from dalembert.study.tables.catalogue import ROLES, kinds_of

PAGE = (Path(__file__).parents[3] / "docs/how-to/study-files.md").read_text(encoding="utf-8")
SPACE = "Components in space"
PLANAR, _, IN_SPACE = PAGE.partition(f"## {SPACE}\n")
IN_SPACE, _, REST = IN_SPACE.partition("\n## ")
FREE_BODIES = IN_SPACE.partition("| modes |")[2].partition("| `[[model.joint]]`")[0]
SECTIONS, _, INERTIAS = IN_SPACE.partition("| section |")[2].partition("| inertia |")
OTHERS = {
    f"{'Spatial' * space}{kind.__name__}"
    for space in (False, True)
    for role in ROLES
    if not space or role in ("body", "joint", "load")
    for kind in kinds_of(role, space=space)
    if not kind.__module__.startswith("dalembert.")
}
DEFINITIONS = {"Study": json_schema(), **json_schema()["$defs"]}
DEFINITIONS = {name: table for name, table in DEFINITIONS.items() if name not in OTHERS}  # those of test modules
TABLES = {
    "Study": ["The tables", "The tasks"],
    "About": ["study"],
    "ParameterTable": [r"parameters\.NAME"],
    "ModelTable": ["model", "Structures"],
    "SpatialModelTable": ["model"],
    "RobotTable": [r"model\.robot"],
    "Orientation": [SPACE],
    "Pose": [SPACE],
    "GroundPoint": [SPACE],
    "NodePoint": [SPACE],
    "Friction": [SPACE],
    "SlidingFriction": [SPACE],
    "GeneralizedAlpha": ["solver"],
    "DataTable": ["data"],
    "ChannelFile": ["data"],
    "StartTable": ["data"],
    "DerivativeTable": ["data"],
    "BandsTable": ["data", "bands"],
    "ExperimentTable": ["data", "experiments"],
    "SensorTable": [r'sensors\."AB.end.x"'],
    "InputTable": ["data", r"inputs\.NAME"],
    "InputReference": [r"inputs\.NAME"],
    "SimulateTable": ["simulate"],
    "IdentifyTable": ["identify"],
    "ShootingTable": ["identify"],
    "NoiseTable": ["identify"],
    "ChannelNoiseTable": ["identify"],
    "DeviationTable": ["identify"],
    "NormalTable": [r"parameters\.NAME"],
    "LogNormalTable": [r"parameters\.NAME"],
    "HalfNormalTable": [r"parameters\.NAME"],
    "UniformTable": [r"parameters\.NAME"],
    "LogUniformTable": [r"parameters\.NAME"],
    "CorrelationTable": ["prior_correlations"],
    "GlobalSensitivityTable": ["global_sensitivity"],
    "ScreeningTable": ["screening"],
    "RegulariseTable": ["regularise"],
    "SampleTable": ["sample"],
    "nuts": ["sample"],
    "affine-invariant": ["sample"],
    "delayed-acceptance": ["sample"],
    "StateTable": ["identify"],
    "SweepTable": ["sweep"],
    "CampbellTable": ["campbell"],
    "EquilibriumPathTable": ["equilibrium_path"],
    "LoadRangeTable": ["equilibrium_path"],
    "BoundsTable": ["sweep"],
    "PropagateTable": ["propagate"],
    "IdentifyInertiasTable": ["identify_inertias"],
    "ExcitingTrajectoryTable": ["exciting_trajectory"],
    "IdentifyBandsTable": ["identify_bands"],
    "IdentifySetTable": ["identify_set"],
    "DesignTable": ["design"],
    "FrequencyResponseTable": ["frequency_response"],
    "FamilyTable": ["frequency_response"],
    "HeldAmplitudeTable": ["frequency_response"],
    "CompareInTimeTable": ["frequency_response"],
    "Newmark": ["frequency_response"],
    "TrackResonanceTable": ["track_resonance"],
    "BackboneTable": ["backbone"],
    "StaticContactTable": ["static_contact"],
    "ModesTable": ["modes"],
    "HarmonicBalance": ["harmonic_balance"],
    "LocalParameterTable": [r"parameters\.NAME", "experiments"],
    "StructureTable": [r"model\.structure"],
    "ReductionTable": [r"model\.structure"],
    "WorkPrecisionTable": ["work_precision"],
    "SeriesTable": ["work_precision"],
    "dalembert__study__text__numbers__Grid__1": ["Numbers"],
    "dalembert__study__text__numbers__Grid__2": ["Numbers"],
    "dalembert__study__text__numbers__Grid__3": ["Numbers"],
    "dalembert__study__text__numbers__Grid__4": ["Numbers"],
}
"""Where the page tells of a table that is not one kind of several."""

BODIES = {
    "AncfBeam",
    "AncfCable",
    "Beam",
    "Cable",
    "ReducedBody",
    "RigidBar",
    "RigidBarBetween",
    "RigidBody",
    "PointMass",
}
JOINTS = {name.removeprefix("Spatial") for name in DEFINITIONS if name.endswith(("Joint", "PrescribedMotion"))}
LOADS = {
    "Force",
    "Torque",
    "Spring",
    "TorsionSpring",
    "UserForce",
    "Bushing",
    "Motor",
    "Servo",
    "Armature",
    "InertialSensor",
    "RelativeSensor",
    "BeamSensor",
    "CableSensor",
    "RecoverySensor",
    "LineForce",
}
EVERYWHERE = {kind: {"name"} for kind in BODIES | LOADS} | {kind: {"name", "a", "b"} for kind in JOINTS}
"""Keys that the page gives once for all kinds."""


def test_the_example_runs(tmp_path):
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
    path = tmp_path / "example.toml"
    path.write_text(example)
    folder, outcome = run_study(load(path), tmp_path / "run")
    assert folder.path.is_dir()
    assert outcome.success


@pytest.mark.parametrize("name", sorted(DEFINITIONS))
def test_every_kind_key_and_choice_is_where_the_page_tells_of_its_table(name):
    table = DEFINITIONS[name]
    there, name = _place(name, table), name.removeprefix("Spatial")
    words = set(re.findall(r"[A-Za-z]\w*", there))
    assert set(table.get("properties", {})) - {"kind"} <= words | EVERYWHERE.get(name, set())
    missing = [choice for choice in _choices(table) if f'"{choice}"' not in there and f"`{choice}`" not in there]
    assert missing == []


def _place(name, table):
    """What the page says of a table: its row where it is one kind of several, else the entry or section of its own."""
    if name in TABLES:
        return "\n".join(_entry(title) for title in TABLES[name])
    kind, text = table["properties"]["kind"]["const"], PLANAR + REST + INERTIAS
    texts = {"Spatial": IN_SPACE, "Section": SECTIONS, "FreeBody": FREE_BODIES}
    text = next((own for prefix, own in texts.items() if name.startswith(prefix)), text)
    (row,) = [
        line
        for line in text.splitlines()
        if "|" in line and re.search(f'`{kind}`|kind = "{kind}"', line.strip(" |").partition(" |")[0])
    ]
    return row


def _entry(title):
    """Text of the entry of a table such as ``[data]``, or of a section."""
    pattern = rf"^## {title}$.*?(?=^## )" if title[0].isupper() else rf"^`\[+{title}\]+`.*?(?=^\n`\[|^## )"
    return re.search(pattern, PAGE, flags=re.DOTALL | re.MULTILINE)[0]


def _choices(table):
    """Texts that a key of the table itself may have, other than kinds, which have a place of their own."""
    for key, entry in table.get("properties", {}).items():
        for one in (entry, *entry.get("anyOf", ()), *entry.get("oneOf", ())):
            if key != "kind":
                given = (*one.get("enum", ()), one.get("const"))
                yield from (choice for choice in given if isinstance(choice, str) and choice not in DEFINITIONS)
