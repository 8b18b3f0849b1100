"""What the model of a study is, and which tables and keys belong to it."""

from collections.abc import Mapping
from typing import Any

STRUCTURE = ("mass", "spring", "rotor", "speed", "force", "contact", "structure")
"""Tables of structures."""
_KEYS: dict[str, tuple[str, ...]] = {
    "file": ("file",),
    "function": ("function", "forward", "arguments"),
    "mechanism": (
        "body", "joint", "load", "robot", "space", "gravity", "driving", "start", "pose", "rates",
    ),
    "structure": STRUCTURE,
}  # fmt: skip
_TELLING = (
    ("file", ("file",)),
    ("function", ("function", "forward")),
    ("mechanism", ("body", "robot")),
    ("structure", ("mass", "structure")),
    ("mechanism", _KEYS["mechanism"]),
    ("structure", _KEYS["structure"]),
)
"""Kinds by the keys that identify them, the most specific first."""


def model_kind(document: Any) -> str:
    """Return what a document's model is: "file", "function", "mechanism" or "structure"; empty while nothing says it.
    >>> model_kind({"model": {"joint": [{}]}}), model_kind({"model": {"mass": [{}], "gravity": 1}}), model_kind({})
    ('mechanism', 'structure', '')
    """
    model = _model(document)
    return next((kind for kind, keys in _TELLING if any(key in model for key in keys)), "")


def fits_model(document: Any, key: object) -> bool:
    """Return True if a key of ``[model]`` belongs to a model of the document's kind.
    >>> [fits_model({"model": {"body": [{}]}}, key) for key in ("joint", "contact", "file", "key of a plug-in")]
    [True, False, False, True]
    """
    kind = model_kind(document)
    known = {key for keys in _KEYS.values() for key in keys}
    return not kind or key in _KEYS[kind] or key not in known


def model_file(document: Any) -> str:
    """Return the name of the file that holds the model; empty if the document holds it itself."""
    name = _model(document).get("file")
    return name if isinstance(name, str) else ""


def model_elsewhere(document: Any) -> str:
    """Return a sentence that says where the model is; empty if its tables are in the document.
    >>> model_elsewhere({"model": {"file": "pendulum.toml"}})
    'The bodies, joints, forces and other parts of the model are in pendulum.toml. Change them there.'
    """
    model = _model(document)
    if file := model_file(document):
        return f"The bodies, joints, forces and other parts of the model are in {file}. Change them there."
    function = model.get("function") or model.get("forward")
    return f"The function {function} makes the model. Change it there." if isinstance(function, str) else ""


def _model(document: Any) -> Mapping[str, Any]:
    model = document.get("model")
    return model if isinstance(model, Mapping) else {}
