#!/usr/bin/env python3
"""Whole meshings, from the CAD file to the mesh file, beside peers at the same number of tets: time, memory and quality.

Peers are Debian's gmsh with its HXT and its Delaunay algorithm; if it is not installed curvetet is measured alone. gmsh gets the
size; curvetet the size at which it makes as many tets as gmsh's HXT, within two hundredths, which is looked for first. All run on one
thread, curvetet then on all, in turn, so that what else the machine does meets all alike. Times are those of the clock, memory
is the most a process had; the table gives medians. curvetet checks its mesh in that time, gmsh does not. A program that has taken
more than a minute is not run again.

    scripts/benchmark.py --body out/bodies/bulk.brep --sizes 0.0149,0.0107 --curvetet build/bench/apps/curvetet/curvetet \\
        --out out/benchmark --page docs/benchmarks.md
"""
import argparse
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

from compare import write_page
from corpus import gmsh_command, read_json, run

CLOSE = 0.02
ROUNDS = 8  # of the search for the size
MOST_SECONDS = 60  # that a program may have taken before it is run once more


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--body", required=True, type=pathlib.Path, help="CAD file, as bench/make_bodies writes")
    parser.add_argument("--sizes", required=True, help="largest edges for gmsh, separated by commas")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--curvetet", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path, help="markdown file whose table is replaced")
    return parser.parse_args()


def measure(command):
    """Seconds by the clock, megabytes at most, and seconds of processors, of helpers too."""
    start = time.monotonic()
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"failed with {process.returncode}: {' '.join(str(word) for word in command)}")
    return time.monotonic() - start, usage.ru_maxrss / 1000, usage.ru_utime + usage.ru_stime


class Benchmark:
    def __init__(self, arguments):
        self.a = arguments

    def own(self, size, threads):
        return [self.a.curvetet, "mesh", self.a.body, "-o", self.a.out / f"own{threads}.msh", "-q", "--threads", threads, "--size",
                repr(size), "--curvature", 0, "--report", self.report(threads)]

    def report(self, threads):
        return self.a.out / f"own{threads}.json"

    def gmsh(self, size, algorithm):
        return [*gmsh_command(self.a.body, repr(size), self.a.out / f"gmsh{algorithm}.msh", 0, algorithm), "-bin"]

    def quality(self, mesh):
        _, out, _, _ = run([self.a.curvetet, "check", "--json", mesh], None, 0)
        found = read_json(out)
        if not found or not found["counts"]["tets"]:
            sys.exit(f"{mesh} has no tets")
        return found["counts"]["tets"], found["quality"]["mean_radius_ratio"], found["quality"]["worst_dihedral"]

    def matching_size(self, size, wanted):
        """At which curvetet makes `wanted` tets, within two hundredths."""
        for _ in range(ROUNDS):
            measure(self.own(size, 1))
            tets = read_json(self.report(1))["counts"]["tets"]
            if abs(tets / wanted - 1) <= CLOSE:
                return size
            size *= (tets / wanted) ** (1 / 3)
        sys.exit(f"no size found that makes {wanted} tets")

    def rows(self, size):
        commands = {}
        if shutil.which("gmsh"):
            commands = {"gmsh, HXT": self.gmsh(size, 10), "gmsh, Delaunay": self.gmsh(size, 1)}
            measure(commands["gmsh, HXT"])
            size = self.matching_size(size, self.quality(self.a.out / "gmsh10.msh")[0])
        own = {"curvetet": 1, f"curvetet, {os.cpu_count()} threads": os.cpu_count()}
        commands.update((name, self.own(size, threads)) for name, threads in own.items())
        measured, stages = {name: [] for name in commands}, {name: [] for name in commands}
        for _ in range(self.a.runs):
            for name, command in commands.items():
                if sum(seconds for seconds, _, _ in measured[name]) > MOST_SECONDS:
                    continue
                measured[name].append(measure(command))
                if name in own:
                    stages[name].append({s["stage"]: s["seconds"] for s in read_json(self.report(own[name]))["stages"]})
        base = statistics.median(seconds for seconds, _, _ in measured["curvetet"])
        for name, command in commands.items():
            seconds, memory = (statistics.median(run[i] for run in measured[name]) for i in (0, 1))
            tets, ratio, angle = self.quality(command[command.index("-o") + 1])
            inside = [s["interior points"] + s["improvement"] for s in stages[name]]
            yield [name, f"{tets / 1e6:.2f}", f"{seconds:.2f}", f"{seconds / base:.2f}", f"{memory:.0f}", f"{ratio:.3f}", f"{angle:.1f}",
                   f"{statistics.median(inside):.2f}" if inside else "-"]


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    lines = ["| program | million tets | seconds | over curvetet's | MB | mean radius ratio | worst dihedral angle | refinement and improvement, s |",
             "|---|---|---|---|---|---|---|---|"]
    for size in arguments.sizes.split(","):
        for row in Benchmark(arguments).rows(float(size)):
            lines.append("| " + " | ".join(row) + " |")
            print(lines[-1], flush=True)
    if not shutil.which("gmsh"):
        lines.append("\ngmsh was not installed.")
    if arguments.page:
        write_page(arguments.page, lines)


if __name__ == "__main__":
    main()
