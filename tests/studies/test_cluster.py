"""Studies on a cluster: same rows, whatever ends or fails on the way."""

import asyncio
import json
import os
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from hrcplan.errors import InputError, LimitError, PlannerError, UsageError
from hrcplan.studies import run_study
from hrcplan.studies.cluster import tasks
from hrcplan.studies.cluster.backlog import RETRIES, Backlog, EpisodeBatch
from hrcplan.studies.cluster.connection import find_scheduler
from hrcplan.studies.quarantine import end_with_quarantine
from hrcplan.studies.study import Episode, find
from tests.studies.clusters import Cluster, kill_group, toy_study, wait_until

STUDY = "toy:STUDY"
ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.xdist_group("cluster")
slow = pytest.mark.skipif(
    "HRCPLAN_NO_SKIPS" not in os.environ, reason="only with tools/test --all: it takes long"
)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    with Cluster(tmp_path_factory.mktemp("cluster")) as cluster:
        yield cluster


@pytest.fixture
def toy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with a study; it is the current folder, so that its module is found."""
    toy_study(tmp_path)
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    sys.modules.pop("toy", None)


def rows(folder: Path) -> bytes:
    return (folder / "rows.sqlite").read_bytes()


def episodes_run(folder: Path) -> Counter[str]:
    return Counter((folder / "log").read_text().splitlines())


def command(address: str, folder: Path, *words: str) -> "subprocess.Popen[str]":
    """Start ``study run`` of the toy study in its folder."""
    argv = [sys.executable, "-m", "hrcplan", "study", "run", STUDY, "--cluster", address,
            "-o", "out", *words]  # fmt: skip
    return subprocess.Popen(
        argv, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip


# Backlog and quarantine.


def test_batch_that_fails_is_run_again_then_singly_then_not_at_all() -> None:
    poison, cured = (Episode("rows", ("one",), run) for run in range(2))

    async def runs() -> tuple[list[int], dict[Episode, str]]:
        backlog, sizes = Backlog([poison, cured]), []
        one, other = await backlog.take(), await backlog.take()
        backlog.put_back(EpisodeBatch([*one.episodes, *other.episodes]))
        while not backlog.done.is_set():
            batch = await asyncio.wait_for(backlog.take(), 5)
            sizes.append(len(batch.episodes))
            if poison in batch.episodes:
                backlog.fail(batch, "broken")
            else:
                backlog.close(batch, 1.0)
        return sizes, backlog.quarantine

    sizes, quarantine = asyncio.run(runs())
    assert sizes == [2] * (1 + RETRIES) + [1, 1]
    assert quarantine == {poison: "broken"}


def test_batch_that_was_not_run_has_not_failed() -> None:
    async def runs() -> EpisodeBatch:
        backlog = Backlog([Episode("rows", ("one",), 0)])
        backlog.put_back(await backlog.take())
        assert not backlog.done.is_set()
        return await backlog.take()

    assert asyncio.run(runs()).n_failures == 0


@pytest.mark.parametrize("n_slots", [1, 4, 1000])
def test_batches_grow_to_a_sensible_duration_and_shrink_at_the_end(n_slots: int) -> None:
    """Episodes take .01 s here; a scheduler gets no more than 50 batches a second or so."""
    everything = [Episode("rows", ("one",), run) for run in range(200_000)]

    async def batches() -> list[list[Episode]]:
        backlog, taken = Backlog(everything), []
        backlog.n_slots = n_slots
        while not backlog.done.is_set():
            batch = await backlog.take()
            taken.append(list(batch.episodes))
            backlog.close(batch, 0.01 * len(batch.episodes))
        return taken

    taken = asyncio.run(batches())
    assert [episode for batch in taken for episode in batch] == everything
    sizes = list(map(len, taken))
    assert sizes[:3] == [1, 2, 4]
    assert sizes[-1] == 1
    wanted_s = max(1.0, 0.02 * n_slots)
    if n_slots < 1000:  # else there are too few episodes for it
        assert wanted_s / 2 <= 0.01 * max(sizes) <= 2 * wanted_s
    assert max(sizes) <= len(everything) / (2 * n_slots)


def test_nothing_to_do_is_done_at_once() -> None:
    async def is_done() -> bool:
        return Backlog([]).done.is_set()

    assert asyncio.run(is_done())


def test_quarantine_names_episodes_and_goes_with_the_last_one(tmp_path: Path) -> None:
    failures = {Episode("rows", ("one", 2), run): f"why {run}" for run in range(5)}
    with pytest.raises(LimitError, match=r"5 episodes in quarantine.*run 0: why 0.*and 2 more"):
        end_with_quarantine(tmp_path, failures)
    document = json.loads((tmp_path / "quarantine.json").read_text())
    first = {"table": "rows", "cell": ["one", 2], "run": 0, "why": "why 0"}
    assert document["episodes"][0] == first
    assert len(document["episodes"]) == 5
    end_with_quarantine(tmp_path, {})
    assert not (tmp_path / "quarantine.json").exists()


# Addresses.


@pytest.mark.parametrize(
    "address", ["nowhere", "nowhere:port", "http://127.0.0.1:80", "tcp://[::1", "", "inproc://x"]
)
def test_what_is_no_address_is_wrong_use(address: str) -> None:
    with pytest.raises(UsageError, match="no address of a scheduler"):
        find_scheduler(address)


def test_address_at_which_no_scheduler_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("hrcplan.studies.cluster.connection.ANSWER_S", 0.2)
    with pytest.raises(PlannerError, match=r"no scheduler answers at 127\.0\.0\.1:9"):
        run_study(STUDY, tmp_path / "out", cluster="127.0.0.1:9")
    assert not (tmp_path / "out").exists()


def test_scheduler_file(cluster: Cluster, tmp_path: Path) -> None:
    assert find_scheduler(str(cluster.folder / "scheduler.json")) == cluster.address
    with pytest.raises(InputError, match="no file"):
        find_scheduler(str(tmp_path / "missing.json"))
    (tmp_path / "odd.json").write_text("[]")
    with pytest.raises(InputError, match="names no address"):
        find_scheduler(str(tmp_path / "odd.json"))


def test_jobs_and_cluster_are_not_named_together(toy: Path) -> None:
    with pytest.raises(UsageError, match="not both"):
        run_study(STUDY, toy / "out", jobs=2, cluster="127.0.0.1:9")
    process = command("127.0.0.1:9", toy, "--jobs", "1")
    assert "not both" in process.communicate()[1]
    assert process.returncode == 2


# Runs.


def test_same_bytes_as_on_this_machine(cluster: Cluster, toy: Path) -> None:
    progress: list[int] = []
    n_new = run_study(STUDY, toy / "far", runs=60, cluster=cluster.address,
                      progress=lambda n_done, n_all: progress.append(n_done))  # fmt: skip
    assert n_new == 120
    assert set(episodes_run(toy).values()) == {1}
    assert progress[0] == 0
    assert progress[-1] == 120
    run_study(STUDY, toy / "near", runs=60)
    assert rows(toy / "far") == rows(toy / "near")
    assert run_study(STUDY, toy / "far", runs=60, cluster=cluster.address) == 0


FAULTS = {
    "raise": "ZeroDivisionError: broken",
    "leave": "SystemExit: 3",
    "kill": "killed by signal 9",
}


@pytest.mark.parametrize(
    "orders",
    [{3: "raise"}, pytest.param({3: "raise", 12: "leave", 31: "kill"}, marks=slow)],
    ids=["raises", "raises, ends its process, is killed"],
)
def test_poisonous_episodes_are_in_quarantine_until_they_run(
    cluster: Cluster, toy: Path, orders: dict[int, str]
) -> None:
    for run, order in orders.items():
        (toy / f"run-{run}").write_text(order)
    n_runs, n = max(orders) + 1, 2 * len(orders)
    process = command(cluster.address, toy, "--runs", str(n_runs))
    _, text = process.communicate()
    assert process.returncode == 4, text
    assert f"{n} episodes in quarantine" in text
    found = json.loads((toy / "out" / "quarantine.json").read_text())["episodes"]
    assert [(one["cell"], one["run"]) for one in found] == [
        ([cell], run) for cell in ("one", "three") for run in orders
    ]
    assert all(FAULTS[orders[one["run"]]] in one["why"] for one in found)
    for run in orders:
        (toy / f"run-{run}").unlink()
    assert run_study(STUDY, toy / "out", runs=n_runs, cluster=cluster.address) == n
    run_study(STUDY, toy / "near", runs=n_runs)
    assert rows(toy / "out") == rows(toy / "near")
    assert not (toy / "out" / "quarantine.json").exists()


@slow
def test_worker_killed_in_the_middle(cluster: Cluster, toy: Path) -> None:
    """Nothing is lost and nothing is there twice; what a worker leaves is run by another."""
    (toy / "run-5").write_text("2")
    victim = cluster.add_worker()
    process = command(cluster.address, toy, "--runs", "40")
    try:
        wait_until((toy / "log").exists)
        kill_group(victim)
        _, text = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 0, text  # also if it died before it was compared with the others
    run_study(STUDY, toy / "near", runs=40)
    assert rows(toy / "out") == rows(toy / "near")


@slow
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_interrupted_run_goes_on(
    cluster: Cluster, toy: Path, number: signal.Signals, code: int
) -> None:
    """What runs on the workers ends at once, too."""
    (toy / "run-20").write_text("600")
    process = command(cluster.address, toy, "--runs", "21")
    try:
        wait_until((toy / "log").exists)
        process.send_signal(number)
        _, text = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == code, text
    assert "Traceback" not in text
    (toy / "run-20").unlink()
    run_study(STUDY, toy / "out", runs=21, cluster=cluster.address)
    run_study(STUDY, toy / "near", runs=21)
    assert rows(toy / "out") == rows(toy / "near")


@slow
def test_scheduler_killed_in_the_middle(cluster: Cluster, toy: Path, tmp_path: Path) -> None:
    (toy / "run-20").write_text("600")
    with Cluster(tmp_path) as mortal:
        process = command(mortal.address, toy, "--runs", "21")
        try:
            wait_until((toy / "log").exists)
            kill_group(mortal.scheduler)
            _, text = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == 5, text
    assert "is gone" in text
    assert "Traceback" not in text
    (toy / "run-20").unlink()
    run_study(STUDY, toy / "out", runs=21, cluster=cluster.address)
    run_study(STUDY, toy / "near", runs=21)
    assert rows(toy / "out") == rows(toy / "near")


# The studies of hrcplan.

FETCH = Path(__file__).parent / "fetch"
WORKSHOP = Path(__file__).parent / "workshop"
GOALS = {"domain": WORKSHOP / "domain.pddl", "goals": WORKSHOP}
STUDIES = {
    "failure-anticipation": {"domain": FETCH / "domain.pddl", "problem": FETCH / "four-items.pddl"},
    "changed-mind": {**GOALS, "methods": "hrcplan,oracle"},
    "collaboration": {**GOALS, "methods": "joint,goal-only"},
}


@slow
@pytest.mark.parametrize("name", STUDIES)
def test_study_has_the_bytes_of_one_process(cluster: Cluster, tmp_path: Path, name: str) -> None:
    options = {key: str(value) for key, value in STUDIES[name].items()}
    run_study(name, tmp_path / "far", options=options, limit=40, cluster=cluster.address)
    run_study(name, tmp_path / "near", options=options, limit=40)
    assert rows(tmp_path / "far") == rows(tmp_path / "near")


@slow
def test_worker_gets_the_banks_that_its_cache_lacks(tmp_path: Path) -> None:
    """The duration of the making stands in a bank, so equal bytes were made once."""
    cache = tmp_path / "cache"
    options = {"methods": "oracle", **{key: str(path) for key, path in GOALS.items()}}
    with Cluster(tmp_path, n_workers=0) as cluster:
        cluster.add_worker(HRCPLAN_CACHE=str(cache))
        run_study("changed-mind", tmp_path / "out", options=options, limit=2,
                  cluster=cluster.address)  # fmt: skip
    banks = {path.name: path.read_bytes() for path in (cache / "banks").iterdir()}
    own = Path(os.environ["HRCPLAN_CACHE"]) / "banks"
    assert banks
    assert all((own / name).read_bytes() == data for name, data in banks.items())


def test_forests_and_banks_are_what_episodes_read() -> None:
    study, task = find("changed-mind"), {key: str(path) for key, path in GOALS.items()}
    with_forest = study.files(study.with_defaults(task))
    without = study.files(study.with_defaults({**task, "methods": "oracle"}))
    assert [path.suffix for path in with_forest] == [".bank", ".forest"]
    assert list(without) == list(with_forest[:1])
    assert without[0].is_file()


# Workers that differ.


OTHER = "import hrcplan\nhrcplan.__version__ = '0.0.9'\n"


def add_other_worker(cluster: Cluster, code: str = OTHER) -> None:
    """Start a worker with another version of hrcplan, or with what code says."""
    folder = cluster.folder / "other"
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(code)
    cluster.add_worker(PYTHONPATH=os.pathsep.join([str(folder), str(ROOT)]))


def test_worker_of_another_version_is_refused(toy: Path, tmp_path: Path) -> None:
    """Before anything runs; one that joins later takes no part."""
    with Cluster(tmp_path, n_workers=0) as mixed:
        add_other_worker(mixed)
        with pytest.raises(UsageError, match=r"has hrcplan 0\.0\.9, not") as caught:
            run_study(STUDY, toy / "out", cluster=mixed.address)
        assert caught.value.code == "worker-differs"
        assert not (toy / "out").exists()
        assert not (toy / "log").exists()


@slow
def test_worker_without_hrcplan_ends_the_run_at_once(toy: Path, tmp_path: Path) -> None:
    with Cluster(tmp_path, n_workers=0) as mixed:
        add_other_worker(mixed, "import sys\nsys.modules['hrcplan'] = None\n")
        with pytest.raises(UsageError, match="is hrcplan installed there"):
            run_study(STUDY, toy / "out", cluster=mixed.address)


@slow
def test_worker_that_joins_later_is_compared_too(toy: Path, tmp_path: Path) -> None:
    (toy / "run-0").write_text("6")
    texts: list[str] = []
    with Cluster(tmp_path, n_workers=1) as mixed:
        process = command(mixed.address, toy, "--runs", "40")
        wait_until((toy / "out").exists)
        add_other_worker(mixed)
        texts += process.communicate(timeout=60)
    assert process.returncode == 0, texts
    assert "takes no part: it has hrcplan 0.0.9" in texts[1]


def test_other_inputs_and_missing_modules_are_refused(
    cluster: Cluster, toy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = tasks.ClusterJob(
        tasks.StudyWork(STUDY, (), 0), str(toy), tasks.software_versions(), "0" * 64
    )
    with pytest.raises(tasks.DifferenceError, match="other inputs"):
        tasks.check_inputs(job)
    __import__("toy")
    (toy / "elsewhere").mkdir()
    monkeypatch.chdir(toy / "elsewhere")
    with pytest.raises(UsageError, match=r"lacks something: there is no module 'toy'"):
        run_study(STUDY, toy / "out", cluster=cluster.address)
