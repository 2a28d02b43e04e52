"""Tetrahedral meshes of CAD bodies with curved boundaries.

    import curvetet
    made = curvetet.mesh("part.step", size=2.0)
    made.points, made.tets, made.triangles      # numpy arrays
    made.tet_solids, made.triangle_faces        # ids of the CAD's solids and faces
    made.report["quality"]
    made.write("part.msh")
"""
import pathlib as _pathlib

from curvetet._curvetet import Mesh, __version__
from curvetet import _curvetet

__all__ = ["Error", "InternalError", "Mesh", "mesh", "__version__"]


class Error(RuntimeError):
    """No valid mesh: what failed, where, and what to do about it.

    code      stable name, as "open_shell" or "time_limit"
    exit_code that of the command line: 2 options, 3 the input, 4 out of time or memory, 5 no valid mesh
    message   one sentence that names the file or the CAD entity
    entities  as ["face 12", "edge 7"]
    cad_ids   the same by kind: {"face": [12], "edge": [7]}
    where     (x, y, z) in the output's unit, or None
    hint      what to do, or ""
    report    the report as a dict, of what was done until then
    """

    def __init__(self, code, exit_code, message, entities, where, hint, report):
        super().__init__(message + ("; " + hint if hint else ""))
        self.code, self.exit_code, self.message = code, exit_code, message
        self.entities, self.where, self.hint, self.report = entities, where, hint, report
        self.cad_ids = {}
        for entity in entities:
            kind, _, number = entity.rpartition(" ")
            if number.isdigit():
                self.cad_ids.setdefault(kind, []).append(int(number))


class InternalError(RuntimeError):
    """A fault of curvetet itself: an internal check failed."""


def mesh(path, *, size=None, size_divisor=10.0, min_size=None, curvature=12.0, chord_height=None, grading=0.5,
         gaps=True, face_sizes=None, edge_sizes=None, solid_sizes=None, size_callback=None, unit="", input_unit="",
         conformal="auto", overlaps="refuse", min_feature=0.0, recovery="conjoint", refine_interior=True, improve=True,
         radius_edge=2.0, time_limit=None, memory_limit=0, threads=0, seed=1, isolate_cad=True, cad_helper=None,
         dossier=None,
         keep_invalid=False, progress=None, log=None):
    """Meshes a CAD file (STEP, IGES or BREP) and returns a Mesh.

    Lengths are in the output's unit: `unit`, by default mm (for BREP files, which carry none, `input_unit`).

    size          largest edge length; default: the body's diagonal over `size_divisor`
    min_size      floor of derived sizes; default: size / 1000, size / 50 for the curvature of free forms
    curvature     elements per full turn; 0: off
    chord_height  largest distance of a chord to its arc; default: off
    grading       growth of the size per length, above 0 and at most 10
    gaps          chord height at most a quarter of the local gap
    face_sizes, edge_sizes, solid_sizes
                  {id or name: size}, as {"inlet": 1.0, 12: 0.5}
    size_callback function of (x, y, z) that returns the largest size there; it is called from many threads in turn
    unit, input_unit
                  "um", "mm", "cm", "m", "inch" or "ft"
    conformal     solids that touch: "auto" joins them where the CAD kernel can, "strict" raises where it cannot, "off"
                  meshes solids that share no face apart, even if they overlap
    overlaps      "refuse" solids that overlap, or "split" them: what they have in common becomes a solid
    min_feature   edges shorter and faces narrower than this are suppressed where that leaves a sound body, and listed in
                  report["suppressed"]; at most a tenth of the body's diagonal; 0: off
    recovery      "conjoint", or "paper" for the published method to the letter
    refine_interior, improve
                  put points inside; improve the elements
    radius_edge   bound for tetrahedra away from the boundary, at least 1
    time_limit    seconds
    memory_limit  bytes of curvetet's own arrays; 0: none
    threads       0: all cores; the result is the same for any number
    seed          another seed, another mesh
    isolate_cad   read the file in a process of its own, so that a crash of the CAD kernel is an Error
    cad_helper    the curvetet program that reads; default: the one in this package
    dossier       folder for what a failed run leaves: words, the CAD faces, the surface meshes of the spot, and the state
                  for `curvetet replay`; nothing is written if there is a valid mesh, or at Ctrl-C
    keep_invalid  return a mesh that did not pass its final check (report["valid"] says so) instead of raising
    progress      called with (stage, fraction of the whole run)
    log           called with (level, message); level is "debug", "info", "warning" or "error"

    Raises Error, InternalError, MemoryError; TypeError for values of the wrong type; what a callback raises; and
    KeyboardInterrupt within a second of Ctrl-C. Other threads run on meanwhile: the interpreter's lock is not held.
    Time grows about linearly with the number of elements.
    """
    options = {name: value for name, value in locals().items()
               if name not in ("path", "keep_invalid", "progress", "log") and value is not None}
    own_helper = _pathlib.Path(__file__).with_name("curvetet")
    if isolate_cad and cad_helper is None and own_helper.is_file():
        options["cad_helper"] = str(own_helper)
    return _curvetet.mesh(_pathlib.Path(path), options, keep_invalid, progress, log)
