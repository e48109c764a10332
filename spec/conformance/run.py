#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a reader of lumen cases over the conformance set: see README.md.

run.py --reader "CMD" [--lines] [--set FOLDER] [--lacks zstd] [--lacks draco] [--lacks motion] [--exact] [--queries-only]
       [--tolerance 1e-6] [--only TEXT]

Exit status: 0 all as expected, 1 not."""
import argparse, concurrent.futures, copy, json, os, pathlib, resource, shlex, subprocess, sys, tempfile, threading

import encoding, make

PATIENCE = 120  # seconds until an answer
OPTIONAL = ("links", "otherChunks", "nodeArrays", "extensionsUsed", "extensionsRequired", "unit")  # where empty is absent
NOT_COMPARED = ("format", "version", "minimumReader")
INTEGERS = ("branches", "parent", "branch", "links", "offset", "otherChunks", "node")  # of these keys, numbers are integers


def same_number(a, b, path, integer_arrays):
    """Whether two decimals are the same number of the type of their field."""
    if path[:1] == ("nodeArrays",): whole = path[1] in integer_arrays
    else: whole = path[-1] != "meanInlierRate" and any(key in path for key in INTEGERS)
    if path[:1] == ("metadata",) and not set(a + b) & set(".eE") or whole:
        return int(a) == int(b)
    if path[:1] == ("metadata",) or path[-1] in ("kernelParameter", "isoLevel", "period") or "time" in path:
        return float(a) == float(b)
    return encoding.f32_bits(a) == encoding.f32_bits(b)


def difference(expected, found, integer_arrays, path=()):
    """Where two cases in the JSON encoding differ, or None. Numbers are those of the field's type."""
    place = "/" + "/".join(map(str, path))
    if isinstance(expected, encoding.Number) and isinstance(found, encoding.Number):
        if "parameters" in path and bool(set(expected) & set(".eE")) != bool(set(found) & set(".eE")):
            return f"{place}: {found}, expected {expected}: integers and reals are kept apart"
        return None if same_number(expected, found, path, integer_arrays) else f"{place}: {found}, expected {expected}"
    if type(expected) is not type(found):
        return f"{place}: {json.dumps(found)[:80]}, expected {json.dumps(expected)[:80]}"
    if isinstance(expected, dict):
        if set(expected) != set(found):
            return f"{place}: keys {sorted(found)}, expected {sorted(expected)}"
        pairs = [(expected[key], found[key], key) for key in expected]
    elif isinstance(expected, list):
        if len(expected) != len(found):
            return f"{place}: {len(found)} entries, expected {len(expected)}"
        pairs = zip(expected, found, range(len(expected)))
    else:
        return None if expected == found else f"{place}: {found!r}, expected {expected!r}"
    return next(filter(None, (difference(e, f, integer_arrays, path + (key,)) for e, f, key in pairs)), None)


def normal(value, path=()):
    """Without comments and empty optional values."""
    if isinstance(value, list):
        return [normal(x, path + (i,)) for i, x in enumerate(value)]
    if not isinstance(value, dict):
        return value
    free = path[-1:] == ("parameters",) or path == ("nodeArrays",)
    return {key: normal(x, path + (key,)) for key, x in value.items()
            if free or not (key.startswith("x-") or (key in OPTIONAL and x in ([], {}, "")))}


def remove(case, pointer):
    *path, last = pointer.strip("/").split("/")
    for key in path:
        case = case[int(key)] if isinstance(case, list) else case.get(key, {})
    case.pop(last, None)


class EachFile:
    """A reader that is started once for each file. Its answers are the output as JSON, or the reason why there is none."""

    def __init__(self, command):
        self.command = command

    def call(self, file, questions):
        try:
            done = subprocess.run([*self.command, str(file)], input=json.dumps(questions).encode(), capture_output=True, timeout=PATIENCE)
            if done.returncode != 0:
                return f"exit status {done.returncode}: {done.stderr.decode(errors='replace')[-300:]}"
            return encoding.parse(done.stdout.decode())
        except (subprocess.TimeoutExpired, ValueError) as error:
            return f"no answer: {str(error)[:200]}"

    def end(self):
        return None


