"""Servers over standard input and output end at a signal, though their client is still there."""

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

HELLO = {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {
    "capabilities": {}, "protocolVersion": "2025-06-18", "processId": None, "rootUri": None,
    "clientInfo": {"name": "test", "version": "1"}}}  # fmt: skip


@pytest.mark.parametrize("name", ["lsp", "mcp"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_server_that_waits_for_input(
    name: str, number: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    server = subprocess.Popen(
        [sys.executable, "-m", "hrcplan", name],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert server.stdin is not None
    assert server.stdout is not None
    hello = json.dumps(HELLO)
    header = f"Content-Length: {len(hello)}\r\n\r\n" if name == "lsp" else ""
    server.stdin.write(f"{header}{hello}\n".encode())
    server.stdin.flush()
    assert server.stdout.readline()  # it has answered, and waits for the next request
    server.send_signal(number)
    try:
        assert server.wait(timeout=60) == 128 + number
    finally:
        server.kill()
    assert list(tmp_path.iterdir()) == []
    assert b"Traceback" not in server.communicate()[1]
