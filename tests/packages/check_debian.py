#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks packages/debian against a build, without building packages.

check_debian.py CMAKE BUILD

Installs components lumen, blob, cuda, case and python of BUILD into a temporary folder as debhelper does, and expects every file in one
package and every pattern to have a file. Versions agree, the libraries have the sonames and export the functions that the symbols
files promise, no more and no fewer, and each package of the build is among those that bootstrap.sh installs. Exit status: 0 all is
well, 1 something is not."""
import fnmatch, pathlib, re, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEBIAN = ROOT / "packages/debian"
# removed by rules: Debian has the text in /usr/share/common-licenses
REMOVED = "usr/share/doc/*/LICENSE"
failures = []


def check(holds, text):
    if not holds:
        failures.append(text)
        print(text)


def run(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True)


def install(cmake, build, folder):
    """Makes what a package build has in debian/tmp."""
    for component in ("lumen", "blob", "cuda", "case", "python"):
        done = run(cmake, "--install", build, "--prefix", folder / "usr", "--component", component)
        check(done.returncode == 0, f"cmake --install: {done.stdout}{done.stderr}")


def paths_in(folder):
    """Paths of the files, with Debian's folder of libraries."""
    paths = [p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_symlink() or not p.is_dir()]
    return [re.sub(r"^usr/lib/(x86_64-linux-gnu/)?(?!python3/)", "usr/lib/triplet/", p) for p in paths]


def check_files(paths):
    # the first word of a line; a second one is the folder to which debhelper moves it
    patterns = {f.name: [line.split()[0] for line in f.read_text().splitlines()] for f in sorted(DEBIAN.glob("*.install"))}
    fits = lambda path, pattern: fnmatch.fnmatchcase(path, pattern) or path.startswith(pattern + "/")
    check(len(paths) > 30, f"only {len(paths)} files are installed")
    for path in paths:
        holders = [name for name, lines in patterns.items() if any(fits(path, line) for line in lines)]
        if fnmatch.fnmatchcase(path, REMOVED): continue
        check(len(holders) == 1, f"{path} is in {holders or 'no package'}")
    for name, lines in patterns.items():
        for line in lines:
            if name == "lumen-viewer.install" and not (ROOT / "viewer/page/dist").exists(): continue
            # the module is left out where pybind11 is missing
            if name == "python3-lumen.install" and not any("/python3/" in path for path in paths): continue
            # as is blob_cuda where there is no clang for it
            if name.startswith("libblob-cuda") and not any("libblob-cuda" in path for path in paths): continue
            check(any(fits(path, line) for path in paths), f"{name}: no file fits {line}")


def check_versions():
    project = re.search(r"project\(lumen VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    changes = re.match(r"lumen \(([0-9.]+)-\d+\)", (DEBIAN / "changelog").read_text())[1]
    check(project == changes, f"the project has version {project}, debian/changelog {changes}")


def check_symbols(folder):
    for symbols in sorted(DEBIAN.glob("*.symbols")):
        soname, *lines = symbols.read_text().splitlines()
        soname = soname.split()[0]
        libraries = list(folder.rglob(soname))
        if not libraries and "cuda" in soname: continue  # no clang for it
        check(len(libraries) == 1, f"{symbols.name}: there are {len(libraries)} files {soname}")
        found = re.search(r"SONAME\s+(\S+)", run("objdump", "-p", libraries[0]).stdout)
        check(found and found[1] == soname, f"{symbols.name}: the soname is {found and found[1]}")
        promised = {line.split("@")[0].strip() for line in lines if line.startswith(" ")}
        exported = {line.split()[-1].split("@")[0] for line in run("nm", "-D", "--defined-only", libraries[0]).stdout.splitlines()}
        for name in sorted(promised - exported): check(False, f"{symbols.name}: {name} is gone: restore it, or raise the soname")
        for name in sorted(exported - promised): check(False, f"{symbols.name}: {name} is new: add it, with the next version")


def check_dependencies():
    field = re.search(r"^Build-Depends:(.*?)^\S|\n\n", (DEBIAN / "control").read_text(), re.S | re.M)[1]
    needed = {line.split()[0].strip(",") for line in field.strip().splitlines() if "<" not in line}
    known = re.findall(r"[\w.+-]+", (ROOT / "bootstrap.sh").read_text())
    for package in sorted(needed - {"debhelper-compat"}): check(package in known, f"bootstrap.sh does not install {package}")


def main():
    if len(sys.argv) != 3: sys.exit(__doc__)
    with tempfile.TemporaryDirectory(prefix="lumen-debian-") as name:
        folder = pathlib.Path(name)
        install(*sys.argv[1:], folder)
        check_files(paths_in(folder))
        check_symbols(folder)
    check_versions()
    check_dependencies()
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
