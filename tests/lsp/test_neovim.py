"""A real editor: Neovim shows a fault, applies its fix and renames, without a screen."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

NVIM = shutil.which("nvim")
pytestmark = pytest.mark.skipif(NVIM is None, reason="Neovim is not installed (apt: neovim)")

SCRIPT = """
local result = {}
vim.ui.select = function(items, _, choose) choose(items[1], 1) end
local function wait(what, ready)
  if not vim.wait(20000, ready, 50) then
    vim.fn.writefile({vim.fn.json_encode({error = what})}, 'result.json')
    vim.cmd('cquit')
  end
end
vim.cmd('edit domain.pddl')
local client = vim.lsp.start_client({cmd = {'PYTHON', '-m', 'hrcplan', 'lsp'},
                                     root_dir = vim.fn.getcwd()})
vim.lsp.buf_attach_client(0, client)
wait('no diagnostics', function() return #vim.diagnostic.get(0) > 0 end)
local fault = vim.diagnostic.get(0)[1]
result.message = fault.message
result.line = fault.lnum + 1
vim.api.nvim_win_set_cursor(0, {fault.lnum + 1, fault.col + 1})
vim.lsp.buf.code_action()
wait('not fixed', function() return #vim.diagnostic.get(0) == 0 end)
vim.fn.search('inside')
vim.lsp.buf.rename('within')
wait('not renamed', function() return vim.fn.search('within', 'nw') > 0 end)
result.text = vim.api.nvim_buf_get_lines(0, 0, -1, false)
vim.fn.writefile({vim.fn.json_encode(result)}, 'result.json')
vim.cmd('qall!')
"""
DOMAIN = """(define (domain boxes)
  (:requirements :typing)
  (:types box place)
  (:predicates (inside ?b - box ?p - place))
  (:action move
    :parameters (?b - box ?from ?to - place)
    :precondition (insid ?b ?from)
    :effect (and (not (inside ?b ?from)) (inside ?b ?to))))
"""


def test_neovim_shows_a_fault_fixes_and_renames(tmp_path: Path) -> None:
    (tmp_path / "domain.pddl").write_text(DOMAIN)
    (tmp_path / "init.lua").write_text(SCRIPT.replace("PYTHON", sys.executable))
    assert NVIM is not None
    command = [NVIM, "--headless", "--clean", "-n", "-c", "luafile init.lua", "-c", "cquit"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert (tmp_path / "result.json").exists(), done.stderr
    result = json.loads((tmp_path / "result.json").read_text())
    assert "error" not in result, (result, done.stderr)
    assert "'insid' is not declared" in result["message"]
    assert result["line"] == 7
    text = "\n".join(result["text"])
    assert text.count("within") == 4
    assert "insid" not in text
