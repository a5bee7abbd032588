"""Progress of a study where stderr is no terminal: few lines, with the time left."""

from pathlib import Path

import pytest

from hrcplan.cli.study_progress import LARGE, EpisodeLog, study_progress


def test_lines_now_and_then_at_the_present_rate():
    now, lines = [0.0], []
    log = EpisodeLog(lines.append, lambda: now[0])
    for second in range(0, 400):
        now[0] = float(second)
        log(second if second < 200 else 200 + 10 * (second - 200), 10_000)
    assert lines[0] == "0 of 10,000 episodes"
    assert lines[1] == "5 of 10,000 episodes"  # too few to tell a rate
    assert lines[3].endswith("about 2.8 h left at the present rate")
    assert 10 < len(lines) < 30
    last = int(lines[-1].split(" of ")[0].replace(",", ""))
    assert last > 1000
    assert lines[-1].endswith(f"about {(10_000 - last) / 10 / 60:.0f} min left at the present rate")


def test_what_is_loaded_before_the_first_episode_tells_no_rate():
    now, lines = [0.0], []
    log = EpisodeLog(lines.append, lambda: now[0])
    for n in range(201):
        now[0] = 0.0 if n == 0 else 50 + n / 10
        log(n, 1_100)
    n_done = int(lines[-1].split()[0])
    assert n_done > 20
    assert lines[-1].endswith(f"about {(1_100 - n_done) / 10:.0f} s left at the present rate")


def test_a_log_of_work_that_is_done_is_silent():
    lines = []
    log = EpisodeLog(lines.append, iter([0.0, 1.0]).__next__)
    for _ in range(2):
        log(10, 10)
    assert not lines


@pytest.mark.parametrize(("n_all", "has_hint"), [(LARGE, False), (LARGE + 1, True)])
def test_a_large_study_says_how_to_look_at_its_first_rows(n_all, has_hint, capsys):
    with study_progress(Path("rows")) as progress:
        progress(0, n_all)
        progress(1, n_all)
    text = capsys.readouterr().err
    assert text.count("hrcplan study report rows") == has_hint
    assert f"0 of {n_all:,} episodes" in text
