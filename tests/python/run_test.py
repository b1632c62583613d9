"""The Python module against closed forms and against the shipped program.

SWARF_PROGRAM names the program."""
import csv
import json
import os
import pathlib
import re
import signal
import struct
import subprocess
import tempfile
import threading
import time
import unittest

import numpy

import swarf
from jobs import POCKET, POCKET_MM3, pocket_scene, write_pocket

#: What differs from run to run.
TIMES = {"tick_ns_median", "tick_ns_p999", "seconds", "blocks_per_s", "memory_peak_mb", "memory_predicted_mb", "scene"}


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in TIMES}
    return [without_times(v) for v in value] if isinstance(value, list) else value


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = pocket_scene(write_pocket(self.folder))


class Pocket(InAFolder):
    def test_is_as_deep_as_programmed(self):
        result = swarf.run(self.scene)
        self.assertEqual(result.verdict, "pass", result.verdict_text)
        self.assertEqual(result.findings, [])
        self.assertAlmostEqual(result.metrics["stock"]["volume_removed_mm3"], POCKET_MM3, delta=0.005 * POCKET_MM3)
        rays = result.rays
        self.assertGreater(len(rays["deviation_um"]), 1000)
        self.assertLess(numpy.abs(rays["deviation_um"]).max(), 1e-3)
        numpy.testing.assert_allclose(rays["point_mm"][:, 2], -2.0, atol=1e-12)
        numpy.testing.assert_allclose(rays["normal"], numpy.tile([0.0, 0.0, 1.0], (len(rays["normal"]), 1)), atol=1e-12)
        self.assertAlmostEqual(rays["area_mm2"].sum(), 16 * 6, places=6)
        self.assertLessEqual(set(rays["line"]), {6, 7, 8, 9, 10})
        # Line 4 leads from the machine's home.
        at = result.blocks["line"] >= 5
        blocks = {name: values[at] for name, values in result.blocks.items()}
        self.assertEqual(list(blocks["line"]), [5, 6, 7, 8, 9, 10, 11])
        numpy.testing.assert_allclose(blocks["tip_x_mm"], [3, 3, 17, 17, 3, 3, 3], atol=1e-9)
        numpy.testing.assert_allclose(blocks["tip_z_mm"], [5, -2, -2, -2, -2, -2, 20], atol=1e-9)
        self.assertEqual(list(blocks["kind"]), ["rapid"] + 5 * ["cut"] + ["rapid"])
        self.assertAlmostEqual(blocks["feed_mm_min"][2], 900, places=6)

    def test_gives_the_numbers_of_the_program(self):
        ours = swarf.run(self.scene)
        file = self.folder / "scene.toml"
        file.write_text(swarf.toml_text(self.scene))
        done = subprocess.run([os.environ["SWARF_PROGRAM"], "run", file, "--no-render", "-o", self.folder / "out"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        theirs = json.loads((self.folder / "out/metrics.json").read_text())
        self.assertEqual(without_times(ours.metrics), without_times(theirs))
        with open(self.folder / "out/blocks.csv") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(list(rows[0]), list(ours.blocks))
        for name, values in ours.blocks.items():
            told = [row[name] for row in rows]
            if values.dtype.kind == "U":
                self.assertEqual(told, list(values))
            else:
                told = numpy.array([float(text) if text else numpy.nan for text in told])
                numpy.testing.assert_allclose(values, told, atol=1e-4 if name == "feed_mm_min" else 1e-6, err_msg=name)

    def test_runs_twice_to_the_same_bits(self):
        first, second, alone = swarf.run(self.scene), swarf.run(self.scene), swarf.run(self.scene, threads=1)
        for other in (second, alone):
            self.assertEqual(first.metrics["stock"]["hash"], other.metrics["stock"]["hash"])
            self.assertEqual(first.rays["deviation_um"].tobytes(), other.rays["deviation_um"].tobytes())

    def test_keys_are_replaced(self):
        coarse = swarf.run(self.scene, stock={"voxel_mm": 0.5})
        also = swarf.run(self.scene, **{"stock.voxel_mm": numpy.float64(0.5)})
        self.assertEqual(coarse.metrics["stock"]["voxel_mm"], 0.5)
        self.assertEqual(coarse.metrics["stock"]["hash"], also.metrics["stock"]["hash"])

    def test_a_gouge_is_a_finding_with_its_line(self):
        write_pocket(self.folder, POCKET.replace("\nX3\nY3", "\nX3 Z-2.05\nY3 Z-2"))
        result = swarf.run(self.scene)
        self.assertEqual(result.verdict, "findings")
        gouges = [finding for finding in result.findings if finding.code == "gouge"]
        self.assertTrue({finding.line for finding in gouges} <= {9, 10} and gouges, result.findings)
        self.assertEqual(gouges[0].severity, "error")
        self.assertTrue(gouges[0].file.endswith("pocket.ngc"))
        # The path falls by 50 um over 14 mm; the design ends 1 mm before, and the flat end's radius leads.
        self.assertAlmostEqual(result.rays["deviation_um"].min(), -50.0, delta=0.1)

    def test_without_a_design_no_ray_is_measured(self):
        self.scene["design"] = {"kind": "none"}
        self.assertEqual(swarf.run(self.scene).rays["deviation_um"].shape, (0,))


class WrongInput(InAFolder):
    def test_an_unknown_key_is_named_with_its_place(self):
        self.scene["stock"]["voxle_mm"] = 0.25
        with self.assertRaises(swarf.Error) as raised:
            swarf.run(self.scene)
        self.assertRegex(str(raised.exception), r"^scene:7:\d+: error: nothing is called 'stock.voxle_mm'")
        self.assertIn("voxel_mm", raised.exception.diagnostics[0]["fix"])
        self.assertEqual(swarf.toml_text(self.scene).splitlines()[6][:5], "stock")

    def test_a_wrong_block_is_named_with_its_place(self):
        program = write_pocket(self.folder, POCKET.replace("X17 F900", "X17 F900 Q%"))
        with self.assertRaisesRegex(swarf.Error, re.escape(f"{program}:7:11: error:")) as raised:
            swarf.run(self.scene)
        self.assertEqual(raised.exception.diagnostics[0]["line"], 7)

    def test_a_program_is_no_scene(self):
        with self.assertRaisesRegex(swarf.Error, "this is no scene.toml"):
            swarf.run(self.folder / "pocket.ngc")

    def test_a_value_that_no_scene_holds(self):
        with self.assertRaisesRegex(TypeError, "holds no set"):
            swarf.run({**self.scene, "title": {1}})

    def test_texts_come_through(self):
        self.scene["title"] = 'a "pocket"\\ \x7f\t\u00e9 \U0001f529'
        report = self.folder / "out"
        swarf.run(self.scene, report, render=False)
        command = json.loads((report / "run.json").read_text())["command"]
        self.assertTrue(command.startswith("python3 -c "), command)
        import tomllib
        self.assertEqual(tomllib.loads((report / "input/scene.toml").read_text())["title"], self.scene["title"])


class Progress(InAFolder):
    def test_tells_the_stages_in_order(self):
        told = []
        swarf.run(self.scene, progress=lambda *call: told.append(call))
        stages = list(dict.fromkeys(stage for stage, *_ in told))
        self.assertLess(stages.index("plan"), stages.index("cut measuring rays"))
        for stage, done, total, unit in told:
            self.assertTrue(0 <= done <= total and unit, (stage, done, total, unit))

    def test_other_threads_go_on(self):
        ticks, over = [], threading.Event()

        def tick():
            while not over.wait(0.005):
                ticks.append(time.monotonic())

        clock = threading.Thread(target=tick)
        clock.start()
        start = time.monotonic()
        swarf.run(self.scene, stock={"voxel_mm": 0.08})
        end = time.monotonic()
        over.set()
        clock.join()
        during = [t for t in ticks if start < t < end]
        self.assertGreater(len(during), (end - start) / 0.2, "the interpreter was locked")

    def test_what_it_raises_stops_the_run(self):
        def stop(stage, done, total, unit):
            raise RuntimeError("enough")

        with self.assertRaisesRegex(RuntimeError, "enough"):
            swarf.run(self.scene, self.folder / "out", stop)
        self.assertFalse((self.folder / "out").exists())


class Interrupt(InAFolder):
    def test_keeps_the_earlier_result_and_nothing_half(self):
        out = self.folder / "out"
        swarf.run(self.scene, out, render=False)
        before = (out / "metrics.json").read_bytes()
        beside = sorted(self.folder.iterdir())

        def interrupt(stage, done, total, unit):
            if stage == "cut measuring rays":
                signal.raise_signal(signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            swarf.run(self.scene, out, interrupt, render=False, stock={"voxel_mm": 0.5})
        self.assertEqual((out / "metrics.json").read_bytes(), before)
        self.assertEqual(sorted(self.folder.iterdir()), beside)
        self.assertEqual(swarf.run(self.scene).verdict, "pass")

    def test_comes_from_outside(self):
        # Enough rows that the cut alone would take far longer than the time until the signal.
        rows = "".join(f"X{17 if i % 2 else 3} Y{3 + i % 7 * 0.5:.1f} Z{-1 - i % 50 * 0.02:.2f}\n" for i in range(60000))
        write_pocket(self.folder, POCKET.replace("Y7\n", rows + "Y7\n"))
        timer = threading.Timer(0.7, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        start = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            swarf.run(self.scene, self.folder / "out", stock={"voxel_mm": 0.06})
        self.assertFalse((self.folder / "out").exists())
        self.assertLess(time.monotonic() - start, 20)


class Pictures(InAFolder):
    def test_are_png_of_the_size_asked_for(self):
        result = swarf.run(self.scene)
        for kind in ("part", "deviation", "machine"):
            picture = result.picture(kind, size=(320, 240), samples=1)
            self.assertEqual(picture._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(struct.unpack(">II", picture.png[16:24]), (320, 240), kind)
        self.assertNotEqual(result.picture("part", "top", (320, 240), 1).png, result.picture("part", "iso", (320, 240), 1).png)
        picture.save(self.folder / "machine.png")
        self.assertEqual((self.folder / "machine.png").read_bytes(), picture.png)
        with self.assertRaises(swarf.Error):
            result.picture("fish")


class Folder(InAFolder):
    def test_has_the_files_of_the_program(self):
        out = self.folder / "out"
        result = swarf.run(self.scene, out, movie={"seconds": 0}, stills={"size": [320, 240], "samples": 1})
        files = {file.name for file in out.iterdir()}
        self.assertLessEqual({"report.html", "metrics.json", "findings.json", "blocks.csv", "stock.vdb", "still_part.png",
                              "part.glb", "machine.glb", "run.json"}, files)
        told = json.loads((out / "metrics.json").read_text())
        self.assertEqual(without_times(told), without_times(result.metrics))
        again = subprocess.run([os.environ["SWARF_PROGRAM"], "export", out, "--stl", self.folder / "part.stl"],
                               capture_output=True, text=True)
        self.assertEqual(again.returncode, 0, again.stderr)


if __name__ == "__main__":
    unittest.main()
