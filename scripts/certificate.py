#!/usr/bin/env python3
"""Checks the certificates in the reports of a corpus run, face by face, and prints a line for each report.

For every mesh that was made:
  - the hash of each face's facets when they were locked equals that at the end (unless relocks are counted);
  - the facets of all faces together are the mesh's boundary triangles;
  - T_Γ has as many facets as the t_3d whose place it took, and no more of them coincide than there are;
  - no face fell back to recovery facet by facet, which no valid body should need (a run with --recovery paper may:
    --allow-fallback);
  - the points that a stage added to the whole body and to its faces agree: both none, or no face has more than the body.
Runs that made no mesh have no certificate; they are listed with their error. Exit code 1 if a certificate is broken, or
if there is none at all.

    scripts/certificate.py out/corpus            # the folder that scripts/corpus.py wrote to, or reports by name
"""
import argparse
import json
import pathlib
import sys

SCHEMA = 2
STAGES = {"edge_recovery": "edge_splits", "stage_one": "stage_one_points", "stage_two": "stage_two_points"}


def faults_of(report, allow_fallback):
    if report.get("schema") != SCHEMA:
        return [f"schema {report.get('schema')} instead of {SCHEMA}"]
    faults, faces = [], report["faces"]
    if len({face["face"] for face in faces}) != len(faces) or not faces:
        faults.append("faces are missing or named twice")
    for face in faces:
        where = f"face {face['face']}"
        if face["hash_locked"] != face["hash_final"] and not face["relocks"]:
            faults.append(f"{where}: its facets are not those that were locked")
        if face["triangles"] != face["triangles_parametric"]:
            faults.append(f"{where}: {face['triangles']} facets for {face['triangles_parametric']} triangles")
        if face["coincide"] > face["triangles"] or not face["triangles"]:
            faults.append(f"{where}: {face['coincide']} of {face['triangles']} coincide")
        if face["fallback"] and not allow_fallback:
            faults.append(f"{where}: fallback")
    if sum(face["triangles"] for face in faces) != report["counts"]["triangles"]:
        faults.append("the facets of the faces are not the boundary triangles")
    for stage, total in STAGES.items():
        by_face = [face["points"][stage] for face in faces]
        if max(by_face) > report["recovery"][total]:
            faults.append(f"{stage}: {max(by_face)} points on one face, {report['recovery'][total]} in all")
    added = sum(report["recovery"][total] for total in STAGES.values())
    if added > 0 and not any(face["points"][stage] for face in faces for stage in STAGES):
        faults.append(f"{added} points were added, on no face")
    return faults


def row_of(name, report):
    faces = report["faces"]
    total = lambda key: sum(face[key] for face in faces)
    points = lambda stage: sum(face["points"][stage] for face in faces)
    share = 100 * total("coincide") / max(total("triangles"), 1)
    return (f"{name[:48]:48} {len(faces):5} {total('triangles'):8} {share:7.2f} {points('initial'):8} "
            f"{points('edge_recovery'):6} {points('stage_one'):6} {points('stage_two'):6} {total('flips_without_points'):6} "
            f"{total('unlocks'):5} {total('relocks'):5} {report['rounds']:6}")


def reports_in(places):
    for place in places:
        yield from sorted(place.glob("*.report.json")) if place.is_dir() else [place]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reports", nargs="+", type=pathlib.Path, help="folders with *.report.json, or reports")
    parser.add_argument("--allow-fallback", action="store_true")
    arguments = parser.parse_args()
    made = broken = unmade = 0
    print(f"{'body':48} faces   facets coinc % initial   edge    one    two  flips  unl.  rel. rounds")
    for path in reports_in(arguments.reports):
        report = json.loads(path.read_text(errors="replace"))
        name = path.name.removesuffix(".json").removesuffix(".report")
        if not report.get("counts", {}).get("tets"):
            errors = report.get("errors") or [{"code": "no error", "message": ""}]
            print(f"{name[:48]:48} no mesh: {errors[0]['code']}: {errors[0]['message'][:80]}")
            unmade += 1
            continue
        made += 1
        faults = faults_of(report, arguments.allow_fallback)
        print(row_of(name, report) if report.get("schema") == SCHEMA else f"{name[:48]:48}")
        for fault in faults:
            print(f"    BROKEN: {fault}")
        broken += bool(faults)
    print(f"\ncertificates: {made}, broken: {broken}; without a mesh: {unmade}")
    return 1 if broken or not made else 0


if __name__ == "__main__":
    sys.exit(main())