class Lines:
    """A reader that is started once, and again after a file at which it ended or gave no answer."""

    def __init__(self, command):
        self.command, self.process = command, None

    def call(self, file, questions):
        if self.process is None:
            self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        timer = threading.Timer(PATIENCE, self.process.kill)
        timer.start()
        try:
            self.process.stdin.write(json.dumps({"file": str(file), "questions": questions}).encode() + b"\n")
            self.process.stdin.flush()
            return encoding.parse(self.process.stdout.readline().decode())
        except (OSError, ValueError) as error:
            self.process.kill()
            return f"no answer: {str(error)[:200]}, exit status {self.end()}"
        finally:
            timer.cancel()

    def end(self):
        """Closes the reader's input, and waits for its end: its exit status, or None for 0."""
        if self.process is None: return None
        try:
            self.process.stdin.close()
        except OSError:
            pass  # the reader has ended, and what was meant for it cannot be written
        self.process.stdout.close()
        status, self.process = self.process.wait(), None
        return status or None


def wrong_answer(expected, found, keys, tolerance):
    """First deviation of an answer from the expected one, or None. A vector's numbers are right to a share of its largest."""
    for key in sorted(keys & set(expected)):
        want, have = expected[key], found.get(key)
        if isinstance(want, dict):
            wrong = wrong_answer(want, have, set(want), tolerance) if isinstance(have, dict) else f"is {have}"
            if wrong: return f"{key}: {wrong}"
        elif isinstance(want, bool) or key == "node":
            if have is None or (have if isinstance(have, bool) else int(have)) != want: return f"{key} is {have}, expected {want}"
        else:
            wants, haves = (want, have) if isinstance(want, list) else ([want], [have])
            allowed = tolerance * max(1, *map(abs, wants))
            if not isinstance(haves, list) or len(haves) != len(wants) or None in haves or any(
                    not abs(w - float(h)) <= allowed for w, h in zip(wants, haves)):
                return f"{key} is {have}, expected {want}"
    return None


def other_case(expected, found, left_out):
    """Where the case that a reader found differs from the expected one, or None."""
    expected = copy.deepcopy(expected)
    for pointer in left_out: remove(expected, pointer)
    for key in NOT_COMPARED: found.pop(key, None)
    integer_arrays = {a["name"] for a in expected["metadata"].get("nodeArrays", ()) if a["type"] != "f32"}
    return difference(normal(expected), normal(found), integer_arrays)


def check_valid(options, file):
    stem = file.name.split(".")[0]
    about = json.loads((file.parent / f"{stem}.queries.json").read_text())
    if "motion" in options.lacks: about["queries"] = [q for q in about["queries"] if "time" not in q]
    questions = [{key: q[key] for key in ("point", "current", "time") if key in q} for q in about["queries"]]
    out = options.reader.call(file, questions)
    if isinstance(out, str): return out
    expected = encoding.parse((file.parent / f"{stem}.lumen.json").read_text())
    gone = [k for e in options.lacks for k in about["lacking"].get(e, ())] if file.suffix == ".lumen" else []
    if gone and not out.get("accepted"):
        return None if out.get("code") == "CHUNK_ENCODING" else f"refused as {out.get('code')}, expected CHUNK_ENCODING"
    if options.queries_only and out.get("code") == "NO_MODELS" and "models" not in expected: return None
    if not out.get("accepted"): return f"refused as {out.get('code')} at {out.get('place')}: {out.get('message', '')}"
    if not options.queries_only:
        if "refuse" in gone: return "accepted without a critical chunk"
        wrong = other_case(expected, out.get("case", {}), [*about["ignored"], *NOT_COMPARED, *gone])
        if wrong: return f"another case, at {wrong}"
    keys = {"node"} if options.queries_only else {"node", "power"}
    if "models" in expected and "models" not in gone: keys |= {"value", "gradient", "inside", "blended"}
    if len(out["answers"]) != len(questions): return f"{len(out['answers'])} answers to {len(questions)} questions"
    for query, have in zip(about["queries"], out["answers"]):
        wrong = wrong_answer(query, have, keys, options.tolerance)
        if wrong: return f"at {query['point']}: {wrong}"
    return None


