#!/usr/bin/env python3
"""Meshes a list of CAD bodies at several sizes and says what became of each: nothing is skipped, no failure is hidden.

`curvetet batch` meshes, each body in a process of its own with limits of time and memory; a run that was ended while it
meshed goes on where it was. The size is the bounding box's diagonal over the divisor; the diagonal comes from
manifest.jsonl beside the list, else from `curvetet info --json`. The meshes are then judged and compared: one is valid
only if curvetet exits with 0, `curvetet check` against the CAD passes and, where an independent judge is given, the judge
passes too. The judge is any program called as `JUDGE CAD MESH --json OUT` that exits with 0 for a valid mesh, 1 for an
invalid one and 2 when it could not judge.

    scripts/corpus.py --list bodies.txt --root bodies --curvetet build/release/apps/curvetet/curvetet --out out/corpus
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import time

EXIT_WORDS = {2: "bad options", 3: "input refused", 4: "time or budget", 5: "no valid mesh", 70: "internal error"}


def common_parser(words):
    """Bodies, sizes, limits and programs: what every comparison over a list takes."""
    parser = argparse.ArgumentParser(description=words, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", required=True, type=pathlib.Path, help="text file, a path per line, # for comments")
    parser.add_argument("--root", type=pathlib.Path, help="folder the paths are relative to; default: the list's")
    parser.add_argument("--divide", default="10,20", help="divisors of the diagonal, separated by commas")
    parser.add_argument("--curvature", type=float, default=12)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--time-limit", type=float, default=60, help="seconds for each run of each program")
    parser.add_argument("--memory-limit", type=float, default=4, help="GiB of address space for each run; 0: none")
    parser.add_argument("--curvetet", required=True, type=pathlib.Path)
    parser.add_argument("--judge", type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    return parser


def read_list(path):
    lines = [line.strip() for line in path.read_text().splitlines()]
    return [line for line in lines if line and not line.startswith("#")]


def read_divisors(text):
    return [float(divisor) for divisor in text.split(",")]


def gmsh_command(body, size, mesh, curvature, algorithm=1):
    """gmsh by its defaults but for the size, the elements per turn, and the algorithm: 1 Delaunay, 10 HXT."""
    return ["gmsh", "-3", body, "-o", mesh, "-format", "msh41", "-nt", "1", "-setnumber", "Mesh.MeshSizeMax", size,
            "-setnumber", "Mesh.MeshSizeFromCurvature", curvature, "-setnumber", "Mesh.Algorithm3D", algorithm]


def parse_arguments():
    parser = common_parser(__doc__)
    parser.add_argument("--options", default="", help="further options of `curvetet mesh`, separated by spaces")
    parser.add_argument("--cad-options", default="", help="options of all commands that read the CAD file, as "
                        "'--overlaps split'")
    parser.add_argument("--apart", action="store_true", help="bodies that fail, as those whose solids overlap, are "
                        "meshed again with --conformal off, and checked and judged in parts; they are counted")
    parser.add_argument("--gmsh", action="store_true", help="mesh with gmsh at the same size, too, for comparison")
    parser.add_argument("--keep", action="store_true", help="keep the meshes of valid runs")
    return parser.parse_args()


LIVE = set()  # process groups to end with this program


def end_all(*_):
    for group in list(LIVE):
        try:
            os.killpg(group, signal.SIGKILL)
        except ProcessLookupError:
            pass
    sys.exit("ended before all bodies were done")


def run(command, limit, memory_gib, tell=False):
    """Exit code (None: timed out, negative: killed by that signal), output, seconds. With `tell`, errors are shown instead."""
    def limits():
        os.setsid()
        if memory_gib > 0:
            size = int(memory_gib * 2**30)
            resource.setrlimit(resource.RLIMIT_AS, (size, size))

    start = time.monotonic()
    with subprocess.Popen([str(c) for c in command], stdout=subprocess.PIPE, stderr=None if tell else subprocess.PIPE,
                          stdin=subprocess.DEVNULL, preexec_fn=limits) as process:
        LIVE.add(process.pid)
        try:
            out, err = process.communicate(timeout=limit)
            code = process.returncode
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            out, err = process.communicate()
            code = None
        finally:
            LIVE.discard(process.pid)
    return code, out.decode(errors="replace"), (err or b"").decode(errors="replace"), time.monotonic() - start


def read_json(path_or_text):
    try:
        text = path_or_text.read_text(errors="replace") if isinstance(path_or_text, pathlib.Path) else path_or_text
        return json.loads(text)
    except (OSError, ValueError):
        return None


def diagonals(list_file):
    manifest = list_file.parent / "manifest.jsonl"
    found = {}
    if manifest.is_file():
        for line in manifest.read_text().splitlines():
            row = json.loads(line)
            if row.get("diag"):
                found[row["path"]] = float(row["diag"])
    return found


class Corpus:
    def __init__(self, arguments):
        self.a = arguments
        self.root = arguments.root or arguments.list.parent
        self.diagonals = diagonals(arguments.list)

    def diagonal(self, body):
        """Diagonal and None, or None and the cause."""
        if body in self.diagonals:
            return self.diagonals[body], None
        code, out, err, _ = run([self.a.curvetet, "info", "--json", self.root / body, *self.a.cad_options.split()], self.a.time_limit,
                                self.a.memory_limit)
        info = read_json(out)
        box = (info or {}).get("box")
        if code != 0 or not box:
            return None, describe_failure("info", code, read_json(out), err)
        flat = [x for side in box for x in side] if isinstance(box[0], list) else box
        return sum((flat[i + 3] - flat[i]) ** 2 for i in range(3)) ** 0.5, None

    def judge(self, body, mesh, name, apart=False):
        """Valid (None: not judged), failed findings, boundary triangles."""
        out = self.a.out / f"{name}.judge.json"
        command = [self.a.judge, self.root / body, mesh, "--json", out, *(["--parts"] if apart else [])]
        code, _, err, _ = run(command, 10 * self.a.time_limit, 0)
        verdict = read_json(out) or {}
        if code == 0:
            return True, [], verdict
        if code == 1:
            return False, verdict.get("failed", ["unnamed"]), verdict
        return None, ["timed out" if code is None else f"could not judge: {err.strip()[:100]}"], verdict

    def row(self, body, divisor):
        """What is known of a run before it is done. Without a diagonal there is no size, and a cause instead."""
        diagonal, cause = self.diagonal(body)
        return {"body": body, "divide": divisor, "size": None if diagonal is None else diagonal / divisor,
                "name": f"{pathlib.Path(body).name}.{divisor:g}", "status": "failed", "cause": cause or ""}

    def mesh_all(self, rows):
        """Has the body of each row meshed at its size, and where that fails and it is asked, again in parts."""
        rows = [row for row in rows if row["size"]]
        self.mesh_batch(rows, [])
        self.mesh_apart(rows)

    def mesh_apart(self, rows):
        """Meshes again in parts what failed together, if that is asked; the rows concerned."""
        failed = [row for row in rows if self.a.apart and row["size"] and row["cause"] and not row.get("apart")]
        for row in failed:
            row["apart"], row["cause_together"] = True, row["cause"]
        if failed:
            self.mesh_batch(failed, ["--conformal", "off"])
        return failed

    def mesh_batch(self, rows, options):
        """One `curvetet batch`; the rows get what became of it. Meshes and reports are then in the output folder by the
        rows' names."""
        folder = self.a.out / "batch"
        folder.mkdir(parents=True, exist_ok=True)
        keys = {(str((self.root / row["body"]).resolve()), ("--size", repr(row["size"]))): row for row in rows}
        (folder / "list.txt").write_text("".join("\t".join((path, *options)) + "\n" for path, options in keys))
        command = [self.a.curvetet, "batch", folder / "list.txt", "--out", folder, "--jobs", self.a.jobs, "--time-limit",
                   self.a.time_limit, "--", "--unit", "mm", "--curvature", self.a.curvature,
                   *self.a.cad_options.split(), *self.a.options.split(), *options]
        code, _, _, _ = run(command, None, self.a.memory_limit, tell=True)
        if code not in (0, 5):
            sys.exit(f"curvetet batch ended with {code}")
        for line in (folder / "results.jsonl").read_text().splitlines():
            made = json.loads(line)
            row = keys.get((made["body"], tuple(made["options"])))
            if row is not None:
                self.take(row, made, folder)
        shutil.rmtree(folder)  # what was made is taken: another run starts over

    def take(self, row, made, folder):
        row["seconds"], row["exit"] = made["seconds"], made["exit"]
        for key, ending in (("mesh", "msh"), ("report", "report.json")):
            if (folder / made[key]).is_file():
                (folder / made[key]).replace(self.a.out / f"{row['name']}.{ending}")
        document = read_json(self.a.out / f"{row['name']}.report.json") or {}
        row["counts"] = document.get("counts", {})
        row["rounds"] = document.get("rounds")
        row.update(fineness(document))
        row["cause"] = f"mesh: {made['cause']}: {made['message'][:160]}" if made["status"] != "valid" else ""

    def judge_row(self, row):
        """Checks, judges and compares what was meshed."""
        mesh = self.a.out / f"{row['name']}.msh"
        if not row["cause"]:
            self.check(row["body"], mesh, row["name"], row)
        if self.a.gmsh and row["size"]:
            self.compare(row["body"], row["size"], row["name"], row)
        if row["status"] == "valid" and not self.a.keep:
            mesh.unlink(missing_ok=True)
        return row

    def check(self, body, mesh, name, row):
        apart = row.get("apart", False)
        code, out, err, row["check_seconds"] = run([self.a.curvetet, "check", "--json", mesh, self.root / body,
                                                    *self.a.cad_options.split(),
                                                    *(["--conformal", "off"] if apart else [])],
                                                   self.a.time_limit, self.a.memory_limit)
        own = read_json(out) or {}
        row["triangles"] = own.get("counts", {}).get("triangles")
        row["tets"] = own.get("counts", {}).get("tets")
        row["worst_dihedral"] = own.get("quality", {}).get("worst_dihedral")
        row["own_errors"] = [f["check"] for f in own.get("findings", []) if f["severity"] == "error"]
        row["own_valid"] = code == 0
        causes = []
        if code != 0:
            words = ", ".join(row["own_errors"]) or describe_failure("check", code, own, err)
            causes.append(f"check: {words}")
        if self.a.judge:
            row["judge_valid"], row["judge_failed"], _ = self.judge(body, mesh, name, apart)
            if row["judge_valid"] is not True:
                causes.append("judge: " + ", ".join(map(str, row["judge_failed"])))
        row["cause"] = "; ".join(causes)
        row["status"] = "invalid" if causes else "valid"

    def compare(self, body, size, name, row):
        """The same body and size with gmsh, by its defaults and the same elements per turn."""
        mesh = self.a.out / f"{name}.gmsh.msh"
        mesh.unlink(missing_ok=True)
        command = gmsh_command(self.root / body, size, mesh, self.a.curvature)
        code, _, _, seconds = run(command, self.a.time_limit, self.a.memory_limit)
        gmsh = {"exit": code, "seconds": seconds, "valid": False}
        if code == 0 and mesh.is_file():
            _, out, _, _ = run([self.a.curvetet, "check", "--json", mesh], self.a.time_limit, self.a.memory_limit)
            counts = (read_json(out) or {}).get("counts", {})
            gmsh["triangles"], gmsh["tets"] = counts.get("triangles"), counts.get("tets")
            if self.a.judge:
                gmsh["valid"], gmsh["failed"], _ = self.judge(body, mesh, f"{name}.gmsh")
            else:
                gmsh["valid"] = None
        row["gmsh"] = gmsh
        mesh.unlink(missing_ok=True)


