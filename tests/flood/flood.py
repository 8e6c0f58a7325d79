"""The flood: random legal cases, each run under a limit of time and memory, each frame verified by code of its own.

    flood.py PROGRAM [--flow] [--cases N] [--seed S] [--first I] [--replay FILE ...] [--failed DIR] [--markdown]

A case ends with exit 0 and its floors and balances, or is refused for a reason that is true. What fails or is
refused is left behind in DIR as NNN.toml, with what was wrong on top; --replay runs such files again. docs/reliability.md tells more.
"""

import argparse
import collections
import concurrent.futures
import math
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import traceback

import case_maker
import flow_judge
import flow_maker
import judge
from case_file import Case

REFUSED_SHARE = 0.01  # of the cases, at most; each of a legal case is one too many
MEMORY = 6 << 30  # [bytes] of addresses; most of them are never touched


def limited(seconds):
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    return limit


def run_case(program, file, folder, seconds):
    """(exit code, stderr, CPU seconds); a signal's code is negative."""
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    command = [program, "run", str(file), "--out", str(folder), "--threads", "1"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment,
                          preexec_fn=limited(seconds)) as process:
        errors = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, errors, usage.ru_utime + usage.ru_stime


def judged(folder, text, code, errors):
    file, out = folder / "case.toml", folder / "out"
    if "flow" in tomllib.loads(text):
        return flow_judge.judge(flow_judge.FlowCase(file), out, code, errors)
    return judge.judge(Case(file), out, code, errors)


def verdict_on(program, text, seconds):
    """The verdict on the case, and the CPU seconds of its run."""
    with tempfile.TemporaryDirectory(prefix="flood-") as name:
        folder = pathlib.Path(name)
        (folder / "case.toml").write_text(text, encoding="utf-8")
        code, errors, taken = run_case(program, folder / "case.toml", folder / "out", seconds)
        if code in (-signal.SIGXCPU, -signal.SIGKILL):
            return judge.Verdict("failed", [f"not done after {taken:.0f} s of CPU"]), taken
        try:
            return judged(folder, text, code, errors), taken
        except Exception:  # what is left cannot even be read: a fault of the run, or of the judge; both are to be seen
            return judge.Verdict("failed", [traceback.format_exc(limit=-1)]), taken


def made_case(arguments, number):
    if arguments.flow:
        return flow_maker.make_case(arguments.seed, number, arguments.most_steps)
    return case_maker.make_case(arguments.seed, number, arguments.least_cells, arguments.most_cells, arguments.most_steps)


def one(job):
    arguments, number = job
    if arguments.replay:
        path = arguments.replay[number]
        name, text = path.name, path.read_text(encoding="utf-8")
    else:
        name = f"{number:03}.toml"
        text = made_case(arguments, number)
    started = time.time()
    verdict, taken = verdict_on(arguments.program, text, arguments.seconds)
    return name, text, verdict, taken, time.time() - started


def keep(folder, seed, name, text, verdict):
    """Leaves behind a case that failed or was refused."""
    folder.mkdir(parents=True, exist_ok=True)
    wrong = [f"# {line}" for fault in verdict.faults[:12] or [verdict.said] for line in fault.splitlines()]
    body = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    lines = [f"# flood, seed {seed}: {verdict.outcome}", *wrong, body, ""]
    (folder / name).write_text("\n".join(lines), encoding="utf-8")


def kinds_of(text):
    """What of the table's rows a case belongs to."""
    case = tomllib.loads(text)
    bodies = case.get("body", [])
    span = [high - low for low, high in zip(case["domain"]["min"], case["domain"]["max"])]
    if "flow" in case:
        motions = [body.get("motion", {}).get("kind", "path") for body in bodies]
        return {"all": True, "liquid bodies": "flow" in motions, "free bodies": "free" in motions,
                "several bodies": len(bodies) > 1, "layers": any("layer" in body for body in bodies), "heat": "heat" in case,
                "species": "species" in case, "gravity": "gravity" in case["flow"], "open": "pressure" in text}
    return {"all": True, "heat": "heat" in case, "layers": any("layer" in body for body in bodies),
            "several bodies": len(bodies) > 1, "ellipsoids": any(body["shape"] == "ellipsoid" for body in bodies),
            "turning": any("angle" in body.get("motion", {}) for body in bodies),
            "flat box": min(span) * 4 < max(span), "below a micrometre": max(span) < 1e-6,
            "above a kilometre": max(span) > 1e3,
            "far from the origin": max(map(abs, case["domain"]["min"])) > 20 * max(span)}


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else math.nan


