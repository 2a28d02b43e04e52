#!/usr/bin/env python3
"""curvetet and its peers on the same bodies at the same sizes, under the same limits and the same judge, as a table.

Peers are Debian's programs: gmsh with its Delaunay and its HXT algorithm, and netgen. One that is not installed is left
out, and the table says so. Each gets the size, and 12 elements per turn where it knows such a thing; all else is as it
comes. The judge is as in corpus.py. A mesh counts only if the program ended with 0 in time and the judge passes, of the whole
or, where solids touch or overlap without sharing faces, part by part; curvetet is asked for that (--conformal off). What the
output folder has measured already is kept, so that a run goes on where it was ended; `--again` measures a program anew.

    scripts/compare.py --list bodies.txt --divide 20 --curvetet build/release/apps/curvetet/curvetet --judge judge \\
        --out out/compare --page page.md
"""
import argparse
import concurrent.futures
import json
import pathlib
import shutil
import statistics
import subprocess
import sys

from corpus import Corpus, common_parser, gmsh_command, quantile, read_divisors, read_json, read_list, run

NETGEN = """
import sys
from netgen.NgOCC import LoadOCCGeometry
from netgen.meshing import MeshingParameters
geometry = LoadOCCGeometry(sys.argv[1])
mesh = geometry.GenerateMesh(mp=MeshingParameters(maxh=float(sys.argv[2]), curvaturesafety=float(sys.argv[4]) / 6.283185307))
mesh.Export(sys.argv[3], "Gmsh2 Format")
"""


def mend_netgen(mesh):
    """Its export calls the format 2.0 and lists the nodes of tets the other way round, which is no fault of the mesh."""
    lines = mesh.read_text().split("\n")
    lines[1] = "2.2 0 8"
    for i in range(lines.index("$Elements") + 2, lines.index("$EndElements")):
        words = lines[i].split()
        if words[1] == "4":
            lines[i] = " ".join([*words[:-2], words[-1], words[-2]])
    mesh.write_text("\n".join(lines))


def gmsh(algorithm):
    return lambda body, size, mesh, curvature: gmsh_command(body, size, mesh, curvature, algorithm)


def netgen(body, size, mesh, curvature):
    """Debian's reads STEP only."""
    return [PYTHON, "-c", NETGEN, body, size, mesh, curvature] if body.suffix.lower() in (".step", ".stp") else None


PYTHON = next((p for p in ("/usr/bin/python3", sys.executable)
               if subprocess.run([p, "-c", "import netgen.NgOCC"], capture_output=True, check=False).returncode == 0), None)


def programs(arguments):
    """Name, command, and whether it is there."""
    def own(body, size, mesh, curvature):
        return [arguments.curvetet, "mesh", body, "-o", mesh, "-q", "--unit", "mm", "--threads", "1", "--size", size,
                "--curvature", curvature]

    has_gmsh = shutil.which("gmsh") is not None
    return [(OWN, own, True), ("gmsh, Delaunay", gmsh(1), has_gmsh), ("gmsh, HXT", gmsh(10), has_gmsh),
            ("netgen", netgen, PYTHON is not None)]


OWN = "curvetet"


class Comparison:
    def __init__(self, arguments):
        self.a = arguments
        self.corpus = Corpus(argparse.Namespace(**vars(arguments), cad_options=""))

    def measure(self, job):
        body, divisor, name, command = job
        diagonal, _ = self.corpus.diagonal(body)
        row = {"body": body, "divide": divisor, "program": name, "valid": False}
        stem = f"{pathlib.Path(body).name}.{divisor:g}.{name.replace(', ', '-').lower()}"
        mesh = self.a.out / (stem + ".msh")
        if diagonal is None:  # unreadable, and counted: no program is asked
            return row
        words = command(self.corpus.root / body, repr(diagonal / divisor), mesh, self.a.curvature)
        if words is None:
            return row | {"left_out": True}
        self.mesh_and_judge(row, words, mesh, stem, [False] if name == OWN else [False, True])
        if name == OWN and row["valid"] is not True:
            apart = {"body": body, "divide": divisor, "program": name, "valid": False}
            self.mesh_and_judge(apart, [*words, "--conformal", "off"], mesh, stem, [True])
            row = apart if apart["valid"] is True else row
        return row

    def mesh_and_judge(self, row, words, mesh, stem, in_parts):
        """Asks the judge for the whole, or part by part, or both, until it passes."""
        mesh.unlink(missing_ok=True)
        row["exit"], _, _, row["seconds"] = run(words, self.a.time_limit, self.a.memory_limit)
        if row["exit"] == 0 and mesh.is_file():
            if row["program"] == "netgen":
                mend_netgen(mesh)
            for row["parts"] in in_parts:
                row["valid"], row["failed"], _ = self.corpus.judge(row["body"], mesh, stem, row["parts"])
                if row["valid"] is True:
                    break
            _, out, _, _ = run([self.a.curvetet, "check", "--json", mesh], self.a.time_limit, self.a.memory_limit)
            counts = (read_json(out) or {}).get("counts", {})
            row["triangles"], row["tets"] = counts.get("triangles"), counts.get("tets")
        mesh.unlink(missing_ok=True)


