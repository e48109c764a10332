# SPDX-License-Identifier: Apache-2.0
"""Runs the example's notebook: by a kernel where nbclient is installed, else cell by cell in this process."""
import asyncio
import contextlib
import io
import json
import os
import pathlib
import tempfile
import unittest

NOTEBOOK = pathlib.Path(__file__).resolve().parent.parent / "examples/volume_to_simulator.ipynb"


def run_by_kernel(document):
    """The outputs of all cells, as Jupyter makes them."""
    import nbclient
    import nbformat
    notebook = nbformat.reads(json.dumps(document), as_version=4)
    with contextlib.closing(asyncio.new_event_loop()) as loop:
        asyncio.set_event_loop(loop)
        nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    return [output for cell in notebook.cells for output in cell.get("outputs", ())]


def run_cells(document):
    """The printed texts of all cells."""
    names = {}
    with contextlib.redirect_stdout(io.StringIO()) as out:
        for cell in document["cells"]:
            if cell["cell_type"] == "code":
                exec("".join(cell["source"]), names)  # pylint: disable=exec-used
    return out.getvalue()


class NotebookTest(unittest.TestCase):
    def setUp(self):
        self.document = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        before = os.environ.get("TMPDIR")
        self.addCleanup(lambda: os.environ.update(TMPDIR=before) if before else os.environ.pop("TMPDIR"))
        os.environ["TMPDIR"] = folder.name
        os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # the kernel's debugger prints advice
        tempfile.tempdir = None
        self.addCleanup(setattr, tempfile, "tempdir", None)

    def test_it_is_kept_without_outputs(self):
        for cell in self.document["cells"]:
            self.assertFalse(cell.get("outputs"))

    def test_it_goes_from_a_volume_to_a_folder_for_sofa(self):
        try:
            import ipykernel  # noqa: F401  pylint: disable=unused-import
            import nbclient  # noqa: F401  pylint: disable=unused-import
        except ImportError:
            self.assertIn("lumen-export.json", run_cells(self.document))
            return
        outputs = run_by_kernel(self.document)
        printed = "".join(output.get("text", "") for output in outputs)
        self.assertIn("lumen-export.json", printed)
        pictures = [o["data"]["image/png"] for o in outputs if "image/png" in o.get("data", {})]
        self.assertEqual(len(pictures), 2)
        if folder := os.environ.get("LUMEN_PICTURES"):
            import base64
            for number, picture in enumerate(pictures):
                pathlib.Path(folder, f"notebook-{number}.png").write_bytes(base64.b64decode(picture))


if __name__ == "__main__":
    unittest.main()
