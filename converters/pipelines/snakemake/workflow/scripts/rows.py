# SPDX-License-Identifier: Apache-2.0
"""Rows of a list of `lumen library build`, and what each job needs to know of them."""
import csv
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

# Memory and time by voxels, measured: docs/cohorts.md, "Memory and time of a row". One step of a row
# needs less than the whole row.
BASE_MEGABYTES, BYTES_PER_VOXEL = 500, 16
BASE_MINUTES, MICROSECONDS_PER_VOXEL = 10, 6
OWN = ("input", "volume", "seeds", "id", "targets")
ID = re.compile(r"[a-z0-9][a-z0-9-]{0,63}$")


def digest(file):
    found = hashlib.sha256()
    with open(file, "rb") as data:
        for block in iter(lambda: data.read(1 << 20), b""):
            found.update(block)
    return found.hexdigest()


def refuse(message):
    sys.exit(f"lumen: error: {message}")


class Digests:
    """Known digests of files, which are read again only where size, time or inode is another."""

    def __init__(self, file):
        self.file = pathlib.Path(file)
        try:
            self.known = json.loads(self.file.read_text())
        except (OSError, ValueError):
            self.known = {}
        self.before = json.dumps(self.known)

    def of(self, path):
        path = pathlib.Path(path)
        if path.is_dir():
            inside = sorted(p for p in path.rglob("*") if p.is_file())
            return hashlib.sha256(json.dumps([[p.relative_to(path).as_posix(), self.of(p)]
                                              for p in inside]).encode()).hexdigest()
        state = path.stat()
        stamp = [state.st_size, state.st_mtime_ns, state.st_ino]
        known = self.known.get(str(path))
        if known is None or known[:3] != stamp:
            known = self.known[str(path)] = [*stamp, digest(path)]
        return known[3]

    def keep(self):
        text = json.dumps(self.known)
        if text == self.before:
            return
        self.file.parent.mkdir(parents=True, exist_ok=True)
        new = self.file.with_name(f"{self.file.name}.{os.getpid()}")
        new.write_text(text)
        os.replace(new, self.file)


class Rows:
    """The list, by ids."""

    def __init__(self, config):
        self.config = config
        self.lumen = config["lumen"]
        self.folder = str(config["work"]).rstrip("/")
        self.threads, self.retries = int(config["threads"]), int(config["retries"])
        self.list = pathlib.Path(config["list"])
        self.rows = self.read()
        self.ids = list(self.rows)
        self.files = ["case.lumen", "check.json", "case.glb", "report.html",
                      *(f"export-{target}" for target in config["export"])]
        self.version = json.loads(self.ask("--version", "--json"))["version"]
        # what both take, such as --spacing, is for the volume that is tracked
        self.fit_options = self.options_of("fit") - self.options_of("track")
        self.digests = Digests(pathlib.Path(self.folder) / "digests.json")
        self.recipes = {name: self.make_recipe(name) for name in self.ids}
        for name in self.ids:
            self.voxels(name)
        self.digests.keep()

    def options_of(self, command):
        return set(re.findall(r"--([a-z][a-z-]*)", self.ask(command, "--help")))

    def ask(self, *words):
        try:
            return subprocess.run([self.lumen, *words], check=True, capture_output=True,
                                  text=True).stdout
        except FileNotFoundError:
            refuse(f"{self.lumen}: there is no such program, expected lumen; "
                   "--config lumen=PROGRAM states another")

    def read(self):
        with open(self.list, encoding="utf-8-sig", newline="") as text:
            rows = [row for row in csv.DictReader(text) if any(row.values())]
        found = {}
        for number, row in enumerate(rows, 1):
            name = row.get("id") or ""
            if not ID.match(name):
                refuse(f"{self.list}: row {number}: id: found {name!r}, expected 1 to 64 of a to "
                       "z, 0 to 9 and -")
            if name in found:
                refuse(f"{self.list}: row {number}: id: {name} is that of another row, too")
            found[name] = row
        return found

    def path(self, name, *columns):
        text = next((self.rows[name][c] for c in columns if self.rows[name].get(c)), "")
        return str(self.list.parent / text) if text else ""

    def volume(self, name):
        return self.path(name, "input", "volume")

    def options(self, name, command):
        """Options of the row that the command takes; those of fit go there, others to track."""
        words = []
        if command == "track" and self.path(name, "seeds"):
            words += ["--seeds", self.path(name, "seeds")]
        for column, value in self.rows[name].items():
            if not column.startswith("--") or not value:
                continue
            if (column[2:] in self.fit_options) == (command == "fit"):
                words += [column, value]
        return words

    def make_recipe(self, name):
        row = self.rows[name]
        files = [self.digests.of(p) for p in (self.volume(name), self.path(name, "seeds")) if p]
        options = {k: v for k, v in row.items() if k.startswith("--") and v}
        return hashlib.sha256(json.dumps([self.version, files, options],
                                         sort_keys=True).encode()).hexdigest()

    def recipe(self, name):
        return self.recipes[name]

    def recipe_of_all(self):
        text = json.dumps([self.recipes, self.rows], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def voxels(self, name):
        """Voxels of the row's volume, by its header; 0 for another input, or one that cannot be read."""
        key = "voxels of " + self.recipes[name]
        if key not in self.digests.known:
            try:
                size = json.loads(self.ask("info", self.volume(name), "--json"))["size"]
                self.digests.known[key] = size[0] * size[1] * size[2]
            except (subprocess.CalledProcessError, KeyError):
                self.digests.known[key] = 0
        return self.digests.known[key]

    def megabytes(self, name):
        return int(BASE_MEGABYTES + self.voxels(name) * BYTES_PER_VOXEL / 1e6)

    def minutes(self, name):
        return int(BASE_MINUTES + self.voxels(name) * MICROSECONDS_PER_VOXEL / 6e7)

    def build_library(self):
        """The library of all cases that are there; empty ones are rows whose input is no good."""
        library = pathlib.Path(self.config["library"])
        if not (library / "library.json").exists():
            words = ["library", "init", library, "--title", self.config["title"]]
            words += ["--licence", self.config["licence"]] if self.config["licence"] else []
            subprocess.run([self.lumen, *words], check=True)
        statements = [c for c in next(iter(self.rows.values()))
                      if c not in OWN and not c.startswith("--")]
        out = pathlib.Path(self.folder) / "library.csv"
        with open(out, "w", encoding="utf-8", newline="") as text:
            table = csv.writer(text, lineterminator="\n")
            table.writerow(["input", "id", "targets", *statements])
            for name, row in self.rows.items():
                case = pathlib.Path(self.folder).resolve() / name / "case.lumen"
                if case.exists() and case.stat().st_size > 0:
                    table.writerow([case, name, row.get("targets") or "",
                                    *(row[s] for s in statements)])
        subprocess.run([self.lumen, "library", "build", out, library], check=True)
