"""Measures of the sources, with limits that may only fall: ``python tools/code_measures.py [-v | --lower]``.

``tools/limits.toml`` has the limits. ``-v`` lists what each measure counts; ``--lower`` writes the measures of today in
place of larger limits.

A **kernel** is a function that Numba compiles, and what is nested in it. Such functions are as long as their loop. A
name counts once in each function, class or module that defines it: as a variable, an argument, an attribute, a function
or a class.
"""

import ast
import io
import re
import statistics
import sys
import tokenize
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCES = ROOT / "src" / "dalembert"
LIMITS = ROOT / "tools" / "limits.toml"
COMPILED = {"cfunc", "inlined", "inner", "intrinsic", "kernel", "law", "njit", "overload"}
"""Decorators of kernels."""
VAGUE = {"own", "found", "told", "given", "one", "asked", "held", "made", "there", "others", "whole"}
NUMERICS = {"kernels", "integrators", "balance", "laws", "surrogate", "samplers", "optimize"}
"""Folders with numerical methods, whose comments are counted."""
LONGEST_FUNCTION, MOST_COMPLEX, LONGEST_FILE = 80, 25, 400
DIRECTIVE = re.compile(r"#\s*(fmt|type|pyright|noqa|ruff|pragma)\b")
Function = ast.FunctionDef | ast.AsyncFunctionDef
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
DEFINITIONS = (*FUNCTIONS, ast.ClassDef)
BRANCHES = (ast.If, ast.For, ast.AsyncFor, ast.While, ast.ExceptHandler, ast.IfExp, ast.match_case, ast.comprehension)
BLANK = {getattr(tokenize, name) for name in ("NL", "NEWLINE", "INDENT", "DEDENT", "ENDMARKER")}


@dataclass(frozen=True)
class Source:
    """A file of the package: its path below the package, and its text."""

    path: Path
    text: str

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.text)

    @property
    def lines(self) -> int:
        return self.text.count("\n")

    @property
    def module(self) -> str:
        parts = self.path.with_suffix("").parts
        return ".".join(("dalembert", *(parts[:-1] if parts[-1] == "__init__" else parts)))

    @property
    def package(self) -> str:
        return self.path.parts[0] if len(self.path.parts) > 1 else ""


@dataclass(frozen=True)
class Measure:
    """A number, and what it counts."""

    value: float
    cases: list[str] = field(default_factory=list)


def sources(folder: Path = SOURCES) -> list[Source]:
    """Python files below a folder."""
    files = sorted(folder.rglob("*.py"))
    return [Source(file.relative_to(folder), file.read_text(encoding="utf-8")) for file in files]


def is_compiled(function: Function) -> bool:
    """Whether a decorator compiles a function.

    >>> is_compiled(ast.parse("@inlined('x')" + chr(10) + "def f(): pass").body[0])
    True
    """
    called = (item.func if isinstance(item, ast.Call) else item for item in function.decorator_list)
    return any(getattr(item, "id", getattr(item, "attr", "")) in COMPILED for item in called)


def functions(node: ast.AST) -> Iterator[Function]:
    """Functions and methods outside kernels, and not those nested in functions."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, FUNCTIONS):
            yield from functions(child)
        elif not is_compiled(child):
            yield child


def length(function: Function) -> int:
    """Lines of a function without its docstring, which grows with the number of arguments.

    >>> length(ast.parse("def f(x):" + chr(10) + " 'Text.'" + chr(10) + " return x").body[0])
    2
    """
    documentation = function.body[0] if ast.get_docstring(function) else None
    lines = (function.end_lineno or 0) - function.lineno + 1
    return lines if documentation is None else lines - (documentation.end_lineno or 0) + documentation.lineno - 1


def complexity(function: Function) -> int:
    """Cyclomatic complexity: one, and one for each branch, loop, handler, case and boolean operator.

    >>> complexity(ast.parse("def f(x): return [y for y in x if y and y > 0] if x else 0").body[0])
    5
    """
    total = 1
    for node in ast.walk(function):
        total += isinstance(node, BRANCHES)
        if isinstance(node, ast.comprehension):
            total += len(node.ifs)
        elif isinstance(node, ast.BoolOp):
            total += len(node.values) - 1
    return total


def names(scope: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and name of each variable, argument, attribute, function and class, once in each scope that defines it.

    >>> list(names(ast.parse("def f(x):" + chr(10) + " y = x" + chr(10) + " x = y")))
    [(1, 'f'), (1, 'x'), (2, 'y')]
    """
    defined: dict[str, int] = {}
    scopes: list[ast.AST] = []
    pending = list(ast.iter_child_nodes(scope))
    while pending:
        node = pending.pop()
        if isinstance(node, ast.Name | ast.Attribute):
            if isinstance(node.ctx, ast.Store):
                name = node.id if isinstance(node, ast.Name) else node.attr
                defined[name] = min(node.lineno, defined.get(name, node.lineno))
        elif isinstance(node, ast.arg):
            defined[node.arg] = node.lineno
        elif isinstance(node, DEFINITIONS):
            defined[node.name] = min(node.lineno, defined.get(node.name, node.lineno))
            scopes.append(node)
            continue
        pending.extend(ast.iter_child_nodes(node))
    yield from sorted((line, name) for name, line in defined.items())
    for inner in sorted(scopes, key=lambda node: node.lineno):
        yield from names(inner)


