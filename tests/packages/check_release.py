#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs packages/release.sh on a small repository, with one kind that can be built and one that cannot.

check_release.py: expects sums of all files, the failed kind by name with exit status 1, the same bytes in a second run, a
signature of minisign that holds, and the words "not signed" without a key. Exit status: 0 all is well, 1 something is not,
77 git is missing."""
import hashlib, os, pathlib, shutil, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
failures = []


def check(holds, text):
    if not holds:
        failures.append(text)
        print(text)


def run(*command, folder, **environment):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, cwd=folder, timeout=60,
                          env=dict(os.environ, HOME=str(folder), **environment))


def kind(root, name, line):
    script = root / "packages" / name / "build.sh"
    script.parent.mkdir(parents=True)
    script.write_text(f"#!/bin/sh\n{line}\n")
    script.chmod(0o755)


def make_repository(root):
    kind(root, "good", 'echo content >"$1/good.txt"')
    kind(root, "torn", "exit 3")
    shutil.copy(ROOT / "packages/release.sh", root / "packages")
    (root / "CMakeLists.txt").write_text("project(lumen VERSION 7.8.9 LANGUAGES C)\n")
    (root / ".gitignore").write_text("/dist/\n")
    for words in (["init", "-q"], ["add", "."], ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-m", "one"]):
        done = run("git", *words, folder=root)
        check(done.returncode == 0, f"git: {done.stderr}")


def check_sums(dist):
    lines = (dist / "SHA256SUMS").read_text().splitlines()
    sums = {line[66:]: line[:64] for line in lines}
    check(set(sums) == {"good.txt", "lumen-7.8.9.tar.gz"}, f"SHA256SUMS lists {sorted(sums)}")
    for name, digest in sums.items():
        check(hashlib.sha256((dist / name).read_bytes()).hexdigest() == digest, f"the digest of {name}")


def check_signature(root):
    if not shutil.which("minisign"): return print("minisign is missing: signatures are not tried")
    made = run("minisign", "-G", "-W", "-p", root / "key.pub", "-s", root / "key", folder=root)
    if made.returncode: return print(f"minisign makes no key without a password: {made.stderr}")
    done = run("packages/release.sh", "good", folder=root, LUMEN_MINISIGN_KEY=str(root / "key"))
    check(done.returncode == 0, f"with a key: {done.stdout}{done.stderr}")
    verify = ("minisign", "-V", "-p", root / "key.pub", "-m", "dist/SHA256SUMS")
    check(run(*verify, folder=root).returncode == 0, "the signature does not hold")
    with open(root / "dist/SHA256SUMS", "a") as sums: sums.write("x\n")
    check(run(*verify, folder=root).returncode != 0, "the signature holds for other sums")


def main():
    if not shutil.which("git"): return 77
    with tempfile.TemporaryDirectory(prefix="lumen-release-") as folder:
        root = pathlib.Path(folder)
        make_repository(root)
        no_keys = {"LUMEN_MINISIGN_KEY": "", "LUMEN_GPG_KEY": ""}
        done = run("packages/release.sh", folder=root, **no_keys)
        check(done.returncode == 1, f"a torn kind: exit status {done.returncode}")
        check("not built: torn" in done.stderr, f"the torn kind is not named: {done.stderr}")
        check("is not signed" in done.stdout, f"no word on the signature: {done.stdout}")
        check_sums(root / "dist")
        first = (root / "dist/SHA256SUMS").read_bytes()
        run("packages/release.sh", folder=root, **no_keys)
        check((root / "dist/SHA256SUMS").read_bytes() == first, "a second run makes other bytes")
        check(run("packages/release.sh", "nothing", folder=root, **no_keys).returncode == 1, "a kind that does not exist")
        check_signature(root)
    print(f"{len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
