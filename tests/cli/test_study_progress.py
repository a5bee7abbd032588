"""Progress of a study where stderr is no terminal: few lines, with the time left."""

from hrcplan.cli.study_progress import EpisodeLog


def test_lines_now_and_then_at_the_present_rate():
    now, lines = [0.0], []
    log = EpisodeLog(lines.append, lambda: now[0])
    for second in range(0, 400):
        now[0] = float(second)
        log(second if second < 200 else 200 + 10 * (second - 200), 10_000)
    assert lines[0] == "5 of 10,000 episodes; about 2.8 h left at the present rate"
    assert 10 < len(lines) < 30
    last = int(lines[-1].split(" of ")[0].replace(",", ""))
    assert last > 1000
    assert lines[-1].endswith(f"about {(10_000 - last) / 10 / 60:.0f} min left at the present rate")


def test_a_log_is_silent_if_work_is_done_at_once():
    lines = []
    log = EpisodeLog(lines.append, iter([0.0, 1.0, 2.0]).__next__)
    for n in (0, 5, 10):
        log(n, 10)
    assert not lines
