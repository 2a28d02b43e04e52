#!/usr/bin/env python3
"""Whole meshings, from the CAD file to the mesh file, beside peers: time, memory and quality, as a table and plots.

Peers are Debian's gmsh with its HXT and its Delaunay algorithm, netgen, and tetgen, which fills curvetet's surface and does not read
CAD; one that is not installed is left out, and the page says so. gmsh and netgen get the size; curvetet the size at which it makes as
many tets as gmsh's HXT, within two hundredths, which is looked for first; tetgen a largest volume for that size. All run on one
thread, curvetet then on all, in turn, so that what else the machine does meets all alike. Times are those of the clock, memory
is the most a process had; the table gives medians. curvetet checks its mesh in that time, its peers do not. A program that has taken
more than a minute is not run again, nor at smaller sizes. Sizes are given from the largest down.

    scripts/benchmark.py --body out/bodies/bulk.brep --hole 0.5,0.5,0.5 --sizes 0.06,0.03,0.0149,0.0107 \\
        --curvetet build/bench/apps/curvetet/curvetet --out out/benchmark --page docs/benchmarks.md
"""
import argparse
import multiprocessing
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import time
import typing

import compare
import svg_plot
from corpus import gmsh_command, read_json, run

OWN = compare.OWN
CLOSE = 0.02
ROUNDS = 8  # of the search for the size
MOST_SECONDS = 60  # that a program may have taken before it is run once more
VOLUME_OVER_CUBE = 0.18  # tetgen's largest volume over the cube of curvetet's size, for about as many tets
SHOWN_SHARE = 0.03  # of the time, from which a stage has a part of its own in the plot


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--body", required=True, type=pathlib.Path, help="CAD file, as bench/make_bodies writes; netgen gets "
                        "the STEP file beside it")
    parser.add_argument("--hole", default="", help="x,y,z within a hollow of the body, which tetgen is told of")
    parser.add_argument("--sizes", required=True, help="largest edges for gmsh, separated by commas")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--curvetet", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path, help="markdown file whose table is replaced; plots go to pictures/ beside it")
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


def step_of(body):
    """netgen reads nothing else."""
    return body.with_suffix(".step")


def installed(body):
    """Which peers can be measured."""
    return {"gmsh": shutil.which("gmsh"), "netgen": compare.PYTHON and step_of(body).is_file(), "tetgen": shutil.which("tetgen")}


def apart(work, *arguments):
    """In a process of its own: what this one has at most would be counted for the programs that it starts."""
    process = multiprocessing.Process(target=work, args=arguments)
    process.start()
    process.join()
    if process.exitcode != 0:
        sys.exit(f"{work.__name__} failed")


def medit_block(lines, keyword):
    """Lines of a keyword, split into words."""
    at = lines.index(keyword)
    return [line.split() for line in lines[at + 2:at + 2 + int(lines[at + 1])]]


def write_smesh(medit, smesh, hole):
    """The boundary of a mesh as tetgen reads it."""
    lines = medit.read_text().split("\n")
    points, triangles = medit_block(lines, "Vertices"), medit_block(lines, "Triangles")
    used = sorted({int(corner) for triangle in triangles for corner in triangle[:3]})
    number = {point: k + 1 for k, point in enumerate(used)}
    out = [f"{len(used)} 3 0 0", *(f"{k + 1} {' '.join(points[point - 1][:3])}" for k, point in enumerate(used)),
           f"{len(triangles)} 0", *(f"3 {' '.join(str(number[int(corner)]) for corner in t[:3])}" for t in triangles)]
    out += ["1", f"1 {hole.replace(',', ' ')}"] if hole else ["0"]
    smesh.write_text("\n".join([*out, "0"]) + "\n")


def write_medit(medit):
    """tetgen's files as one that curvetet reads: its own Medit files have a wrong number of triangles."""
    def rows(suffix):
        lines = [line.split() for line in medit.with_suffix(suffix).read_text().split("\n") if line and not line.startswith("#")]
        return lines[1:1 + int(lines[0][0])]

    points, tets = rows(".1.node"), rows(".1.ele")
    medit.write_text("\n".join(["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(points)),
                                *(" ".join(p[1:4]) + " 0" for p in points), "Tetrahedra", str(len(tets)),
                                *(" ".join(t[1:5]) + " 1" for t in tets), "End"]) + "\n")


class Program(typing.NamedTuple):
    command: list
    mesh: pathlib.Path  # that it writes, or that is made of what it writes
    mend: typing.Callable = None  # of the mesh, so that curvetet reads it
    report: pathlib.Path = None


