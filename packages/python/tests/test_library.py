# SPDX-License-Identifier: Apache-2.0
"""Libraries by commands of the engine: their rows are made in the process of Python."""
import pathlib
import tempfile
import unittest

import lumen


class LibraryTest(unittest.TestCase):
    def test_a_list_becomes_a_library(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            nodes = [f"{i + 1} 0 {i} 0 0 1.5 {i if i else -1}\n" for i in range(21)]
            (folder / "tree.swc").write_text("# synthetic; mm, LPS\n" + "".join(nodes))
            (folder / "none.swc").write_text("no numbers\n")
            (folder / "list.csv").write_text("input,id,title,synthetic\ntree.swc,tree,Tree,yes\n"
                                             "none.swc,none,None,yes\n")
            lumen.run("library init", folder / "library", title="Trees", licence="CC0-1.0")
            with self.assertWarnsRegex(lumen.Warning, "none.swc"):
                answer = lumen.run("library build", folder / "list.csv", folder / "library",
                                   jobs=2, work=folder / "work")
            self.assertEqual([row["end"] for row in answer["rows"]], ["made", "failed"])
            self.assertEqual(answer["rows"][1]["code"], 3)
            self.assertIn("none.swc", answer["rows"][1]["why"])
            self.assertIn("none.swc", (folder / "work/logs/none.log").read_text())
            listed = lumen.run("library list", folder / "library")
            self.assertEqual([case["id"] for case in listed["cases"]], ["tree"])

    def test_an_address_is_no_file(self):
        with self.assertRaisesRegex(lumen.Error, "lumen reads files") as raised:
            lumen.run("info", "https://me:word@example.org/head.nrrd")
        self.assertNotIn("word", str(raised.exception))
        with self.assertRaisesRegex(lumen.Error, "lumen reads files"):
            lumen.Volume.read("https://example.org/head.nrrd")


if __name__ == "__main__":
    unittest.main()
