#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the recipes of vcpkg and Conan with stand-ins of these programs, which Debian does not have.

check_recipes.py CMAKE [--install]: packs both recipes, configures the archive of the sources in them with the options that
they give, and expects these to hold. --install also builds and installs the port. Stand-ins know the functions that the
recipes use and fail for others, so they show that a recipe fits lumen, not that it fits the next version of vcpkg or
Conan. Exit status: 0 all is well, 1 something is not."""
import importlib.util, json, pathlib, re, subprocess, sys, tarfile, tempfile, types

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
failures = []


def check(holds, text):
    if not holds:
        failures.append(text)
        print(text)


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=1500)
    check(done.returncode == 0, f"{' '.join(map(str, command))}: {done.stdout[-2000:]}{done.stderr[-2000:]}")


def unpacked(kind, work, version):
    """The folder of a packed recipe; packing it twice gives the same bytes."""
    archives = []
    for again in ("a", "b"):
        run(ROOT / f"packages/{kind}/build.sh", work / again)
        archives.append(work / again / f"lumen-{kind}-{version}.tar.gz")
    check(archives[0].read_bytes() == archives[1].read_bytes(), f"{kind}: two runs give other bytes")
    with tarfile.open(archives[0]) as archive: archive.extractall(work / kind)
    return work / kind / f"lumen-{kind}-{version}"


def cached(build):
    lines = (build / "CMakeCache.txt").read_text().splitlines()
    return dict(re.match(r"([^:]+):[^=]*=(.*)", line).groups() for line in lines if re.match(r"LUMEN_\w+:", line))


def check_vcpkg(cmake, work, version, install):
    port = unpacked("vcpkg", work, version) / "ports/lumen"
    manifest = json.loads((port / "vcpkg.json").read_text())
    check(manifest["version"] == version, f"vcpkg.json has version {manifest['version']}")
    for features, option in (("core;case", "LUMEN_LIBRARIES_ONLY"), ("core", "LUMEN_LIBBLOB_ONLY")):
        place = work / f"port-{option}"
        run(cmake, f"-DPORT={port}", f"-DWORK={place}", f"-DVERSION={version}", f"-DFEATURES={features}",
            f"-DINSTALL={'ON' if install else 'OFF'}", "-P", HERE / "vcpkg_stand_in.cmake")
        check(cached(place / "build").get(option) == "ON", f"the port with {features} does not set {option}")
        if install: check((place / "packages/include/blob.h").exists(), "the port installs no blob.h")


class Anything:
    """An object of a stand-in whose every member is another, and that records what is set."""

    def __init__(self, *_): self.__dict__["members"] = {}
    def __getattr__(self, name): return self.members.setdefault(name, Anything())
    def __setattr__(self, name, value): self.members[name] = value
    def __getitem__(self, key): return self.members.setdefault(key, Anything())
    def __setitem__(self, key, value): self.members[key] = value
    def __call__(self, *_, **__): return Anything()


def recipe_class(path):
    """The class of a recipe, with modules that stand in for those of Conan."""
    names = {"conan": ["ConanFile"], "conan.tools": [], "conan.tools.cmake": ["CMake", "CMakeToolchain", "CMakeDeps", "cmake_layout"],
             "conan.tools.files": ["copy", "unzip"]}
    made = []
    for name, members in names.items():
        module = sys.modules[name] = types.ModuleType(name)
        for member in members: setattr(module, member, type(member, (Anything,), {}))
    sys.modules["conan"].ConanFile = type("ConanFile", (), {})
    sys.modules["conan.tools.cmake"].CMakeToolchain = lambda recipe: made.append(Anything()) or made[-1]

    def unzip(recipe, archive, strip_root):
        with tarfile.open(archive) as opened: opened.extractall(recipe.source_folder)

    sys.modules["conan.tools.files"].unzip = unzip
    spec = importlib.util.spec_from_file_location("conanfile", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Lumen, made


def check_conan(cmake, work, version):
    folder = unpacked("conan", work, version) / "recipe"
    kind, toolchains = recipe_class(folder / "conanfile.py")
    check(kind.version == version, f"conanfile.py has version {kind.version}")
    for with_case, option in ((True, "LUMEN_LIBRARIES_ONLY"), (False, "LUMEN_LIBBLOB_ONLY")):
        recipe, needed = kind(), []
        recipe.options = types.SimpleNamespace(with_case=with_case)
        recipe.export_sources_folder, recipe.source_folder = folder, work / f"conan-{option}"
        recipe.requires, recipe.cpp_info = lambda name, **_: needed.append(name.split("/")[0]), Anything()
        recipe.requirements(), recipe.source(), recipe.generate(), recipe.package_info()
        check(bool(needed) == with_case, f"with_case={with_case} requires {needed}")
        variables = toolchains[-1].members["cache_variables"].members
        check(variables.get(option) is True, f"with_case={with_case} sets {variables}")
        root = recipe.source_folder / f"lumen-{version}"
        flags = [f"-D{name}={'ON' if value else 'OFF'}" for name, value in variables.items()]
        run(cmake, "-G", "Ninja", "-S", root, "-B", recipe.source_folder / "build", *flags)


def main():
    options = [a for a in sys.argv[1:] if a.startswith("--")]
    if len(sys.argv) - len(options) != 2 or not set(options) <= {"--install"}: sys.exit(__doc__)
    version = re.search(r"project\(lumen VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    with tempfile.TemporaryDirectory(prefix="lumen-recipes-") as folder:
        work = pathlib.Path(folder)
        check_vcpkg(sys.argv[1], work, version, bool(options))
        check_conan(sys.argv[1], work, version)
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
