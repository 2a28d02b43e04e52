"""The built program from outside: what it says, what it writes, how it ends.

usage: command_line_test.py CURVETET MAKE_BODIES [unittest arguments]
"""

import json
import os
import pathlib
import pty
import re
import resource
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = ""
BODIES = pathlib.Path()
PATIENCE = 120  # seconds; only a hung program needs as much


def run(*arguments, **options):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        **options,
    )


class CommandLineTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="curvetet_cli_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def expect(self, code, *arguments, **options):
        result = run(*arguments, **options)
        self.assertEqual(result.returncode, code, f"{arguments}\n{result.stdout}\n{result.stderr}")
        if code not in (0, 5):
            self.assertTrue(result.stderr.startswith("curvetet: "), result.stderr)
        return result

    def mesh_plate(self, *arguments):
        mesh = self.folder / "plate.msh"
        return mesh, self.expect(0, "mesh", BODIES / "plate.step", "-o", mesh, *arguments)


class Help(CommandLineTest):
    def test_help_and_version(self):
        text = self.expect(0, "--help").stdout
        for word in ("mesh", "replay", "info", "check", "picture", "batch", "Exit codes", "Examples"):
            self.assertIn(word, text)
        for command in ("mesh", "replay", "info", "check", "picture", "batch"):
            self.assertIn("Examples", self.expect(0, command, "--help").stdout)
        text = self.expect(0, "mesh", "--help").stdout
        for option in ("--size", "--unit", "--recovery", "--face-size", "--time-limit", "LENGTH", "SECONDS"):
            self.assertIn(option, text)
        self.assertRegex(self.expect(0, "--version").stdout, r"^curvetet \d+\.\d+\.\d+")


class UsageErrors(CommandLineTest):
    def test_nothing_is_done(self):
        box, mesh = BODIES / "box.step", self.folder / "box.msh"
        wrong = [
            [],
            ["weave"],
            ["mesh"],
            ["mesh", box],
            ["mesh", box, "-o"],
            ["mesh", box, "-o", mesh, "--frobnicate"],
            ["mesh", box, "-o", self.folder / "box.step"],
            ["mesh", box, "-o", self.folder / "box"],
            ["mesh", box, "-o", mesh, "-o", mesh],
            ["mesh", box, "-o", mesh, "--report", mesh],
            ["mesh", box, "-o", box, "--format", "msh"],
            ["mesh", box, "-o", mesh, "--format", "obj"],
            ["mesh", box, "-o", self.folder / "box.vtu", "--format", "msh22"],
            ["mesh", box, "-o", mesh, "--recovery", "magic"],
            ["mesh", box, "-o", mesh, "--quiet", "--verbose"],
            ["mesh", box, "-o", mesh, "--face-size", "1"],
            ["mesh", box, "-o", mesh, "--face-size", "=1"],
            ["mesh", box, "-o", mesh, "--face-size", "1=x"],
            ["mesh", box, "-o", mesh, "--face-size", "1=-1"],
            ["mesh", box, "-o", mesh, "--face-size", "no such face=1"],
            ["mesh", box, "-o", mesh, "--unit", "furlong"],
            ["mesh", box, "-o", mesh, "--grading", "0"],
            ["mesh", box, "-o", mesh, "--curvature", "-1"],
            ["mesh", box, "-o", mesh, "--time-limit", "0"],
            ["mesh", box, "-o", mesh, "--threads", "-3"],
            ["mesh", box, "-o", mesh, "--radius-edge", "nan"],
            ["mesh", box, "-o", mesh, "--min-feature", "-1"],
            ["mesh", box, "-o", mesh, "--min-feature", "nan"],
            ["mesh", box, "-o", mesh, "--min-feature", "5"],
            ["info", box, "--min-feature", "-1"],
            ["mesh", box, "-o", mesh, "--memory-limit", "much"],
            ["mesh", box, "-o", mesh, "--memory-limit", "1M"],
            ["mesh", box, "-o", mesh, "--dossier", ""],
            ["mesh", box, "-o", mesh, "--dossier", mesh],
            ["replay"],
            ["replay", box, "-o", box],
            ["replay", box, "--size", "x"],
            ["info"],
            ["check"],
            ["picture", mesh],
            ["picture", mesh, "-o", self.folder / "a.png", "--cut", "w=1"],
            ["picture", mesh, "-o", self.folder / "a.png", "--cut", "x=2"],
            ["picture", mesh, "-o", self.folder / "a.png", "--size", "0x0"],
        ]
        wrong += [["mesh", box, "-o", mesh, "--size", size] for size in ("0", "-1", "nan", "inf", "1e-300", "1e400", "x", "")]
        before = box.read_bytes()
        for arguments in wrong:
            with self.subTest(arguments=arguments):
                result = self.expect(2, *arguments)
                self.assertEqual(result.stdout, "")
                self.assertEqual(self.files(), [])
        self.assertEqual(box.read_bytes(), before)


