#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`lumen library build`: keeps going, tells what failed, makes again only what changed, and goes on where it was killed.

check_build.py LUMEN [--kills N]

Its inputs are synthetic centerlines, which are converted in a moment. Exit status: 0 all holds, 1 not."""
import argparse, hashlib, json, pathlib, random, signal, subprocess, sys, tempfile, time

HEAD = "input,id,targets,title,synthetic,licence\n"


def run(lumen, *words):
    return subprocess.run([str(lumen), *(str(w) for w in words)], capture_output=True, text=True)


def must(holds, what):
    if not holds: sys.exit(f"check_build.py: {what}")


def centerline(file, k):
    """A vessel of 20 mm with a side branch."""
    rows = [f"{i + 1} 0 {i} {0.02 * k * i} 0 {1.5 + 0.1 * k} {i if i else -1}" for i in range(21)]
    rows += [f"{22 + i} 0 {10 + 0.5 * i} {1 + i} 0 0.8 {11 if i == 0 else 21 + i}" for i in range(8)]
    file.write_text("# synthetic; mm, LPS\n" + "\n".join(rows) + "\n")


def built(lumen, folder, *more):
    done = run(lumen, "library", "build", folder / "list.csv", folder / "lib", "--jobs", 2, "--json", *more)
    return done, {row["id"]: row for row in json.loads(done.stdout)["rows"]} if done.stdout else {}


def prepare(lumen, folder, count):
    for k in range(count): centerline(folder / f"{k}.swc", k)
    (folder / "list.csv").write_text(HEAD + "".join(f"{k}.swc,tree-{k},svzerod,Tree {k},yes,CC0-1.0\n" for k in range(count)))
    done = run(lumen, "library", "init", folder / "lib", "--title", "Trees", "--licence", "CC0-1.0", "--date", "2026-11-22",
               "--id", "0b8f2ac0-58a8-4d3c-93c9-3f3f39f1f2a4")
    must(done.returncode == 0, done.stderr)


def contents(library):
    """Files of every case, without the statements of when it came (dates, revision)."""
    found = {}
    for file in sorted((library / "data").glob("*/**/*")):
        if file.is_file() and file.name not in ("record.json", "ro-crate-metadata.json"):
            found[file.relative_to(library).as_posix()] = hashlib.sha256(file.read_bytes()).hexdigest()
    return found


def check(lumen, library):
    done = run(lumen, "library", "check", library)
    must(done.returncode == 0, f"the library is not whole: {done.stdout}{done.stderr}")


def one_bad_row(lumen, folder):
    prepare(lumen, folder, 3)
    good = (folder / "1.swc").read_text()
    (folder / "1.swc").write_text("no numbers at all\n")
    done, rows = built(lumen, folder)
    must(done.returncode == 3, f"a bad input: exit code {done.returncode}, {done.stderr}")
    must([rows[f"tree-{k}"]["end"] for k in range(3)] == ["made", "failed", "made"], f"ends: {rows}")
    must("1.swc" in rows["tree-1"]["why"] and rows["tree-1"]["code"] == 3, f"why: {rows['tree-1']}")
    must("line 3 (tree-1)" in done.stderr, f"it is not told at once: {done.stderr}")
    check(lumen, folder / "lib")

    (folder / "1.swc").write_text(good)
    done, rows = built(lumen, folder)
    must(done.returncode == 0, done.stderr)
    must([rows[f"tree-{k}"]["end"] for k in range(3)] == ["kept", "made", "kept"], f"ends: {rows}")
    must(not (folder / "lib.build").exists(), "the folder for work stays, with nothing left to do")
    check(lumen, folder / "lib")


def a_folder_of_somebody_stays(lumen, folder):
    """Stands on one_bad_row()."""
    mine = folder / "mine"
    mine.mkdir()
    (mine / "thesis.txt").write_text("years of work")
    centerline(folder / "0.swc", 5)
    done, rows = built(lumen, folder, "--work", mine)
    must(done.returncode == 0 and rows["tree-0"]["end"] == "made", f"{rows} {done.stderr}")
    must((mine / "thesis.txt").read_text() == "years of work", "a folder that was there before went with its files")


def what_changed_is_made_again(lumen, folder):
    """Stands on one_bad_row()."""
    before = contents(folder / "lib")
    text = (folder / "list.csv").read_text()
    (folder / "list.csv").write_text(text.replace("Tree 0", "A better title").replace("tree-2,svzerod", "tree-2,svzerod;oned"))
    centerline(folder / "1.swc", 7)
    done, rows = built(lumen, folder)
    must(done.returncode == 0 and all(row["end"] == "made" for row in rows.values()), f"{rows} {done.stderr}")
    after = contents(folder / "lib")
    must(after["data/tree-0/case.lumen"] == before["data/tree-0/case.lumen"], "a title changed the case")
    must(after["data/tree-1/case.lumen"] != before["data/tree-1/case.lumen"], "another input, the same case")
    must(any(name.startswith("data/tree-2/exports/oned/") for name in after), "the new export is not there")
    record = json.loads((folder / "lib/data/tree-0/record.json").read_text())
    must(record["version"] == 2 and record["title"] == "A better title", f"record: {record['version']}, {record['title']}")
    done, rows = built(lumen, folder)
    must(all(row["end"] == "kept" for row in rows.values()), f"not kept: {rows}")
    check(lumen, folder / "lib")


def killed_again_and_again(lumen, folder, kills):
    prepare(lumen, folder, 6)
    random.seed(1)
    took = 3.0
    for k in range(kills):
        child = subprocess.Popen([lumen, "library", "build", folder / "list.csv", folder / "lib", "--jobs", "2", "--quiet"],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        begin = time.monotonic()
        try:
            child.wait(random.uniform(0.05, took))
            break
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGKILL if k % 2 else signal.SIGINT)
            child.wait()
        must(time.monotonic() - begin < 600, "it did not end")
        check(lumen, folder / "lib")
    done, rows = built(lumen, folder)
    must(done.returncode == 0 and len(rows) == 6, done.stderr)
    check(lumen, folder / "lib")
    with tempfile.TemporaryDirectory() as other:
        other = pathlib.Path(other)
        prepare(lumen, other, 6)
        must(built(lumen, other)[0].returncode == 0, "an undisturbed run fails")
        must(contents(folder / "lib") == contents(other / "lib"), "interrupted and undisturbed runs differ")


def goes_on_beside_rows_with_faults(lumen, folder):
    prepare(lumen, folder, 2)
    (folder / "list.csv").write_text(HEAD + "9.swc,lost,,A,yes,CC0-1.0\n0.swc,tree-0,nowhere,A,yes,CC0-1.0\n1.swc,tree-1,,A,yes,CC0-1.0\n"
                                     "1.swc,tree-1,,B,yes,CC0-1.0\n")
    done, rows = built(lumen, folder)
    must(done.returncode == 3 and not rows and not (folder / "lib.build").exists(), f"not refused as a whole: {done.stdout}")
    for line in (2, 3, 5): must(f"line {line}: " in done.stderr, f"line {line} is not reported: {done.stderr}")
    done = run(lumen, "library", "build", folder / "list.csv", folder / "lib", "--json", "--keep-going")
    answer = json.loads(done.stdout)
    must(done.returncode == 3 and (answer["made"], answer["failed"]) == (1, 3), f"{done.returncode}, {answer}")
    must([(row["row"], row["end"]) for row in answer["rows"]] == [(2, "failed"), (3, "failed"), (4, "made"), (5, "failed")], f"{answer['rows']}")
    must("input: there is no " in answer["rows"][0]["why"] and "nowhere" in answer["rows"][1]["why"], f"why: {answer['rows']}")
    check(lumen, folder / "lib")


def refused(lumen, folder):
    prepare(lumen, folder, 1)
    for text, code, said in (
            ("input,id,title\n0.swc,a,A\n", 3, "line 2: "),  # no consent, not synthetic
            (HEAD + "0.swc,a,nowhere,A,yes,CC0-1.0\n", 3, 'targets: found "nowhere"'),
            (HEAD.strip() + ",--ray\n0.swc,a,,A,yes,CC0-1.0,42\n", 3, "--ray: lumen convert has no such option"),
            (HEAD + "0.swc,a,,,yes,CC0-1.0\n", 3, "title: is empty"),
            (HEAD + "9.swc,a,,A,yes,CC0-1.0\n", 3, "input: there is no ")):
        (folder / "list.csv").write_text(text)
        done, _ = built(lumen, folder)
        must(done.returncode == code and said in done.stderr, f"{text!r}: {done.returncode}, {done.stderr}")
        must(not (folder / "lib.build").exists(), "work was begun before the list was refused")
    done = run(lumen, "library", "build", folder / "list.csv", folder / "nowhere")
    must(done.returncode == 3, f"no library: {done.returncode}, {done.stderr}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("lumen")
    parser.add_argument("--kills", type=int, default=12)
    options = parser.parse_args()
    lumen = pathlib.Path(options.lumen).resolve()
    whole = [(one_bad_row, what_changed_is_made_again, a_folder_of_somebody_stays), (refused,), (goes_on_beside_rows_with_faults,)]
    if options.kills: whole.append((lambda lumen, folder: killed_again_and_again(lumen, folder, options.kills),))
    for steps in whole:
        with tempfile.TemporaryDirectory() as folder:
            for step in steps: step(lumen, pathlib.Path(folder))


main()
