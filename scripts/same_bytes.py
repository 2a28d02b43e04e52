#!/usr/bin/env python3
"""Meshes each body of a list several times, and compares the files: twice with one thread, and with more threads.

The size is the bounding box's diagonal over --divide; the diagonal comes from manifest.jsonl beside the list, else from
`curvetet info --json`. What ends without a mesh must end alike each time: same exit code, same first error. Exit code 1
if any two runs differ, or if no body was meshed at all; runs that reach the time limit are counted as not compared.

    scripts/same_bytes.py --list bodies.txt --root bodies --curvetet build/release/apps/curvetet/curvetet
"""
import argparse
import hashlib
import json
import pathlib
import sys
import tempfile

from corpus import diagonals, read_json, run

TIME_OR_BUDGET = 4


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", required=True, type=pathlib.Path, help="text file, a path per line, # for comments")
    parser.add_argument("--root", type=pathlib.Path, help="folder the paths are relative to; default: the list's")
    parser.add_argument("--divide", type=float, default=20)
    parser.add_argument("--threads", default="1,1,2", help="of each run, separated by commas")
    parser.add_argument("--time-limit", type=float, default=60, help="seconds for each run")
    parser.add_argument("--curvetet", required=True, type=pathlib.Path)
    parser.add_argument("--options", default="", help="further options of `curvetet mesh`, separated by spaces")
    return parser.parse_args()


class Comparison:
    def __init__(self, arguments, folder):
        self.a, self.folder = arguments, pathlib.Path(folder)
        self.root = arguments.root or arguments.list.parent
        self.diagonals = diagonals(arguments.list)

    def size(self, body):
        if body in self.diagonals:
            return self.diagonals[body] / self.a.divide
        _, out, _, _ = run([self.a.curvetet, "info", "--json", self.root / body], self.a.time_limit, 0)
        box = (read_json(out) or {}).get("box")
        if not box:
            return None
        flat = [x for side in box for x in side] if isinstance(box[0], list) else box
        return sum((flat[i + 3] - flat[i]) ** 2 for i in range(3)) ** 0.5 / self.a.divide

    def outcome(self, body, size, threads):
        """Exit code and what is to be the same: the hash of the mesh, or the first error."""
        mesh, report = self.folder / "a.msh", self.folder / "a.json"
        for old in (mesh, report):
            old.unlink(missing_ok=True)
        command = [self.a.curvetet, "mesh", self.root / body, "-o", mesh, "--report", report, "-q", "--threads", threads,
                   "--unit", "mm", "--time-limit", self.a.time_limit, *self.a.options.split()]
        code, _, _, _ = run(command + (["--size", repr(size)] if size else []), 1.2 * self.a.time_limit + 5, 0)
        if mesh.is_file():
            return code, hashlib.sha256(mesh.read_bytes()).hexdigest()
        errors = (read_json(report) or {}).get("errors") or [{}]
        return code, json.dumps(errors[0])

    def compare(self, body):
        """same, differ or not compared; and words."""
        size = self.size(body)
        outcomes = []
        for threads in self.a.threads.split(","):
            outcomes.append(self.outcome(body, size, threads))
            if outcomes[-1][0] in (TIME_OR_BUDGET, None):
                return "not compared", "time limit"
        if any(outcome != outcomes[0] for outcome in outcomes):
            return "differ", "; ".join(f"{code} {what[:60]}" for code, what in outcomes)
        code, what = outcomes[0]
        return ("same" if code == 0 else "same failure"), what[:100] if code else what[:16]


def main():
    arguments = parse_arguments()
    bodies = [line.strip() for line in arguments.list.read_text().splitlines()]
    counts = {}
    with tempfile.TemporaryDirectory(prefix="curvetet_same_") as folder:
        comparison = Comparison(arguments, folder)
        for body in (line for line in bodies if line and not line.startswith("#")):
            verdict, words = comparison.compare(body)
            counts[verdict] = counts.get(verdict, 0) + 1
            print(f"{verdict:12}  {body}  {words}", flush=True)
    print("\n" + ", ".join(f"{verdict}: {count}" for verdict, count in sorted(counts.items())))
    return 0 if counts.get("same") and not counts.get("differ") else 1


if __name__ == "__main__":
    sys.exit(main())
