#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a reader of lumen cases over the conformance set: see README.md.

run.py --reader "CMD" [--lacks zstd] [--lacks draco] [--lacks motion] [--exact] [--queries-only] [--tolerance 1e-6] [--only TEXT]

Exit status: 0 all as expected, 1 not."""
import argparse, concurrent.futures, copy, json, os, pathlib, resource, shlex, subprocess, sys

import make

HERE = pathlib.Path(__file__).resolve().parent
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
    return make.f32_bits(a) == make.f32_bits(b)


def difference(expected, found, integer_arrays, path=()):
    """Where two cases in the JSON encoding differ, or None. Numbers are those of the field's type."""
    place = "/" + "/".join(map(str, path))
    if isinstance(expected, make.Number) and isinstance(found, make.Number):
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


def call(reader, file, questions):
    """Output of the reader as JSON, or the reason why there is none."""
    try:
        done = subprocess.run([*reader, str(file)], input=json.dumps(questions).encode(), capture_output=True, timeout=120)
        if done.returncode != 0:
            return f"exit status {done.returncode}: {done.stderr.decode(errors='replace')[-300:]}"
        return make.parse(done.stdout.decode())
    except (subprocess.TimeoutExpired, ValueError) as error:
        return f"no answer: {str(error)[:200]}"


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
    out = call(options.reader, file, questions)
    if isinstance(out, str): return out
    expected = make.parse((file.parent / f"{stem}.lumen.json").read_text())
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
    out = call(options.reader, file, [])
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
    parser.add_argument("--lacks", action="append", default=[], choices=["zstd", "draco", "motion"], help="encodings that the reader does not have; motion: it answers of the case at rest alone")
    parser.add_argument("--exact", action="store_true", help="places must be those of the reports")
    parser.add_argument("--queries-only", action="store_true", help="the reader answers queries and gives no case; binary files only")
    parser.add_argument("--tolerance", type=float, default=1e-6, help="of the numbers in answers; 1e-5 for a reader that computes with f32")
    parser.add_argument("--only", default="", help="files whose name contains this")
    options = parser.parse_args()
    options.reader = [sys.executable if word == "{python}" else word for word in options.reader]
    endings = (".lumen",) if options.queries_only else (".lumen", ".lumen.json")
    jobs = [(check, file) for check, folder in ((check_valid, "valid"), (check_hostile, "hostile"))
            for file in sorted((HERE / folder).iterdir())
            if file.name.endswith(endings) and options.only in file.name]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda job: job[0](options, job[1]), jobs))
    for (_, file), wrong in zip(jobs, results):
        if wrong: print(f"{file.relative_to(HERE)}: {wrong}")
    failed = sum(map(bool, results))
    valid = sum(check is check_valid for check, _ in jobs)
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss // 1024
    print(f"{valid} valid and {len(jobs) - valid} hostile files: {failed} not as expected; at most {memory} MiB of memory")
    sys.exit(1 if failed or not jobs else 0)


if __name__ == "__main__":
    main()
