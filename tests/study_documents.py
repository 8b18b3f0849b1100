"""Study documents taken apart and written again, for tests that put mistakes into them."""

from hypothesis import strategies as st

ODD = st.one_of(
    st.none().map(lambda _: {}),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=12),
    st.sampled_from(
        ["theta1", "-L", "3 kg", "1e999 m", "ground", "OA.end", "ground(", "x.py:f", "0/0", "9**9**9", "1 "]
    ),
    st.lists(st.integers(-2, 2), max_size=3),
    st.dictionaries(st.sampled_from(["kind", "end", "count", "x"]), st.sampled_from(["Step", 1, -1.5]), max_size=3),
)


def places(value: object, path: tuple = ()) -> list[tuple]:
    """Paths of everything in a document."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path] * bool(path) + [found for key, entry in inner for found in places(entry, (*path, key))]


def toml(value: object) -> str:
    """A value in TOML's inline form."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml(str(key))} = {toml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str):
        return '"' + "".join(f"\\U{ord(letter):08x}" for letter in value) + '"'
    return str(value).lower()
