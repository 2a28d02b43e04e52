"""The Python module from outside.

usage: module_test.py FOLDER_OF_THE_PACKAGE MAKE_BODIES [unittest arguments]
"""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

BODIES = pathlib.Path()


def signed_volumes(made):
    a, b, c, d = (made.points[made.tets[:, i]] for i in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


class Meshing(unittest.TestCase):
    def test_arrays_fit_each_other_and_the_cad(self):
        made = curvetet.mesh(BODIES / "plate.step", size=4.0)
        self.assertEqual(made.points.dtype, numpy.float64)
        self.assertEqual(made.points.shape[1], 3)
        for elements, corners in ((made.tets, 4), (made.triangles, 3), (made.segments, 2)):
            self.assertEqual(elements.dtype, numpy.uint32)
            self.assertEqual(elements.shape[1], corners)
            self.assertLess(elements.max(), len(made.points))
        for ids, elements, entities in ((made.tet_solids, made.tets, made.solids),
                                        (made.triangle_faces, made.triangles, made.faces),
                                        (made.segment_edges, made.segments, made.edges)):
            self.assertEqual(len(ids), len(elements))
            self.assertEqual(set(ids.tolist()), {entity["id"] for entity in entities})
        volumes = signed_volumes(made)
        self.assertTrue((volumes > 0).all())
        reported = sum(solid["volume"] for solid in made.report["solids"])
        self.assertAlmostEqual(volumes.sum(), reported, delta=1e-9 * reported)
        self.assertEqual(made.report["counts"]["tets"], len(made.tets))
        self.assertTrue(made.report["valid"])

    def test_details_are_suppressed_on_request(self):
        self.assertEqual(curvetet.mesh(BODIES / "pricked.step").report["suppressed"], [])
        made = curvetet.mesh(BODIES / "pricked.step", min_feature=0.5)
        gone = {detail["id"] for detail in made.report["suppressed"]}
        self.assertEqual(len(gone), 2)
        self.assertEqual({face["id"] for face in made.faces} | gone, set(range(1, 9)))

    def test_nodes_know_their_place_on_the_cad(self):
        made = curvetet.mesh(str(BODIES / "ball.brep"), size=2)
        self.assertEqual(len(made.node_dimensions), len(made.points))
        self.assertEqual(made.node_parameters.shape, (len(made.points), 2))
        on_boundary = made.node_dimensions < 3
        self.assertEqual(set(made.triangles.ravel().tolist()), set(numpy.flatnonzero(on_boundary).tolist()))
        distance = numpy.linalg.norm(made.points[on_boundary], axis=1)
        self.assertLess(abs(distance - 5).max(), 1e-6)
        self.assertEqual(set(made.node_entities[made.node_dimensions == 2].tolist()), {1})

    def test_arrays_outlive_the_mesh_and_cannot_be_written(self):
        points = curvetet.mesh(BODIES / "box.step").points
        before = points.copy()
        curvetet.mesh(BODIES / "plate.step")
        self.assertTrue((points == before).all())
        with self.assertRaises(ValueError):
            points[0] = 0

    def test_sizes_of_faces_and_of_places(self):
        coarse = curvetet.mesh(BODIES / "box.step", size_divisor=4)
        face = coarse.faces[0]["id"]
        size = coarse.report["options"]["size"]
        local = curvetet.mesh(BODIES / "box.step", size_divisor=4, face_sizes={face: size / 4})
        self.assertGreater((local.triangle_faces == face).sum(), 4 * (coarse.triangle_faces == face).sum())
        places = []

        def by_place(x, y, z):
            places.append((x, y, z))
            return size / 3

        finer = curvetet.mesh(BODIES / "box.step", size_divisor=4, size_callback=by_place)
        self.assertTrue(places)
        self.assertGreater(len(finer.triangles), 2 * len(coarse.triangles))

    def test_writes_what_it_holds(self):
        made = curvetet.mesh(BODIES / "box.step")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "box.msh"
            made.write(path)
            self.assertGreater(path.stat().st_size, 1000)
            with self.assertRaises(curvetet.Error) as caught:
                made.write(pathlib.Path(folder) / "nowhere" / "box.msh")
            self.assertEqual(caught.exception.code, "output_unwritable")
            with self.assertRaises(curvetet.Error):
                made.write(pathlib.Path(folder) / "box.unknown")
            self.assertEqual([p.name for p in pathlib.Path(folder).iterdir()], ["box.msh"])

    def test_same_mesh_for_any_number_of_threads(self):
        one, two = (curvetet.mesh(BODIES / "plate.step", threads=n) for n in (1, 2))
        self.assertEqual(one.points.tobytes(), two.points.tobytes())
        self.assertEqual(one.tets.tobytes(), two.tets.tobytes())

    def test_read_in_this_process(self):
        self.assertTrue(curvetet.mesh(BODIES / "box.step", isolate_cad=False).report["valid"])


class Failures(unittest.TestCase):
    def test_an_open_shell_is_an_error_that_says_all(self):
        with self.assertRaises(curvetet.Error) as caught:
            curvetet.mesh(BODIES / "open.brep")
        error = caught.exception
        self.assertEqual(error.code, "open_shell")
        self.assertEqual(error.exit_code, 3)
        self.assertIn("open.brep", str(error))
        self.assertTrue(error.entities)
        self.assertEqual(sum(map(len, error.cad_ids.values())), len(error.entities))
        self.assertEqual(error.report["errors"][0]["code"], "open_shell")

    def test_a_dossier_of_what_fails_and_of_nothing_else(self):
        with tempfile.TemporaryDirectory() as folder:
            dossier = pathlib.Path(folder) / "why"
            curvetet.mesh(BODIES / "box.step", dossier=dossier)
            self.assertFalse(dossier.exists())
            with self.assertRaises(curvetet.Error) as caught:
                curvetet.mesh(BODIES / "crossed.brep", dossier=dossier)
            self.assertEqual({path.name for path in dossier.iterdir()},
                             {"summary.txt", "report.json", "faces.brep", "spot.vtu", "replay.bin"})
            self.assertIn(caught.exception.message, (dossier / "summary.txt").read_text())
            self.assertEqual(caught.exception.report["warnings"], [])
            with self.assertRaises(curvetet.Error) as caught:
                curvetet.mesh(BODIES / "crossed.brep", dossier=str(dossier / "summary.txt"))
            self.assertIn("output_unwritable", caught.exception.report["warnings"][0])

    def test_files_that_are_none(self):
        for path, code in ((BODIES / "missing.step", "file_not_found"), (BODIES, "file_unreadable")):
            with self.assertRaises(curvetet.Error) as caught:
                curvetet.mesh(path)
            self.assertEqual(caught.exception.exit_code, 3)
            self.assertEqual(caught.exception.code, code)

    def test_options_of_the_wrong_kind(self):
        box = BODIES / "box.step"
        for wrong in ({"size": "large"}, {"threads": 1.5}, {"face_sizes": [1]}, {"size_callback": 3}, {"colour": 1},
                      {"face_sizes": {1: "x"}}, {"dossier": 5}, {"threads": -(2**40)}):
            with self.assertRaises(TypeError, msg=str(wrong)):
                curvetet.mesh(box, **wrong)
        for wrong in ({"overlaps": "perhaps"}, {"recovery": ""}):
            with self.assertRaises(ValueError, msg=str(wrong)):
                curvetet.mesh(box, **wrong)
        for wrong in ({"size": -1}, {"size": float("nan")}, {"unit": "parsec"}, {"face_sizes": {"nobody": 1}},
                      {"min_feature": -1.0}):
            with self.assertRaises(curvetet.Error, msg=str(wrong)) as caught:
                curvetet.mesh(box, **wrong)
            self.assertEqual(caught.exception.exit_code, 2)
        with self.assertRaises(TypeError):
            curvetet.mesh(7)

    def test_out_of_time(self):
        with self.assertRaises(curvetet.Error) as caught:
            curvetet.mesh(BODIES / "plate.step", size_divisor=400, time_limit=1)
        self.assertEqual(caught.exception.code, "time_limit")
        self.assertEqual(caught.exception.exit_code, 4)


class Callbacks(unittest.TestCase):
    def test_progress_rises_to_one(self):
        seen = []
        curvetet.mesh(BODIES / "plate.step", progress=lambda stage, fraction: seen.append((stage, fraction)))
        fractions = [fraction for _, fraction in seen]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1)

    def test_what_callbacks_raise_ends_the_run(self):
        class Mine(Exception):
            pass

        def fail(*_):
            raise Mine("enough")

        for callback in ("progress", "size_callback"):
            with self.assertRaises(Mine):
                curvetet.mesh(BODIES / "plate.step", size_divisor=30, **{callback: fail})
        with self.assertRaises(TypeError):
            curvetet.mesh(BODIES / "box.step", size_callback=lambda x, y, z: "small")

    def test_other_threads_run_meanwhile(self):
        count, done = 0, threading.Event()

        def work():
            try:
                curvetet.mesh(BODIES / "plate.step", size_divisor=30)
            finally:
                done.set()

        thread = threading.Thread(target=work)
        thread.start()
        while not done.is_set():
            count += 1
            time.sleep(0.001)
        thread.join()
        self.assertGreater(count, 20)


class Stopping(unittest.TestCase):
    def test_ctrl_c_is_a_keyboard_interrupt(self):
        code = ("import sys, time, curvetet\n"
                "def told(stage, fraction):\n"
                "    if stage not in ('load', 'done'): print('meshing', flush=True)\n"
                "try:\n"
                f"    curvetet.mesh({str(BODIES / 'plate.step')!r}, size_divisor=500, progress=told)\n"
                "except KeyboardInterrupt:\n"
                "    print('interrupted', flush=True)\n")
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "PYTHONPATH": PACKAGE}) as process:
            self.assertEqual(process.stdout.readline().strip(), "meshing")
            process.send_signal(signal.SIGINT)
            rest, _ = process.communicate(timeout=60)  # without the signal it would mesh for minutes
        self.assertEqual(rest.split()[-1], "interrupted")
        self.assertEqual(process.returncode, 0)


if __name__ == "__main__":
    PACKAGE, maker = sys.argv[1], sys.argv[2]
    sys.path.insert(0, PACKAGE)
    import curvetet

    with tempfile.TemporaryDirectory(prefix="curvetet_python_") as made:
        BODIES = pathlib.Path(made)
        subprocess.run([maker, made], check=True, capture_output=True)
        unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
