#!/usr/bin/env python3
"""Meshes a list of CAD bodies at several sizes and says what became of each: nothing is skipped, no failure is hidden.

`curvetet batch` meshes, each body in a process of its own with limits of time and memory, at its diagonal over the divisor;
a run that was ended while it meshed goes on where it was. This script then has the meshes judged and compared. A mesh counts as valid
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
import signal
import subprocess
import sys
import time

EXIT_WORDS = {2: "bad options", 3: "input refused", 4: "time or budget", 5: "no valid mesh", 70: "internal error"}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", required=True, type=pathlib.Path, help="text file, a path per line, # for comments")
    parser.add_argument("--root", type=pathlib.Path, help="folder the paths are relative to; default: the list's")
    parser.add_argument("--divide", default="10,20", help="divisors of the diagonal, separated by commas")
    parser.add_argument("--curvature", type=float, default=12)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--threads", type=int, default=0, help="of each run; 0: all cores")
    parser.add_argument("--time-limit", type=float, default=60, help="seconds for each run of each program")
    parser.add_argument("--memory-limit", type=float, default=4, help="GiB of address space for each run; 0: none")
    parser.add_argument("--curvetet", required=True, type=pathlib.Path)
    parser.add_argument("--options", default="", help="further options of `curvetet mesh`, separated by spaces")
    parser.add_argument("--cad-options", default="", help="options of all commands that read the CAD file, as "
                        "'--overlaps split'")
    parser.add_argument("--judge", type=pathlib.Path)
    parser.add_argument("--gmsh", action="store_true", help="mesh with gmsh at the same size, too, for comparison")
    parser.add_argument("--out", required=True, type=pathlib.Path)
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


def run(command, limit, memory_gib):
    """Exit code (None: timed out, negative: killed by that signal), output, seconds."""
    def limits():
        os.setsid()
        if memory_gib > 0:
            size = int(memory_gib * 2**30)
            resource.setrlimit(resource.RLIMIT_AS, (size, size))

    start = time.monotonic()
    with subprocess.Popen([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
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
    return code, out.decode(errors="replace"), err.decode(errors="replace"), time.monotonic() - start


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

    def judge(self, body, mesh, name, unit_scale=None):
        """Valid (None: not judged), failed findings, boundary triangles."""
        out = self.a.out / f"{name}.judge.json"
        command = [self.a.judge, self.root / body, mesh, "--json", out]
        code, _, err, _ = run(command, 10 * self.a.time_limit, 0)
        verdict = read_json(out) or {}
        if code == 0:
            return True, [], verdict
        if code == 1:
            return False, verdict.get("failed", ["unnamed"]), verdict
        return None, ["timed out" if code is None else f"could not judge: {err.strip()[:100]}"], verdict

    def mesh_all(self, bodies, divisor):
        """What `curvetet batch` made of the bodies, by name."""
        folder = self.a.out / f"at_{divisor:g}"
        folder.mkdir(parents=True, exist_ok=True)
        names = {str((self.root / body).resolve()): body for body in bodies}
        (folder / "list.txt").write_text("".join(f"{path}\n" for path in names))
        # Once meshes are being judged they are moved and removed: such a run starts over.
        restart = ["--restart"] if (self.a.out / "results.jsonl").exists() else []
        command = [self.a.curvetet, "batch", folder / "list.txt", "--out", folder, "--jobs", self.a.jobs, "--time-limit",
                   self.a.time_limit, "--memory-limit", f"{self.a.memory_limit:g}G", *restart, "--", "--size", f"D/{divisor:g}", "--unit", "mm",
                   "--threads", self.a.threads, "--curvature", self.a.curvature, *self.a.cad_options.split(), *self.a.options.split()]
        process = subprocess.Popen([str(c) for c in command], stdout=subprocess.DEVNULL, start_new_session=True)
        LIVE.add(process.pid)
        process.wait()
        LIVE.discard(process.pid)
        if process.returncode not in (0, 5):
            sys.exit(f"curvetet batch ended with {process.returncode}")
        made = {}
        for line in (folder / "results.jsonl").read_text().splitlines():
            row = json.loads(line)
            row["mesh"], row["report"] = folder / row["mesh"], folder / row["report"]
            made[names[row["body"]]] = row
        return made

    def made_by_batch(self, body, divisor, made):
        """The row of a body that was meshed already."""
        name = f"{pathlib.Path(body).name}.{divisor:g}"
        row = {"body": body, "divide": divisor, "status": "failed", "cause": "", "size": made["size"], "seconds": made["seconds"],
               "exit": made["exit"]}
        mesh, report = self.a.out / f"{name}.msh", self.a.out / f"{name}.report.json"
        for old, new in ((made["mesh"], mesh), (made["report"], report)):
            if old.is_file():
                old.replace(new)
        self.take_report(row, read_json(report) or {})
        if made["status"] == "valid" and mesh.is_file():
            self.check(body, mesh, name, row)
        else:
            row["cause"] = f"mesh: {made['cause']}: {made['message'][:160]}"
        return self.finish(body, mesh, name, row)

    def one(self, body, divisor):
        name = f"{pathlib.Path(body).name}.{divisor:g}"
        row = {"body": body, "divide": divisor, "status": "failed", "cause": ""}
        diagonal, cause = self.diagonal(body)
        if diagonal is None:
            row["cause"] = cause
            return row
        return self.at_size(body, diagonal / divisor, name, row)

    def at_size(self, body, size, name, row):
        """Meshes one body at one size; the row gets what became of it."""
        row["size"] = size
        mesh, report = self.a.out / f"{name}.msh", self.a.out / f"{name}.report.json"
        for old in (mesh, report):
            old.unlink(missing_ok=True)
        command = [self.a.curvetet, "mesh", self.root / body, "-o", mesh, "--report", report, "--size", repr(size),
                   "--unit", "mm", "--time-limit", self.a.time_limit, "--curvature", self.a.curvature, "-q", *self.a.cad_options.split(), *self.a.options.split()]
        # The program is to keep the limit by itself; what does not is ended a little later and counted apart.
        code, _, err, row["seconds"] = run(command, 1.2 * self.a.time_limit + 5, self.a.memory_limit)
        document = read_json(report) or {}
        row["exit"] = code
        self.take_report(row, document)
        if code != 0 or not mesh.is_file():
            row["cause"] = describe_failure("mesh", code, document, err)
        else:
            self.check(body, mesh, name, row)
        return self.finish(body, mesh, name, row)

    @staticmethod
    def take_report(row, document):
        row["counts"] = document.get("counts", {})
        row["rounds"] = document.get("rounds")
        row.update(fineness(document))

    def finish(self, body, mesh, name, row):
        if self.a.gmsh and row["size"] > 0:
            self.compare(body, row["size"], name, row)
        if row["status"] == "valid" and not self.a.keep:
            mesh.unlink(missing_ok=True)
        return row

    def check(self, body, mesh, name, row):
        code, out, err, row["check_seconds"] = run([self.a.curvetet, "check", "--json", mesh, self.root / body,
                                                    *self.a.cad_options.split()],
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
            row["judge_valid"], row["judge_failed"], _ = self.judge(body, mesh, name)
            if row["judge_valid"] is not True:
                causes.append("judge: " + ", ".join(map(str, row["judge_failed"])))
        row["cause"] = "; ".join(causes)
        row["status"] = "invalid" if causes else "valid"

    def compare(self, body, size, name, row):
        """The same body and size with gmsh, by its defaults and the same elements per turn."""
        mesh = self.a.out / f"{name}.gmsh.msh"
        mesh.unlink(missing_ok=True)
        command = ["gmsh", "-3", self.root / body, "-o", mesh, "-format", "msh41", "-nt", "1", "-setnumber",
                   "Mesh.MeshSizeMax", size, "-setnumber", "Mesh.MeshSizeFromCurvature", self.a.curvature]
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
    bodies = [line.strip() for line in arguments.list.read_text().splitlines()]
    bodies = [line for line in bodies if line and not line.startswith("#")]
    divisors = [float(d) for d in arguments.divide.split(",")]
    corpus = Corpus(arguments)
    tasks = [(body, divisor) for body in bodies for divisor in divisors]
    made = {divisor: corpus.mesh_all(bodies, divisor) for divisor in divisors}
    rows = []
    with open(arguments.out / "results.jsonl", "w") as results, \
            concurrent.futures.ThreadPoolExecutor(max_workers=arguments.jobs) as pool:
        # In the order of the list, each as soon as those before it are done.
        for row in pool.map(lambda task: corpus.made_by_batch(*task, made[task[1]][task[0]]), tasks):
            rows.append(row)
            results.write(json.dumps(row) + "\n")
            results.flush()
            print_row(row)
    return 0 if summarize(rows, arguments.judge is not None) else 1


if __name__ == "__main__":
    sys.exit(main())
