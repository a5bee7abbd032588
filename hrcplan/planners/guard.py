"""Supervise one program: the script that ``process.run`` starts, never imported.

A planner cannot be trusted to end, nor to end its children. This small process stands between
hrcplan and the planner. It is a *child subreaper* (Linux ``prctl``): a descendant that loses its
parent, daemons included, becomes a child of this process. So "no child is left" means that
nothing at all is left, and a killed tree cannot hide anything. It is two processes: the guard, and
a watcher above it that takes over if the guard is killed, by a planner or for want of memory.

It must start fast (it is paid for on every planner call), hence the standard library only, no
``site``, and signal numbers instead of the ``signal`` module, whose import costs 3 ms.

Protocol: standard input is the lifeline. It carries one marshalled job and then stays silent (the
program reads nothing, or the file descriptor that the job names);
end of file means that hrcplan is gone or has had enough. The answer, a marshalled
``(reason, exit code, message)``, goes to the file descriptor named by the first argument.
"""

import ctypes
import marshal
import os
import resource
import select
import sys
import time

LIFELINE = 0
GRACE_S = 0.3  # between TERM and KILL
PATIENCE_S = 5.0  # after KILL: a process in an uninterruptible wait must not hang hrcplan
TICK_S = 0.02
IDLE_TICK_S = 0.1
DUTY = 20  # a look at /proc may take one part in so many of the time

HUP, INT, QUIT, KILL, PIPE, TERM, CHLD, XFSZ = 1, 2, 3, 9, 13, 15, 17, 25
DEFAULT, IGNORE = ctypes.c_void_p(0), ctypes.c_void_p(1)
PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
PAGE = os.sysconf("SC_PAGE_SIZE")
LIBC = ctypes.CDLL(None)


def main() -> None:
    """Run the job that stands on the lifeline, clear up, and report."""
    report = int(sys.argv[1])
    os.set_inheritable(report, False)
    try:
        argv, env, parent, time_s, memory, stdin = marshal.load(sys.stdin.buffer)
    except EOFError:  # hrcplan ended between starting this process and writing the job
        return
    harden()
    watcher = os.getpid()
    guard = os.fork()
    if guard:
        if stdin is not None:
            os.close(stdin)
        stand_by(guard, parent, time_s, report)
    harden()  # to be a subreaper is not inherited
    supervise(argv, env, watcher, time_s, memory, stdin, report)


def stand_by(guard: int, parent: int, time_s: float, report: int) -> None:
    """Wait for the guard; if it is killed or stopped, or hrcplan is gone, clear up for it.

    What the guard leaves behind becomes a child of this process.
    """
    deadline = time.monotonic() + max(0.0, time_s) + GRACE_S + PATIENCE_S + 1.0
    waiter = select.poll()
    pause_s = TICK_S
    try:
        waiter.register(os.pidfd_open(guard), select.POLLIN)
        pause_s = IDLE_TICK_S
    except OSError:  # an old kernel
        pass
    while True:
        waiter.poll(pause_s * 1000)
        dead: dict[int, int] = {}
        reap(dead)
        if dead.get(guard) == 0:
            os._exit(0)
        if guard in dead or time.monotonic() > deadline:
            end_all(guard, 0.0)
            reason = "lost" if guard in dead else "timeout"
            os.write(report, marshal.dumps((reason, None, "")))
            os._exit(0)
        if os.getppid() != parent:
            end_all(guard, GRACE_S)
            os._exit(0)


def end_all(guard: int, grace_s: float) -> None:
    """End the guard, which may be stopped, and then all that it leaves behind."""
    if guard in descendants():
        os.kill(guard, KILL)
    clear(grace_s)


def supervise(
    argv: list[bytes], env: dict[bytes, bytes], parent: int, time_s: float, memory: int | None,
    stdin: int | None, report: int,
) -> None:  # fmt: skip
    """Run the planner, clear up, and report."""
    planner, fault = start(argv, env, stdin)
    if fault:
        answer: tuple[str, int | None, str] = ("missing", None, fault)
    else:
        reason, code = watch(planner, parent, time_s, memory)
        # Memory is taken back at once: a grace period could eat the rest of the machine.
        clear(0.0 if reason == "memory" else GRACE_S)
        answer = (reason, code, "")
    try:
        os.write(report, marshal.dumps(answer))
    finally:  # also if the parent is gone; and nothing is left to finalize
        os._exit(0)


def harden() -> None:
    """Adopt orphans, leave no core files, and let only the lifeline end this process."""
    LIBC.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    for number in (HUP, INT, TERM):
        LIBC.signal(number, IGNORE)
    # An ignored SIGCHLD is inherited, and would lose the exit code.
    LIBC.signal(CHLD, DEFAULT)


def start(argv: list[bytes], env: dict[bytes, bytes], stdin: int | None) -> tuple[int, str]:
    """Return the planner's process id, and why it could not be started ("" if it was)."""
    fault_read, fault_write = os.pipe()  # closed by a successful exec
    planner = os.fork()
    if planner == 0:
        become(argv, env, stdin, fault_write)
    os.close(fault_write)
    if stdin is not None:
        os.close(stdin)
    fault = os.read(fault_read, 4096).decode()
    os.close(fault_read)
    if fault:
        os.waitpid(planner, 0)
    return planner, fault


