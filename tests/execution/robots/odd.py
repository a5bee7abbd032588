"""A robot that does what its first argument says, and otherwise what it is told, at once."""

import json
import os
import sys
import threading
import time

MODE = sys.argv[1] if len(sys.argv) > 1 else ""
MARK = sys.argv[2] if len(sys.argv) > 2 else ""  # a file: whether this is the first start


def write(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def say(event: str, **values: object) -> None:
    write(json.dumps({"event": event, **values}))


def end(n: int, outcome: str = "done", **values: object) -> None:
    say("ended", n=n, outcome=outcome, **values)


def is_first_start() -> bool:
    first = not os.path.exists(MARK)
    open(MARK, "w").close()
    return first


def first(n: int) -> None:
    """Do the first action as the mode says."""
    match MODE:
        case "reject":
            say("rejected", n=n, why="the path is blocked")
        case "endless" | "late" | "endless-alone":
            say("accepted", n=n)
        case "fail" | "alone-fail":
            say("accepted", n=n)
            end(n, "failed", why="slipped")
        case "unknown":
            say("accepted", n=n)
            end(n, "unknown")
        case "die":
            say("accepted", n=n)
            if is_first_start():
                os.kill(os.getpid(), 9)
            end(n)
        case "feedback":
            say("accepted", n=n)
            say("feedback", n=n, text="half way")
            end(n)
        case "garbage":
            write("hello\n\x00\x1b[31m\n[1]\n{}\n" + "[" * 5000)
            sys.stdout.buffer.write(b'\xff\xfe\n{"event": "ended", "n": "x"}\n')
            sys.stdout.buffer.flush()
            end(n)
        case "long":
            write("x" * 10_000_000)
            end(n)
        case "twice":
            end(n)
            end(n)
            end(n, "failed")
            end(99)
        case "flood":
            if is_first_start():
                while True:
                    sys.stdout.write("x" * 1000 + "\n")
            end(n)
        case "lost-acceptance":
            PENDING.add(n)
        case "stop":
            say("accepted", n=n)
            say("stop", why="a person is too near")
            time.sleep(0.3)
            say("release")
        case "sense":
            say("accepted", n=n)
            say("sensed", values={"motivation human": 9, "nonsense x": 1})
            end(n)
        case "close":
            say("accepted", n=n)
            say("observed", absent=["reach robot wp2"])
            say("observed", facts=["box-at red wp2"])
            end(n)
        case "teleport":
            end(n, "failed")
            say("observed", facts=["at robot wp5"], absent=["(at robot wp0)"])
            say("observed", facts=["no fact"])
        case _:
            say("accepted", n=n)
            end(n)


AGENTS = {
    "stranger": ["nobody"], "stop": ["robot"], "kitchen": [], "alone": ["robot"],
    "alone-fail": ["robot"], "endless-alone": ["robot"], "reports": ["robot"],
}  # fmt: skip
REPORTS = [("move", "wp1", "wp4"), ("grasp", "blue", "wp4"), ("move", "wp4", "wp5"),
           ("place", "blue", "wp5")]  # fmt: skip


def report() -> None:
    """Say what the person does: some of it as an action, some in words, and that it was all."""
    for n, (action, *args) in enumerate(REPORTS):
        if n % 2:
            say("said", agent="human", text=f"({action} human {' '.join(args)})")
        else:
            say("begun", agent="human", action=action, args=["human", *args])
        time.sleep(0.2)
    for _ in range(3):
        say("said", agent="human", text="Yes!")
        time.sleep(0.1)


PENDING: set[int] = set()


def main() -> None:
    n_actions = 0
    if MODE == "mute":
        time.sleep(60)
    for line in sys.stdin:
        command = json.loads(line)
        match command["do"]:
            case "begin":
                say("ready", agents=AGENTS.get(MODE, ["robot", "human"]))
            case "dispatch":
                n_actions += 1
                if MODE == "reports" and n_actions == 1:
                    threading.Thread(target=report, daemon=True).start()
                if MODE == "deaf" and n_actions > 1:
                    continue
                if command["n"] in PENDING:
                    end(command["n"])
                elif n_actions == 1:
                    first(command["n"])
                else:
                    say("accepted", n=command["n"])
                    end(command["n"])
            case "cancel":
                if MODE == "late":
                    end(command["n"])
                elif MODE != "deaf":
                    end(command["n"], "cancelled")
            case "observe":
                if MODE == "unknown":
                    say("observed", facts=["at robot wp3"], absent=["at robot wp0"])
            case "end":
                break


if __name__ == "__main__":
    main()
