#!/usr/bin/env python3
"""Surface triangles per second by kind of surface: the stage "curves and faces" of curvetet's own report, one thread, medians.

Bodies are those that bench/make_bodies draws, one for each kind; the size is the same share of each one's diagonal, without curvature
or gaps, so that nothing but the size counts.

    scripts/benchmark_surfaces.py --bodies out/bodies --curvetet build/release/apps/curvetet/curvetet --out out/surfaces \\
        --page docs/benchmarks.md
"""
import argparse
import pathlib
import statistics

from benchmark import measure
from compare import write_page
from corpus import read_json

KINDS = {"plane": "planes", "cylinder": "cylinder", "cone": "cone", "sphere": "ball", "torus": "torus", "bspline": "torus of splines",
         "bspline_ball": "ball of splines", "revolution": "profile turned around", "loft": "loft", "offset": "offset of splines",
         "fillet": "rounded box"}
STAGE = "curves and faces"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodies", required=True, type=pathlib.Path, help="folder that bench/make_bodies has written")
    parser.add_argument("--divide", type=float, default=200, help="divisor of the diagonal")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--curvetet", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path, help="markdown file whose text between <!-- surfaces: begin --> and "
                        "<!-- surfaces: end --> is replaced")
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    report = arguments.out / "report.json"
    measured = {kind: [] for kind in KINDS}
    for _ in range(arguments.runs):
        for kind, runs in measured.items():
            measure([arguments.curvetet, "mesh", arguments.bodies / f"kind_{kind}.brep", "-o", arguments.out / "mesh.msh", "-q", "--threads", 1,
                     "--size", f"D/{arguments.divide:g}", "--curvature", 0, "--no-gaps", "--no-refine", "--no-improve", "--report", report])
            found = read_json(report)
            runs.append((found["counts"]["triangles"], sum(s["seconds"] for s in found["stages"] if s["stage"] == STAGE)))
    lines = ["| body | triangles | seconds | thousand triangles per second |", "|---|---|---|---|"]
    for kind, runs in measured.items():
        seconds = statistics.median(seconds for _, seconds in runs)
        lines.append(f"| {KINDS[kind]} | {runs[0][0]} | {seconds:.2f} | {runs[0][0] / seconds / 1000:.0f} |")
    print("\n".join(lines))
    if arguments.page:
        write_page(arguments.page, lines, "surfaces")


if __name__ == "__main__":
    main()
