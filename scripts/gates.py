#!/usr/bin/env python3
"""Runs the gates of thin walls, of kinds of surfaces and of half turns over the bodies that bench/make_bodies writes.

    cmake --preset bench && cmake --build --preset bench --target make_bodies curvetet
    build/bench/bench/make_bodies out/bodies
    scripts/gates.py --curvetet build/bench/apps/curvetet/curvetet --bodies out/bodies --out out/gates

thin-walls: sizes are lengths, without sizes from curvature, so that a coarse mesh crosses itself unless that is prevented
or cured. half-turns: coarse meshes of slots and ridges, likewise without sizes from curvature. kinds: every kind of surface, and holes across seams and at poles, at the box's diagonal over 5, 15 and 40.
A mesh is valid as scripts/corpus.py says; of some bodies it must be coarse, too. Exit code 1 if one run fails.
"""
import argparse
import concurrent.futures
import json
import pathlib
import signal
import sys

from corpus import Corpus, end_all, number

SHELLS_AND_TUBES = [f"{body}_{wall}" for wall in ("1", "0.5", "0.2") for body in ("shell", "tube")]
OTHER_WALLS = ["lens", "bent_pipe", "ball_in_box", "two_bores", "eccentric", "cone_shell"]
MOST_TRIANGLES = {("shell_0.2", 8.0): 3000}
KIND_PREFIXES = ("kind_", "seam_", "pole_")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--gate", choices=["thin-walls", "kinds", "half-turns", "all"], default="all")
    parser.add_argument("--coarsest", action="store_true", help="only the coarsest size of each body")
    parser.add_argument("--bodies", required=True, type=pathlib.Path, help="folder that make_bodies has filled")
    parser.add_argument("--curvetet", required=True, type=pathlib.Path)
    parser.add_argument("--judge", type=pathlib.Path, help="a second judge, as in scripts/corpus.py")
    parser.add_argument("--options", default="", help="further options of `curvetet mesh`, separated by spaces")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--time-limit", type=float, default=60, help="seconds for each run of each program")
    parser.add_argument("--memory-limit", type=float, default=4, help="GiB of address space for each run; 0: none")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--keep", action="store_true", help="keep the meshes of valid runs")
    return parser.parse_args()


def sizes_of(arguments, coarse_to_fine):
    return coarse_to_fine[:1] if arguments.coarsest else coarse_to_fine


def corpus_with(arguments, curvature):
    settings = argparse.Namespace(**vars(arguments))
    settings.root, settings.list, settings.gmsh = arguments.bodies, arguments.bodies / "-", False
    settings.curvature, settings.cad_options = curvature, ""
    return Corpus(settings)


def thin_wall_tasks(arguments):
    corpus = corpus_with(arguments, 0)
    plan = [(body, size) for body in SHELLS_AND_TUBES for size in sizes_of(arguments, [8.0, 5.0, 3.0])]
    plan += [(body, size) for body in OTHER_WALLS for size in sizes_of(arguments, [6.0, 3.0, 1.0])]
    for body, size in plan:
        row = {"gate": "thin-walls", "body": f"{body}.brep", "at": f"{size:g}", "most": MOST_TRIANGLES.get((body, size))}
        row.update(status="failed", cause="")
        yield lambda row=row, size=size: corpus.at_size(row["body"], size, f"{row['body']}.{size:g}", row)


def kind_tasks(arguments):
    corpus = corpus_with(arguments, 12)
    for path in sorted(arguments.bodies.glob("*.brep")):
        if not path.name.startswith(KIND_PREFIXES):
            continue
        for divisor in sizes_of(arguments, [5.0, 15.0, 40.0]):
            yield lambda body=path.name, divisor=divisor: {
                "gate": "kinds", "at": f"D/{divisor:g}", **corpus.one(body, divisor)}


def half_turn_tasks(arguments):
    corpus = corpus_with(arguments, 0)
    for path in sorted(arguments.bodies.glob("half_*.brep")):
        for divisor in sizes_of(arguments, [3.0, 5.0, 10.0]):
            yield lambda body=path.name, divisor=divisor: {
                "gate": "half-turns", "at": f"D/{divisor:g}", **corpus.one(body, divisor)}


def hold_to_most(row):
    most = row.get("most")
    if row["status"] == "valid" and most and row["triangles"] > most:
        row["status"], row["cause"] = "invalid", f"more than {most} triangles"
    return row


def print_row(row):
    print(f"{row['status']:8}  {row['gate']:10}  {row['body']:28} {row['at']:>5}  {number(row.get('triangles'), '%d'):>7}  "
          f"{number(row.get('tets'), '%d'):>7}  {number(row.get('seconds'), '%.1f'):>6}s  {row['cause']}", flush=True)


def main():
    arguments = parse_arguments()
    for number_of_signal in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number_of_signal, end_all)
    arguments.out.mkdir(parents=True, exist_ok=True)
    tasks = []
    for gate, of_gate in (("thin-walls", thin_wall_tasks), ("half-turns", half_turn_tasks), ("kinds", kind_tasks)):
        if arguments.gate in (gate, "all"):
            tasks += of_gate(arguments)
    rows = []
    print(f"{'status':8}  {'gate':10}  {'body':28} {'size':>5}  {'triang.':>7}  {'tets':>7}  {'time':>7}  cause")
    with open(arguments.out / "results.jsonl", "w") as results, \
            concurrent.futures.ThreadPoolExecutor(max_workers=arguments.jobs) as pool:
        for row in pool.map(lambda task: hold_to_most(task()), tasks):
            rows.append(row)
            results.write(json.dumps(row) + "\n")
            results.flush()
            print_row(row)
    print()
    for gate in sorted({row["gate"] for row in rows}):
        here = [row for row in rows if row["gate"] == gate]
        print(f"{gate}: {sum(row['status'] == 'valid' for row in here)} of {len(here)} valid")
    return 0 if rows and all(row["status"] == "valid" for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