def words(name: str) -> list[str]:
    """Words of a name in lower case.

    >>> words("_given_Values2"), words("OwnPoint")
    (['given', 'values'], ['own', 'point'])
    """
    return [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)]


def private_functions(source: Source) -> Iterator[tuple[Function, int]]:
    """Private functions of a module, each with the number of its uses in that module."""
    loads = Counter(
        node.id for node in ast.walk(source.tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
    )
    for node in source.tree.body:
        if isinstance(node, FUNCTIONS) and node.name.startswith("_") and not node.name.startswith("__"):
            yield node, loads[node.name]


def imports(source: Source, modules: set[str]) -> set[str]:
    """Modules of the package that a module imports when it is loaded."""
    imported: set[str] = set()
    pending: list[ast.AST] = list(source.tree.body)
    while pending:
        node = pending.pop()
        if isinstance(node, FUNCTIONS) or (isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)):
            continue
        if isinstance(node, ast.Import):
            imported |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                submodule = f"{node.module}.{alias.name}"
                imported.add(submodule if submodule in modules else node.module)
        elif isinstance(node, ast.stmt):
            pending.extend(
                child for child in ast.iter_child_nodes(node) if isinstance(child, ast.stmt | ast.excepthandler)
            )
    return (imported & modules) - {source.module}


def circles(graph: dict[str, set[str]]) -> list[list[str]]:
    """Groups of modules that import one another, directly or by way of others.

    >>> circles({"a": {"b"}, "b": {"a", "c"}, "c": set()})
    [['a', 'b']]
    """
    reached: dict[str, set[str]] = {}
    for start in graph:
        pending, seen = [start], set()
        while pending:
            for module in graph[pending.pop()] - seen:
                seen.add(module)
                pending.append(module)
        reached[start] = seen
    groups = {
        tuple(sorted(module for module in reached[start] if start in reached[module]))
        for start in graph
        if start in reached[start]
    }
    return [list(group) for group in sorted(groups)]


def comments(source: Source) -> tuple[int, int]:
    """Lines with a comment and lines of code of a file; docstrings and directives are neither.

    >>> comments(Source(Path("a.py"), "# why" + chr(10) + "x = 1  # what" + chr(10) + "y = 2  # fmt: skip"))
    (2, 2)
    """
    strings: set[int] = set()
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            strings |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    commented: set[int] = set()
    code: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source.text).readline):
        if token.type == tokenize.COMMENT:
            if not DIRECTIVE.match(token.string):
                commented.add(token.start[0])
        elif token.type not in BLANK:
            code |= set(range(token.start[0], token.end[0] + 1)) - strings
    return len(commented), len(code)


def shared_names(files: list[Source]) -> list[list[Source]]:
    """Files of one name within a package; each package of ``dalembert`` counts alone."""
    by_name: dict[tuple[str, str], list[Source]] = defaultdict(list)
    for source in files:
        if source.path.name != "__init__.py":
            by_name[source.package, source.path.name].append(source)
    return [group for group in by_name.values() if len(group) > 1]