def fineness(document):
    """What the report says of fineness: triangles over those that area and size ask for, faces with over three times as
    many and no reason, points added by recovery over the first surface points."""
    faces, initial = document.get("faces", []), document.get("counts", {}).get("initial_surface_points", 0)
    asked = sum(face.get("triangles_asked") or 0 for face in faces)
    if not asked or not initial:
        return {}
    explained = {reduction["face"] for reduction in document.get("reductions", [])}
    recovery = document["recovery"]
    added = recovery["edge_splits"] + recovery["stage_one_points"] + recovery["stage_two_points"]
    return {"over_asked": sum(face["triangles"] for face in faces) / asked,
            "unexplained_faces": sum(face["triangles"] > 3 * face["triangles_asked"] and face["face"] not in explained
                                     for face in faces),
            "added_share": added / initial}


def describe_failure(what, code, document, err):
    """One line: who failed and how, with the code of the first error where there is one."""
    if code is None:
        return f"{what}: did not end in time"
    if code < 0:
        return f"{what}: killed by {signal.Signals(-code).name}"
    errors = (document or {}).get("errors") or []
    if errors:
        first = errors[0]
        return f"{what}: {first.get('code', '?')}: {str(first.get('message', ''))[:160]}"
    last = err.strip().splitlines()[-1][:160] if err.strip() else ""
    return f"{what}: exit {code} ({EXIT_WORDS.get(code, 'unknown')}) {last}".strip()