class BadInput(CommandLineTest):
    def expect_refused(self, path, *arguments):
        mesh, report = self.folder / "out.msh", self.folder / "out.json"
        begin = time.monotonic()
        result = self.expect(3, "mesh", path, "-o", mesh, "--report", report, *arguments)
        self.assertLess(time.monotonic() - begin, 20)
        self.assertIn("error:", result.stderr)
        self.assertIn(os.fspath(path), result.stderr)
        self.assertFalse(mesh.exists())
        errors = json.loads(report.read_text())["errors"]
        self.assertEqual(len(errors), 1)
        self.error = errors[0]
        report.unlink()
        return errors[0]["code"]

    def test_bodies_that_bound_no_volume(self):
        for isolation in ([], ["--no-isolate"]):
            with self.subTest(isolation=isolation):
                for name in ("plane.brep", "half_space.brep"):
                    self.assertEqual(self.expect_refused(BODIES / name, *isolation), "unbounded")
                    self.assertEqual(self.error["entities"], ["face 1"])
                self.assertEqual(self.expect_refused(BODIES / "vertex.brep", *isolation), "no_faces")
                self.assertEqual(self.expect_refused(BODIES / "speck.brep", *isolation), "zero_size")
                for name in ("open.brep", "open.step"):
                    self.assertEqual(self.expect_refused(BODIES / name, *isolation), "open_shell")
                    self.assertEqual(len(self.error["entities"]), 4)
                    self.assertRegex(self.error["entities"][0], r"^edge \d+$")
                    self.assertEqual(len(self.error["where"]), 3)
        self.assertEqual(self.files(), [])

    def test_coordinates_that_are_no_numbers(self):
        brep, step = (BODIES / "ball.brep").read_text(), (BODIES / "box.step").read_text()
        for number in ("nan", "inf", "1e308", "-1e300"):
            for name, text in (
                ("bad.brep", brep.replace("5 ", number + " ")),
                ("bad.step", re.sub(r"(CARTESIAN_POINT\('',\()[^,]*,", rf"\g<1>{number},", step, count=3)),
            ):
                with self.subTest(name=name, number=number):
                    path = self.folder / name
                    path.write_text(text)
                    self.assertNotIn(self.expect_refused(path), ("reader_crashed", "time_limit"))
                    if name == "bad.step":
                        self.assertEqual(self.error["code"], "not_finite")
                        self.assertRegex(self.error["entities"][0], r"^#\d+$")
                    path.unlink()
        self.assertEqual(self.files(), [])

    def test_wrong_endings(self):
        # The content decides, whatever the ending says; what no reader knows is refused.
        for name in ("plate.brep", "plate.igs", "plate.txt", "plate"):
            with self.subTest(name=name):
                path, mesh = self.folder / name, self.folder / "out.msh"
                path.write_bytes((BODIES / "plate.step").read_bytes())
                self.expect(0, "mesh", path, "-o", mesh)
                mesh.unlink()
                path.unlink()
        text = self.folder / "text.txt"
        text.write_text("no body\n")
        self.assertEqual(self.expect_refused(text), "unknown_format")
        text.rename(self.folder / "text.step")
        self.assertEqual(self.expect_refused(self.folder / "text.step"), "reader_failed")

    def test_files_that_end_too_early(self):
        whole = {name: (BODIES / name).read_bytes() for name in ("plate.step", "ball.brep")}
        for name, content in whole.items():
            for share in (0.02, 0.2, 0.5, 0.8, 0.97):
                with self.subTest(name=name, share=share):
                    path = self.folder / name
                    path.write_bytes(content[: int(share * len(content))])
                    self.assertNotIn(self.expect_refused(path), ("reader_crashed", "time_limit"))
                    path.unlink()
        self.assertEqual(self.files(), [])

    def test_missing_folder_empty(self):
        self.assertEqual(self.expect_refused(self.folder / "none.step"), "file_not_found")
        self.assertEqual(self.expect_refused(self.folder), "file_unreadable")
        empty = self.folder / "empty.step"
        empty.write_bytes(b"")
        self.assertEqual(self.expect_refused(empty), "empty_file")
        self.assertEqual(self.files(), ["empty.step"])

    def test_truncated_and_garbage(self):
        whole = (BODIES / "plate.step").read_bytes()
        for name, content in (
            ("half.step", whole[: len(whole) // 2]),
            ("head.step", whole[:200]),
            ("noise.step", bytes(range(256)) * 50),
            ("noise.brep", b"DBRep_DrawableShape\n" + bytes(range(256)) * 50),
            ("noise.igs", b"S 1\n" * 400),
        ):
            with self.subTest(name=name):
                path = self.folder / name
                path.write_bytes(content)
                self.expect_refused(path)
                path.unlink()
        self.assertEqual(self.files(), [])

    def test_other_commands(self):
        self.expect(3, "info", self.folder / "none.step")
        self.expect(3, "check", self.folder / "none.msh")
        self.expect(3, "check", BODIES / "box.step")
        self.expect(3, "picture", self.folder / "none.msh", "-o", self.folder / "a.png")
        self.assertEqual(self.files(), [])


class Outputs(CommandLineTest):
    def test_every_format_and_the_check(self):
        names = ["a.msh", "a.msh2", "a.vtu", "a.mesh", "a.stl", "a.data"]
        outputs = [argument for name in names for argument in ("-o", self.folder / name)]
        result = self.expect(0, "mesh", BODIES / "plate.step", *outputs, "--report", self.folder / "a.json",
                             "--format", "msh-ascii")
        self.assertEqual(self.files(), sorted(names + ["a.json"]))
        for word in ("tetrahedra", "worst dihedral", "default", "volume", "rounds", "time", "valid"):
            self.assertIn(word, result.stdout)
        report = json.loads((self.folder / "a.json").read_text())
        self.assertTrue(report["valid"])
        self.assertEqual(report["errors"], [])
        self.assertEqual(len(report["faces"]), 7)
        self.assertTrue((self.folder / "a.data").read_text().startswith("$MeshFormat\n4.1 0 8"))
        for name in names[:4]:
            with self.subTest(name=name):
                self.expect(0, "check", self.folder / name, BODIES / "plate.step")
                check = json.loads(self.expect(0, "check", self.folder / name, "--json").stdout)
                self.assertTrue(check["valid"])
                self.assertEqual(check["counts"]["tets"], report["counts"]["tets"])

    def test_units(self):
        mesh, _ = self.mesh_plate("--unit", "m", "--size", "0.004")
        check = json.loads(self.expect(0, "check", mesh, BODIES / "plate.step", "--json").stdout)
        self.assertEqual(check["unit"], "m")
        self.assertAlmostEqual(check["solids"][0]["volume"] * 1e9, 6000 - 3.14159265 * 9 * 30, delta=60)

    def test_local_size_makes_it_finer(self):
        counts = []
        for extra in ([], ["--face-size", "1=1.5"]):
            self.mesh_plate("--size", "6", "--report", self.folder / "r.json", *extra)
            counts.append(json.loads((self.folder / "r.json").read_text())["counts"]["tets"])
        self.assertLess(counts[0], counts[1])

    def test_same_bytes_for_any_number_of_threads(self):
        contents = []
        for threads in ("1", "2", "3"):
            mesh, _ = self.mesh_plate("--threads", threads, "--size", "3")
            contents.append(mesh.read_bytes())
        self.assertEqual(contents[0], contents[1])
        self.assertEqual(contents[0], contents[2])

    def test_quiet_says_nothing(self):
        _, result = self.mesh_plate("--quiet")
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_places_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        (self.folder / "folder.msh").mkdir()
        before = self.files()
        for place in ("no/such/folder/a.msh", "file/a.msh", "folder.msh"):
            with self.subTest(place=place):
                self.expect(3, "mesh", BODIES / "box.step", "-o", self.folder / place)
        self.expect(3, "mesh", BODIES / "box.step", "-o", self.folder / "a.msh", "--report", self.folder / "no/r.json")
        if os.path.exists("/dev/full"):
            self.expect(3, "mesh", BODIES / "box.step", "-o", "/dev/full", "--format", "msh")
        self.assertEqual(self.files(), before)

    def test_an_older_mesh_is_replaced_only_by_a_whole_one(self):
        mesh = self.folder / "a.msh"
        mesh.write_text("old")
        self.expect(3, "mesh", self.folder / "none.step", "-o", mesh)
        self.assertEqual(mesh.read_text(), "old")
        self.expect(0, "mesh", BODIES / "box.step", "-o", mesh)
        self.assertNotEqual(mesh.read_bytes()[:3], b"old")
        self.assertEqual(self.files(), ["a.msh"])


class InfoAndPicture(CommandLineTest):
    def test_info(self):
        text = self.expect(0, "info", BODIES / "plate.step").stdout
        self.assertIn("cylinder", text)
        self.assertIsInstance(json.loads(self.expect(0, "info", BODIES / "plate.step", "--json").stdout), dict)

    def test_picture(self):
        mesh, _ = self.mesh_plate()
        picture = self.folder / "a.png"
        for extra in ([], ["--cut", "x=0.5"], ["--size", "200x100", "--cut", "z=0.3"]):
            self.expect(0, "picture", mesh, "-o", picture, *extra)
            self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
            picture.unlink()
        self.expect(3, "picture", mesh, "-o", self.folder / "no/a.png")


class Renamed(CommandLineTest):
    def test_a_program_by_another_name_still_reads_in_a_helper(self):
        other = self.folder / "mesher"
        other.write_bytes(pathlib.Path(PROGRAM).read_bytes())
        other.chmod(0o755)
        mesh = self.folder / "plate.msh"
        command = [other, "mesh", BODIES / "plate.step", "-o", mesh, "-v"]
        result = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("in this process", result.stderr)


class InvalidMeshes(CommandLineTest):
    def test_check_finds_an_inverted_tet(self):
        mesh, _ = self.mesh_plate("--format", "msh22")
        lines = mesh.read_text().split("\n")
        at = next(i for i, line in enumerate(lines) if line.split()[1:3] == ["4", "2"])
        words = lines[at].split()
        words[-1], words[-2] = words[-2], words[-1]
        lines[at] = " ".join(words)
        mesh.write_text("\n".join(lines))
        result = self.expect(5, "check", mesh)
        self.assertIn("NOT VALID", result.stdout)
        self.assertFalse(json.loads(self.expect(5, "check", mesh, "--json").stdout)["valid"])

    def test_check_finds_the_wrong_body(self):
        mesh, _ = self.mesh_plate()
        self.expect(5, "check", mesh, BODIES / "ball.brep")


class Stopping(CommandLineTest):
    # The bore at this size takes minutes, so that there is something to stop.
    LONG = ["--size", "0.1"]

    def start(self, *arguments, **options):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], text=True, **options)

    def test_interrupt_while_meshing(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(signal=number):
                report = self.folder / "r.json"
                program = self.start("mesh", BODIES / "plate.step", "-o", self.folder / "a.msh", "--report", report,
                                     *self.LONG, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                for line in program.stderr:
                    if "load" not in line:
                        break
                time.sleep(0.3)
                begin = time.monotonic()
                program.send_signal(number)
                _, said = program.communicate(timeout=PATIENCE)
                took = time.monotonic() - begin
                self.assertEqual(program.returncode, 4, said)
                # A second is what is promised; the rest is for machines that are busy with other tests.
                self.assertLess(took, 3)
                self.assertEqual(json.loads(report.read_text())["errors"][0]["code"], "cancelled")
                self.assertEqual(self.files(), ["r.json"])
                report.unlink()

    def test_interrupt_while_reading(self):
        program = self.start("mesh", BODIES / "plate.step", "-o", self.folder / "a.msh", *self.LONG,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        program.stderr.readline()
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=PATIENCE)
        self.assertEqual(program.returncode, 4, said)
        self.assertEqual(self.files(), [])

    def test_time_limit(self):
        begin = time.monotonic()
        report = self.folder / "r.json"
        self.expect(4, "mesh", BODIES / "plate.step", "-o", self.folder / "a.msh", "--time-limit", "2", "--report", report,
                    *self.LONG)
        self.assertLess(time.monotonic() - begin, 10)
        self.assertEqual(json.loads(report.read_text())["errors"][0]["code"], "time_limit")
        self.assertEqual(self.files(), ["r.json"])

    def test_memory_limit(self):
        report = self.folder / "r.json"
        self.expect(4, "mesh", BODIES / "plate.step", "-o", self.folder / "a.msh", "--memory-limit", "64M", "--report",
                    report, "--size", "0.2")
        self.assertEqual(json.loads(report.read_text())["errors"][0]["code"], "memory_limit")
        self.assertEqual(self.files(), ["r.json"])

    def test_progress_bar_on_a_terminal(self):
        ours, theirs = pty.openpty()
        program = self.start("mesh", BODIES / "box.step", "-o", self.folder / "a.msh", stdout=subprocess.DEVNULL,
                             stderr=theirs)
        os.close(theirs)
        shown = b""
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:  # the other end is closed
                break
            if not part:
                break
            shown += part
        os.close(ours)
        self.assertEqual(program.wait(timeout=PATIENCE), 0)
        self.assertIn(b"\r[#", shown)
        self.assertTrue(shown.endswith(b"\r\x1b[K"), shown[-80:])


class Assemblies(CommandLineTest):
    def mesh_and_check(self, body, *options):
        mesh, report = self.folder / "out.msh", self.folder / "report.json"
        self.expect(0, "mesh", BODIES / body, "-o", mesh, "--report", report, "--size", "3", *options)
        checked = json.loads(self.expect(0, "check", "--json", mesh, BODIES / body, *options).stdout)
        return json.loads(report.read_text()), checked

    def test_solids_that_touch_share_the_place(self):
        for mode in ([], ["--conformal", "auto"], ["--conformal", "strict"]):
            report, _ = self.mesh_and_check("touching.brep", *mode)
            notes = report["input"]["healing"]
            self.assertTrue(any("coincides" in note or "split" in note for note in notes), notes)

    def test_faces_of_no_solid_are_left_out_with_a_warning(self):
        report, _ = self.mesh_and_check("leftover.brep")
        left_out = [warning for warning in report["warnings"] if "left out" in warning]
        self.assertEqual(left_out, ["file: 5 faces that belong to no solid are left out"])
        said = self.expect(0, "mesh", BODIES / "leftover.brep", "-o", self.folder / "out.msh", "--size", "3").stdout
        self.assertIn(left_out[0], said)

    def test_apart_each_has_nodes_of_its_own(self):
        joined, _ = self.mesh_and_check("touching.brep")
        apart, checked = self.mesh_and_check("touching.brep", "--conformal", "off")
        self.assertEqual(apart["options"]["conformal"], "off")
        self.assertEqual([face["face"] for face in apart["faces"]], list(range(1, 19)))
        self.assertEqual([solid["solid"] for solid in apart["solids"]], [1, 2, 3])
        self.assertGreater(apart["counts"]["triangles"], joined["counts"]["triangles"])
        for solid, volume in zip(checked["solids"], (1000, 512, 125)):
            self.assertAlmostEqual(solid["volume"], volume, delta=1e-6 * volume)

    def test_solids_that_overlap_are_refused_split_or_meshed_apart(self):
        body, mesh = BODIES / "overlapping.brep", self.folder / "out.msh"
        refused = self.expect(3, "mesh", body, "-o", mesh).stderr
        for word in ("overlapping_solids", "solid 1", "solid 2", "192"):
            self.assertIn(word, refused)
        split, checked = self.mesh_and_check("overlapping.brep", "--overlaps", "split")
        self.assertEqual(len(split["solids"]), 4)
        self.assertAlmostEqual(sum(solid["volume"] for solid in checked["solids"]), 1000 + 512 - 192 + 125, delta=1e-3)
        _, checked = self.mesh_and_check("overlapping.brep", "--conformal", "off")
        self.assertAlmostEqual(sum(solid["volume"] for solid in checked["solids"]), 1000 + 512 + 125, delta=1e-3)

    def test_a_mesh_apart_is_not_one_that_is_conformal(self):
        mesh = self.folder / "out.msh"
        self.expect(0, "mesh", BODIES / "overlapping.brep", "-o", mesh, "--conformal", "off")
        self.expect(5, "check", mesh)
        self.expect(5, "check", mesh, BODIES / "overlapping.brep", "--overlaps", "split")
        self.expect(0, "check", mesh, "--conformal", "off")

    def test_sizes_of_a_part_and_contradictions(self):
        mesh, report = self.folder / "out.msh", self.folder / "report.json"
        arguments = ["mesh", BODIES / "overlapping.brep", "-o", mesh, "--report", report, "--size", "4"]
        self.expect(0, *arguments, "--conformal", "off", "--solid-size", "2=1")
        faces = json.loads(report.read_text())["faces"]
        self.assertGreater(min(face["triangles"] for face in faces[6:12]), 64)
        self.assertLess(max(face["triangles"] for face in faces[:6]), 64)
        self.expect(2, *arguments, "--conformal", "off", "--overlaps", "split")
        self.expect(2, *arguments, "--conformal", "off", "--solid-size", "nobody=1")
        self.expect(2, *arguments, "--conformal", "perhaps")

    def test_same_bytes_for_any_number_of_threads(self):
        meshes = [self.folder / f"{threads}.msh" for threads in (1, 2)]
        for threads, mesh in zip((1, 2), meshes):
            self.expect(0, "mesh", BODIES / "overlapping.brep", "-o", mesh, "--conformal", "off", "--threads", threads)
        self.assertEqual(*(mesh.read_bytes() for mesh in meshes))


class Details(CommandLineTest):
    def test_what_is_suppressed_is_told_and_checked_so(self):
        body, mesh, report = BODIES / "pricked.step", self.folder / "out.msh", self.folder / "report.json"
        faces = json.loads(self.expect(0, "info", "--json", body).stdout)["faces"]
        self.assertEqual(len(faces), 8)
        bore = sorted(face["id"] for face in faces if face["area"] < 1)
        # The same length, in the units of the output.
        for option in (["--min-feature", "0.5"], ["--unit", "cm", "--min-feature", "0.05"]):
            done = self.expect(0, "mesh", body, "-o", mesh, "--report", report, *option)
            self.assertRegex(done.stdout, rf"suppressed +2 details below {option[-1]} .*: faces {bore[0]}, {bore[1]}")
            document = json.loads(report.read_text())
            self.assertEqual([(detail["kind"], detail["id"]) for detail in document["suppressed"]],
                             [("face", face) for face in bore])
            self.assertEqual(sorted([face["face"] for face in document["faces"]] + bore), list(range(1, 9)))
            checked = self.expect(0, "check", "--json", mesh, body, "--min-feature", option[-1]).stdout
            volume = json.loads(checked)["solids"][0]["volume"]
            self.assertAlmostEqual(volume, 6000 if option[0] == "--min-feature" else 6, delta=1e-9 * volume)
            self.expect(5, "check", mesh, body)

    def test_info_lists_it(self):
        body = BODIES / "pricked.step"
        self.assertNotIn("suppressed: ", self.expect(0, "info", body).stdout)
        text = self.expect(0, "info", body, "--min-feature", "0.5").stdout
        self.assertEqual(len(re.findall(r"^suppressed: face \d+.* width 0\.\d+ at \(5, 10, 2.*\)$", text, re.M)), 2, text)
        details = json.loads(self.expect(0, "info", "--json", body, "--min-feature", "0.5").stdout)["suppressed"]
        self.assertEqual(len(details), 2)

    def test_nothing_to_suppress_changes_nothing(self):
        meshes = [self.folder / name for name in ("plain.msh", "asked.msh")]
        for mesh, option in zip(meshes, ([], ["--min-feature", "0.05"])):
            self.expect(0, "mesh", BODIES / "pricked.step", "-o", mesh, *option)
        self.assertEqual(*(mesh.read_bytes() for mesh in meshes))


class Dossiers(CommandLineTest):
    ALL = ["faces.brep", "replay.bin", "report.json", "spot.vtu", "summary.txt"]

    def setUp(self):
        super().setUp()
        self.mesh, self.dossier = self.folder / "out.msh", self.folder / "why not"

    def fail_to_mesh(self, *arguments, **options):
        return self.expect(3, "mesh", BODIES / "crossed.brep", "-o", self.mesh, "--dossier", self.dossier, *arguments,
                           **options)

    def kept(self, folder=None):
        return sorted(path.name for path in (folder or self.dossier).iterdir())

    def test_what_fails_is_told_shown_and_repeated(self):
        report = self.folder / "report.json"
        said = self.fail_to_mesh("--report", report)
        self.assertIn(str(self.dossier), said.stderr)
        self.assertFalse(self.mesh.exists())
        self.assertEqual(self.kept(), self.ALL)
        error = json.loads(report.read_text())["errors"][0]
        self.assertEqual(json.loads((self.dossier / "report.json").read_text())["errors"][0], error)
        summary = (self.dossier / "summary.txt").read_text()
        for text in (error["message"], *error["entities"], "crossed.brep"):
            self.assertIn(text, summary)
        command = re.search(r"^  curvetet (replay .*)$", summary, re.MULTILINE).group(1)
        again = self.expect(3, *shlex.split(command))
        self.assertIn("the failure recurs", again.stdout)
        self.assertIn(error["message"], again.stderr)

    def test_a_replay_needs_neither_the_body_nor_its_dossier(self):
        body = self.folder / "body.brep"
        body.write_bytes((BODIES / "crossed.brep").read_bytes())
        self.expect(3, "mesh", body, "-o", self.mesh, "--dossier", self.dossier, "--no-isolate")
        body.unlink()
        second = self.folder / "second"
        first = self.expect(3, "replay", self.dossier / "replay.bin", "--dossier", second)
        self.assertEqual(self.kept(second), self.ALL)
        self.assertEqual(self.expect(3, "replay", second / "replay.bin").stdout, first.stdout)

    def test_a_replay_with_other_options(self):
        box = BODIES / "box.step"
        self.expect(4, "mesh", box, "-o", self.mesh, "--size", "D/700", "--time-limit", "5", "--dossier", self.dossier)
        said = self.expect(0, "replay", self.dossier / "replay.bin", "--size", "D/5", "-o", self.mesh)
        self.assertIn("does not recur", said.stdout)
        self.expect(0, "check", self.mesh, box)

    def test_nothing_is_left_of_what_succeeds(self):
        self.expect(0, "mesh", BODIES / "box.step", "-o", self.mesh, "--dossier", self.dossier)
        self.assertEqual(self.files(), ["out.msh"])

    def test_a_body_that_cannot_be_read(self):
        self.expect(3, "mesh", BODIES / "open.brep", "-o", self.mesh, "--dossier", self.dossier)
        self.assertEqual(self.kept(), ["faces.brep", "report.json", "summary.txt"])
        self.assertIn("replay.bin", (self.dossier / "summary.txt").read_text())

    def test_files_that_are_no_states(self):
        self.fail_to_mesh()
        state, whole = self.folder / "state.bin", (self.dossier / "replay.bin").read_bytes()
        for damaged in (b"", whole[:20], whole[:-1], whole[:200] + b"?" + whole[201:], whole + b"."):
            state.write_bytes(damaged)
            self.expect(3, "replay", state)
        self.expect(3, "replay", BODIES / "box.step")
        self.expect(3, "replay", self.folder / "missing.bin")
        self.expect(3, "replay", self.folder)

    def test_a_place_that_cannot_be_written_changes_no_exit_code(self):
        plain = self.expect(3, "mesh", BODIES / "crossed.brep", "-o", self.mesh)
        self.dossier.write_text("a file")
        said = self.fail_to_mesh()
        self.assertIn("warning: the dossier is not complete", said.stderr)
        self.assertIn("[output_unwritable]", said.stderr)
        self.assertEqual(plain.stderr.split("error:")[1], said.stderr.split("error:")[1])
        self.assertEqual(self.dossier.read_text(), "a file")

    def test_a_full_disk_leaves_whole_files_only(self):
        limits = lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
                          resource.setrlimit(resource.RLIMIT_FSIZE, (200, 200)))
        said = self.fail_to_mesh("--no-isolate", preexec_fn=limits)
        self.assertIn("[output_unwritable]", said.stderr)
        self.assertEqual(self.files(), [])
        limits = lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
                          resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000)))
        self.fail_to_mesh("--no-isolate", preexec_fn=limits)
        self.assertIn("summary.txt", self.kept())
        self.assertNotIn("replay.bin", self.kept())
        self.assertIn("replay.bin cannot be written", (self.dossier / "summary.txt").read_text())

    def test_each_body_of_a_batch_has_its_own(self):
        listed, out = self.folder / "list.txt", self.folder / "out"
        listed.write_text("".join(f"{BODIES / name}\n" for name in ("crossed.brep", "box.step", "open.brep")))
        self.expect(5, "batch", listed, "--out", out, "--dossier", self.dossier, "--", "--size", "D/5")
        folders = self.kept()
        self.assertEqual(len(folders), 2, folders)
        for folder, name in zip(folders, ("crossed.brep", "open.brep")):
            self.assertTrue(folder.endswith(name))
            self.assertIn(name, (self.dossier / folder / "summary.txt").read_text())
        self.assertEqual(self.kept(self.dossier / folders[0]), self.ALL)
        self.expect(2, "batch", listed, "--out", out, "--", "--dossier", self.dossier)


