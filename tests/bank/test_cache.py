"""The cache of banks keeps what was used last."""

import os
from pathlib import Path

import pytest

from hrcplan.bank import cache, read_goals
from tests.worlds import PACKED, PARCELS, WORKSHOP


def files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_what_was_used_least_lately_goes_first(tmp_path: Path) -> None:
    for age, name in enumerate("abcd"):
        path = tmp_path / f"{name}.bank"
        path.write_bytes(b"x" * 10)
        os.utime(path, ns=(0, 10**9 * (10 - age)))
    (tmp_path / "other.txt").write_text("x" * 100)
    cache.drop_oldest(tmp_path, 25)
    assert files(tmp_path) == ["a.bank", "b.bank", "other.txt"]
    cache.drop_oldest(tmp_path, 5)
    assert files(tmp_path) == ["a.bank", "other.txt"]


def test_a_bank_in_use_stays_when_others_are_built(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HRCPLAN_CACHE", str(tmp_path / "cache"))
    (tmp_path / "domain.pddl").write_text(WORKSHOP)
    sets = [["rope-red", "wire-red"], ["rope-red", "both-red"], ["wire-red", "both-red"]]
    for n, names in enumerate(sets):
        (tmp_path / f"goals{n}").mkdir()
        for name in names:
            text = PACKED.format(name=name, goal=PARCELS[name])
            (tmp_path / f"goals{n}" / f"{name}.pddl").write_text(text)
    first, second, third = (
        read_goals(str(tmp_path / "domain.pddl"), str(tmp_path / f"goals{n}")) for n in range(3)
    )
    cache.cached_bank(first)
    banks = tmp_path / "cache" / "banks"
    (path,) = banks.iterdir()
    cache.cached_bank(second)
    for old in banks.iterdir():
        os.utime(old, ns=(0, 10**9 * (1 + (old != path))))
    cache.cached_bank(first)  # now it is the one that was used last
    total = sum(bank.stat().st_size for bank in banks.iterdir())
    cache.drop_oldest(banks, total - 1)
    assert files(banks) == [path.name]
    monkeypatch.setattr(cache, "MAX_BYTES", 1)
    cache.cached_bank(third)
    assert len(files(banks)) == 1
    assert not path.exists()
