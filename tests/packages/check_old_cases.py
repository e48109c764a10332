#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds lumen to the answers that earlier versions gave for the cases that they wrote.

check_old_cases.py LUMEN BLOB            compares, in every folder tests/data/cases-VERSION
check_old_cases.py LUMEN BLOB --make     writes answers.json of the folder of LUMEN's own version

BLOB is the shared library of libblob. Exit status: 0 all are the same, 1 some are not."""
import ctypes, json, pathlib, subprocess, sys, tempfile

DATA = pathlib.Path(__file__).resolve().parents[1] / "data"
NEAR = 1e-6  # mm


def run(lumen, *arguments, folder):
    result = subprocess.run([lumen, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=300)
    if result.returncode != 0: raise SystemExit(f"lumen {' '.join(map(str, arguments))}: {result.stderr}")
    return result.stdout


def open_library(path):
    """libblob by ctypes, without the Python package."""
    blob = ctypes.CDLL(path)
    blob.blob_model_open.argtypes = [ctypes.c_char_p, ctypes.c_void_p, ctypes.POINTER(ctypes.c_void_p)]
    blob.blob_query_many.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_size_t] + [ctypes.c_void_p] * 3
    blob.blob_query_many.restype = None
    blob.blob_model_close.argtypes = [ctypes.c_void_p]
    return blob


def distances(blob, case, tree):
    """Signed distances, mm, of places beside every fifth node: within the vessel, about its wall, and outside."""
    places = [c + share * radius * way[axis] for centre, radius in list(zip(tree["centre"], tree["radius"]))[::5]
              for share in (0.3, 0.95, 1.6) for way in ((1, 0, 0), (0, 0.6, -0.8)) for axis, c in enumerate(centre)]
    count, model = len(places) // 3, ctypes.c_void_p()
    if blob.blob_model_open(str(case).encode(), None, ctypes.byref(model)) != 0: raise SystemExit(f"libblob refuses {case}")
    points, samples = (ctypes.c_double * (3 * count))(*places), (ctypes.c_double * (9 * count))()
    cursors = (ctypes.c_uint32 * count)(*[0xFFFFFFFF] * count)
    blob.blob_query_many(model, 0, count, points, cursors, samples)
    blob.blob_model_close(model)
    return [samples[9 * i + 4] for i in range(count)]


def plain(answer):
    """An answer without what names the file or the folder: the command to type does, too."""
    return {key: value for key, value in answer.items() if key not in ("file", "files", "next")}


def answers_of(lumen, blob, case, work):
    ask = lambda *words: plain(json.loads(run(lumen, *words, "--json", "--quiet", folder=work)))
    answers = {"info": ask("info", case), "validate": ask("validate", case)}
    if answers["info"].get("blobs"):
        run(lumen, "convert", case, "text.lumen.json", "--quiet", folder=work)
        run(lumen, "convert", case, "raw.lumen", "--quiet", folder=work)  # libblob reads no compressed case
        tree = json.loads((work / "text.lumen.json").read_text())["tree"]
        answers["distances"] = distances(blob, work / "raw.lumen", tree)
    return answers


def named_as_now(answers):
    """Answers of lumen 0.1.0 with the keys of today: the rows of branches were `branch_table`, beside their number `branches`.
    Lengths were those of the line through the nodes, not of the smoothed axis, and are not compared."""
    info = answers["info"]
    if "branch_table" in info: info["branches"] = info.pop("branch_table")
    for one in (info, info.get("reachable") or {}, *info.get("branches", [])):
        for key in ("length_mm", "of_mm", "longest_tree_mm"): one.pop(key, None)
    return answers


def differ(found, expected):
    """Lists of numbers differ beyond the last digits, which may change between versions, and objects where a key is gone or has
    another value, as versions add keys; anything else at all."""
    if isinstance(expected, dict) and isinstance(found, dict):
        return any(key not in found or differ(found[key], value) for key, value in expected.items())
    if isinstance(expected, list) and isinstance(found, list):
        if expected and isinstance(expected[0], float):
            return len(found) != len(expected) or any(not abs(a - b) < NEAR for a, b in zip(found, expected))
        return len(found) != len(expected) or any(map(differ, found, expected))
    return found != expected


def opens_again(lumen, case, work):
    """The case, written by this version in both encodings and read again, has the same content."""
    before = plain(json.loads(run(lumen, "info", case, "--json", folder=work)))
    run(lumen, "convert", case, "again.lumen.json", "--quiet", folder=work)
    run(lumen, "convert", "again.lumen.json", "again.lumen", "--quiet", folder=work)
    return before == plain(json.loads(run(lumen, "info", "again.lumen", "--json", folder=work)))


def main(lumen, blob, make):
    version = run(lumen, "--version", folder=".").split()[1]
    folders = [DATA / f"cases-{version}"] if make else sorted(DATA.glob("cases-*"))
    compared, wrong = 0, []
    for folder in folders:
        kept = folder / "answers.json"
        expected = {} if make else json.loads(kept.read_text())
        cases = sorted([*folder.glob("*.lumen"), *folder.glob("*.lumen.json")])
        with tempfile.TemporaryDirectory() as work:
            found = {case.name: answers_of(lumen, blob, case, pathlib.Path(work)) for case in cases}
            wrong += [f"{case}: changes when it is written again" for case in cases if not opens_again(lumen, case, pathlib.Path(work))]
        if make: kept.write_text(json.dumps(found, indent=1) + "\n")
        elif set(found) != set(expected) or not found: wrong.append(f"{folder}: cases {sorted(found)}, answers for {sorted(expected)}")
        for case, answers in expected.items():
            for name, answer in named_as_now(answers).items():
                compared += 1
                if differ(found.get(case, {}).get(name), answer): wrong.append(f"{folder.name}/{case}: another answer of {name}")
    for line in wrong: print(line)
    print(f"{compared} answers of {len(folders)} versions compared, {len(wrong)} differ")
    return 1 if wrong or (not make and compared == 0) else 0


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["--make"]): sys.exit(__doc__)
    sys.exit(main(str(pathlib.Path(sys.argv[1]).resolve()), open_library(sys.argv[2]), sys.argv[3:] == ["--make"]))
