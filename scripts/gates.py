#!/usr/bin/env python3
"""Runs the gates of thin walls, of coarse meshes and of kinds of surfaces over the bodies that bench/make_bodies writes.

    cmake --preset bench && cmake --build --preset bench --target make_bodies curvetet
    build/bench/bench/make_bodies out/bodies
    scripts/gates.py --curvetet build/bench/apps/curvetet/curvetet --bodies out/bodies --out out/gates

thin-walls: sizes are lengths, without sizes from curvature, so that a coarse mesh crosses itself unless that is prevented
or cured. coarse: slots, ridges, countersinks and bores at the box's diagonal over 3, 5 and 10, likewise. kinds: every kind
of surface, and holes across seams and at poles, at the diagonal over 5, 15 and 40.
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
    parser.add_argument("--gate", choices=[*GATES, "all"], default="all")
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


def corpus_with(arguments, gate, curvature):
    settings = argparse.Namespace(**vars(arguments))
    settings.out = arguments.out / gate
    settings.out.mkdir(parents=True, exist_ok=True)
    settings.root, settings.list, settings.gmsh = arguments.bodies, arguments.bodies / "-", False
    settings.curvature, settings.cad_options, settings.apart = curvature, "", False
    return Corpus(settings)


def thin_walls(arguments, corpus):
    plan = [(body, size) for body in SHELLS_AND_TUBES for size in sizes_of(arguments, [8.0, 5.0, 3.0])]
    plan += [(body, size) for body in OTHER_WALLS for size in sizes_of(arguments, [6.0, 3.0, 1.0])]
    return [{"body": f"{body}.brep", "at": f"{size:g}", "size": size, "name": f"{body}.{size:g}", "status": "failed",
             "cause": "", "most": MOST_TRIANGLES.get((body, size))} for body, size in plan]


def at_divisors(arguments, corpus, prefixes, divisors):
    return [{"at": f"D/{divisor:g}", **corpus.row(path.name, divisor)}
            for path in sorted(arguments.bodies.glob("*.brep")) if path.name.startswith(prefixes)
            for divisor in sizes_of(arguments, divisors)]


def kinds(arguments, corpus):
    return at_divisors(arguments, corpus, KIND_PREFIXES, [5.0, 15.0, 40.0])


def coarse(arguments, corpus):
    return at_divisors(arguments, corpus, ("coarse_",), [3.0, 5.0, 10.0])


GATES = {"thin-walls": (thin_walls, 0), "coarse": (coarse, 0), "kinds": (kinds, 12)}  # with elements per turn


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
    rows = []
    print(f"{'status':8}  {'gate':10}  {'body':28} {'size':>5}  {'triang.':>7}  {'tets':>7}  {'time':>7}  cause")
    with open(arguments.out / "results.jsonl", "w") as results, \
            concurrent.futures.ThreadPoolExecutor(max_workers=arguments.jobs) as pool:
        for gate, (plan, curvature) in GATES.items():
            if arguments.gate not in (gate, "all"):
                continue
            corpus = corpus_with(arguments, gate, curvature)
            planned = [{"gate": gate, **row} for row in plan(arguments, corpus)]
            corpus.mesh_all(planned)
            for row in map(hold_to_most, pool.map(corpus.judge_row, planned)):
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
