#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds every place that states the version of lumen to the one in CMakeLists.txt.

version.py            prints the version
version.py --check    names the places that state another one; exit status 1 if there are some
version.py --write    writes the version into all of them

A place is found by the name of its file, so that a new package needs no line here. The tests,
whose data of older versions stays as it is, have none."""
import pathlib, re, subprocess, sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
NO_SOURCE = {"node_modules", ".git", "obj-x86_64-linux-gnu"}
NUMBER = r"([0-9]+\.[0-9]+\.[0-9]+)"

# Names of files, and what stands before the version there; (?m) makes ^ the start of a line.
PLACES = {
    "CITATION.cff": [r"(?m)^version: "],
    "package.json": [r'(?m)^  "version": "'],
    "export.md": [r'"generator": "lumen '],
    "library.md": [r'"generator": "lumen '],
    "debian/changelog": [r"\Alumen \("],
    "sofa_plugin/CMakeLists.txt": [r"project\(LumenSofa VERSION "],
    "container/Containerfile": [r'image\.version="'],
    "LumenVessels.xml": [r"<version>"],
    "LumenModelToCase.xml": [r"<version>"],
    "LumenCaseToModel.xml": [r"<version>"],
}
MUST = ["CITATION.cff", "CHANGELOG.md", "converters/export/sofa_plugin/CMakeLists.txt", "libblob/include/blob.h",
        "spec/export.md", "spec/library.md"]  # places without which a rule above has gone blind


def project_version():
    return re.search(r"project\(lumen VERSION " + NUMBER, (ROOT / "CMakeLists.txt").read_text())[1]


def files():
    """Names of the sources: of git, or of an archive that was unpacked. Those of tests are left out."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True) \
        if (ROOT / ".git").exists() else None
    if listed is not None and listed.returncode == 0: names = listed.stdout.splitlines()
    else: names = [path.relative_to(ROOT).as_posix() for path in ROOT.rglob("*") if not NO_SOURCE & set(path.relative_to(ROOT).parts)]
    return [name for name in names if not name.startswith(("tests/", "build", "dist/"))]


def patterns(name):
    """The patterns of the versions in a file; each has the version as its one group."""
    for ending, befores in PLACES.items():
        if name == ending or name.endswith("/" + ending):
            return [re.compile(before + NUMBER) for before in befores]
    return []


def macros(version):
    return dict(zip(("MAJOR", "MINOR", "PATCH"), version.split(".")))


def stated(name, text):
    """(version, start, end) of each place in a text, but for those of SPECIAL."""
    for pattern in patterns(name):
        for found in pattern.finditer(text):
            yield found[1], *found.span(1)


def header_with(text, version):
    for part, number in macros(version).items():
        text = re.sub(rf"(#define BLOB_VERSION_{part}) [0-9]+", rf"\1 {number}", text)
    return text


def add_on_with(text, version):
    return re.sub(r'(?m)^(    "version": )\([0-9, ]+\)', rf"\1({version.replace('.', ', ')})", text)


def changes_with(text, version):
    """The newest section is that of the version; sections of released ones keep their names."""
    head = "# Changes\n\n"
    return text if text.startswith(f"{head}## {version}\n") else text.replace(head, f"{head}## {version}\n\n", 1)


# Places whose version is not a text of its own.
SPECIAL = {"libblob/include/blob.h": header_with, "packages/blender/lumen_blender/__init__.py": add_on_with, "CHANGELOG.md": changes_with}


def text_with(name, text, version):
    if name in SPECIAL: return SPECIAL[name](text, version)
    for _, start, end in sorted(stated(name, text), key=lambda place: -place[1]):
        text = text[:start] + version + text[end:]
    return text


def holds_version(name, text):
    return name in SPECIAL or any(True for _ in stated(name, text))


def main(how):
    version = project_version()
    if how == "":
        print(version)
        return 0
    places, wrong = [], []
    for name in files():
        if name not in SPECIAL and not patterns(name): continue
        path = ROOT / name
        if not path.is_file(): continue
        text = path.read_text()
        if not holds_version(name, text): continue
        places.append(name)
        right = text_with(name, text, version)
        if right == text: continue
        wrong.append(name)
        if how == "--write": path.write_text(right)
    missing = sorted(set(MUST) - set(places))
    for name in missing: print(f"{name}: no version was found")
    for name in wrong: print(f"{name}: {'now' if how == '--write' else 'does not state'} {version}")
    print(f"{version}: {len(places)} places, {len(wrong)} of another version")
    return 1 if missing or (wrong and how == "--check") else 0


if __name__ == "__main__":
    if len(sys.argv) > 2 or (len(sys.argv) == 2 and sys.argv[1] not in ("--check", "--write")):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1] if len(sys.argv) == 2 else ""))