def table(rows, divisors, names, missing):
    """Lines of markdown: for each program and size what became of the bodies."""
    lines = ["| program | size | bodies | valid | of these in parts | no mesh | invalid | median seconds of the valid | curvetet's triangles over its |",
             "|---|---|---|---|---|---|---|---|---|"]
    own = {(row["body"], row["divide"]): row for row in rows if row["program"] == OWN}
    for name in names:
        for divisor in divisors:
            here = [row for row in rows if row["program"] == name and row["divide"] == divisor and "left_out" not in row]
            valid = [row for row in here if row["valid"] is True]
            no_mesh = [row for row in here if not row.get("tets")]
            ratios = [own[row["body"], divisor]["triangles"] / row["triangles"] for row in valid
                      if own[row["body"], divisor]["valid"] is True and row["triangles"]]
            seconds = f"{statistics.median(row['seconds'] for row in valid):.2f}" if valid else "-"
            ratio = f"{statistics.median(ratios):.2f}, 95 %: {quantile(ratios, 0.95):.2f}" if ratios else "-"
            share = 100 * len(valid) / max(1, len(here))
            lines.append(f"| {name} | D/{divisor:g} | {len(here)} | {len(valid)} ({share:.1f} %) | "
                         f"{sum(row['parts'] for row in valid)} | {len(no_mesh)} | "
                         f"{len(here) - len(valid) - len(no_mesh)} | {seconds} | {ratio} |")
    lines += [f"\n{name} was not installed." for name in missing]
    return lines


def write_page(page, lines, name="table"):
    """Replaces what is between the markers of that name."""
    text = page.read_text()
    begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
    head, rest = text.split(begin)
    page.write_text(head + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end)[1])


def key_of(row):
    return row["body"], row["divide"], row["program"]


def read_rows(path):
    """Of a run that was ended the last line may be cut off."""
    rows = [read_json(line) for line in path.read_text().splitlines()] if path.is_file() else []
    return [row for row in rows if row is not None]


def parse_arguments():
    parser = common_parser(__doc__)
    parser.add_argument("--page", type=pathlib.Path, help="page whose table, between <!-- table: begin --> and "
                        "<!-- table: end -->, is replaced")
    parser.add_argument("--every", type=int, default=1, help="only each Nth body of the list")
    parser.add_argument("--again", action="append", default=[], metavar="PROGRAM", help="as curvetet, after a change")
    parser.set_defaults(divide="20", jobs=1, time_limit=120)  # more than one job spoils the times
    arguments = parser.parse_args()
    if arguments.judge is None:
        parser.error("without a judge nothing is valid")
    return arguments


def main():
    arguments = parse_arguments()
    arguments.out.mkdir(parents=True, exist_ok=True)
    bodies, divisors = read_list(arguments.list)[::arguments.every], read_divisors(arguments.divide)
    there = [(name, command) for name, command, installed in programs(arguments) if installed]
    missing = [name for name, _, installed in programs(arguments) if not installed]
    comparison = Comparison(arguments)
    jobs = [(body, divisor, name, command) for body in bodies for divisor in divisors for name, command in there]
    results = arguments.out / "comparison.jsonl"
    known = {key_of(row): row for row in read_rows(results) if row["program"] not in arguments.again}
    results.write_text("".join(json.dumps(row) + "\n" for row in known.values()))
    left = [job for job in jobs if job[:3] not in known]
    with open(results, "a") as out, concurrent.futures.ThreadPoolExecutor(max_workers=arguments.jobs) as pool:
        for row in pool.map(comparison.measure, left):
            known[key_of(row)] = row
            out.write(json.dumps(row) + "\n")
            out.flush()
    rows = [known[job[:3]] for job in jobs]
    lines = table(rows, divisors, [name for name, _ in there], missing)
    print("\n".join(lines))
    if arguments.page:
        write_page(arguments.page, lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
