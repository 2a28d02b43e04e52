#!/usr/bin/env python3
"""CPU time over real CAD files, beside Debian's gmsh (Delaunay) at the same number of tets.

curvetet gets the size and its default curvature. Sizes mean different things to different programs, so gmsh gets the same two
numbers and a factor on all of its sizes (Mesh.MeshSizeFactor), which is looked for until it makes as many tets within a fifth.
Both run on one thread, in turn; times are those of the processors, helpers included, medians. A body counts if both mesh it:
curvetet with a valid mesh, gmsh with any tets at all. Those for which no factor is found are counted and left out.

    scripts/benchmark_cad.py --list bodies.txt --divide 50 --curvetet build/release/apps/curvetet/curvetet --out out/benchmark_cad \\
        --page docs/benchmarks.md
"""
import argparse
import json
import pathlib
import shutil
import statistics
import sys

from benchmark import measure
from compare import write_page
from corpus import Corpus, common_parser, gmsh_command, read_json, read_list, run

NEAR = 0.2
ROUNDS = 8  # of the search for the factor
CURVATURE = 12


class CadBenchmark:
    def __init__(self, arguments):
        self.a = arguments
        self.corpus = Corpus(argparse.Namespace(**vars(arguments), cad_options=""))

    def own(self, body, size, mesh):
        return [self.a.curvetet, "mesh", self.corpus.root / body, "-o", mesh, "-q", "--unit", "mm", "--threads", "1", "--size", repr(size)]

    def gmsh(self, body, size, factor, mesh):
        return [*gmsh_command(self.corpus.root / body, repr(size), mesh, CURVATURE), "-bin", "-setnumber", "Mesh.MeshSizeFactor", repr(factor)]

    def tets(self, command, mesh):
        """None: it fails or makes none."""
        mesh.unlink(missing_ok=True)
        code, _, _, _ = run(command, self.a.time_limit, self.a.memory_limit)
        if code != 0 or not mesh.is_file():
            return None
        _, out, _, _ = run([self.a.curvetet, "check", "--json", mesh], self.a.time_limit, self.a.memory_limit)
        return (read_json(out) or {}).get("counts", {}).get("tets") or None

    def matching_factor(self, body, size, wanted, mesh):
        """The factor and gmsh's tets with it. Without a factor the tets are those with all sizes as they are: none if gmsh fails so."""
        factor = 1.0
        first = tets = self.tets(self.gmsh(body, size, factor, mesh), mesh)
        for _ in range(ROUNDS):
            if tets is None:
                break
            if abs(tets / wanted - 1) <= NEAR:
                return factor, tets
            factor *= (tets / wanted) ** (1 / 3)
            tets = self.tets(self.gmsh(body, size, factor, mesh), mesh)
        return None, first

    def compare(self, body):
        mesh = self.a.out / "mesh.msh"
        diagonal, _ = self.corpus.diagonal(body)
        size = (diagonal or 0) / float(self.a.divide)
        row = {"body": body, "own": self.tets(self.own(body, size, mesh), mesh) if diagonal else None}
        if row["own"] is None:
            return row
        factor, row["gmsh"] = self.matching_factor(body, size, row["own"], mesh)
        if factor is None:
            return row
        commands = [self.own(body, size, mesh), self.gmsh(body, size, factor, mesh)]
        measured = [[measure(command)[2] for command in commands] for _ in range(self.a.runs)]
        row["factor"] = factor
        row["seconds"] = [statistics.median(pair[i] for pair in measured) for i in (0, 1)]
        return row


def parse_arguments():
    parser = common_parser(__doc__)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--page", type=pathlib.Path, help="markdown file whose text between <!-- cad: begin --> and <!-- cad: end --> is "
                        "replaced")
    parser.set_defaults(divide="50", time_limit=120)
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    if not shutil.which("gmsh"):
        sys.exit("gmsh is not installed")
    arguments.out.mkdir(parents=True, exist_ok=True)
    benchmark = CadBenchmark(arguments)
    rows = []
    with open(arguments.out / "rows.jsonl", "w") as out:
        for body in read_list(arguments.list):
            rows.append(benchmark.compare(body))
            print(json.dumps(rows[-1]), flush=True)
            out.write(json.dumps(rows[-1]) + "\n")
    both = [row for row in rows if row["own"] and row["gmsh"]]
    matched = [row for row in both if "seconds" in row]
    own, gmsh = (sum(row["seconds"][i] for row in matched) for i in (0, 1))
    tets = [sum(row[name] for row in matched) / 1e6 for name in ("own", "gmsh")]
    ratios = sorted(row["seconds"][0] / row["seconds"][1] for row in matched)
    lines = ["| bodies | both mesh | matched | curvetet, s | gmsh, s | curvetet's over gmsh's | median of the bodies | million tets, both |",
             "|---|---|---|---|---|---|---|---|",
             f"| {len(rows)} at D/{float(arguments.divide):g} | {len(both)} | {len(matched)} | {own:.1f} | {gmsh:.1f} | {own / gmsh:.2f} | "
             f"{statistics.median(ratios):.2f} | {tets[0]:.2f}, {tets[1]:.2f} |"]
    print("\n".join(lines))
    if arguments.page:
        write_page(arguments.page, lines, "cad")


if __name__ == "__main__":
    main()
