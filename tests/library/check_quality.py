#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The gate over many cases: cases that need a person wait, open at their worst place, and keep their corrections.

check_quality.py LUMEN [--quick]

Its volume is a synthetic fork. --quick: one case, and the page at its worst place. Exit status: 0 all held, 1 not."""
import json, os, pathlib, signal, subprocess, sys, tempfile, time, urllib.request

OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))
failures = []


def expect(held, what):
    if not held:
        failures.append(what)
        print("FAILED:", what)


class Place:
    def __init__(self, lumen, folder): self.lumen, self.folder = lumen, folder

    def run(self, *words, code=0):
        done = subprocess.run([self.lumen, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=600)
        expect(done.returncode == code, f"lumen {' '.join(map(str, words))}: ended with {done.returncode}, not {code}: {done.stdout}{done.stderr}")
        return done

    def json(self, *words, code=0): return json.loads(self.run(*words, "--json", code=code).stdout)

    def build(self, *more, code=0):
        answer = self.json("library", "build", "list.csv", "lib", *more, code=code)
        return {row["id"]: row for row in answer["rows"]}, answer

    def labels(self, case):
        self.run("convert", case, "labels.lumen.json")
        return [branch["label"] for branch in json.loads((self.folder / "labels.lumen.json").read_text())["tree"]["branches"]]


class Viewer:
    """The command that a verdict prints, as a person runs it."""
    def __init__(self, place, words):
        self.process = subprocess.Popen([place.lumen, *words[1:], "--no-browser"], cwd=place.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.address = self.process.stdout.readline().strip()

    def state(self): return json.loads(OPENER.open(self.address + "state", timeout=60).read())

    def do(self, **request):
        body = json.dumps({**request, "revision": self.state()["revision"]}).encode()
        OPENER.open(urllib.request.Request(self.address + "do", data=body), timeout=60).read()
        while self.state()["job"]: time.sleep(0.05)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=60)
        expect(self.process.returncode == 0, f"the viewer: {errors}")


def prepare(place):
    place.run("phantom", "bifurcation", "fork.nrrd", "--size", "64", "--seeds", "fork.json")
    seeds = json.loads((place.folder / "fork.json").read_text())
    (place.folder / "trunk.json").write_text(json.dumps({**seeds, "branches": seeds["branches"][:1]}))
    place.run("convert", "fork.nrrd", "whole.lumen", "--seeds", "fork.json")
    place.run("convert", "fork.nrrd", "trunk.lumen", "--seeds", "trunk.json", "--seeds-only")
    return seeds["branches"]


def verdicts(place):
    """The words of the command that opens the worst place."""
    good = place.json("check", "fork.nrrd", "whole.lumen", "--profile", "screening")["verdict"]
    expect(good["passes"] and good["faults"] == [] and good["worst"] is None and good["view"] == [], f"a whole case: {good}")
    expect(place.json("check", "fork.nrrd", "whole.lumen")["verdict"] is None, "a verdict without a profile")
    answer = place.json("check", "fork.nrrd", "trunk.lumen", "--profile", "simulator", code=3)
    bad, missing = answer["verdict"], answer["missing_vessels"][0]
    found = {fault["measure"]: fault["found"] for fault in bad["faults"]}
    expect(not bad["passes"] and found.get("coverage_share") == answer["coverage_share"], f"{bad}")
    expect(bad["worst"]["measure"] != "coverage_share" or bad["worst"]["position"] == missing["position"], f"the worst place: {bad['worst']}, {missing}")
    expect(bad["view"][:4] == ["lumen", "view", "fork.nrrd", "trunk.lumen"] and bad["view"][4].startswith("--at="), f"{bad['view']}")
    text = place.run("check", "fork.nrrd", "trunk.lumen", "--profile", "simulator", code=3).stdout
    expect("profile simulator: needs a person" in text and " ".join(bad["view"]) in text, f"text: {text}")
    (place.folder / "ours.json").write_text('{"name": "ours", "least": {"coverage_share": 0.01}}')
    expect(place.json("check", "fork.nrrd", "trunk.lumen", "--profile", "ours.json")["verdict"]["profile"] == "ours", "a profile of one's own")
    done = place.run("check", "fork.nrrd", "trunk.lumen", "--profile", "simulater", code=2)
    expect("did you mean" in done.stderr, f"a wrong name: {done.stderr}")
    return bad


def looking(place, bad):
    viewer = Viewer(place, bad["view"])
    look = viewer.state()["look"]
    expect(look is not None and max(abs(a - b) for a, b in zip(look, bad["worst"]["position"])) < 0.006, f"the page looks at {look}")
    viewer.end()


def waiting_and_correcting(place, branches):
    place.run("library", "init", "lib", "--title", "Forks", "--licence", "CC0-1.0")
    head = "input,seeds,id,title,synthetic,--seeds-only,--repeat\n"
    rows = "fork.nrrd,trunk.json,trunk,Trunk,yes,true,{0}\nfork.nrrd,fork.json,whole,Whole,yes,,{0}\n"
    (place.folder / "list.csv").write_text(head + rows.format(""))
    (place.folder / "whole.json").write_text('{"name": "whole", "least": {"coverage_share": 0.8}}')
    ends, answer = place.build("--profile", "whole.json", code=3)
    expect((ends["trunk"]["end"], ends["whole"]["end"], answer["needs_person"]) == ("needs a person", "made", 1), f"{answer}")
    expect(ends["trunk"]["why"].startswith("needs a person: ") and ends["trunk"]["view"][0] == "lumen", f"{ends['trunk']}")
    expect(place.json("library", "list", "lib")["count"] == 1, "a case that waits is in the library")
    ends, _ = place.build("--profile", "whole.json", code=3)
    expect((ends["trunk"]["end"], ends["whole"]["end"]) == ("needs a person", "kept"), f"once more: {ends}")

    viewer = Viewer(place, ends["trunk"]["view"])
    viewer.do(op="rename", branch=0, label="corrected")
    for vessel in branches[1:]:
        points = [{"position": p["position"], "radius_mm": p.get("radius")} for p in vessel["points"]]
        viewer.do(op="track_from", label=vessel["label"], points=points)
    viewer.do(op="save")
    expect(len(place.labels(ends["trunk"]["view"][3])) > 1, "the missing vessel was not tracked")
    viewer.end()
    ends, _ = place.build("--profile", "whole.json")
    expect((ends["trunk"]["end"], ends["whole"]["end"]) == ("made", "kept"), f"after the correction: {ends}")
    expect("corrected" in place.labels("lib/data/trunk/case.lumen"), "the correction is not in the library")

    # another recipe: the name is given again, the click is reported
    (place.folder / "list.csv").write_text(head + rows.format("1"))
    ends, _ = place.build(code=3)
    expect((ends["trunk"]["end"], ends["whole"]["end"]) == ("needs a person", "made"), f"another recipe: {ends}")
    expect("corrections no longer fit: " in ends["trunk"]["why"] and "keeps no request" in ends["trunk"]["why"], f"{ends['trunk']}")
    expect("corrected" in place.labels(ends["trunk"]["view"][3]), "the correction is not made again")
    ends, _ = place.build(code=3)
    expect(ends["trunk"]["end"] == "needs a person", f"nobody has looked, and yet: {ends}")
    ends, _ = place.build("--accept", "trunk")
    expect(ends["trunk"]["end"] == "made" and place.labels("lib/data/trunk/case.lumen") == ["corrected"], f"accepted: {ends}")
    expect(not (place.folder / "lib.build").exists(), "the folder for work stays")
    place.run("library", "check", "lib")


def replaying(place):
    answer = place.json("convert", "fork.nrrd", "again.lumen", "--seeds", "trunk.json", "--seeds-only", "--corrections", "lib/data/trunk/case.lumen")
    expect(len(answer["corrections"]["made"]) == 1 and len(answer["corrections"]["left"]) >= 1, f"{answer['corrections']}")
    expect(place.labels("again.lumen") == ["corrected"], "a replay by hand")
    place.run("validate", "again.lumen", "--privacy")
    place.run("convert", "again.lumen", "x.glb", "--corrections", "whole.lumen", code=2)


def main():
    with tempfile.TemporaryDirectory() as folder:
        place = Place(str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(folder))
        branches = prepare(place)
        looking(place, verdicts(place))
        if "--quick" not in sys.argv:
            waiting_and_correcting(place, branches)
            replaying(place)
    sys.exit(1 if failures else 0)


main()
