"""What holds for every test: repeatable examples, and no hidden skips where skips are forbidden."""

import os
import signal
from collections.abc import Iterator

import pytest
from hypothesis import settings

# A shared machine has slow moments, so no deadline; the same examples in every run, so that a
# failure can be seen again. To look for new ones: tools/test --hypothesis-profile=explore
settings.register_profile("hrcplan", deadline=None, derandomize=True)
settings.register_profile("explore", deadline=None, max_examples=1000)
settings.load_profile("hrcplan")

# A run in the background ignores Ctrl-C, and so would everything that the tests start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True, scope="session")
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Nothing is found in, or left in, the cache folder of whoever runs the tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HRCPLAN_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.hookimpl(tryfirst=True)
def pytest_sessionfinish(session: pytest.Session) -> None:
    """With HRCPLAN_NO_SKIPS=1 (as in CI) a skipped test fails the run."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if os.environ.get("HRCPLAN_NO_SKIPS") != "1" or reporter is None:
        return  # workers of xdist have no reporter; their controller has it
    skipped = reporter.stats.get("skipped", [])
    if skipped:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
        reporter.write_line("")
    for report in skipped:
        reporter.write_line(f"skipped, but no skips are allowed: {report.nodeid}", red=True)