def cause_key(row):
    """Short cause for counting: what failed and the code, without numbers and places."""
    parts = row["cause"].split(": ")
    return ": ".join(parts[:2])[:80] if row["cause"] else "unknown"


def number(value, form):
    return form % value if isinstance(value, (int, float)) else "-"


def print_row(row):
    gmsh = row.get("gmsh")
    columns = [f"{row['status']:8}", f"/{row['divide']:<5g}", f"{number(row.get('triangles'), '%d'):>8}",
               f"{number(row.get('tets'), '%d'):>9}", f"{number(row.get('seconds'), '%.1f'):>6}s",
               f"{number(row.get('worst_dihedral'), '%.1f'):>6}"]
    if gmsh is not None:
        verdict = {True: "valid", False: "invalid", None: "unjudged"}[gmsh["valid"]]
        columns.append(f"gmsh {verdict:8} {number(gmsh.get('triangles'), '%d'):>8}")
    print("  ".join(columns), f" {row['body']}", f" {row['cause']}" if row["cause"] else "", flush=True)


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def summarize_fineness(rows):
    rows = [row for row in rows if row["status"] == "valid" and "added_share" in row]
    if not rows:
        return
    added, over = [row["added_share"] for row in rows], [row["over_asked"] for row in rows]
    print(f"points added by recovery over the first surface points: median {quantile(added, 0.5):.1%}, "
          f"95 % of runs at most {quantile(added, 0.95):.1%}")
    print(f"boundary triangles over those that area and size ask for: median {quantile(over, 0.5):.2f}; more than 3: "
          f"{sum(x > 3 for x in over)} runs, of which with a face that has no reason in the report: "
          f"{sum(row['over_asked'] > 3 and row['unexplained_faces'] > 0 for row in rows)}")