def place_is_right(report, out, exact):
    """The stated byte lies where the fault is, or the stated pointer leads to the value or to what holds it."""
    places = [str(out[key]) for key in ("place", "pointer") if key in out]
    if exact: return "place" not in report or report["place"] in places
    if not ("within" in report or "pointer" in report): return True
    for place in places:
        if place.startswith("byte ") and "within" in report:
            if any(first <= int(place[5:]) <= last for first, last in report["within"]): return True
        pointer = report.get("pointer")
        if pointer is not None and place in (pointer, pointer.rpartition("/")[0]): return True
        if pointer is not None and place.rpartition("/")[0] == pointer: return True
    return False


def check_hostile(options, file):
    report = json.loads((file.parent / (file.name.split(".")[0] + ".report.json")).read_text())
    out = options.reader.call(file, [])
    if isinstance(out, str): return out
    if options.queries_only:
        accepted = out.get("accepted") or out.get("code") == "NO_MODELS"
        return f"accepted: {report['fault']}" if accepted and not report.get("unread") else None
    for encoding in options.lacks:
        allowed = report.get("basic", {}).get(encoding, ())
        if (out["accepted"] and "accepted" in allowed) or out.get("code") in allowed: return None
    if out.get("accepted"): return f"accepted, expected {report['code']}: {report['fault']}"
    if out.get("code") not in report["code"]: return f"refused as {out.get('code')} at {out.get('place')}, expected {report['code']}"
    if "case" in out: return "refused, but with a part of a case"
    return None if place_is_right(report, out, options.exact) else (
        f"{out['code']} at {out.get('place')} {out.get('pointer', '')}, expected it at {report.get('place', '')} {report.get('pointer', '')}")


def main():
    parser = argparse.ArgumentParser(description="Runs a reader over the conformance set; see README.md.")
    parser.add_argument("--reader", required=True, type=shlex.split, help="command, to which the name of a file is added; {python} is the Python that runs this")
    parser.add_argument("--lines", action="store_true", help="the command is started once, and is given the files as lines of its input")
    parser.add_argument("--set", type=pathlib.Path, help="folder in which make.py has made the set; without it, the set is made in a temporary one")
    parser.add_argument("--lacks", action="append", default=[], choices=["zstd", "draco", "motion"], help="encodings that the reader does not have; motion: it answers of the case at rest alone")
    parser.add_argument("--exact", action="store_true", help="places must be those of the reports")
    parser.add_argument("--queries-only", action="store_true", help="the reader answers queries and gives no case; binary files only")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="of the numbers in answers; 1e-5 for a reader that computes with f32")
    parser.add_argument("--only", default="", help="files whose name contains this")
    options = parser.parse_args()
    command = [sys.executable if word == "{python}" else word for word in options.reader]
    options.reader = (Lines if options.lines else EachFile)(command)
    if options.set: sys.exit(run(options))
    with tempfile.TemporaryDirectory(prefix="lumen-conformance-") as folder:
        options.set = pathlib.Path(folder)
        make.write(options.set)
        sys.exit(run(options))


def run(options):
    """The exit status."""
    endings = (".lumen",) if options.queries_only else (".lumen", ".lumen.json")
    jobs = [(check, file) for check, folder in ((check_valid, "valid"), (check_hostile, "hostile"))
            for file in sorted((options.set / folder).iterdir())
            if file.name.endswith(endings) and options.only in file.name]
    with concurrent.futures.ThreadPoolExecutor(1 if options.lines else os.cpu_count()) as pool:
        results = list(pool.map(lambda job: job[0](options, job[1]), jobs))
    for (_, file), wrong in zip(jobs, results):
        if wrong: print(f"{file.relative_to(options.set)}: {wrong}")
    failed = sum(map(bool, results))
    if status := options.reader.end():
        print(f"the reader ended with exit status {status}")
        failed += 1
    valid = sum(check is check_valid for check, _ in jobs)
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
    print(f"{valid} valid and {len(jobs) - valid} hostile files: {failed} not as expected; at most {memory} MiB of memory")
    return 1 if failed or not jobs else 0


if __name__ == "__main__":
    main()