class Batch(CommandLineTest):
    LONG = ["--", "--size", "D/700"]  # minutes for a body

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        self.list = self.folder / "list.txt"

    def name_bodies(self, *bodies):
        self.list.write_text("# bodies\n" + "".join(f"{body}\n" for body in bodies))

    def rows(self):
        return [json.loads(line) for line in (self.out / "results.jsonl").read_text().splitlines()]

    def batch(self, code, *arguments, **options):
        return self.expect(code, "batch", self.list, "--out", self.out, *arguments, **options)

    def start(self, *arguments):
        return subprocess.Popen([PROGRAM, "batch", str(self.list), "--out", str(self.out), *map(str, arguments)],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def wait_for_rows(self, count):
        for _ in range(100 * PATIENCE):
            path = self.out / "results.jsonl"
            if path.is_file() and len(path.read_text().splitlines()) >= count:
                return
            time.sleep(0.01)
        self.fail("no results")

    def test_a_row_for_each_body_and_a_summary_by_cause(self):
        (self.folder / "empty.step").write_bytes(b"")
        self.name_bodies(BODIES / "plate.step", "empty.step", "missing.brep", BODIES / "box.step")
        said = self.batch(5, "--jobs", 2, "--", "--size", "D/5").stdout
        self.assertIn("valid 2 of 4", said)
        rows = {pathlib.Path(row["body"]).name: row for row in self.rows()}
        self.assertEqual({name: row["cause"] for name, row in rows.items()},
                         {"plate.step": "", "box.step": "", "empty.step": "empty_file", "missing.brep": "file_not_found"})
        for name, row in rows.items():
            self.assertEqual((self.out / row["mesh"]).is_file(), row["status"] == "valid", name)
            self.assertTrue((self.out / row["report"]).is_file(), name)
        for name in ("plate.step", "box.step"):
            self.assertGreater(rows[name]["tets"], 0)
            self.expect(0, "check", self.out / rows[name]["mesh"], BODIES / name)
        summary = json.loads((self.out / "summary.json").read_text())
        self.assertEqual(summary, {"bodies": 4, "done": 4, "valid": 2,
                                   "failed_by_cause": {"empty_file": 1, "file_not_found": 1}})

    def test_a_folder_is_searched(self):
        self.list = BODIES
        said = self.batch(5, "--jobs", 0, "--quiet", "--", "--size", "D/4")
        self.assertEqual(said.stderr, "")
        self.assertEqual(sorted(row["body"] for row in self.rows()),
                         sorted(str(p.relative_to(BODIES)) for p in BODIES.rglob("*")
                                if p.suffix in (".step", ".stp", ".brep", ".igs", ".iges")))

    def test_goes_on_after_it_was_killed(self):
        self.name_bodies(BODIES / "box.step", BODIES / "plate.step")
        first = self.start("--jobs", 1, *self.LONG[:1], "--size", "D/4")
        self.wait_for_rows(1)
        first.kill()
        first.communicate()
        with open(self.out / "results.jsonl", "a") as results:
            results.write('{"body": "half a li')  # as a kill may leave it
        before = self.rows_before_the_half_line()
        said = self.batch(0, "--jobs", 1, *self.LONG[:1], "--size", "D/4")
        self.assertIn("done already", said.stderr)
        self.assertEqual(self.rows()[:len(before)], before)
        self.assertEqual(sorted(row["body"] for row in self.rows()), sorted(map(str, (BODIES / "box.step", BODIES / "plate.step"))))

    def rows_before_the_half_line(self):
        return [json.loads(line) for line in (self.out / "results.jsonl").read_text().splitlines()[:-1]]

    def wait_for_program(self):
        """The process that meshes in the folder, once there is one."""
        for _ in range(100 * PATIENCE):
            if programs := self.programs():
                return programs[0]
            time.sleep(0.01)
        self.fail("no body is meshed")

    def programs(self):
        lines = {path: self.read(path) for path in pathlib.Path("/proc").glob("[0-9]*/cmdline")}
        return [int(path.parent.name) for path, line in lines.items()
                if str(self.out).encode() in line and b"mesh" in line.split(b"\0")]

    def wait_for_no_program(self):
        for _ in range(500):
            if not self.programs():
                return
            time.sleep(0.01)
        self.fail("a body is still meshed")

    def test_bodies_end_with_a_batch_that_is_killed(self):
        self.name_bodies(BODIES / "plate.step")
        first = self.start(*self.LONG)
        self.wait_for_program()
        first.kill()
        first.communicate()
        self.wait_for_no_program()

    def test_a_body_that_crashes_or_hangs_is_its_own_fault_alone(self):
        for number, cause in ((signal.SIGSEGV, "killed by signal 11"), (signal.SIGSTOP, "did not end in time")):
            with self.subTest(signal=number):
                self.list.write_text(f"{BODIES / 'plate.step'}\t--size\tD/700\n{BODIES / 'box.step'}\n")
                batch = self.start("--restart", "--time-limit", 2)
                os.kill(self.wait_for_program(), number)
                said, _ = batch.communicate(timeout=PATIENCE)
                self.assertEqual(batch.returncode, 5)
                self.assertIn("valid 1 of 2", said)
                self.assertIn(cause, self.rows()[0]["cause"])
                self.assertEqual(self.rows()[1]["status"], "valid")
                self.assertEqual(self.programs(), [])

    def test_jobs_share_the_cores(self):
        self.name_bodies(BODIES / "plate.step")
        cores = len(os.sched_getaffinity(0))
        for jobs, options, threads in ((1, [], cores), (cores, [], 1), (4096, [], 1), (4096, ["--threads", 2], 2)):
            with self.subTest(jobs=jobs, options=options):
                batch = self.start("--restart", "--jobs", jobs, *self.LONG, *options)
                words = self.read(pathlib.Path(f"/proc/{self.wait_for_program()}/cmdline")).split(b"\0")
                batch.kill()
                batch.communicate()
                self.assertEqual([b for a, b in zip(words, words[1:]) if a == b"--threads"], [str(threads).encode()])
                self.wait_for_no_program()

    def test_options_of_one_body(self):
        self.list.write_text("".join(f"{BODIES / 'box.step'}\t--size\tD/{n}\n" for n in (2, 6)))
        self.batch(0)
        rows = self.rows()
        self.assertEqual([row["options"] for row in rows], [["--size", "D/2"], ["--size", "D/6"]])
        self.assertLess(rows[0]["tets"], rows[1]["tets"])
        self.assertNotEqual(rows[0]["mesh"], rows[1]["mesh"])
        self.list.write_text(f"{BODIES / 'box.step'}\t--size\tD/6\n{BODIES / 'box.step'}\t--size\tD/3\n")
        said = self.batch(0)
        self.assertIn("1 of 2 bodies are done already", said.stderr)
        self.assertIn("valid 2 of 2", said.stdout)  # what is no longer listed does not count
        self.list.write_text(f"{BODIES / 'box.step'}\t--weave\n")
        self.batch(2)

    @staticmethod
    def read(path):
        try:
            return path.read_bytes()
        except OSError:
            return b""

    def test_interrupt_keeps_what_is_done(self):
        self.name_bodies(BODIES / "empty.step", BODIES / "plate.step")
        program = self.start("--jobs", 1, *self.LONG)
        self.wait_for_rows(1)
        time.sleep(0.3)
        begin = time.monotonic()
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=PATIENCE)
        self.assertLess(time.monotonic() - begin, 3)
        self.assertEqual(program.returncode, 4, said)
        self.assertEqual(len(self.rows()), 1)
        self.assertEqual([p.name for p in self.out.iterdir() if "plate" in p.name], [])

    def test_time_limit_of_a_body(self):
        self.name_bodies(BODIES / "plate.step")
        self.batch(5, "--time-limit", 1, *self.LONG)
        self.assertEqual(self.rows()[0]["cause"], "time_limit")

    def test_one_batch_at_a_time(self):
        self.name_bodies(BODIES / "plate.step")
        first = self.start(*self.LONG)
        for _ in range(1000):
            if (self.out / "results.jsonl").is_file():
                break
            time.sleep(0.01)
        self.assertIn("another batch is at work", self.batch(3, *self.LONG).stderr)
        first.send_signal(signal.SIGINT)
        first.communicate(timeout=PATIENCE)

    def test_refused_before_any_work(self):
        self.name_bodies(BODIES / "box.step")
        for wrong in (["--", "--weave"], ["--", "--size", "D/x"], ["--", "-o", "x.msh"], ["--", "--report=r.json"],
                      ["--jobs", "-1"], ["--time-limit", "0"], ["--format", "doc"]):
            with self.subTest(arguments=wrong):
                self.batch(2, *wrong)
                self.assertFalse(self.out.exists())
        (self.folder / "file").write_text("")
        self.expect(3, "batch", self.list, "--out", self.folder / "file" / "out")
        self.expect(3, "batch", self.folder / "none.txt", "--out", self.out)
        (self.folder / "hollow").mkdir()
        self.expect(3, "batch", self.folder / "hollow", "--out", self.out)

    def test_other_options_need_another_folder_or_a_restart(self):
        self.name_bodies(BODIES / "box.step")
        self.batch(0, "--", "--size", "D/2")
        self.assertIn("other options", self.batch(2, "--", "--size", "D/3").stderr)
        self.batch(0, "--restart", "--", "--size", "D/3")
        self.assertEqual(len(self.rows()), 1)

    def test_a_full_disk_stops_it_and_loses_nothing(self):
        # No file may grow beyond this: writing a mesh or a row fails as on a full disk.
        self.name_bodies(BODIES / "box.step", BODIES / "plate.step")
        limits = lambda: (signal.signal(signal.SIGXFSZ, signal.SIG_IGN),
                          resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000)))
        self.batch(3, "--", "--size", "D/3", preexec_fn=limits)
        done = self.rows()
        self.assertTrue(all(row["status"] == "valid" for row in done))
        self.batch(0, "--", "--size", "D/3")
        self.assertEqual(self.rows()[:len(done)], done)
        self.assertEqual(len(self.rows()), 2)


def main():
    global PROGRAM, BODIES
    PROGRAM = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="curvetet_bodies_") as folder:
        subprocess.run([sys.argv[2], folder], check=True, stdout=subprocess.DEVNULL)
        BODIES = pathlib.Path(folder)
        result = unittest.main(argv=[sys.argv[0], *sys.argv[3:]], exit=False).result
    sys.exit(0 if result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
