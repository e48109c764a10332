#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes and changes libraries with lumen, and reads them with others: `sha256sum`, a reader of bags and of spec/library.md
in Python (bag.py), the schemas, npm's ro-crate.

check_library.py LUMEN BATCH_LUMEN

Without node_modules beside this file (npm ci) the crates are read by bag.py alone, and it is said. Exit status: 0 all held,
1 not."""
import fcntl, json, os, pathlib, re, shutil, subprocess, sys, tempfile, time

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
import bag
from batch import Batch

HERE = pathlib.Path(__file__).resolve().parent
failures = []


def expect(held, what):
    if not held:
        failures.append(what)
        print(what)


class Place:
    """A folder in which lumen runs."""

    def __init__(self, lumen, batch, folder):
        self.lumen, self.folder = str(lumen.resolve()), folder
        self.environment = {**os.environ, "SOURCE_DATE_EPOCH": "1795305600"}
        self.batch = Batch(batch.resolve(), env=self.environment)

    def run(self, *words, code=0):
        done = self.batch.run(words, self.folder)
        expect(done.returncode == code, f"lumen {' '.join(words)}: ended with {done.returncode}, not {code}: {done.stderr}")
        return done

    def add(self, *words, code=0, case="tube.lumen"):
        return self.run("library", "add", "lib", case, "--synthetic", "--no-surface", "--picture", "none", *words, code=code)

    def library(self):
        return json.loads((self.folder / "lib/library.json").read_text())

    def valid(self, when):
        for fault in bag.library_faults(self.folder / "lib"): expect(False, f"{when}: {fault}")
        for name in ("manifest-sha256.txt", "tagmanifest-sha256.txt"):
            done = subprocess.run(["sha256sum", "--quiet", "--strict", "-c", name], cwd=self.folder / "lib", capture_output=True)
            expect(done.returncode == 0 or not (self.folder / "lib" / name).stat().st_size, f"{when}: {name}: {done.stdout}")

    def refused(self, code, said, *words, case="tube.lumen"):
        """Nothing changes, and one sentence tells why."""
        before = {p: p.read_bytes() for p in (self.folder / "lib").rglob("*") if p.is_file()}
        done = self.run("library", *words, code=code)
        errors = [line for line in done.stderr.splitlines() if line.startswith("lumen: error: ")]
        expect(len(errors) == 1 and said in errors[0], f"{words}: said {done.stderr!r}, not {said!r}")
        after = {p: p.read_bytes() for p in (self.folder / "lib").rglob("*") if p.is_file()}
        expect(before == after, f"{words}: the library is another")


def making(place):
    place.run("library", "init", "lib", "--title", "Tubes", "--licence", "CC0-1.0", "--id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4")
    place.valid("a new library")
    expect(place.library()["revision"] == 1 and place.library()["previous"] is None, "a new library is of revision 1")
    expect(place.library()["date"] == "2026-11-22", "the date is that of SOURCE_DATE_EPOCH")
    place.run("library", "init", "twin", "--title", "Tubes", "--licence", "CC0-1.0", "--id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4")
    expect((place.folder / "twin/library.json").read_bytes() == (place.folder / "lib/library.json").read_bytes(),
           "the same library twice is not of the same bytes")
    place.run("library", "init", "other", "--title", "Tubes", "--licence", "CC0-1.0")
    expect(json.loads((place.folder / "other/library.json").read_text())["id"] != place.library()["id"], "ids are not random")


def adding(place):
    first = bag.sha256(place.folder / "lib/library.json")
    place.add("--export", "svzerod", "--export", "openfoam")
    place.valid("one case")
    whole = place.library()
    digest = bag.sha256(place.folder / "tube.lumen")
    expect([case["id"] for case in whole["cases"]] == ["case-" + digest[:12]], "the id is not of the case's digest")
    expect(whole["revision"] == 2 and whole["previous"] == first, "the revision before is not named")
    record = json.loads((place.folder / "lib/data" / whole["cases"][0]["id"] / "record.json").read_text())
    expect((record["licence"], record["modality"]) == ("CC0-1.0", "synthetic"), "licence and modality are not taken over")
    expect({f["target"] for f in record["files"] if f["role"] == "export"} == {"svzerod", "openfoam"}, "exports are not recorded")
    programs = [p.name for p in (place.folder / "lib/data").rglob("*") if p.is_file() and os.access(p, os.X_OK)]
    expect(programs == ["Allrun"], f"programs of a case: {programs}")
    info = json.loads(place.run("info", "tube.lumen", "--json").stdout)
    figures = record["figures"]
    for mine, its in ((figures["length_mm"], info["length_mm"]), (figures["fit_error_mm"]["median"], info["error_of_fit_mm"]["median"]),
                      (figures["fit_error_mm"]["p90"], info["error_of_fit_mm"]["p90"]),
                      (figures["radius_mm"]["max"], info["radius_mm"]["max"]), (figures["reachable_mm"], info["reachable"]["length_mm"])):
        expect(abs(mine - its) <= 1e-6 * abs(its), f"a figure is {mine}, and lumen info says {its}")
    measured = json.loads(place.run("measure", "tube.lumen", "--json").stdout)["cases"][0]
    for key, column in (("path_tortuosity", "tortuosity"), ("path_turning_deg_per_cm", "turning_deg_per_cm"), ("take_off_deg", "greatest_take_off_deg")):
        values = [path[column]["value"] for path in measured["paths"] if path[column]["absent"] is None]
        mine = figures["geometry"][key]
        expect(mine is None if not values else abs(mine - max(values)) <= 1e-4 * max(1, max(values)), f"{key} is {mine}, and lumen measure says {values}")
    expect(figures["geometry"]["aneurysm_reach_mm"] is None, "a tube has an aneurysm")
    (place.folder / "about.json").write_text(json.dumps({"title": "From a file", "anatomy": {"text": "tube", "codes": []}, "doi": "10.1234/x"}))
    (place.folder / "note.txt").write_text("a note")
    place.run("library", "add", "lib", "tube.lumen", "--id", "full", "--about", "about.json", "--title", "Of the line", "--synthetic",
              "--code", "FMA:3947:Internal carotid artery", "--turntable", "2", "--picture", "left", "--picture", "best", "--file", "note.txt")
    place.valid("a case with pictures")
    record = json.loads((place.folder / "lib/data/full/record.json").read_text())
    expect((record["title"], record["doi"]) == ("Of the line", "10.1234/x"), "the command line does not win over --about")
    expect([f["path"] for f in record["files"]] == ["case.lumen", "files/note.txt", "picture-best.png", "picture-left.png", "surface.glb",
                                                  "thumbnail.png", "turntable/000.png", "turntable/001.png"], "files of the full case")
    expect(record["anatomy"]["codes"] == [{"system": "FMA", "code": "3947", "name": "Internal carotid artery"}], "codes")
    place.run("convert", "tube.lumen", "tube.lumen.json")
    place.add("--id", "of-json", case="tube.lumen.json")
    place.valid("a case that came as JSON")


def changing(place):
    library = place.folder / "lib"
    for name in ("library.json.sig", "library.json.minisig", "index.html"): (library / name).write_text("old")
    (library / "site").mkdir()
    (library / "site/page.js").write_text("old")
    (library / "README.md").write_text("somebody's")
    (library / "data/full/extra.txt").write_text("somebody's")
    os.chmod(library, 0o750)
    inode = (library / "data/full/surface.glb").stat().st_ino
    done = place.add("--id", "full", "--replace", "--only", "--title", "Better", case="tube.lumen")
    for name in ("library.json.sig", "library.json.minisig", "index.html", "site", "data/full/files/note.txt", "data/full/picture-left.png"):
        expect(name in done.stdout, f"{name} goes without a word: {done.stdout}")
    place.add("--id", "later")
    names = sorted(p.name for p in library.iterdir())
    expect("README.md" in names and not {"library.json.sig", "library.json.minisig", "index.html", "site"} & set(names), f"left: {names}")
    (library / "README.md").unlink()
    expect(library.stat().st_mode & 0o777 == 0o750, "the library's permissions are others")
    place.valid("after a replacement")
    full = [case for case in place.library()["cases"] if case["id"] == "full"][0]
    expect((full["version"], full["title"], full["files"]) == (2, "Better", 1), f"the replaced case: {full}")
    other = place.library()["cases"][0]["id"]
    inode = (library / "data" / other / "case.lumen").stat().st_ino
    place.run("library", "remove", "lib", "full", "of-json")
    expect((library / "data" / other / "case.lumen").stat().st_ino == inode, "a file that stays is no hard link")
    expect([case["id"] for case in place.library()["cases"]] == [other, "later"], "removed cases")
    place.valid("after a removal")
    listed = json.loads(place.run("library", "list", "lib", "--json").stdout)
    expect([case["id"] for case in listed["cases"]] == [other, "later"] and listed["cases"][0]["length_mm"] > 10, "the list")
    expect(sorted(p.name for p in place.folder.iterdir() if p.name.startswith(".")) == [], "hidden files are left")


def replacing(place):
    """Parts that are not named again stay: statements, exports, pages, pictures, files; all that goes is listed."""
    place.run("library", "add", "lib", "tube.lumen", "--id", "rich", "--consent", "Given", "--deidentification", "Done", "--no-surface",
              "--picture", "left", "--turntable", "2", "--export", "svzerod", "--viewer", "--file", "note.txt",
              "--code", "FMA:3947:Internal carotid artery")
    record = lambda: json.loads((place.folder / "lib/data/rich/record.json").read_text())
    before = record()
    answer = json.loads(place.run("library", "add", "lib", "tube.lumen", "--id", "rich", "--replace", "--title", "Better", "--json").stdout)
    after = record()
    expect([f["path"] for f in after["files"]] == [f["path"] for f in before["files"]], f"files that went: {after['files']}")
    expect(answer["gone"] == [], f"gone: {answer['gone']}")
    expect((after["version"], after["title"], after["consent"], after["anatomy"]) == (2, "Better", "Given", before["anatomy"]), "statements")
    answer = json.loads(place.run("library", "add", "lib", "tube.lumen", "--id", "rich", "--replace", "--picture", "none", "--json").stdout)
    expect(answer["gone"] == ["data/rich/picture-left.png"] + ["data/rich/thumbnail.png"] * ("thumbnail.png" in
           [f["path"] for f in before["files"]]), f"gone without pictures: {answer['gone']}")
    expect(record()["title"] == "Better", "the title of the version before")
    (place.folder / "old.json").write_bytes((place.folder / "lib/data/rich/record.json").read_bytes())
    place.run("library", "add", "lib", "tube.lumen", "--id", "poor", "--about", "old.json", "--no-surface", "--picture", "none")
    poor = json.loads((place.folder / "lib/data/poor/record.json").read_text())
    expect((poor["title"], poor["consent"]) == ("Better", "Given"), "--about does not take a record.json")
    place.refused(2, "--replace", "add", "lib", "tube.lumen", "--id", "lone", "--only", "--synthetic")
    place.valid("after replacements")
    place.run("library", "remove", "lib", "rich", "poor")


def updating(place):
    """Other statements, the same files; the signature goes with a word."""
    place.run("library", "add", "lib", "tube.lumen", "--id", "told", "--title", "Old", "--doi", "10.1234/x", "--consent", "Given", "--deidentification",
              "Done", "--no-surface", "--picture", "left", "--report", "--file", "note.txt")
    place.add("--id", "other")
    folder, record = place.folder / "lib/data/told", lambda: json.loads((place.folder / "lib/data/told/record.json").read_text())
    before, inode = record(), (folder / "case.lumen").stat().st_ino
    (place.folder / "lib/library.json.minisig").write_text("old")
    done = place.run("library", "update", "lib", "told", "other", "--title", "New", "--doi", "", "--laterality", "left", "--code", "FMA:3947:Internal carotid artery")
    for word in ("told, version 2", "other, version 2", "library.json.minisig", "lumen library sign"): expect(word in done.stdout, f"update: {done.stdout}")
    after = record()
    expect((after["title"], after["doi"], after["laterality"], after["consent"], after["version"]) == ("New", "", "left", "Given", 2), f"update: {after}")
    expect(after["provenance"] == before["provenance"] and after["figures"] == before["figures"], "an update changes facts of the case")
    expect((folder / "case.lumen").stat().st_ino == inode, "an update copies files")
    files = lambda one: {f["path"]: f["sha256"] for f in one["files"]}
    changed = {path for path in files(before) if files(after).get(path) != files(before)[path]}
    expect(files(before).keys() == files(after).keys() and changed == {"report.html"}, f"changed files: {changed}")
    words = re.sub(r"data:[^\"]*", "", (folder / "report.html").read_text())  # pictures hold any three letters
    expect("New" in words and "Old" not in words, "the report has the old title")
    place.valid("after an update")
    place.run("library", "check", "lib")
    whole = place.library()["revision"]
    answer = json.loads(place.run("library", "update", "lib", "told", "--title", "New", "--json").stdout)
    expect((answer["updated"], answer["revision"], place.library()["revision"]) == ([], whole, whole), f"nothing to change: {answer}")
    place.refused(2, "expected a statement", "update", "lib", "told")
    place.refused(2, "no case nobody", "update", "lib", "told", "nobody", "--title", "X")
    place.refused(3, "consent", "update", "lib", "told", "--consent", "")
    place.run("library", "remove", "lib", "told", "other")


def extracting(place):
    first = place.library()["cases"][0]["id"]
    place.run("library", "extract", "lib", "own", "--case", first)
    made, whole = json.loads((place.folder / "own/library.json").read_text()), place.library()
    expect(made["id"] != whole["id"] and made["revision"] == 1, "an extract has no identity of its own")
    expect(made["origin"] == dict(id=whole["id"], revision=whole["revision"], sha256=bag.sha256(place.folder / "lib/library.json")), "origin")
    for fault in bag.library_faults(place.folder / "own"): expect(False, f"an extract: {fault}")
    place.run("library", "check", "own")


def leaving(place):
    """Leftovers of a killed `library index` are no fault, and no part of the next revision."""
    left = place.folder / "lib/.lumen-4711-0000000000"
    left.mkdir()
    (left / "page.html").write_text("half")
    (left / ".lumen-temporary").write_text("lumen writes in this folder, and removes it with all in it: when it is done, or else with the "
                                           "next file that it writes beside it.\n")
    place.run("library", "check", "lib")
    place.add("--id", "after-a-kill")
    expect(not left.exists(), "what a killed writer left is in the next revision")


def checking_meanwhile(place):
    """A check during changes finds a whole library."""
    words = [place.lumen, "library", "add", "lib", "tube.lumen", "--synthetic", "--no-surface", "--picture", "none", "--quiet", "--id"]
    for i in range(3):
        adding = subprocess.Popen([*words, f"meanwhile-{i}"], cwd=place.folder, env=place.environment)
        while adding.poll() is None: place.run("library", "check", "lib", "--quiet")
        expect(adding.wait() == 0, "an add during checks failed")


def sharing_the_lock(place):
    """A check reads beside other readers, and waits for a change, as a change waits for it."""
    def begun(*words):
        return subprocess.Popen([place.lumen, *words, "--quiet"], cwd=place.folder, env=place.environment)
    def held(kind):
        folder = os.open(place.folder / "lib", os.O_RDONLY)
        fcntl.flock(folder, kind)
        return folder
    def expect_waiting(process, folder, what):
        time.sleep(1)
        expect(process.poll() is None, f"{what} does not wait")
        os.close(folder)
        expect(process.wait(timeout=60) == 0, f"{what} fails after it has waited")
    reader = held(fcntl.LOCK_SH)
    place.run("library", "check", "lib")
    adding = begun("library", "add", "lib", "tube.lumen", "--synthetic", "--no-surface", "--picture", "none", "--id", "shared")
    expect_waiting(adding, reader, "an add beside a reader")
    writer = held(fcntl.LOCK_EX)
    expect_waiting(begun("library", "check", "lib"), writer, "a check beside a change")
    place.run("library", "check", "lib")


def refusing(place):
    hurt = ["--consent", "Given", "--deidentification", "Done"]
    place.refused(2, "has a case later already", "add", "lib", "tube.lumen", "--synthetic", "--id", "later")
    place.refused(3, "no statement of consent", "add", "lib", "tube.lumen")
    place.refused(3, "no statement of de-identification", "add", "lib", "tube.lumen", "--consent", "Given")
    place.refused(2, "expected 1 to 64 of a to z", "add", "lib", "tube.lumen", "--id", "../x", *hurt)
    for name in ("con", "nul", "com1"):
        place.refused(2, "no device of Windows", "add", "lib", "tube.lumen", "--id", name, *hurt)
    (place.folder / "-note.txt").write_text("x")
    place.refused(3, "cannot have a file of this name", "add", "lib", "tube.lumen", "--file", "./-note.txt", *hurt)
    place.refused(2, "--key FILE is missing", "sign", "lib")
    place.refused(2, "--key FILE is missing", "verify", "lib")
    done = place.run("library", "copy", "lib", "copy", code=2)
    expect("did you mean" not in done.stderr, f"library copy: {done.stderr}")
    done = place.run("library", "chek", "lib", code=2)
    expect("did you mean library check?" in done.stderr, f"library chek: {done.stderr}")
    place.refused(2, "did you mean CC-BY-4.0?", "add", "lib", "tube.lumen", "--licence", "CC-BY", *hurt)
    place.refused(2, "did you mean CC-BY-4.0?", "add", "lib", "tube.lumen", "--licence", "cc-by-4.0", *hurt)
    place.refused(2, "expected a DOI such as", "add", "lib", "tube.lumen", "--doi", "https://doi.org/10.1234/x", *hurt)
    place.refused(2, "expected SNOMED CT or FMA", "add", "lib", "tube.lumen", "--code", "ICD:1:x", *hurt)
    place.refused(4, "lumen does not export to this", "add", "lib", "tube.lumen", "--export", "nothing", *hurt)
    place.refused(3, "there is no such case file", "add", "lib", "none.lumen", *hurt)
    place.refused(3, "there is no such file", "add", "lib", "tube.lumen", "--file", "none.txt", *hurt)
    place.refused(3, "there is no such file about the case", "add", "lib", "tube.lumen", "--about", "none.json", *hurt)
    (place.folder / "bad.json").write_text('{"laterality": "links"}')
    place.refused(3, 'at "/laterality"', "add", "lib", "tube.lumen", "--about", "bad.json", *hurt)
    (place.folder / "a b.txt").write_text("x")
    place.refused(3, "cannot have a file of this name", "add", "lib", "tube.lumen", "--file", "a b.txt", *hurt)
    place.refused(2, "the library has no case gone", "remove", "lib", "gone")
    place.refused(3, "lumen library init", "list", "tube.json")
    place.refused(1, "there is something already", "init", "lib", "--title", "x", "--licence", "MIT")
    place.refused(3, "has no models", "add", "lib", "tree.lumen", "--export", "sofa", *hurt)
    warned = place.add("--id", "named", "--title", "Born 1.2.1950")
    expect("PRIVACY_DATE" in warned.stderr, f"a date in the title is passed over: {warned.stderr}")
    done = place.run("library", "add", "lib", "tube.lumen", "--synthetic", "--id", "strict", "--title", "Born 1.2.1950", "--strict", code=3)
    expect("PRIVACY_DATE" in done.stderr and "strict" not in [c["id"] for c in place.library()["cases"]], "--strict adds it")
    record = place.folder / "lib/data/later/record.json"
    good = record.read_bytes()
    record.write_bytes(good.replace(b"synthetic", b"Synthetic", 1))
    place.refused(3, "is not what library.json states", "add", "lib", "tube.lumen", "--synthetic", "--id", "next", "--no-surface")
    record.unlink()
    record.write_bytes(good)
    place.valid("after refusals")


def at_once(place):
    """Changes that begin together are all there at the end."""
    words = [place.lumen, "library", "add", "lib", "tube.lumen", "--synthetic", "--no-surface", "--picture", "none", "--quiet", "--id"]
    processes = [subprocess.Popen([*words, f"once-{i}"], cwd=place.folder, env=place.environment) for i in range(6)]
    expect([process.wait() for process in processes] == [0] * 6, "an add of six at once failed")
    expect({f"once-{i}" for i in range(6)} <= {case["id"] for case in place.library()["cases"]}, "a case of six at once is lost")
    place.valid("after six at once")


def crates(place):
    files = sorted((place.folder / "lib/data").rglob("ro-crate-metadata.json"))
    if not (HERE / "node_modules/ro-crate").is_dir() or not shutil.which("node"):
        print("npm's ro-crate is not here (npm ci in tests/library): crates were read by bag.py alone")
        return
    done = subprocess.run(["node", HERE / "read_crate.mjs", *files], capture_output=True, text=True)
    expect(done.returncode == 0, f"ro-crate: {done.stderr}")
    facts = [json.loads(line) for line in done.stdout.splitlines()]
    expect(len(facts) == len(files), "not all crates were read")
    for fact in facts:
        expect(not fact["dangling"] and not fact["terms"] and fact["name"] and fact["license"] == "CC0-1.0", f"ro-crate: {fact}")
    parts = {pathlib.Path(fact["file"]).parent.name: fact["parts"] for fact in facts}
    expect(parts["data"] == len(place.library()["cases"]), "cases of the root crate")


def main():
    lumen, batch = map(pathlib.Path, sys.argv[1:3])
    with tempfile.TemporaryDirectory() as name:
        place = Place(lumen, batch, pathlib.Path(name))
        place.run("phantom", "stenosis", "tube.nrrd", "--size", "64", "--seeds", "tube.json", "--quiet")
        place.run("convert", "tube.nrrd", "tube.lumen", "--seeds", "tube.json", "--quiet")
        place.run("track", "tube.nrrd", "tree.lumen", "--seeds", "tube.json", "--quiet")
        for step in (making, adding, changing, replacing, updating, extracting, leaving, refusing, at_once, checking_meanwhile, sharing_the_lock, crates):
            step(place)
        place.batch.end()
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
