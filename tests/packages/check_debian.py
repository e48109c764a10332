#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks packages/debian against a build, without building packages.

check_debian.py CMAKE BUILD

Installs components lumen, blob, cuda, case and python of BUILD into a temporary folder as debhelper does, and expects every file in one
package and every pattern to have a file. Versions agree, the symbols files name the functions of packages/abi, and each
package of the build is among those that bootstrap.sh installs. Exit status: 0 all is well, 1 something is not."""
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


def installed(cmake, build):
    """Paths of the files that a package build has in debian/tmp, with Debian's folder of libraries."""
    with tempfile.TemporaryDirectory(prefix="lumen-debian-") as folder:
        for component in ("lumen", "blob", "cuda", "case", "python"):
            done = subprocess.run([cmake, "--install", build, "--prefix", f"{folder}/usr", "--component", component],
                                  capture_output=True, text=True)
            check(done.returncode == 0, f"cmake --install: {done.stdout}{done.stderr}")
        paths = [p.relative_to(folder).as_posix() for p in pathlib.Path(folder).rglob("*") if p.is_symlink() or not p.is_dir()]
    return [re.sub(r"^usr/lib/(x86_64-linux-gnu/)?(?!python3/)", "usr/lib/triplet/", p) for p in paths]


def check_files(paths):
    patterns = {f.name: f.read_text().split() for f in sorted(DEBIAN.glob("*.install"))}
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


def check_symbols():
    for package, library in (("libblob1", "libblob"), ("libblob-cuda1", "libblob-cuda"), ("liblumen-case1", "liblumen-case")):
        lines = (DEBIAN / f"{package}.symbols").read_text().splitlines()
        named = {line.split("@")[0].strip() for line in lines if line.startswith(" ")}
        stored = set(re.findall(r"<elf-symbol name='([^']+)'", (ROOT / f"packages/abi/{library}.abi").read_text()))
        check(named == stored, f"{package}.symbols differs from {library}.abi in {sorted(named ^ stored)}")


def check_dependencies():
    field = re.search(r"^Build-Depends:(.*?)^\S|\n\n", (DEBIAN / "control").read_text(), re.S | re.M)[1]
    needed = {line.split()[0].strip(",") for line in field.strip().splitlines() if "<" not in line}
    known = (ROOT / "bootstrap.sh").read_text().split()
    for package in sorted(needed - {"debhelper-compat"}): check(package in known, f"bootstrap.sh does not install {package}")


def main():
    if len(sys.argv) != 3: sys.exit(__doc__)
    check_files(installed(*sys.argv[1:]))
    check_versions()
    check_symbols()
    check_dependencies()
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
