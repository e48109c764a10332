# SPDX-License-Identifier: Apache-2.0
"""The files that the pages of docs/mistakes use: a recipe for each, run when a command mentions its name.

A recipe is a function that is handed a Store and returns the bytes of the file, or None if it made the files itself:

    @fixture("empty.nrrd")
    def empty(store):
        return b""

Recipes for one page are in the file of its name, those that several pages use in shared.py."""
import importlib, pathlib, re, shutil, subprocess, threading

MODULES = ("shared", "libraries", "volumes", "surfaces", "medical", "seeds", "tracking", "cases", "meshes", "pictures", "viewer", "commands", "trust")
RECIPES = {}  # by the name of a file that they make


def fixture(*names):
    """A recipe for the files of these names; a folder's name ends with a slash."""
    def register(recipe):
        for name in names:
            assert name not in RECIPES, name
            RECIPES[name] = (recipe, names)
        return recipe
    return register


class Store:
    """The files made so far."""
    def __init__(self, folder, lumen):
        self.folder, self.program = folder, lumen
        self.folder.mkdir()
        self.lock = threading.RLock()
        for module in MODULES:
            if (pathlib.Path(__file__).parent / f"{module}.py").exists():
                importlib.import_module(module)

    def path(self, name):
        """The file or folder of that name, made if it is not there yet."""
        with self.lock:
            target = self.folder / name.rstrip("/")
            recipe, _ = RECIPES[name]
            if not target.exists():
                made = recipe(self)
                if made is not None:
                    target.write_bytes(made)
            return target

    def bytes(self, name):
        """Bytes of the file of that name."""
        return self.path(name).read_bytes()

    def text(self, name):
        """Text of the file of that name."""
        return self.bytes(name).decode()

    def lumen(self, *arguments):
        """Runs lumen among the files."""
        subprocess.run([self.program, *arguments, "--quiet"], cwd=self.folder, check=True)

    def copy(self, commands, folder):
        """Puts the files that the commands mention into a folder."""
        words = set(re.findall(r"[\w.-]+/?", commands))
        for name in sorted(words | {word + "/" for word in words}):
            if name not in RECIPES:
                continue
            source, target = self.path(name), folder / name.rstrip("/")
            if not target.exists():
                shutil.copytree(source, target) if source.is_dir() else shutil.copy(source, target)