def summarize(rows, judged):
    total, valid = len(rows), sum(row["status"] == "valid" for row in rows)
    print(f"\nvalid {valid} of {total} ({100 * valid / max(total, 1):.1f} %)"
          + ("" if judged else "; no independent judge was asked"))
    for divisor in sorted({row["divide"] for row in rows}):
        here = [row for row in rows if row["divide"] == divisor]
        print(f"  /{divisor:g}: {sum(row['status'] == 'valid' for row in here)} of {len(here)}")
    apart = [row for row in rows if row.get("apart")]
    if apart:
        print(f"of these failed as a whole and were tried in parts: {len(apart)}, "
              f"valid {sum(row['status'] == 'valid' for row in apart)}")
    causes = collections.Counter(cause_key(row) for row in rows if row["status"] != "valid")
    for cause, count in causes.most_common():
        print(f"  {count:5}  {cause}")
    disagree = [row for row in rows if row.get("own_valid") and row.get("judge_valid") is False]
    if disagree:
        print(f"passed by `curvetet check` but not by the judge: {len(disagree)}")
    both = [row for row in rows if row["status"] == "valid" and row.get("gmsh", {}).get("valid")
            and row["gmsh"].get("triangles") and row.get("triangles")]
    if any("gmsh" in row for row in rows):
        gmsh_valid = sum(row.get("gmsh", {}).get("valid") is True for row in rows)
        print(f"gmsh: valid {gmsh_valid} of {total}")
    if both:
        ratios = sorted(row["triangles"] / row["gmsh"]["triangles"] for row in both)
        print(f"boundary triangles over gmsh's where both are valid ({len(both)}): median "
              f"{ratios[len(ratios) // 2]:.2f}, from {ratios[0]:.2f} to {ratios[-1]:.2f}")
    summarize_fineness(rows)
    return valid == total


def main():
    arguments = parse_arguments()
    for number_of_signal in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number_of_signal, end_all)
    arguments.out.mkdir(parents=True, exist_ok=True)
    corpus = Corpus(arguments)
    planned = [corpus.row(body, divisor) for body in read_list(arguments.list)
               for divisor in read_divisors(arguments.divide)]
    corpus.mesh_all(planned)
    (arguments.out / "results.jsonl").unlink(missing_ok=True)
    judge_all(corpus, planned, arguments)
    if again := corpus.mesh_apart(planned):
        print("\nagain, in parts:")
        judge_all(corpus, again, arguments)
    (arguments.out / "results.jsonl").write_text("".join(json.dumps(row) + "\n" for row in planned))
    return 0 if summarize(planned, arguments.judge is not None) else 1


def judge_all(corpus, rows, arguments):
    """In the order of the list, each as soon as those before it are done."""
    with open(arguments.out / "results.jsonl", "a") as results, \
            concurrent.futures.ThreadPoolExecutor(max_workers=arguments.jobs) as pool:
        for row in pool.map(corpus.judge_row, rows):
            results.write(json.dumps(row) + "\n")
            results.flush()
            print_row(row)


if __name__ == "__main__":
    sys.exit(main())