def become(argv: list[bytes], env: dict[bytes, bytes], stdin: int | None, fault_write: int) -> None:
    """Turn this forked copy into the planner; on failure say why and end."""
    try:
        os.setsid()
        # If the guard is killed, the planner must not outlive it.
        LIBC.prctl(PR_SET_PDEATHSIG, KILL, 0, 0, 0)
        for number in (HUP, INT, QUIT, PIPE, TERM, XFSZ):
            LIBC.signal(number, DEFAULT)
        os.dup2(os.open(os.devnull, os.O_RDONLY) if stdin is None else stdin, 0)
        if stdin is not None:
            os.close(stdin)
        os.execvpe(argv[0], argv, env)
    except (OSError, ValueError) as error:
        os.write(fault_write, (getattr(error, "strerror", None) or str(error)).encode())
    finally:
        os._exit(127)


def watch(planner: int, parent: int, time_s: float, memory: int | None) -> tuple[str, int | None]:
    """Return why the planner has to end, and its exit code if it ended by itself."""
    deadline = time.monotonic() + time_s
    waiter = select.poll()
    waiter.register(LIFELINE, select.POLLIN)
    pause_s = IDLE_TICK_S if memory is None else TICK_S
    try:
        waiter.register(os.pidfd_open(planner), select.POLLIN)
    except OSError:  # an old kernel: the planner's end is noticed at the next tick
        pause_s = TICK_S
    dead: dict[int, int] = {}
    while True:
        wait_s = max(0.0, min(pause_s, deadline - time.monotonic()))
        woken = [fd for fd, _ in waiter.poll(wait_s * 1000)]
        reap(dead)
        if planner in dead:
            return "exited", os.waitstatus_to_exitcode(dead[planner])
        # The fork of another process may hold the lifeline open, so the parent is looked at, too.
        if LIFELINE in woken or os.getppid() != parent:
            return "abandoned", None
        if time.monotonic() >= deadline:
            return "timeout", None
        if memory is not None:
            looked_s = time.monotonic()
            if exceeds(memory):
                return "memory", None
            pause_s = max(TICK_S, DUTY * (time.monotonic() - looked_s))


def reap(dead: dict[int, int]) -> bool:
    """Add the wait status of every dead child; return whether any child is left."""
    try:
        while True:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if pid == 0:
                return True
            dead[pid] = status
    except ChildProcessError:
        return False


def clear(grace_s: float) -> None:
    """End all descendants, by TERM and then KILL, and return when none is left."""
    kill_at = time.monotonic() + grace_s
    term_groups: set[int] = set()
    while reap({}) and (now := time.monotonic()) < kill_at + PATIENCE_S:
        for group in groups():
            if now >= kill_at:
                send(group, KILL)
            elif group not in term_groups:
                term_groups.add(group)
                send(group, TERM)
        time.sleep(0.005)


def send(group: int, number: int) -> None:
    """Send a signal to a process group: a fork cannot slip through as with single processes."""
    try:
        os.killpg(group, number)
    except OSError:
        return  # gone already, or another user's


def groups() -> set[int]:
    """Return the process groups of all descendants; this process is in none of them."""
    ids = set()
    for pid in descendants():
        try:
            ids.add(os.getpgid(pid))
        except ProcessLookupError:
            continue
    return ids - {os.getpgrp()}


def descendants() -> list[int]:
    """Return the ids of all processes below this one, zombies included."""
    return below(os.getpid(), children())


def children() -> dict[int, list[int]]:
    """Return the children of every process that has some."""
    ids: dict[int, list[int]] = {}
    for name in os.listdir("/proc"):
        if name.isdigit() and (stat := read(f"/proc/{name}/stat")):
            # The name of the program, in parentheses, may hold spaces and parentheses.
            parent = int(stat[stat.rindex(b")") + 2 :].split(None, 2)[1])
            ids.setdefault(parent, []).append(int(name))
    return ids


def below(pid: int, children: dict[int, list[int]]) -> list[int]:
    """Return the ids of all processes below one."""
    ids = list(children.get(pid, ()))
    for one in ids:  # grows while it is walked
        ids.extend(children.get(one, ()))
    return ids


def exceeds(memory: int) -> bool:
    """Return whether the resident memory of all descendants is above a limit in bytes.

    The plain sum counts pages that processes share several times, so a planner that forks would
    be punished for memory it does not use. The exact figure is slow and only read in doubt.
    """
    pids = descendants()
    return sum(map(resident, pids)) > memory and sum(map(proportional, pids)) > memory


def resident(pid: int) -> int:
    """Return the resident memory of a process in bytes, shared pages in full."""
    fields = read(f"/proc/{pid}/statm").split()
    return int(fields[1]) * PAGE if fields else 0


def proportional(pid: int) -> int:
    """Return the resident memory of a process in bytes, each shared page divided by its users."""
    for line in read(f"/proc/{pid}/smaps_rollup").splitlines():
        if line.startswith(b"Pss:"):
            return int(line.split()[1]) * 1024
    return resident(pid)


def read(path: str) -> bytes:
    """Return the content of a short /proc file, nothing if its process is gone."""
    try:
        file = os.open(path, os.O_RDONLY)
    except OSError:
        return b""
    try:
        return os.read(file, 4096)
    except OSError:
        return b""
    finally:
        os.close(file)


if __name__ == "__main__":
    main()
