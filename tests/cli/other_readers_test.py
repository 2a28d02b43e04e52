"""Whether other programs read the meshes that the built program writes, without a word of complaint.

usage: other_readers_test.py CURVETET MAKE_BODIES gmsh GMSH
       other_readers_test.py CURVETET MAKE_BODIES meshio
"""

import pathlib
import subprocess
import sys
import tempfile


def read_with_gmsh(gmsh, folder):
    """Gmsh loads each file and checks it, and writes it again with as many elements."""
    for name in ("a.msh", "p.msh", "t.msh", "o.msh2", "m.mesh"):
        source = folder / name
        if name.endswith(".msh2"):
            source = folder / "o.msh"
            source.write_bytes((folder / name).read_bytes())
        result = subprocess.run([gmsh, "-check", source], capture_output=True, text=True, timeout=120)
        said = result.stdout + result.stderr
        assert result.returncode == 0 and "Warning" not in said and "Error" not in said, said
        again = folder / "again.msh"
        result = subprocess.run([gmsh, "-save", "-format", "msh41", "-o", again, source], capture_output=True, text=True,
                                timeout=120)
        said = result.stdout + result.stderr
        assert result.returncode == 0 and "Warning" not in said and "Error" not in said, said
    return "gmsh"


def read_with_meshio(folder):
    """meshio finds the same numbers of points and of cells in every format, and the names."""
    import meshio

    seen = []
    for name in ("a.msh", "t.msh", "o.msh", "v.vtu", "m.mesh"):
        if name == "o.msh":
            (folder / name).write_bytes((folder / "o.msh2").read_bytes())
        mesh = meshio.read(folder / name)
        counts = {kind: sum(len(block.data) for block in mesh.cells if block.type == kind)
                  for kind in ("tetra", "triangle", "line")}
        seen.append((len(mesh.points), counts))
    assert all(entry == seen[0] for entry in seen), seen
    assert seen[0][1]["tetra"] > 0
    assert "face_1" in meshio.read(folder / "a.msh").field_data
    labels = bytes(meshio.read(folder / "v.vtu").field_data["labels"].ravel()).decode()
    assert '"name":"face_1"' in labels, labels
    return "meshio"


def main():
    program, make_bodies = (pathlib.Path(argument).absolute() for argument in sys.argv[1:3])
    reader = sys.argv[3]
    with tempfile.TemporaryDirectory(prefix="curvetet_readers_") as name:
        folder = pathlib.Path(name)
        subprocess.run([make_bodies, folder], check=True, stdout=subprocess.DEVNULL)
        for outputs in (["-o", "a.msh", "-o", "o.msh2", "-o", "v.vtu", "-o", "m.mesh"], ["-o", "t.msh", "--format", "msh-ascii"],
                        ["-o", "p.msh", "--parametric"]):
            subprocess.run([program, "mesh", "plate.step", "-q", *outputs], check=True, cwd=folder, timeout=120)
        print("read by", read_with_gmsh(sys.argv[4], folder) if reader == "gmsh" else read_with_meshio(folder))


if __name__ == "__main__":
    main()