def measures(files: list[Source]) -> dict[str, Measure]:
    """All measures, by the name of their limit."""
    outside = [(source, function) for source in files for function in functions(source.tree)]
    long = [(length(function), source, function) for source, function in outside]
    complex_ = [(complexity(function), source, function) for source, function in outside]
    defined = [(source, line, name) for source in files for line, name in names(source.tree)]
    vague = [(source, line, name) for source, line, name in defined if VAGUE.intersection(words(name))]
    private = [(source, function, uses) for source in files for function, uses in private_functions(source)]
    once = [(source, function) for source, function, uses in private if uses == 1]
    modules = {source.module for source in files}
    groups = circles({source.module: imports(source, modules) for source in files})
    numerics = [(source, *comments(source)) for source in files if NUMERICS.intersection(source.path.parts[:-1])]
    commented, code = sum(count for _, count, _ in numerics), sum(count for _, _, count in numerics)
    twins = shared_names(files)
    return {
        "lines": _measure(sum(source.lines for source in files)),
        "long_functions": _counted(
            f"{source.path}:{function.lineno}: {function.name} has {lines} lines"
            for lines, source, function in long
            if lines > LONGEST_FUNCTION
        ),
        "complex_functions": _counted(
            f"{source.path}:{function.lineno}: {function.name} has complexity {number}"
            for number, source, function in complex_
            if number > MOST_COMPLEX
        ),
        "long_files": _counted(
            f"{source.path} has {source.lines} lines" for source in files if source.lines > LONGEST_FILE
        ),
        "median_lines": _measure(statistics.median(source.lines for source in files)),
        "modules_in_circles": Measure(sum(map(len, groups)), [" → ".join([*group, group[0]]) for group in groups]),
        "called_once_percent": _measure(
            100 * len(once) / len(private),
            (f"{source.path}:{function.lineno}: {function.name}" for source, function in once),
        ),
        "vague_names_percent": _measure(
            100 * len(vague) / len(defined), (f"{source.path}:{line}: {name}" for source, line, name in vague)
        ),
        "files_of_shared_names": Measure(
            sum(map(len, twins)), [", ".join(str(source.path) for source in group) for group in twins]
        ),
        "comments_per_1000_lines": _measure(
            1000 * commented / code, (f"{source.path}: {count} of {lines}" for source, count, lines in numerics)
        ),
    }


def _measure(value: float, cases: Iterable[str] = ()) -> Measure:
    return Measure(round(value, 2), list(cases))


def _counted(cases: Iterable[str]) -> Measure:
    listed = list(cases)
    return Measure(len(listed), listed)


def limits() -> dict[str, dict[str, float]]:
    """Limit of each measure (``most`` or ``least``), and the ``margin`` by which it may be slacker than needed."""
    return tomllib.loads(LIMITS.read_text(encoding="utf-8"))["code_measures"]


def excess(value: float, limit: dict[str, float]) -> float:
    """Return by how much a measure violates its limit. A negative number is a reserve.

    >>> excess(5, {"most": 4}), excess(50, {"least": 60}), excess(70, {"least": 60})
    (1, 10, -10)
    """
    return value - limit["most"] if "most" in limit else limit["least"] - value


def tightened(text: str, values: dict[str, float]) -> str:
    """Text of the table of limits with today's values in place of slacker limits."""
    for name, value in values.items():
        row = re.search(rf"^{name} = {{ (most|least) = ([\d.]+)", text, re.MULTILINE)
        if row and excess(value, {row[1]: float(row[2])}) < 0:
            text = text[: row.start(2)] + f"{value:g}" + text[row.end(2) :]
    return text


def main() -> int:
    results = measures(sources())
    if "--lower" in sys.argv:
        text = LIMITS.read_text(encoding="utf-8")
        LIMITS.write_text(tightened(text, {name: item.value for name, item in results.items()}), encoding="utf-8")
    exceeded = False
    for name, limit in limits().items():
        if "-v" in sys.argv:
            print(*results[name].cases, sep="\n")
        bound = "most" if "most" in limit else "least"
        exceeded |= excess(results[name].value, limit) > 0
        print(f"{name:24} {results[name].value:10g}   at {bound} {limit[bound]:g}")
    return int(exceeded)


if __name__ == "__main__":
    sys.exit(main())
