"""Rules about the whole package: one definition per name, no import cycles, true references."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from runpy import run_path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "hrcplan"
MODULES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
    for path in sorted(PACKAGE.rglob("*.py"))
}
TREES = {name: ast.parse(path.read_text(encoding="utf-8")) for name, path in MODULES.items()}


def type_names(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield the public classes and type aliases of a module, each with what it stands for.

    Two aliases of one type are the same definition; a class never is that of another module.
    """
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield node.name, f"class {node.name} {id(node)}"
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                if isinstance(target, ast.Name) and re.fullmatch(r"[A-Z]\w*[a-z]\w*", target.id):
                    yield target.id, ast.unparse(node.value).replace("npt.", "")


def definitions() -> dict[str, dict[str, str]]:
    """Return what each type name stands for, by a module that says so."""
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for module, tree in TREES.items():
        for name, meaning in type_names(tree):
            found[name].setdefault(meaning, module)
    return found


def test_every_type_name_has_one_definition() -> None:
    assert {n: [*where.values()] for n, where in definitions().items() if len(where) > 1} == {}


def glossary() -> list[str]:
    """Return the words of the glossary."""
    rows = re.findall(r"^\| (.+?) \|", (ROOT / "docs/glossary.md").read_text("utf-8"), re.MULTILINE)
    return [re.sub(r"[*`]", "", word).strip() for row in rows for word in re.split(r"[,/]", row)]


def test_a_glossary_word_is_explained_once() -> None:
    words = [word for word in glossary() if word not in ("word", "---")]
    assert len(words) > 60
    assert [word for word in set(words) if words.count(word) > 1] == []


def test_a_glossary_word_names_one_class() -> None:
    classes = definitions()
    names = {"".join(part.title() for part in re.split(r"[ -]", word)) for word in glossary()}
    defined = {name: classes[name] for name in names & classes.keys()}
    assert {"Plan", "PlanGraph", "Belief", "Assistant", "Course"} <= defined.keys()
    assert all(len(modules) == 1 for modules in defined.values()), defined


def imports(module: str) -> Iterator[str]:
    """Yield the modules of the package that are loaded when a module is: not those in functions."""
    waiting: list[ast.stmt] = list(TREES[module].body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield from (
                name if (name := f"{node.module}.{alias.name}") in MODULES else node.module
                for alias in node.names
            )
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.If) and "TYPE_CHECKING" not in ast.unparse(node.test):
            waiting += [*node.body, *node.orelse]
        elif isinstance(node, ast.Try):
            waiting += [*node.body, *node.orelse, *(s for h in node.handlers for s in h.body)]


def test_no_imports_go_round() -> None:
    edges = {name: {to for to in imports(name) if to in MODULES and to != name} for name in MODULES}
    while leaves := [name for name, targets in edges.items() if not targets & edges.keys()]:
        for name in leaves:
            del edges[name]
    assert edges == {}, "these modules import one another"


def test_the_figure_shows_the_rooms_of_the_import_contract() -> None:
    """After a change: ``python tools/make_pictures.py architecture``."""
    drawing = run_path(str(ROOT / "tools" / "make_pictures.py"))["architecture"]()
    assert (ROOT / "docs" / "images" / "architecture.svg").read_text("utf-8") == drawing


def headings(document: Path) -> set[str]:
    """Return the headings of a document, in small letters."""
    text = document.read_text(encoding="utf-8")
    return {line.lstrip("# ").strip().lower() for line in text.splitlines() if line[:1] == "#"}


# `docs/design.md`, and docs/design.md, "Execution"
CITED = re.compile(r"\b(docs/[\w/-]+\.md)(?:`{0,2},\s*(?:section\s+)?[\"“]([^\"”]+)[\"”])?")
SOURCES = [*PACKAGE.rglob("*.py"), *PACKAGE.rglob("*.toml"), *(ROOT / "tests").rglob("*.py"),
           *(ROOT / "tools").iterdir(), *(ROOT / "domains").glob("*.pddl")]  # fmt: skip


def test_cited_documents_and_sections_exist() -> None:
    faults = []
    for source in (path for path in SOURCES if path.is_file() and path != Path(__file__)):
        text = re.sub(r"\n\s*(#|;;?)?\s*", " ", source.read_text(encoding="utf-8"))
        place = source.relative_to(ROOT)
        for name, section in CITED.findall(text):
            if not (ROOT / name).is_file():
                faults.append(f"{place} cites {name}")
            elif section and section.lower() not in headings(ROOT / name):
                faults.append(f"{place} cites {name}, {section}")
        if re.search(r"\bDESIGN\b", text):
            faults.append(f"{place} cites DESIGN: the design is docs/design.md")
    assert faults == []


