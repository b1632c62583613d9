"""The notebooks of cli/python/examples: their code runs from top to bottom, and they keep no outputs.

SWARF_SOURCE names the folder of the sources."""
import contextlib
import io
import json
import os
import pathlib
import tempfile
import unittest

EXAMPLES = pathlib.Path(os.environ["SWARF_SOURCE"]) / "cli/python/examples"


def code_cells(file):
    notebook = json.loads(file.read_text())
    return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]


class Notebooks(unittest.TestCase):
    def test_there_are_two(self):
        self.assertEqual(len(list(EXAMPLES.glob("*.ipynb"))), 2)

    def test_have_no_outputs(self):
        for file in EXAMPLES.glob("*.ipynb"):
            for cell in code_cells(file):
                self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), file)

    def test_run(self):
        """Each checks its own answer with assert."""
        for file in sorted(EXAMPLES.glob("*.ipynb")):
            with self.subTest(file=file.name), tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
                names, said = {}, io.StringIO()
                sources = ["".join(cell["source"]) for cell in code_cells(file)]
                self.assertTrue(any("assert " in source for source in sources))
                with contextlib.redirect_stdout(said):
                    for number, source in enumerate(sources):
                        exec(compile(source, f"{file.name} cell {number + 1}", "exec"), names)
                self.assertTrue(said.getvalue())


if __name__ == "__main__":
    unittest.main()
