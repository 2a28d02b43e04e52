#!/usr/bin/env python3
"""Copies of CAD bodies that are rotated by three odd angles, moved by ten thousand diagonals, and scaled by 1e-3 and 1e3,
as BREP files with a list of them for corpus.py: the success must be the same for all. gmsh's program makes the copies.

    scripts/transform.py --list bodies.txt --out out/moved
    scripts/corpus.py --list out/moved/list.txt --divide 20 --curvetet build/release/apps/curvetet/curvetet --out out/runs
"""
import argparse
import json
import pathlib
import subprocess
import sys

from corpus import diagonals, read_list

ROTATIONS = (("{1,2,3}", 0.7), ("{3,-1,1}", 1.9), ("{0,1,5}", 2.3))


def operations(diagonal):
    """The names of the copies, and what gmsh does for them."""
    far = ",".join(repr(factor * diagonal) for factor in (1e4, -7e3, 3e3))
    return {"rotated": " ".join(f"Rotate {{{axis},{{0,0,0}},{angle}}} {{ Volume{{:}}; }}" for axis, angle in ROTATIONS),
            "moved": f"Translate {{{far}}} {{ Volume{{:}}; }}",
            "small": "Dilate {{0,0,0},1e-3} { Volume{:}; }",
            "large": "Dilate {{0,0,0},1e3} { Volume{:}; }"}


def copy(body, operation, path, seconds):
    """False if gmsh does not make it."""
    path.unlink(missing_ok=True)  # of an earlier run
    script = path.with_suffix(".geo")
    script.write_text('SetFactory("OpenCASCADE");\nGeometry.OCCFixDegenerated = 0;\n'
                      f"v() = ShapeFromFile({json.dumps(str(body))});\n{operation}\nSave {json.dumps(str(path))};\n")
    try:
        subprocess.run(["gmsh", script, "-0", "-v", "1"], capture_output=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        path.unlink(missing_ok=True)
    for left in (script, script.with_suffix(".geo_unrolled")):
        left.unlink(missing_ok=True)
    return path.is_file()


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", required=True, type=pathlib.Path, help="text file, a path per line, with manifest.jsonl")
    parser.add_argument("--root", type=pathlib.Path, help="folder the paths are relative to; default: the list's")
    parser.add_argument("--most", type=int, default=20, help="bodies, from the first on that can be copied")
    parser.add_argument("--time-limit", type=float, default=60, help="seconds for each copy")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    root = (arguments.root or arguments.list.parent).resolve()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    known, made, bodies = diagonals(arguments.list), [], 0
    for body in read_list(arguments.list):
        if bodies == arguments.most:
            break
        copies = [out / f"{pathlib.Path(body).name}.{name}.brep" for name in operations(1)]
        if body in known and all(copy(root / body, operation, path, arguments.time_limit)
                                 for path, operation in zip(copies, operations(known[body]).values())):
            made += [path.name for path in copies]
            bodies += 1
        else:
            print(f"not copied: {body}", file=sys.stderr)
    (out / "list.txt").write_text("".join(name + "\n" for name in made))
    print(f"{len(made)} copies of {bodies} bodies")
    return 0 if bodies == arguments.most else 1


if __name__ == "__main__":
    sys.exit(main())