class Benchmark:
    def __init__(self, arguments):
        self.a = arguments
        self.slow = set()  # programs that have taken too long at a larger size

    def own(self, size, threads):
        mesh, report = (self.a.out / f"own{threads}{ending}" for ending in (".msh", ".json"))
        return Program([self.a.curvetet, "mesh", self.a.body, "-o", mesh, "-q", "--threads", threads, "--size", repr(size),
                        "--curvature", 0, "--report", report], mesh, report=report)

    def gmsh(self, size, algorithm):
        mesh = self.a.out / f"gmsh{algorithm}.msh"
        return Program([*gmsh_command(self.a.body, repr(size), mesh, 0, algorithm), "-bin"], mesh)

    def netgen(self, size):
        mesh = self.a.out / "netgen.msh"
        return Program([compare.PYTHON, "-c", compare.NETGEN, step_of(self.a.body), repr(size), mesh, 0], mesh, compare.mend_netgen)

    def tetgen(self, size):
        """Once its input is there."""
        medit, smesh = self.a.out / "surface.mesh", self.a.out / "tetgen.smesh"
        measure([self.a.curvetet, "mesh", self.a.body, "-o", medit, "-q", "--size", repr(size), "--curvature", 0, "--no-refine",
                 "--no-improve"])
        apart(write_smesh, medit, smesh, self.a.hole)
        return Program(["tetgen", f"-pYq1.2Qa{VOLUME_OVER_CUBE * size**3:.12f}", smesh], self.a.out / "tetgen.mesh", write_medit)

    def quality(self, program):
        """Of the mesh that the program has written: tets, mean radius ratio, worst dihedral angle."""
        if program.mend:
            apart(program.mend, program.mesh)
        _, out, _, _ = run([self.a.curvetet, "check", "--json", program.mesh], None, 0)
        found = read_json(out)
        if not found or not found["counts"]["tets"]:
            sys.exit(f"{program.mesh} has no tets")
        return found["counts"]["tets"], found["quality"]["mean_radius_ratio"], found["quality"]["worst_dihedral"]

    def matching_size(self, size, wanted):
        """At which curvetet makes `wanted` tets, within two hundredths."""
        for _ in range(ROUNDS):
            program = self.own(size, 1)
            measure(program.command)
            tets = read_json(program.report)["counts"]["tets"]
            if abs(tets / wanted - 1) <= CLOSE:
                return size
            size *= (tets / wanted) ** (1 / 3)
        sys.exit(f"no size found that makes {wanted} tets")

    def programs(self, size):
        """By name."""
        programs, own_size, there = {}, size, installed(self.a.body)
        if there["gmsh"]:
            programs = {"gmsh, HXT": self.gmsh(size, 10), "gmsh, Delaunay": self.gmsh(size, 1)}
            measure(programs["gmsh, HXT"].command)
            own_size = self.matching_size(size, self.quality(programs["gmsh, HXT"])[0])
        if there["netgen"]:
            programs["netgen"] = self.netgen(size)
        if there["tetgen"]:
            programs["tetgen, volume only"] = self.tetgen(own_size)
        programs[OWN] = self.own(own_size, 1)
        programs[f"{OWN}, {os.cpu_count()} threads"] = self.own(own_size, os.cpu_count())
        return {name: program for name, program in programs.items() if name not in self.slow}

    def rows(self, size):
        """A dict for each program."""
        programs = self.programs(size)
        measured, stages = {name: [] for name in programs}, {name: [] for name in programs}
        for _ in range(self.a.runs):
            for name, program in programs.items():
                if sum(seconds for seconds, _, _ in measured[name]) > MOST_SECONDS:
                    self.slow.add(name)
                    continue
                measured[name].append(measure(program.command))
                if program.report:
                    stages[name].append({s["stage"]: s["seconds"] for s in read_json(program.report)["stages"]})
        for name, program in programs.items():
            tets, ratio, angle = self.quality(program)
            seconds, memory = (statistics.median(run[i] for run in measured[name]) for i in (0, 1))
            yield {"program": name, "tets": tets, "seconds": seconds, "memory": memory, "ratio": ratio, "angle": angle,
                   "stages": stages[name]}


HEAD = ["| program | million tets | seconds | time per tet over curvetet's | MB | mean radius ratio | worst dihedral angle | "
        "refinement and improvement, s |", "|---|---|---|---|---|---|---|---|"]


def line_of(row, base):
    inside = [stages["interior points"] + stages["improvement"] for stages in row["stages"]]
    over = row["seconds"] / row["tets"] / (base["seconds"] / base["tets"])
    refining = f"{statistics.median(inside):.2f}" if inside else "-"
    return (f"| {row['program']} | {row['tets'] / 1e6:.3g} | {row['seconds']:.2f} | {over:.2f} | {row['memory']:.0f} | {row['ratio']:.3f} | "
            f"{row['angle']:.1f} | {refining} |")


def stage_shares(row):
    """Median seconds of each stage; small ones together."""
    medians = {stage: statistics.median(stages[stage] for stages in row["stages"]) for stage in row["stages"][0]}
    shown = {stage: seconds for stage, seconds in medians.items() if seconds >= SHOWN_SHARE * sum(medians.values())}
    return shown | {"other": sum(medians.values()) - sum(shown.values())}


def plot(rows, folder):
    names = list(dict.fromkeys(row["program"] for row in rows))
    for key, title in (("seconds", "Seconds from file to file"), ("memory", "Memory, MB at most")):
        svg_plot.lines(folder / f"benchmark_{key}.svg", title, "million tets", title,
                       {name: [(row["tets"] / 1e6, row[key]) for row in rows if row["program"] == name] for name in names})
    svg_plot.shares(folder / "benchmark_stages.svg", "Shares of the stages of curvetet, one thread, by million tets",
                    {f"{row['tets'] / 1e6:.3g}": stage_shares(row) for row in rows if row["program"] == OWN})


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    benchmark, rows, lines = Benchmark(arguments), [], list(HEAD)
    for size in arguments.sizes.split(","):
        here = list(benchmark.rows(float(size)))
        base = next(row for row in here if row["program"] == OWN)
        lines += [line_of(row, base) for row in here]
        rows += here
        print("\n".join(lines[-len(here):]), flush=True)
    lines += [f"\n{name} was not there." for name, there in installed(arguments.body).items() if not there]
    if arguments.page:
        compare.write_page(arguments.page, lines)
        plot(rows, arguments.page.parent / "pictures")


if __name__ == "__main__":
    main()
