"""Forests in the cache folder: found again, never half, and no burden where that is impossible."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from hrcplan.bank import build, load, save
from hrcplan.bank.store import digest
from hrcplan.cli.main import main
from hrcplan.core.array_file import Arrays
from hrcplan.core.files import cache_folder
from hrcplan.inference.classifier import cache as kept
from hrcplan.inference.classifier.forest import ForestBelief
from hrcplan.inference.classifier.training import prefixes

SMALL = {"seed": 2, "n_samples": 400, "n_trees": 6}


@pytest.fixture(scope="module")
def two(kitchen):
    return build(kitchen.goals.only(kitchen.names[::15]))


@pytest.fixture(scope="module")
def rows(two):
    return prefixes(two, 200, np.random.default_rng(1))[0]


def files(folder):
    return sorted(folder.glob("*.forest"))


@pytest.fixture
def untrainable(monkeypatch):
    """From now on training is an error."""

    def fail(*_):
        raise AssertionError("a forest was trained")

    return lambda: monkeypatch.setattr("hrcplan.inference.classifier.forest.train", fail)


def test_the_second_forest_is_the_first(two, rows, tmp_path, untrainable):
    first = ForestBelief(two, **SMALL, cache=tmp_path / "deep" / "down")
    (file,) = files(tmp_path / "deep" / "down")
    data = file.read_bytes()
    bare = ForestBelief(two, **SMALL, cache=False)
    untrainable()
    save(two, tmp_path / "b.bank")
    for bank in (two, load(tmp_path / "b.bank")):
        again = ForestBelief(bank, **SMALL, cache=tmp_path / "deep" / "down", n_jobs=-1)
        assert (
            again.posteriors(rows).tolist()
            == first.posteriors(rows).tolist()
            == bare.posteriors(rows).tolist()
        )
        assert again.training == first.training
        assert "kept since" in again.note
    assert "kept since" not in first.note
    assert file.read_bytes() == data


def test_everything_a_forest_depends_on_makes_another_file(two, hall, tmp_path):
    others = [{"seed": 3}, {"n_samples": 500}, {"n_trees": 7}]
    for change in [{}, *others]:
        ForestBelief(two, **(SMALL | change), cache=tmp_path)
    ForestBelief(hall, **SMALL, cache=tmp_path)
    assert len(files(tmp_path)) == 5
    key = kept.key_of(two, 2, 400, 6)
    assert set(kept._PACKAGES) < set(key)
    assert digest(two) != digest(hall)


def damage(data, how):
    """Return the bytes of a forest's file, spoiled in one of several ways."""
    if how == "flipped":
        return data[:-9] + bytes([data[-9] ^ 4]) + data[-8:]
    if how in ("foreign", "senseless"):
        header, _ = kept._FORMAT.decode(data, "file")
        key = {} if how == "foreign" else header["key"]
        return kept._FORMAT.encode({"key": key}, Arrays())
    return {"empty": b"", "cut": data[:-8], "other": b"x" * 200}[how]


REASONS = {
    "empty": "is no trained forest",
    "other": "is no trained forest",
    "cut": "bytes instead of",
    "flipped": "checksum is wrong",
    "foreign": "forest of something else",
    "senseless": "makes no sense",
}


@pytest.mark.parametrize("how", REASONS)
def test_a_spoiled_file_is_made_anew_and_says_why(two, rows, tmp_path, untrainable, how):
    first = ForestBelief(two, **SMALL, cache=tmp_path)
    (file,) = files(tmp_path)
    spoiled = damage(file.read_bytes(), how)
    file.unlink()  # the first forest still has the old file
    file.write_bytes(spoiled)
    anew = ForestBelief(two, **SMALL, cache=tmp_path)
    assert "trained again" in anew.note
    assert REASONS[how] in anew.note
    assert anew.posteriors(rows).tolist() == first.posteriors(rows).tolist()
    untrainable()
    assert "trained again" not in ForestBelief(two, **SMALL, cache=tmp_path).note


