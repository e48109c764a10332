#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks check, sign and verify beyond the faults that they find: passwords, missing programs, remembered results.

check_trust.py LUMEN BATCH_LUMEN [--passwords]

With --passwords only those are checked, typed at a terminal: minisign takes seconds for each.

Exit status: 0 all held, 1 something did not, 77 minisign or ssh-keygen is missing."""
import json, os, pathlib, pty, shutil, subprocess, sys, tempfile, termios, time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from batch import Batch
from made import Maker, read_json

failures = []


def expect(what, found, expected):
    if found != expected:
        failures.append(what)
        print(f"{what}: found {found!r}, expected {expected!r}")


def run(maker, *words, **options):
    if not options:
        result = maker.batch.run(["library", *words], maker.folder)
    else:
        result = subprocess.run([maker.program, "library", *map(str, words)], capture_output=True, text=True, timeout=120,
                                stdin=subprocess.DEVNULL, **options)
    return result.returncode, result.stdout, result.stderr


def answer(maker, *words):
    code, out, err = run(maker, *words, "--json", "--quiet")
    return code, json.loads(out) if out else err


def typed(maker, keys, *words):
    """Runs at a terminal where somebody types `keys` when a password is asked for: exit code, what was shown, and whether
    the terminal echoes afterwards."""
    child, terminal = pty.fork()
    if child == 0: os.execv(maker.program, [str(maker.program), "library", *map(str, words)])
    shown, begin, sent = b"", time.monotonic(), False
    while time.monotonic() - begin < 60:
        try:
            more = os.read(terminal, 4096)
        except OSError:
            break
        if not more: break
        shown += more
        if b"assword:" in shown and not sent:
            time.sleep(0.3)  # until the echo is off
            os.write(terminal, keys)
            sent = True
    echo = bool(termios.tcgetattr(terminal)[3] & termios.ECHO)
    _, status = os.waitpid(child, 0)
    os.close(terminal)
    return os.waitstatus_to_exitcode(status), shown.decode(errors="replace"), echo


def passwords(maker, library):
    key, public = maker.folder / "locked.key", maker.folder / "locked.pub"
    subprocess.run(["minisign", "-G", "-s", key, "-p", public], input=b"secret\nsecret\n", check=True, capture_output=True)
    signature = library / "library.json.minisig"
    signature.unlink(missing_ok=True)
    code, shown, echo = typed(maker, b"wrong\n", "sign", library, "--key", key)
    expect("a wrong password: exit code", code, 1)
    expect("a wrong password: minisign's words", "minisign reports: Wrong password" in shown, True)
    expect("a wrong password: no signature", signature.exists(), False)
    code, shown, echo = typed(maker, b"\x03", "sign", library, "--key", key)
    expect("Ctrl-C at the password: exit code and echo", (code, echo), (130, True))
    expect("Ctrl-C: nothing is written", signature.exists(), False)
    code, shown, echo = typed(maker, b"secret\n", "sign", library, "--key", key)
    expect(f"the password: {shown}", (code, "secret" in shown), (0, False))
    expect("the password: verified", answer(maker, "verify", library, "--key", public, "--no-state")[0], 0)


def wrong_keys(maker, library):
    for words, told in ((("sign", library, "--key", maker.public), "expected a secret key"),
                        (("verify", library, "--key", maker.key, "--no-state"), "expected a public one"),
                        (("verify", library, "--key", maker.case("a"), "--no-state"), "expected a key of minisign"),
                        (("verify", library, "--key", maker.folder / "nothing", "--no-state"), "there is no such key file")):
        code, out, err = run(maker, *words)
        expect(f"{words[0]} with {words[3]}: exit code and answer", (code, out), (3, ""))
        expect(f"{words[0]} with {words[3]}: {err}", told in err, True)
    code, _, err = run(maker, "verify", library, "--key", maker.public, "--identity", "me", "--no-state")
    expect(f"a name for minisign: {err}", (code, "--identity" in err), (2, True))
    code, _, err = run(maker, "sign", library, "--key", maker.key, env={"PATH": "/nowhere"})
    expect(f"no minisign: {err}", (code, "package minisign" in err), (4, True))
    code, _, err = run(maker, "verify", library, "--key", f"{maker.ssh}.pub", "--no-state", env={"PATH": "/nowhere"})
    expect(f"no ssh-keygen: {err}", (code, "package openssh-client" in err), (4, True))


def faulty_is_not_signed(maker, library):
    (library / "data/a/stray").write_text("x")
    before = (library / "library.json.minisig").read_bytes()
    code, told = answer(maker, "sign", library, "--key", maker.key)
    expect("a faulty library: exit code, signed", (code, told["signed"]), (3, False))
    expect("a faulty library: the old signature", (library / "library.json.minisig").read_bytes(), before)
    (library / "data/a/stray").unlink()


def only_the_signature_is_written(maker, library):
    state = lambda: {str(p): (p.stat().st_mtime_ns, p.stat().st_ino) for p in library.rglob("*") if not p.name.endswith(".minisig")}
    before = state()
    maker.lumen("library", "sign", library, "--key", maker.key)
    before.pop(str(library), None)
    expect("what signing changes", state(), before)


def remembered(maker, library):
    state = maker.folder / "remembered.json"
    words = ("verify", library, "--key", maker.public, "--state", state)
    expect("a first verification", answer(maker, *words)[1]["known_revision"], None)
    revision = read_json(library / "library.json")["revision"]
    expect("a second one", answer(maker, *words)[1]["known_revision"], revision)
    older = ("verify", maker.older, "--key", maker.public)
    expect("an older one", answer(maker, *older, "--state", state)[0], 3)
    expect("an older one without memory", answer(maker, *older, "--no-state")[0], 0)
    kept = state.read_text()
    state.write_text(kept[:-20])
    code, out, err = run(maker, *words)
    expect(f"a damaged memory: {err}", (code, out, state.read_text()), (3, "", kept[:-20]))
    home = maker.folder / "home"
    code, _, err = run(maker, *words[:-2], env={"PATH": os.environ["PATH"], "HOME": str(home)})
    expect(f"the usual place: {err}", (code, (home / ".local/state/lumen/libraries.json").exists()), (0, True))
    code, _, err = run(maker, *words[:-2], env={"PATH": os.environ["PATH"]})
    expect(f"no place: {err}", (code, "--state" in err), (1, True))
    both = [subprocess.Popen([maker.program, "library", *map(str, words[:-1]), maker.folder / "both.json"],
                             stdout=subprocess.DEVNULL) for _ in range(2)]
    expect("two at once", [p.wait() for p in both], [0, 0])
    # a revision that is not whole was not verified, so the whole one before it still is
    broken, late = maker.folder / "broken", maker.folder / "late.json"
    shutil.copytree(library, broken)
    (broken / "data/a/case.lumen").unlink()
    expect("a newer one with a file missing", answer(maker, "verify", broken, "--key", maker.public, "--state", late)[0], 3)
    expect("memory of it", json.loads(late.read_text())["libraries"] if late.exists() else {}, {})
    expect("the older one after it", answer(maker, *older, "--state", late)[0], 0)
    expect("the newer one, whole", answer(maker, "verify", library, "--key", maker.public, "--state", late)[0], 0)
    expect("the older one after that", [f["number"] for f in answer(maker, *older, "--state", late)[1]["faults"]], [764])


def resumed(maker, library):
    journal = maker.folder / "checked"
    time.sleep(4)  # what was changed just now could be changed again without a trace
    words = ("check", library, "--resume", journal)
    expect("the first check", answer(maker, *words)[1]["passed_over"], 0)
    code, told = answer(maker, *words)
    expect("the second check", (code, told["passed_over"], told["cases"]), (0, 3, 3))
    victim = library / "data/b/surface.glb"
    times, data = victim.stat(), bytearray(victim.read_bytes())
    data[len(data) // 2] ^= 1
    with open(victim, "r+b") as stream: stream.write(data)  # in place, and its time set back
    os.utime(victim, ns=(times.st_atime_ns, times.st_mtime_ns))
    code, told = answer(maker, *words)
    expect("a changed bit", (code, told["passed_over"], [f["number"] for f in told["faults"]]), (3, 2, [722]))
    data[len(data) // 2] ^= 1
    victim.write_bytes(bytes(data))
    kept = journal.read_bytes()
    journal.write_bytes(kept[:-10])
    code, told = answer(maker, *words)
    expect("a journal cut off", (code, told["passed_over"] < 3), (0, True))
    journal.write_text("something else")
    code, out, err = run(maker, *words)
    expect(f"no journal: {err}", (code, journal.read_text()), (3, "something else"))


def many_faults(maker, library):
    copy = maker.folder / "many"
    shutil.copytree(library, copy)
    for case in "abc":
        for file in ("surface.glb", "thumbnail.png"): (copy / "data" / case / file).write_bytes(b"")
        for i in range(50): (copy / "data" / case / f"stray {i}").write_text("")
    (copy / "manifest-sha256.txt").unlink()
    answers = {run(maker, "check", copy, "--json", "--threads", n)[1] for n in "1248"}
    expect("answers on 1, 2, 4 and 8 threads", len(answers), 1)
    told = json.loads(answers.pop())
    expect("all faults", (told["errors"], len(told["faults"]), told["complete"]), (157, 157, True))
    told = answer(maker, "check", copy, "--max-faults", "10")[1]
    expect("ten faults", (told["errors"], len(told["faults"]), told["complete"]), (157, 10, False))
    expect("one after the other", {f["case"] for f in told["faults"]}, {"a"})


def strictness(maker, library):
    maker.add(library, "d", maker.case("d"), "--picture", "none", "--consent", "given 1999-12-31")
    code, told = answer(maker, "check", library)
    expect("a date", (code, [f["number"] for f in told["faults"]]), (0, [741]))
    expect("a date with --strict", answer(maker, "check", library, "--strict")[0], 3)


def main():
    if len(sys.argv) not in (3, 4): sys.exit(__doc__)
    if missing := [p for p in ("minisign", "ssh-keygen") if not shutil.which(p)]:
        print(f"skipped: {', '.join(missing)} not found (Debian: minisign, openssh-client)")
        sys.exit(77)
    with tempfile.TemporaryDirectory(prefix="lumen-trust-") as folder:
        maker = Maker(Batch(pathlib.Path(sys.argv[2]).resolve()), pathlib.Path(folder))
        maker.program = pathlib.Path(sys.argv[1]).resolve()
        maker.make_signed()
        usual = (wrong_keys, only_the_signature_is_written, faulty_is_not_signed, remembered, resumed, many_faults, strictness)
        for check in (passwords,) if "--passwords" in sys.argv else usual:
            check(maker, maker.signed)
        maker.batch.end()
    print(f"{len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
