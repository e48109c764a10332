#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints "sha256  NAME" for every output of a set of runs, so that two builds can be compared.

    tests/hash_outputs.py build/release > after.hashes
    diff before.hashes after.hashes         # what changed; nothing, if nothing is printed

Runs `lumen` (found in BUILD/converters/cli, or in BUILD/converters/app of older builds) and libblob.so (in
BUILD/libblob): every phantom with its truth and seeds, tracked, fitted, converted to every format, described, checked, compared, validated and queried
on every SIMD path that this processor has; the real angiogram of --data, where it is; and the
files of spec/conformance. A failed run is an output too: its exit status is part of what is hashed.
The set takes about two minutes on two cores, with --quick half a minute.

Parts that may differ between builds that compute the same are settled before they are hashed, unless --raw:
  - in .lumen files the format's version, and the checksums of header, table and chunks, are zeroed;
  - in texts the format's version reads "0.0";
  - the digest of an earlier output of the run, where a case states what it was made from, is replaced
    by the digest of that output once settled.
"lumen 0.1.0", which names the program, stays: a release changes every case. No output holds a time;
progress, which does, goes to standard error and is not hashed. NaN is one value, whatever its bits.
"""
import argparse
import fnmatch
import hashlib
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

import hash_queries

ROOT = pathlib.Path(__file__).resolve().parent.parent
SMALL = ["tube", "helix", "bifurcation", "kissing", "aneurysm", "stenosis", "dropout", "sac-lobes", "companion",
         "hairpin", "right-angle", "fading", "thick-slices"]
PROGRAMS = ["converters/cli/lumen", "converters/app/lumen"]  # below the build folder; the first that exists
FULL = ["bifurcation", "kissing"]  # the phantoms that every format and option is tried on
KERNELS = ["gaussian", "quartic", "soft-object"]
MESHES = ["glb", "gltf", "vtp", "obj", "stl", "ply"]
SIGNATURE = b"\x8cLUMEN\r\n\x1a\n"


def without_versions(data):
    """A .lumen file with zeros for its versions and checksums; other bytes as they are."""
    if not data.startswith(SIGNATURE) or len(data) < 64:
        return data
    out = bytearray(data)
    out[10:14] = bytes(4)
    out[28:32] = bytes(4)
    out[60:64] = bytes(4)
    (chunks,) = struct.unpack_from("<I", data, 24)
    for entry in range(64, min(64 + 64 * chunks, len(out) - 63), 64):
        out[entry + 32:entry + 36] = bytes(4)
    return bytes(out)


def without_text_versions(data):
    data = re.sub(rb'("(?:version|minimumReader)": )"\d+\.\d+"', rb'\1"0.0"', data)
    return re.sub(rb"^(version +)\d+\.\d+$", rb"\g<1>0.0", data, flags=re.MULTILINE)


class Listing:
    """The lines printed so far, and the digests that later outputs may state."""

    def __init__(self, pattern, raw):
        self.pattern, self.raw, self.stated, self.count = pattern, raw, {}, 0

    def wants(self, group):
        return fnmatch.fnmatchcase(group, self.pattern.split("/")[0])

    def add(self, name, data):
        settled = data if self.raw else self.settle(data)
        digest = hashlib.sha256(settled).hexdigest()
        if settled != data:
            self.stated[hashlib.sha256(data).hexdigest().encode()] = digest.encode()
        if fnmatch.fnmatchcase(name, self.pattern):
            print(f"{digest}  {name}", flush=True)
            self.count += 1

    def settle(self, data):
        if data.startswith(SIGNATURE):
            data = without_versions(data)
        elif data[:1].isascii() and b"\0" not in data[:4096]:
            data = without_text_versions(data)
        for before, after in self.stated.items():
            data = data.replace(before, after)
        return data


class Folder:
    """Runs of `lumen` in one folder, by relative names so that no output holds a path."""

    def __init__(self, lumen, listing, path, group):
        self.lumen, self.listing, self.path, self.group = lumen, listing, path, group
        self.seen = set()
        path.mkdir()

    def run(self, name, *arguments):
        """One run; hashes its status and answer as NAME.out, and every file that it made."""
        done = subprocess.run([self.lumen, *map(str, arguments)], cwd=self.path,
                              capture_output=True, check=False)
        if done.returncode < 0:
            sys.exit(f"hash_outputs.py: signal {-done.returncode} ended lumen {arguments}")
        self.listing.add(f"{self.group}/{name}.out", b"%d\n" % done.returncode + done.stdout)
        for file in sorted(self.path.iterdir()):
            if file.name not in self.seen:
                self.seen.add(file.name)
                self.listing.add(f"{self.group}/{file.name}", file.read_bytes())
        if done.returncode not in (0, 3):
            print(f"hash_outputs.py: {self.group}/{name}: lumen ended with {done.returncode}: "
                  f"{done.stderr.decode(errors='replace').strip()}", file=sys.stderr)


def track_and_fit(folder, volume, seeds):
    """case.lumen from a volume in one go, tracked.lumen and fitted.lumen in two."""
    folder.run("convert", "convert", volume, "case.lumen", "--seeds", seeds, "--json")
    folder.run("track", "track", volume, "tracked.lumen", "--seeds", seeds, "--json")
    folder.run("fit", "fit", "tracked.lumen", "fitted.lumen", "--json")


def describe(folder, volume):
    for what, file in (("volume", volume), ("case", "case.lumen")):
        folder.run(f"info-{what}", "info", file)
        folder.run(f"info-{what}-json", "info", file, "--json")
    folder.run("info-voxels-json", "info", volume, "--json", "--voxels")
    folder.run("info-chunks", "info", "case.lumen", "--chunks")
    folder.run("info-chunks-json", "info", "case.lumen", "--chunks", "--json")
    folder.run("validate", "validate", "case.lumen", "tracked.lumen", "--privacy", "--json")
    folder.run("check", "check", volume, "case.lumen", "--mask", "labels.nrrd", "--overlay", "overlay.png")
    folder.run("check-json", "check", volume, "case.lumen", "--json")
    folder.run("picture", "picture", "case.lumen", "case.png", "--volume", volume, "--colour", "radius", "--size", "400x320")


def convert_case(folder):
    """The case in every format and encoding, and back."""
    folder.run("to-json", "convert", "case.lumen", "case.lumen.json")
    folder.run("from-json", "convert", "case.lumen.json", "again.lumen")
    folder.run("to-zstd", "convert", "case.lumen", "zstd.lumen", "--compress")
    folder.run("from-zstd", "convert", "zstd.lumen", "zstd.lumen.json")
    folder.run("to-draco", "convert", "case.lumen", "draco.lumen", "--point-bits", "14")
    folder.run("from-draco", "convert", "draco.lumen", "draco.lumen.json")
    for mesh in MESHES:
        folder.run(f"to-{mesh}", "convert", "case.lumen", f"mesh.{mesh}", "--json")
    for mesh in ("glb", "gltf"):
        folder.run(f"to-draco-{mesh}", "convert", "case.lumen", f"draco.{mesh}", "--draco")
    folder.run("to-meshopt", "convert", "case.lumen", "meshopt.glb", "--meshopt", "--lod", "2", "--mesh-per", "branch")
    folder.run("to-colors", "convert", "case.lumen", "colors.glb", "--color", "radius")
    folder.run("to-solids", "convert", "case.lumen", "solids.stl", "--stl-solids")
    folder.run("to-fine-ply", "convert", "case.lumen", "fine.ply", "--patches", "--cell", "0.1")


def try_options(folder, name):
    """Runs of some phantoms only: kernels, options, volume formats."""
    for kernel in KERNELS:
        folder.run(f"fit-{kernel}", "fit", "tracked.lumen", f"{kernel}.lumen", "--kernel", kernel)
        folder.run(f"{kernel}-to-ply", "convert", f"{kernel}.lumen", f"{kernel}.ply")
    folder.run("track-options", "track", "volume.nrrd", "options.lumen", "--seeds", "seeds.json",
               "--rays", "42", "--axes", "21", "--smoothing", "0.2", "--random-seed", "7")
    folder.run("fit-options", "fit", "options.lumen", "options-fitted.lumen", "--neighbourhood",
               "1", "--seam-sweeps", "0", "--accuracy", "0.1", "--kernel-parameter", "0.3")
    for extension in ("nii", "nii.gz", "mha"):
        file = f"volume.{extension}"
        folder.run(f"phantom-{extension}", "phantom", name, file, "--size", "48")
        folder.run(f"info-{extension}", "info", file, "--json", "--voxels")
    folder.run("crop", "convert", "volume.nrrd", "crop.lumen", "--seeds", "seeds.json", "--crop",
               "10,110,10,110,10,110")


def queries(folder, blob, cases):
    for case in cases:
        file = folder.path / f"{case}.lumen"
        for name, data in hash_queries.answers(blob, file) if file.exists() else []:
            folder.listing.add(f"{folder.group}/queries/{case}/{name}", data)


def phantom(folder, blob, name, *subject):
    """The phantom `name`, drawn by the arguments `subject` if there are any."""
    folder.run("phantom", "phantom", *(subject or [name]), "volume.nrrd", "--truth", "truth.lumen", "--seeds",
               "seeds.json", "--json")
    track_and_fit(folder, "volume.nrrd", "seeds.json")
    describe(folder, "volume.nrrd")
    folder.run("compare", "compare", "case.lumen", "truth.lumen")
    folder.run("compare-json", "compare", "case.lumen", "truth.lumen", "--json")
    if name in FULL:
        convert_case(folder)
        try_options(folder, name)
        queries(folder, blob, ["case", *KERNELS])
    else:
        folder.run("to-glb", "convert", "case.lumen", "mesh.glb", "--json")
        queries(folder, blob, ["case"])


def tree(folder, blob):
    (folder.path / "tree.swc").symlink_to(ROOT / "tests/fuzz/corpus/swc/fork")
    folder.seen.add("tree.swc")
    phantom(folder, blob, "tree", "--tree", "tree.swc")


def angiogram(folder, blob, data):
    volume = (data / "aneurism-3dra.nrrd").resolve()
    if not volume.exists():
        print(f"hash_outputs.py: angiogram skipped, there is no {volume}", file=sys.stderr)
        return
    # by links in the folder: names of files are in answers
    (folder.path / "volume.nrrd").symlink_to(volume)
    (folder.path / "seeds.json").symlink_to(ROOT / "tests/data/aneurism-3dra.seeds.json")
    folder.seen |= {"volume.nrrd", "seeds.json"}
    track_and_fit(folder, "volume.nrrd", "seeds.json")
    describe(folder, "volume.nrrd")
    folder.run("to-json", "convert", "case.lumen", "case.lumen.json")
    folder.run("to-glb", "convert", "case.lumen.json", "mesh.glb", "--json")
    queries(folder, blob, ["case"])


def conformance(folder, blob):
    """Answers of validation and libblob for each file of the conformance set."""
    subprocess.run([sys.executable, "-B", ROOT / "spec/conformance/make.py", folder.path / "spec"], check=True)
    folder.seen.add("spec")
    for kind in ("valid", "hostile"):
        files = sorted(f for f in (folder.path / "spec" / kind).iterdir()
                       if f.name.endswith((".lumen", ".lumen.json")))
        names = [f"spec/{kind}/{f.name}" for f in files]
        done = subprocess.run([folder.lumen, "validate", "--json", "--privacy", *names],
                              cwd=folder.path, capture_output=True, check=False)
        for name, report in zip(names, json.loads(done.stdout)["files"]):
            folder.listing.add(f"conformance/validate/{name[5:]}", json.dumps(report).encode())
        for file in files:
            if file.suffix == ".lumen":
                folder.listing.add(f"conformance/open/{kind}/{file.name}",
                                   hash_queries.opening(blob, file))


def arguments():
    about, _, text = __doc__.partition("\n\n")
    parser = argparse.ArgumentParser(description=about, epilog=text,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="build folder, such as build/release")
    parser.add_argument("--quick", action="store_true",
                        help="no patient phantom, no real angiogram")
    parser.add_argument("--only", metavar="PATTERN", default="*",
                        help="only outputs whose name fits, such as 'kissing/*' or '*/queries/*'; "
                        "what precedes the first / chooses which runs are made")
    parser.add_argument("--data", metavar="FOLDER", type=pathlib.Path,
                        default=ROOT.parent / "shared/data",
                        help="where aneurism-3dra.nrrd is (default: ../shared/data)")
    parser.add_argument("--raw", action="store_true", help="hash all bytes as they are")
    parser.add_argument("--keep", metavar="FOLDER", type=pathlib.Path,
                        help="make the outputs in this new folder and leave them there")
    return parser.parse_args()


def program(build):
    """The command line of a build."""
    found = [build / path for path in PROGRAMS if (build / path).exists()]
    if not found:
        sys.exit(f"hash_outputs.py: {build} has none of {', '.join(PROGRAMS)}")
    return found[0].resolve()


def hash_all(options, work):
    listing = Listing(options.only, options.raw)
    lumen = program(options.build)
    blob = hash_queries.load(options.build / "libblob/libblob.so")
    runs = {name: lambda folder, name=name: phantom(folder, blob, name)
            for name in SMALL + ([] if options.quick else ["patient"])}
    runs["tree"] = lambda folder: tree(folder, blob)
    if not options.quick:
        runs["angiogram"] = lambda folder: angiogram(folder, blob, options.data)
    runs["conformance"] = lambda folder: conformance(folder, blob)
    for group, run in runs.items():
        if listing.wants(group):
            run(Folder(lumen, listing, work / group, group))
    if listing.count == 0:
        sys.exit(f"hash_outputs.py: no output fits {options.only}")


def main():
    options = arguments()
    if options.keep:
        options.keep.mkdir(parents=True)
        hash_all(options, options.keep)
    else:
        with tempfile.TemporaryDirectory() as work:
            hash_all(options, pathlib.Path(work))


if __name__ == "__main__":
    main()