@pytest.mark.parametrize("name", ["CONTRIBUTING.md", "README.md"])
def test_files_named_in_documents_exist(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    paths = re.findall(r"`([\w-]+(?:/[\w-]+)*/(?:[\w-]+\.(?:py|md|toml))?)`", text)
    assert paths
    missing = [p for p in paths if not any((base / p).exists() for base in (ROOT, PACKAGE))]
    assert missing == []


VAGUE = re.compile(
    r"\b(some(one|body)('s)?|whoever|anybody|nobody|a stranger('s)?|by chance|beside|anew|mend|"
    r"its word counts|what is kept|likewise|dear(est)?|ours|told|stands in)\b",
    re.IGNORECASE,
)


def prose(path: Path) -> Iterator[tuple[int, str]]:
    """Yield comments, docstrings and messages of a file, with their lines; code is left out."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".py":
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type == tokenize.COMMENT or (
                token.type == tokenize.STRING and " " in token[1]
            ):
                yield token.start[0], re.sub(r"\{[^{}]*\}|[\w-]+=", "", token.string)
    else:
        for number, line in enumerate(text.splitlines(), 1):
            if path.suffix == ".md" or line.startswith("#"):
                yield number, re.sub(r"`[^`]*`", "", line)


def test_prose_names_who_and_what() -> None:
    """Docstrings, comments, messages and documents say which agent, file or value they mean."""
    files = [
        *PACKAGE.rglob("*.py"), *PACKAGE.rglob("*.toml"), *(ROOT / "docs").rglob("*.md"),
        ROOT / "README.md",
    ]  # fmt: skip
    faults = [
        f"{path.relative_to(ROOT)}:{number}: {match[0]}"
        for path in files
        for number, text in prose(path)
        for match in VAGUE.finditer(text)
    ]
    assert faults == []


Definition = ast.FunctionDef | ast.ClassDef


def public_definitions(body: list[ast.stmt]) -> Iterator[Definition]:
    """Yield the public classes and functions of a body, methods too; not the overloads."""
    for node in body:
        if isinstance(node, Definition) and not node.name.startswith("_"):
            if "overload" not in map(ast.unparse, node.decorator_list):
                yield node
            if isinstance(node, ast.ClassDef):
                yield from public_definitions(node.body)


def own_nodes(node: ast.AST) -> Iterator[ast.AST]:
    """Yield what a function itself does: not what functions and classes inside it do."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, (ast.FunctionDef, ast.ClassDef, ast.Lambda)):
            yield child
            yield from own_nodes(child)


def errors_raised(function: Definition) -> set[str]:
    """Return the errors of hrcplan that a function itself raises."""
    raised = (node.exc for node in own_nodes(function) if isinstance(node, ast.Raise) and node.exc)
    calls = (exc.func if isinstance(exc, ast.Call) else exc for exc in raised)
    errors = {n.name for n in TREES["hrcplan.errors"].body if isinstance(n, ast.ClassDef)}
    return {call.id for call in calls if isinstance(call, ast.Name)} & errors


def test_public_functions_have_docstrings_that_name_their_errors() -> None:
    faults = []
    for module, tree in TREES.items():
        for node in public_definitions(tree.body):
            text = ast.get_docstring(node)
            is_command = "hrcplan.cli" in module and any(
                "command" in ast.unparse(decorator) for decorator in node.decorator_list
            )
            if text is None:
                faults.append(f"{module}.{node.name} has no docstring")
            elif isinstance(node, ast.FunctionDef) and not is_command and "Raises:" not in text:
                faults += [f"{module}.{node.name} raises {e}" for e in errors_raised(node)]
    assert faults == []


def bound_names(tree: ast.Module) -> Iterator[str]:
    """Yield the names of variables, parameters, attributes and functions, as often as bound."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.FunctionDef):
            yield node.name


def test_a_name_says_what_a_thing_is() -> None:
    names = {module: set(bound_names(tree)) for module, tree in TREES.items()}
    vague = {"found", "said", "had", "drawn", "made", "taken", "asked"}
    assert {module: own & vague for module, own in names.items() if own & vague} == {}


def test_parameters_have_types() -> None:
    """Anything is accepted only where another program decides what is passed on.

    The two programs that run on the Python of ROS speak with ROS only, which has no types.
    """
    parameters = [
        f"{module}.{function.name}({parameter.arg})"
        for module, tree in TREES.items()
        if module not in ("hrcplan.execution.links.ros.bridge", "hrcplan.execution.links.ros.robot")
        for function in ast.walk(tree)
        if isinstance(function, ast.FunctionDef) and function.name != "__eq__"
        for parameter in ast.walk(function.args)
        if isinstance(parameter, ast.arg) and parameter.annotation is not None
        if ast.unparse(parameter.annotation) in ("Any", "object")
    ]
    assert len(parameters) <= 5, parameters
