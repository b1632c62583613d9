"""pip takes the folder that CMake has built, without a network; machines are known by name there.

SWARF_PYTHON_FOLDER names that folder."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import jobs

READ = """
import sys, swarf
assert swarf.__file__.startswith(sys.prefix), swarf.__file__
print(swarf.__version__, swarf.run({scene!r}).verdict)
"""


class Pip(unittest.TestCase):
    def test_installs_it(self):
        with tempfile.TemporaryDirectory() as folder:
            env = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
            run = lambda *words: subprocess.run(words, cwd=folder, env=env, capture_output=True, text=True)
            # With the system's packages: setuptools, wheel and NumPy.
            made = run(sys.executable, "-m", "venv", "--system-site-packages", "venv")
            self.assertEqual(made.returncode, 0, made.stderr)
            python = str(pathlib.Path(folder, "venv/bin/python"))
            done = run(python, "-m", "pip", "install", "--no-index", "--no-build-isolation", "--no-deps",
                       os.environ["SWARF_PYTHON_FOLDER"])
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            scene = jobs.pocket_scene(jobs.write_pocket(folder))
            used = run(python, "-c", READ.format(scene=scene))
            self.assertEqual(used.returncode, 0, used.stderr)
            self.assertRegex(used.stdout, r"^\d+\.\d+\.\d+ pass\n$")


if __name__ == "__main__":
    unittest.main()