def test_where_nothing_can_be_kept_the_forest_is_made_all_the_same(two, rows, tmp_path):
    expected = ForestBelief(two, **SMALL, cache=False).posteriors(rows).tolist()
    (tmp_path / "file").write_text("in the way")
    found = ForestBelief(two, **SMALL, cache=tmp_path / "file" / "folder")
    assert found.posteriors(rows).tolist() == expected
    assert (tmp_path / "file").read_text() == "in the way"

    ForestBelief(two, **SMALL, cache=tmp_path)
    (file,) = files(tmp_path)
    file.unlink()
    file.mkdir()
    found = ForestBelief(two, **SMALL, cache=tmp_path)
    assert found.posteriors(rows).tolist() == expected
    assert "cannot read" in found.note


def test_without_a_lock_file_nothing_is_written(two, tmp_path):
    ForestBelief(two, **SMALL, cache=tmp_path)
    (file,) = files(tmp_path)
    file.unlink()
    file.with_suffix(".lock").unlink()
    file.with_suffix(".lock").mkdir()
    ForestBelief(two, **SMALL, cache=tmp_path)
    assert files(tmp_path) == []


def test_without_locks_nothing_is_written(two, rows, tmp_path, monkeypatch):
    def no_locks(*_):
        raise OSError("no locks available")

    monkeypatch.setattr(kept.fcntl, "flock", no_locks)
    found = ForestBelief(two, **SMALL, cache=tmp_path)
    assert files(tmp_path) == []
    assert found.posteriors(rows).shape == (len(rows), 2)


PROBE = """
import sys
from pathlib import Path
from hrcplan.bank import load
from hrcplan.inference.classifier.forest import ForestBelief
bank = load(sys.argv[1])
print("ready", flush=True)
sys.stdin.readline()
found = ForestBelief(bank, seed=2, n_samples=400, n_trees=6, cache=Path(sys.argv[2]))
print("kept since" in found.note)
print(found.posterior(found.observe(found.start(), 1)).tolist())
print(sorted({name.partition(".")[0] for name in sys.modules}))
"""


def probed(n, bank, folder):
    """Return what processes print that make the same forest at the same moment."""
    save(bank, folder / "b.bank")
    command = [sys.executable, "-c", PROBE, folder / "b.bank", folder / "cache"]
    piped = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    workers = [subprocess.Popen(command, **piped) for _ in range(n)]
    for worker in workers:
        assert worker.stdout.readline() == "ready\n"
    for worker in workers:
        worker.stdin.write("go\n")
        worker.stdin.flush()
    found = [worker.communicate(timeout=100)[0].splitlines() for worker in workers]
    assert all(worker.returncode == 0 for worker in workers)
    return found


def test_of_several_processes_one_trains_and_all_have_the_same(two, tmp_path):
    found = probed(3, two, tmp_path)
    assert sorted(is_from_cache for is_from_cache, *_ in found) == ["False", "True", "True"]
    assert len({posterior for _, posterior, _ in found}) == 1
    assert len(files(tmp_path / "cache")) == 1


def test_a_kept_forest_needs_no_scikit_learn(two, tmp_path):
    first = ForestBelief(two, **SMALL, cache=tmp_path / "cache")
    ((is_from_cache, posterior, loaded),) = probed(1, two, tmp_path)
    assert is_from_cache == "True"
    assert posterior == str(first.posterior(first.observe(first.start(), 1)).tolist())
    assert "'numpy'" in loaded
    assert "'sklearn'" not in loaded
    assert "'scipy'" not in loaded


def test_where_the_cache_folder_is(monkeypatch):
    monkeypatch.setenv("HRCPLAN_CACHE", "/here")
    monkeypatch.setenv("XDG_CACHE_HOME", "/shared")
    monkeypatch.setenv("HOME", "/home/someone")
    assert cache_folder() == Path("/here")
    monkeypatch.setenv("HRCPLAN_CACHE", "")
    assert cache_folder() == Path("/shared/hrcplan")
    for ignored in ("", "not/from/the/root"):
        monkeypatch.setenv("XDG_CACHE_HOME", ignored)
        assert cache_folder() == Path("/home/someone/.cache/hrcplan")

    def homeless():
        raise RuntimeError("no home")

    monkeypatch.setattr(Path, "home", homeless)
    assert cache_folder() is None


def test_doctor_names_the_folder_and_its_size(tmp_path, monkeypatch):
    monkeypatch.setenv("HRCPLAN_CACHE", str(tmp_path))
    (tmp_path / "a.forest").write_bytes(b"x" * 250_000)
    assert f"cache: {tmp_path}, 0.2 MB" in CliRunner().invoke(main, ["doctor"]).output
