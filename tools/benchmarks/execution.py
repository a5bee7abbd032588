"""How long simulated runs and replans take: `PYTHONPATH=. python tools/benchmarks/execution.py [RUNS]`.

Goals: replanning at most 20 ms in the median; 1000 runs of all cases in three minutes on two cores;
500 MB. Prints one JSON document.
"""

import json
import resource
import statistics
import sys
import time

from hrcplan.execution import Spec, engine_for, means, simulate

CASES = [(case, model, profile) for case in (1, 2) for model in (False, True)
         for profile in ("paper", "hrcplan")]  # fmt: skip


def main() -> None:
    n_runs = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    report: dict[str, object] = {"runs_per_case": n_runs}
    begun = time.perf_counter()
    for case, model, profile in CASES:
        started = time.perf_counter()
        rows = [simulate(Spec(case=case, model=model, profile=profile, seed=f"bench/{i}"))
                for i in range(n_runs)]  # fmt: skip
        took_ms = 1e3 * (time.perf_counter() - started) / n_runs
        found = {name: round(mean, 2) for name, (mean, _) in means(rows).items()}
        report[f"{case}{'b' if model else 'a'} {profile}"] = {"run_ms": round(took_ms, 1), **found}
    walls_ms = [1e3 * wall for wall in engine_for(Spec()).planner.wall_s]
    report["replans_asked"] = len(walls_ms)
    report["replan_ms_median"] = round(statistics.median(walls_ms), 1)
    report["replan_ms_max"] = round(max(walls_ms), 1)
    report["wall_s"] = round(time.perf_counter() - begun, 1)
    report["memory_mb"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    print(json.dumps(report, indent=2))


if __name__ == "__main__":
    main()
