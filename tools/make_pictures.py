"""Make the pictures of the documents: ``python tools/make_pictures.py``.

Every chart is what a command writes; only the figure of the architecture is drawn here, alone with
``python tools/make_pictures.py architecture``.
"""

from __future__ import annotations

import subprocess
import sys
import tomllib
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
SEEN = """(get human yogurt)
(get human berries)
(turn_on human blender)
(get human glass)
(pour human yogurt glass)
(pour human berries glass)
(get human oats)
(pour human oats glass)
"""
# Commands in order, in one folder; what they write under "images/" is kept.
COMMANDS = [
    ["plan", "transport/two-boxes", "--gantt", "images/two-boxes.svg"],
    ["plan", "transport/two-boxes", "--set", "motivation human=10",
     "--gantt", "images/two-boxes-distracted.svg"],
    ["plan", "transport/handover", "--gantt", "images/handover.svg"],
    ["plan", "household/sick-day", "--gantt", "images/sick-day.svg"],
    ["plan", "kitchen/parfait-fruit", "--planner", "fast-downward",
     "--gantt", "images/parfait.svg"],
    ["bank", "build", "kitchen", "-o", "kitchen.bank"],
    ["infer", "kitchen.bank", "seen.txt", "--plot", "images/posterior.svg"],
]  # fmt: skip
BOXES = [  # concept, what it is, x, y
    ("Task", "what can be done, by whom, at what cost", 10, 130),
    ("Plan", "who does what, when; replayed, proven", 300, 30),
    ("Run", "a plan carried out; replanned before it fails", 590, 30),
    ("Bank", "all plans of all goals, counted exactly", 300, 230),
    ("Belief", "what the human wants; what the robot does", 590, 230),
]
ARROWS = [  # from, to, label
    (0, 1, "planners"), (1, 2, "execution"), (0, 3, "goals"), (3, 4, "observe"),
]  # fmt: skip
WIDTH, HEIGHT = 205, 84
TOP, BOTTOM = 36, 384  # of the floors


def main() -> None:
    """Run the commands and draw the figure; with the word ``architecture`` the figure alone."""
    IMAGES.mkdir(exist_ok=True)
    if "architecture" not in sys.argv:
        make_charts()
    (IMAGES / "architecture.svg").write_text(architecture(), "utf-8")


def make_charts() -> None:
    """Run the commands that write charts."""
    with TemporaryDirectory() as folder:
        Path(folder, "seen.txt").write_text(SEEN)
        Path(folder, "images").mkdir()
        for words in COMMANDS:
            subprocess.run([sys.executable, "-m", "hrcplan", *words], cwd=folder, check=True)
        for file in Path(folder, "images").iterdir():
            (IMAGES / file.name).write_bytes(file.read_bytes())


def floors() -> list[str]:
    """Return the rooms of the package from the top, as the import contract lists them."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    contracts = settings["tool"]["importlinter"]["contracts"]
    layers = next(contract["layers"] for contract in contracts if "layers" in contract)
    return [layer.strip("()") for layer in layers if layer != "__main__"]


def architecture() -> str:
    """Return the five concepts with their arrows, and the floors of the package."""
    parts = [_text(10, 24, "PDDL files are the only description of a task", "#1a237e", 16)]
    for start, end, label in ARROWS:
        parts += _arrow(BOXES[start][2:], BOXES[end][2:], label)
    for name, words, x, y in BOXES:
        parts += _box(name, words, x, y)
    parts += _arrow_from_file(BOXES[0][2:])
    parts.append(_text(825, 24, "floors, from the top", "#1a237e", 16))
    rooms = floors()
    height = (BOTTOM - TOP) / len(rooms)
    for i, room in enumerate(rooms):
        y = TOP + height * i
        shade = f"hsl(231 48% {94 - 40 * i // len(rooms)}%)"
        parts.append(
            f'<rect x="825" y="{y:.1f}" width="175" height="{height - 2:.1f}" rx="3" '
            f'fill="{shade}"/>'
        )
        color = "#111" if i < 0.7 * len(rooms) else "#fff"
        parts.append(_text(912, round(y + height / 2 + 3), room, color, 12, "middle"))
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1010 390" font-family="sans-serif" '
        'role="img"><title>The five concepts of hrcplan and the floors of its package</title>'
        '<defs><marker id="head" viewBox="0 0 10 10" refX="9" refY="5" markerWidth="7" '
        'markerHeight="7" orient="auto-start-reverse"><path d="M0 0 10 5 0 10z" fill="#3949ab"/>'
        '</marker></defs><rect width="1010" height="390" fill="#fff"/>'
        f"{''.join(parts)}</svg>\n"
    )


def _box(name: str, words: str, x: int, y: int) -> list[str]:
    half = words.rfind(" ", 0, 27)
    return [
        f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="6" fill="#e8eaf6" '
        'stroke="#3949ab"/>',
        _text(x + WIDTH // 2, y + 26, name, "#1a237e", 18, "middle", bold=True),
        _text(x + WIDTH // 2, y + 48, words[:half], "#333", 14, "middle"),
        _text(x + WIDTH // 2, y + 66, words[half + 1 :], "#333", 14, "middle"),
    ]


def _arrow(start: tuple[int, int], end: tuple[int, int], label: str) -> list[str]:
    x1, y1, x2, y2 = start[0] + WIDTH, start[1] + 40, end[0], end[1] + 40
    aside = 16 if y2 < y1 else 0
    below = 44 if y2 > y1 else (-10 if y2 == y1 else -34)
    return [
        f'<line x1="{x1}" y1="{y1}" x2="{x2 - 2}" y2="{y2}" stroke="#3949ab" stroke-width="2" '
        'marker-end="url(#head)"/>',
        _text((x1 + x2) // 2 - aside, (y1 + y2) // 2 + below, label, "#333", 14, "middle"),
    ]


def _arrow_from_file(end: tuple[int, int]) -> list[str]:
    x, y = end[0] + WIDTH // 2, end[1]
    return [
        f'<line x1="{x}" y1="36" x2="{x}" y2="{y - 2}" stroke="#3949ab" stroke-width="2" '
        'marker-end="url(#head)"/>',
        _text(x + 8, 86, "read, check", "#333", 14),
    ]


def _text(
    x: int, y: int, text: str, fill: str, size: int, anchor: str = "start", *, bold: bool = False
) -> str:
    weight = ' font-weight="bold"' if bold else ""
    style = f'fill="{fill}" font-size="{size}" text-anchor="{anchor}"{weight}'
    return f'<text x="{x}" y="{y}" {style}>{escape(text)}</text>'


if __name__ == "__main__":
    main()
