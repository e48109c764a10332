#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Changes a signed library in every way that somebody might, and holds lumen to what it must say.

tamper.py BATCH_LUMEN [--markdown | --every N]

Makes a library of synthetic cases, signs it, and for each row below changes a copy of it; then `lumen library check`
and `lumen library verify` must find exactly the faults of the row (spec/library.md, Faults), and exit with 3 if there
is an error. With --markdown it prints the table; with --every N one row of N is tried. Needs minisign and ssh-keygen (Debian: minisign, openssh-client).
Exit status: 0 all held, 1 something did not."""
import json, os, pathlib, shutil, subprocess, sys, tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from batch import Batch
from made import Maker, digest, read_json, write_json

ROWS, failures = [], []


def row(check, verify=None, **options):
    """A change of a library: faults that check finds, and verify; the same if verify is not given."""
    def add(change):
        ROWS.append((change.__doc__, change, set(check), set(check if verify is None else verify), options))
        return change
    return add


def flip(path, at=None):
    """Another bit in the middle of a file."""
    data = bytearray(path.read_bytes())
    data[len(data) // 2 if at is None else at] ^= 1
    path.write_bytes(bytes(data))


def flip_in(path, text):
    flip(path, path.read_bytes().index(text.encode()) + len(text) // 2)


def restate(library, case):
    """Changes a record and makes library.json fit."""
    file, top = library / "data" / case / "record.json", read_json(library / "library.json")
    record = read_json(file)
    for entry in top["cases"]:
        if entry["id"] != case: continue
        entry["record"] = {"bytes": file.stat().st_size, "sha256": digest(file)}
        entry.update(title=record["title"], files=len(record["files"]), bytes=sum(f["bytes"] for f in record["files"]))
    write_json(library / "library.json", top)


def change_record(library, case, change):
    file = library / "data" / case / "record.json"
    record = read_json(file)
    change(record)
    write_json(file, record)
    restate(library, case)


def refit(library, case, name):
    """The record states what a file of the case is now."""
    file = library / "data" / case / name
    def change(record):
        for entry in record["files"]:
            if entry["path"] == name: entry.update(bytes=file.stat().st_size, sha256=digest(file))
    change_record(library, case, change)


def replace(path, make):
    path.unlink()
    make(path)


# ---- nothing changed, and what is no change

@row([])
def untouched(t): "nothing"

@row([])
def hard_link(t):
    "a file replaced by a hard link to the same bytes"
    other = t.folder / "elsewhere.png"
    shutil.copy(t.library / "data/a/thumbnail.png", other)
    replace(t.library / "data/a/thumbnail.png", lambda p: os.link(other, p))

@row([])
def touched(t):
    "times of files"
    for file in t.library.rglob("*"): os.utime(file, (1, 1), follow_symlinks=False)


# ---- one bit

@row([722])
def bit_of_case(t):
    "a bit of a case"
    flip(t.library / "data/a/case.lumen")

@row([712])
def bit_of_record(t):
    "a bit of a record"
    flip_in(t.library / "data/a/record.json", "made by a program")

@row([722])
def bit_of_surface(t):
    "a bit of a surface"
    flip(t.library / "data/a/surface.glb")

@row([722])
def bit_of_picture(t):
    "a bit of a picture"
    flip(t.library / "data/a/thumbnail.png")

@row([722])
def bit_of_export(t):
    "a bit of an export"
    flip(next(p for p in sorted((t.library / "data/a/exports").rglob("*")) if p.is_file()))

@row([751, 752], [763])
def bit_of_library(t):
    "a bit of library.json"
    flip_in(t.library / "library.json", "Three tubes")

@row([752])
def bit_of_case_crate(t):
    "a bit of a case's RO-Crate"
    flip(t.library / "data/b/ro-crate-metadata.json")

@row([752])
def bit_of_crate(t):
    "a bit of the library's RO-Crate"
    flip(t.library / "data/ro-crate-metadata.json")

@row([751])
def bit_of_manifest(t):
    "a bit of the manifest"
    flip(t.library / "manifest-sha256.txt")

@row([751])
def bit_of_bag_info(t):
    "a bit of bag-info.txt"
    flip(t.library / "bag-info.txt")

@row([751])
def bit_of_bagit(t):
    "a bit of bagit.txt"
    flip(t.library / "bagit.txt")

@row([751])
def bit_of_tag_manifest(t):
    "a bit of the tag manifest"
    flip(t.library / "tagmanifest-sha256.txt")

@row([], [763])
def bit_of_signature(t):
    "a bit of the signature"
    file = t.library / "library.json.minisig"
    lines = file.read_text().split("\n")
    lines[1] = lines[1][:40] + ("A" if lines[1][40] != "A" else "B") + lines[1][41:]
    file.write_text("\n".join(lines))


# ---- files and cases moved, removed, added

@row([722])
def swapped_files(t):
    "two pictures exchanged"
    a, b, c = (t.library / "data" / n / "thumbnail.png" for n in "abx")
    c = t.folder / "x"
    a.rename(c), b.rename(a), c.rename(b)

@row([712, 713])
def swapped_cases(t):
    "the folders of two cases exchanged"
    a, b, c = t.library / "data/a", t.library / "data/b", t.folder / "x"
    a.rename(c), b.rename(a), c.rename(b)

@row([721])
def removed_file(t):
    "a file removed"
    (t.library / "data/a/surface.glb").unlink()

@row([721])
def removed_folder(t):
    "the folder of a case removed"
    shutil.rmtree(t.library / "data/b")

@row([751, 752], [763])
def removed_case(t):
    "a case removed, in library.json too"
    shutil.rmtree(t.library / "data/b")
    top = read_json(t.library / "library.json")
    top["cases"] = [c for c in top["cases"] if c["id"] != "b"]
    write_json(t.library / "library.json", top)

@row([], [763])
def removed_well(t):
    "a case removed by lumen library remove, and the old signature put back"
    signature = (t.library / "library.json.minisig").read_bytes()
    t.lumen("library", "remove", t.library, "b")
    (t.library / "library.json.minisig").write_bytes(signature)

@row([723])
def added_file(t):
    "a file added"
    (t.library / "data/a/notes.txt").write_text("hello")

@row([723])
def added_folder(t):
    "a folder of a case added"
    shutil.copytree(t.library / "data/a", t.library / "data/z")

@row([], [761])
def added_case(t):
    "a case added by lumen library add"
    t.add(t.library, "d", t.case("d"))

@row([712, 713])
def older_case(t):
    "an older version of a case put back, files and record"
    shutil.rmtree(t.library / "data/c")
    shutil.copytree(t.older / "data/c", t.library / "data/c")

@row([], [764])
def older_library(t):
    "an older signed revision of the library put back"
    shutil.rmtree(t.library)
    shutil.copytree(t.older, t.library)

@row([], [765])
def other_revision(t):
    "another library of the same revision, signed by the same key"
    shutil.rmtree(t.library)
    shutil.copytree(t.older, t.library)
    t.add(t.library, "d", t.case("d"))
    t.lumen("library", "sign", t.library, "--key", t.key)

@row([], [765])
def other_history(t):
    "a later revision of another history, signed by the same key"
    shutil.rmtree(t.library)
    shutil.copytree(t.older, t.library)
    t.add(t.library, "d", t.case("d"))
    t.add(t.library, "e", t.case("d"))
    t.lumen("library", "sign", t.library, "--key", t.key)


# ---- signatures

@row([], [762])
def other_key(t):
    "signed by a key that is not trusted"
    t.lumen("library", "sign", t.library, "--key", t.other_key)

@row([], [763])
def other_library(t):
    "the signature of another library by the same key"
    shutil.copy(t.another / "library.json.minisig", t.library)

@row([], [761])
def no_signature(t):
    "the signature removed"
    (t.library / "library.json.minisig").unlink()

@row([725], [763])
def linked_signature(t):
    "the signature a symbolic link"
    copy = t.folder / "signature"
    shutil.move(t.library / "library.json.minisig", copy)
    (t.library / "library.json.minisig").symlink_to(copy)

@row([], [763])
def no_minisign(t):
    "a signature that is none"
    (t.library / "library.json.minisig").write_text("hello\n")

@row([], [], key="ssh")
def ssh(t): "nothing; OpenSSH's public key"

@row([], [], key="allowed")
def ssh_allowed(t): "nothing; a list of allowed signers"

@row([], [], key="allowed", identity="publisher@example.org")
def ssh_identity(t): "nothing; a name of that list"

@row([], [762], key="allowed", identity="somebody@example.org")
def ssh_other_identity(t): "nothing; another name of that list"

@row([], [762], key="ssh")
def ssh_other_key(t):
    "signed by a key of OpenSSH that is not trusted"
    t.lumen("library", "sign", t.library, "--key", t.other_ssh)

@row([], [763], key="ssh")
def ssh_namespace(t):
    "signed by OpenSSH's key for another purpose"
    (t.library / "library.json.sig").unlink()
    subprocess.run(["ssh-keygen", "-q", "-Y", "sign", "-f", t.ssh, "-n", "file", t.library / "library.json"], check=True,
                   stderr=subprocess.DEVNULL)

@row([751, 752], [763], key="ssh")
def ssh_bit(t):
    "a bit of library.json; OpenSSH's key"
    flip_in(t.library / "library.json", "Three tubes")


# ---- paths, links, kinds

@row([713, 723, 724, 751, 752], [763])
def parent_path(t):
    "a record that lists ../../../secret"
    def change(record): record["files"][-1]["path"] = "../../../secret"
    change_record(t.library, "a", change)

@row([713, 723, 724, 751, 752], [763])
def absolute_path(t):
    "a record that lists /etc/passwd"
    def change(record): record["files"][-1]["path"] = "/etc/passwd"
    change_record(t.library, "a", change)

@row([713, 723, 724, 751, 752], [763])
def twins_listed(t):
    "a record that lists thumbnail.png and Thumbnail.png"
    def change(record):
        twin = dict(next(f for f in record["files"] if f["path"] == "thumbnail.png"), path="Thumbnail.png")
        record["files"] = sorted(record["files"] + [twin], key=lambda f: f["path"])
    change_record(t.library, "a", change)
    shutil.copy(t.library / "data/a/thumbnail.png", t.library / "data/a/Thumbnail.png")

@row([723])
def twins_there(t):
    "Thumbnail.png beside thumbnail.png"
    shutil.copy(t.library / "data/a/thumbnail.png", t.library / "data/a/Thumbnail.png")

@row([725])
def link_outside(t):
    "a file replaced by a symbolic link to the same bytes"
    other = t.folder / "elsewhere.png"
    shutil.copy(t.library / "data/a/thumbnail.png", other)
    replace(t.library / "data/a/thumbnail.png", lambda p: p.symlink_to(other))

@row([725])
def link_of_case(t):
    "the folder of a case a symbolic link to the same files"
    (t.library / "data/a").rename(t.folder / "elsewhere")
    (t.library / "data/a").symlink_to(t.folder / "elsewhere")

@row([725, 752])
def link_of_payload(t):
    "data/ a symbolic link to the same files"
    (t.library / "data").rename(t.folder / "elsewhere")
    (t.library / "data").symlink_to(t.folder / "elsewhere")

@row([701])
def link_of_library(t):
    "library.json a symbolic link to the same bytes"
    (t.library / "library.json").rename(t.folder / "elsewhere.json")
    (t.library / "library.json").symlink_to(t.folder / "elsewhere.json")

@row([725])
def link_loop(t):
    "a symbolic link to the folder that it is in"
    (t.library / "data/a/again").symlink_to(".")

@row([725])
def pipe(t):
    "a file replaced by a named pipe"
    replace(t.library / "data/a/thumbnail.png", os.mkfifo)

@row([701])
def pipe_of_library(t):
    "library.json a named pipe"
    replace(t.library / "library.json", os.mkfifo)

@row([725])
def folder_for_file(t):
    "a folder in the place of a file"
    replace(t.library / "data/a/thumbnail.png", os.mkdir)

@row([725])
def file_for_folder(t):
    "a file in the place of a folder"
    shutil.rmtree(t.library / "data/a/exports")
    (t.library / "data/a/exports").write_text("hello")

@row([723])
def not_utf8(t):
    "a name that is not UTF-8, with a line end"
    (pathlib.Path(os.fsdecode(os.fsencode(t.library / "data/a") + b"/\xff\n\x1b[31m"))).write_text("hello")

@row([723])
def deep(t):
    "folders nested 500 deep"
    here = os.open(t.library / "data/a", os.O_RDONLY)
    for _ in range(500):
        os.mkdir("d", dir_fd=here)
        inner = os.open("d", os.O_RDONLY, dir_fd=here)
        os.close(here)
        here = inner
    os.close(here)


# ---- what is said

@row([702, 751], [763])
def ids_twice(t):
    "a case twice in library.json"
    top = read_json(t.library / "library.json")
    top["cases"].insert(1, dict(top["cases"][0], title="Another"))
    write_json(t.library / "library.json", top)

@row([703, 751], [763])
def order(t):
    "the cases of library.json in another order"
    top = read_json(t.library / "library.json")
    top["cases"].reverse()
    write_json(t.library / "library.json", top)

@row([704, 751, 752], [763])
def no_licence(t):
    "a case without a licence"
    def change(record): record["licence"] = ""
    change_record(t.library, "a", change)

@row([704, 751, 752], [763])
def strange_licence(t):
    "a library with a licence that is no SPDX expression"
    top = read_json(t.library / "library.json")
    top["licence"] = "free for all"
    write_json(t.library / "library.json", top)

@row([705, 751], [763])
def no_consent(t):
    "a case of a patient without consent and de-identification"
    def change(record): record.update(synthetic=False, consent="", deidentification="")
    change_record(t.library, "a", change)

@row([741, 751, 752], [763])
def person(t):
    "a title that looks like a person's"
    def change(record): record["title"] = "Doe^Jane 1999-12-31"
    change_record(t.library, "a", change)

@row([711], [763])
def broken_record(t):
    "a record that is no JSON, with the right digest"
    file = t.library / "data/a/record.json"
    top = read_json(t.library / "library.json")
    file.write_text("{")
    top["cases"][0]["record"] = {"bytes": 1, "sha256": digest(file)}
    write_json(t.library / "library.json", top)

@row([701], [763])
def broken_library(t):
    "library.json of another version"
    top = read_json(t.library / "library.json")
    top["formatVersion"] = 2
    write_json(t.library / "library.json", top)

@row([731, 751, 752], [763])
def broken_case(t):
    "a case that breaks its format, with the right digests"
    flip(t.library / "data/a/case.lumen")
    refit(t.library, "a", "case.lumen")

@row([732, 751, 752], [763])
def other_case(t):
    "the case of another record, with the right digests"
    shutil.copy(t.library / "data/b/case.lumen", t.library / "data/a/case.lumen")
    refit(t.library, "a", "case.lumen")

@row([732, 751], [763])
def figures(t):
    "a record that states a wider vessel than its case has"
    def change(record): record["figures"]["radius_mm"]["max"] *= 2
    change_record(t.library, "a", change)

@row([732, 751], [763])
def geometry(t):
    "a record that states a more tortuous path than its case has"
    def change(record): record["figures"]["geometry"]["path_tortuosity"] = 3
    change_record(t.library, "a", change)

@row([751], [763])
def no_geometry(t):
    "a record without measures, as older versions wrote it"
    def change(record): del record["figures"]["geometry"]
    change_record(t.library, "a", change)

@row([751])
def manifest_outside(t):
    "a manifest that lists a file outside"
    file = t.library / "manifest-sha256.txt"
    file.write_text(file.read_text() + "0" * 64 + "  ../../secret\n")

@row([751])
def no_manifest(t):
    "no manifest"
    (t.library / "manifest-sha256.txt").unlink()


class Tampered:
    """A copy of the library, and what changes may use."""
    def __init__(self, maker, folder, name):
        self.__dict__.update(maker.__dict__)
        self.maker, self.folder = maker, folder
        self.library = folder / "library"
        shutil.copytree(name, self.library, symlinks=True)

    def lumen(self, *arguments): return self.maker.lumen(*arguments)
    def add(self, *arguments): return self.maker.add(*arguments)
    def case(self, name): return self.maker.case(name)


def ask(batch, *arguments):
    """Exit code and faults by number."""
    result = batch.run([*arguments, "--json", "--quiet"], "/")
    try:
        answer = json.loads(result.stdout)
    except ValueError:
        return result.returncode, {result.stderr}, []
    return result.returncode, {f["number"] for f in answer["faults"]}, answer["faults"]


def hold(maker, what, command, expected, found, code):
    wanted = 3 if expected - {741} else 0
    if found != expected or code != wanted:
        failures.append(what)
        print(f"{what}: {command}: found {sorted(map(str, found))} and exit code {code}, "
              f"expected {sorted(expected)} and {wanted}")


def run_row(maker, name, change, check, verify, options):
    with tempfile.TemporaryDirectory(dir=maker.folder) as folder:
        t = Tampered(maker, pathlib.Path(folder), maker.signed)
        change(t)
        code, found, faults = ask(maker.batch, "library", "check", t.library)
        hold(maker, name, "check", check, found, code)
        key = {"ssh": f"{maker.ssh}.pub", "allowed": maker.allowed}.get(options.get("key"), maker.public)
        who = ("--identity", options["identity"]) if "identity" in options else ()
        state = t.folder / "state.json"
        shutil.copy(maker.state, state)
        code_v, found_v, _ = ask(maker.batch, "library", "verify", t.library, "--key", key, "--state", state, *who)
        hold(maker, name, "verify", verify, found_v, code_v)
        numbers = lambda s: ", ".join(map(str, sorted(s))) or "-"
        return f"| {name} | {numbers(found)} | {code} | {numbers(found_v)} | {code_v} |"


def main():
    if len(sys.argv) < 2: sys.exit(__doc__)
    if missing := [p for p in ("minisign", "ssh-keygen") if not shutil.which(p)]:
        print(f"skipped: {', '.join(missing)} not found (Debian: minisign, openssh-client)")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="lumen-tamper-") as folder:
        maker = Maker(Batch(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(folder))
        maker.make_signed()
        every = int(sys.argv[sys.argv.index("--every") + 1]) if "--every" in sys.argv else 1
        lines = [run_row(maker, *r) for r in ROWS[::every]]
        maker.batch.end()
    if "--markdown" in sys.argv:
        print("| changed | check finds | exit | verify finds | exit |\n|---|---|---|---|---|")
        print("\n".join(lines))
    print(f"{len(lines)} rows, {len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