class Table:
    """What is told at the end."""

    def __init__(self):
        self.results = []

    def add(self, text, verdict, taken):
        self.results.append((kinds_of(text), verdict, taken))

    def kind_rows(self):
        for kind in self.results[0][0] if self.results else ():
            of = [(verdict, taken) for kinds, verdict, taken in self.results if kinds[kind]]
            done = [verdict for verdict, _ in of if verdict.outcome == "done"]
            seconds = [taken for _, taken in of]
            yield (kind, len(of), len(done), sum(verdict.outcome.startswith("refused") for verdict, _ in of),
                   sum(verdict.outcome == "failed" for verdict, _ in of),
                   f"{max((verdict.worst_ratio for verdict in done), default=math.nan):.2f}",
                   f"{min((verdict.least_dihedral for verdict in done), default=math.nan):.1f}",
                   f"{quantile(seconds, 0.5):.1f}", f"{max(seconds, default=math.nan):.1f}")

    def written(self, markdown):
        head = ("cases", "number", "done", "refused", "failed", "worst R/r", "least dihedral [deg]", "CPU [s], median",
                "largest")
        rows = [head, *(tuple(map(str, row)) for row in self.kind_rows())]
        widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
        if markdown:
            rows.insert(1, ("---", *["---:"] * (len(head) - 1)))
            lines = ["| " + " | ".join(row) + " |" for row in rows]
        else:
            lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in rows]
        return "\n".join(lines + ["", self.summary()])

    def summary(self):
        done = [verdict for _, verdict, _ in self.results if verdict.outcome == "done"]
        refusals = collections.Counter(v.outcome for _, v, _ in self.results if v.outcome.startswith("refused"))
        most = {name: max((getattr(v, name) for v in done), default=math.nan)
                for name in ("cells", "transfer_error", "energy_drift", "volume_drift", "mass_drift", "attempts")}
        said = ", ".join(f"{count} ({kind.removeprefix('refused: ')})" for kind, count in refusals.items())
        return (f"Of those done: up to {most['cells']} cells and {most['attempts']} attempts at a step; transfer error "
                f"{most['transfer_error']:.1e}, energy off its balance {most['energy_drift']:.1e}, volumes off "
                f"{most['volume_drift']:.1e}, masses of what flows {most['mass_drift']:.1e} at most. Refusals: {said or 'none'}.")

    def end(self):
        """Prints the last line; the exit code."""
        failed = sum(verdict.outcome == "failed" for _, verdict, _ in self.results)
        refused = sum(verdict.outcome.startswith("refused") for _, verdict, _ in self.results)
        allowed = math.ceil(REFUSED_SHARE * len(self.results))
        if refused > allowed:
            print(f"{refused} legal cases refused, more than {allowed}")
        print(f"{len(self.results) - failed} passed, {failed} failed")
        return 0 if failed == 0 and refused <= allowed else 1


def arguments_given():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="kropla")
    parser.add_argument("--flow", action="store_true", help="cases of a flow")
    parser.add_argument("--cases", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the number of the first case")
    parser.add_argument("--replay", type=pathlib.Path, nargs="+", help="case files to run instead")
    parser.add_argument("--failed", type=pathlib.Path, default=pathlib.Path("flood/failed"))
    parser.add_argument("--markdown", action="store_true", help="the table as Markdown")
    parser.add_argument("--seconds", type=int, default=60, help="of CPU that a run may take")
    parser.add_argument("--least-cells", type=float, default=1e3)
    parser.add_argument("--most-cells", type=float, default=2e4)
    parser.add_argument("--most-steps", type=int, default=12)
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    return parser.parse_args()


def main():
    arguments = arguments_given()
    total = len(arguments.replay) if arguments.replay else arguments.cases
    print(f"{total} cases" + ("" if arguments.replay else f", seed {arguments.seed}"), flush=True)
    first = 0 if arguments.replay else arguments.first
    jobs = [(arguments, number) for number in range(first, first + total)]
    table = Table()
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        for name, text, verdict, taken, wall in pool.map(one, jobs):
            table.add(text, verdict, taken)
            if verdict.outcome != "done":
                keep(arguments.failed, arguments.seed, name, text, verdict)
            told = "; ".join(verdict.faults[:2]) or verdict.said.strip()
            print(f"{name}  {verdict.outcome}  {verdict.cells} cells  {taken:.1f} s CPU, {wall:.1f} s  {told}"[:400],
                  flush=True)
    print(table.written(arguments.markdown))
    return table.end()


if __name__ == "__main__":
    sys.exit(main())
