#!/usr/bin/env python3
"""Fails on an include that is not on the arrows between the rooms.

The arrows are the ROOMS of curvetet_room() in CMakeLists.txt, closed transitively. Rules:
  1. a room includes headers of itself, of the rooms it may see, and the public headers;
  2. public headers include public headers only (curvetet/occt.h may also include OpenCASCADE);
  3. of the product, only the room cad includes OpenCASCADE; tests and benchmarks may make shapes with it;
  4. quoted includes are written "room/file.h" or "curvetet/file.h" and name a file that exists; outside of src/ also
     "file.h" for one in the same folder, and in tests/ and fuzz/ "folder/file.h" for one of the tests;
  5. the arrows form no cycle.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
OUTSIDE = ("apps", "tests", "bench", "fuzz", "python")
ROOM = re.compile(r"^curvetet_room\((\w+)([^)]*)\)", re.MULTILINE)


def declared_rooms():
    rooms = {}
    for name, rest in ROOM.findall((ROOT / "CMakeLists.txt").read_text()):
        arrows = re.search(r"ROOMS\s+((?:[a-z_]+\s*)+)", rest)
        rooms[name] = arrows.group(1).split() if arrows else []
    return rooms


def closure(rooms):
    """Rooms seen by each room; rooms are declared in order, so an arrow to a later one is a cycle or a mistake."""
    seen, faults = {}, []
    for name, direct in rooms.items():
        seen[name] = {name}
        for other in direct:
            if other not in seen:
                faults.append(f"CMakeLists.txt: room {name} points to {other}, which is not declared before it")
                continue
            seen[name] |= seen[other]
    return seen, faults


def check_file(path, room, seen, opencascade_allowed):
    faults = []
    text = path.read_text(errors="replace")
    for match in INCLUDE.finditer(text):
        bracket, target = match.groups()
        where = f"{path.relative_to(ROOT)}:{text.count(chr(10), 0, match.start(2)) + 1}"
        if target.endswith(".hxx"):
            if not opencascade_allowed:
                faults.append(f"{where}: only the room cad includes OpenCASCADE ({target})")
            continue
        if bracket == "<":
            continue
        head = target.split("/")[0]
        if head == "curvetet":
            if not (ROOT / "include" / target).is_file():
                faults.append(f"{where}: no public header {target}")
        elif room == "public":
            faults.append(f"{where}: a public header includes {target}")
        elif (ROOT / "src" / target).is_file():
            if head not in seen[room]:
                faults.append(f"{where}: room {room} may not include {target}")
        elif room in OUTSIDE and (path.parent / target).is_file():
            continue
        elif room in ("tests", "fuzz") and (ROOT / "tests" / target).is_file():
            continue
        else:
            faults.append(f'{where}: "{target}" is not of the form room/file.h')
    return faults


def main():
    rooms = declared_rooms()
    seen, faults = closure(rooms)
    everything = set(rooms)
    seen.update({top: everything for top in OUTSIDE})
    for path in sorted(ROOT.glob("include/curvetet/*.h")):
        faults += check_file(path, "public", seen, path.name == "occt.h")
    for folder in sorted(p for p in (ROOT / "src").iterdir() if p.is_dir()):
        if folder.name not in rooms:
            faults.append(f"src/{folder.name}: not declared as a room in CMakeLists.txt")
            continue
        for path in sorted(folder.rglob("*")):
            if path.suffix in (".h", ".cpp"):
                faults += check_file(path, folder.name, seen, folder.name == "cad")
    for top in OUTSIDE:
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                faults += check_file(path, top, seen, top in ("tests", "bench", "fuzz"))
    for fault in faults:
        print(fault)
    print(f"rooms: {len(rooms)}, faults: {len(faults)}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
