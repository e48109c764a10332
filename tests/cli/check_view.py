#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""lumen view as a user starts and ends it.

check_view.py LUMEN"""
import json, os, pathlib, signal, subprocess, sys, tempfile, time, urllib.error, urllib.request

LUMEN = str(pathlib.Path(sys.argv[1]).resolve())
OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))
failures = 0


def expect(what, found, wanted):
    global failures
    if found == wanted: return
    failures += 1
    print(f"FAILED: {what}: found {found!r}, expected {wanted!r}")


def run(*words, cwd):
    return subprocess.run([LUMEN, *words], cwd=cwd, capture_output=True, text=True)


class Viewer:
    """A running `lumen view`, whose temporary files lie in a folder of their own."""
    def __init__(self, *words, cwd, **variables):
        self.temporary = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen([LUMEN, "view", *words, "--no-browser"], cwd=cwd, text=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, env={**os.environ, "TMPDIR": self.temporary.name, **variables})
        self.address = self.process.stdout.readline().strip()

    def get(self, name):
        with OPENER.open(self.address + name, timeout=60) as answer: return answer.read()

    def post(self, name, body):
        with OPENER.open(urllib.request.Request(self.address + name, data=body), timeout=60) as answer:
            return json.loads(answer.read())

    def state(self): return json.loads(self.get("state"))

    def do(self, **request):
        return self.post("do", json.dumps({**request, "revision": self.state()["revision"]}).encode())

    def wait(self):
        while self.state()["job"]: time.sleep(0.05)

    def end(self, number=signal.SIGINT):
        self.process.send_signal(number)
        _, err = self.process.communicate(timeout=60)
        left = os.listdir(self.temporary.name)
        self.temporary.cleanup()
        return self.process.returncode, err, left


def survive_kill(where):
    """Unsaved work is on disk within seconds, and offered after a kill that nothing can catch."""
    kept = where / "tube.unsaved.2.lumen"  # the first name is taken by what main() has left
    killed = Viewer("tube.lumen", cwd=where)
    killed.do(op="rename", branch=0, label="survivor")
    while not kept.exists(): time.sleep(0.1)  # its name appears with all of it
    killed.end(signal.SIGKILL)
    expect("valid after a kill", run("validate", kept.name, cwd=where).returncode, 0)
    again = Viewer("tube.lumen", cwd=where)
    expect("offered", [file["name"] for file in again.state()["unsaved_before"]], ["tube.unsaved.2.lumen", "tube.unsaved.lumen"])
    again.do(op="recover", name=kept.name)
    again.wait()
    again.do(op="save")
    code, err, _ = again.end()
    expect("end after recovering", code, 0)
    expect("reported", f"{kept.name} holds work that was not saved" in err, True)
    expect("recovered", run("info", "tube.lumen", cwd=where).stdout.count("survivor") > 0, True)


def survive_hangup(where):
    """Edits of the last seconds are on disk when the terminal goes away."""
    viewer = Viewer("other.lumen", cwd=where)
    viewer.do(op="rename", branch=0, label="hangup")
    code, err, left = viewer.end(signal.SIGHUP)
    expect("end at SIGHUP", (code, left), (0, []))
    expect("kept at SIGHUP", run("info", "other.unsaved.lumen", cwd=where).stdout.count("hangup") > 0, True)
    (where / "other.unsaved.lumen").unlink()


def keep_without_a_file(where):
    """Unsaved work of a document without a named file is in the user's state folder, and offered from any folder."""
    state, empty = where / "state", where / "empty"
    empty.mkdir()
    viewer = Viewer(cwd=empty, XDG_STATE_HOME=str(state))
    viewer.post("file?name=tube.lumen", (where / "tube.lumen").read_bytes())
    viewer.wait()
    viewer.do(op="rename", branch=0, label="homeless")
    code, err, _ = viewer.end()
    kept = state / "lumen" / "lumen.unsaved.lumen"
    expect("kept without a file", (code, kept.exists(), str(kept) in err), (0, True, True))
    expect("nothing in the current folder", os.listdir(empty), [])
    again = Viewer(cwd=where, XDG_STATE_HOME=str(state))
    expect("offered without a file", [file["name"] for file in again.state()["unsaved_before"]], ["lumen.unsaved.lumen"])
    again.do(op="forget", name=kept.name)
    again.end()
    expect("forgotten", kept.exists(), False)


def see_two_volumes(where):
    run("phantom", "tube", "second.nrrd", "--size", "40", cwd=where)
    viewer = Viewer("tube.nrrd", "second.nrrd", cwd=where)
    state = viewer.state()
    expect("two volumes", (state["title"], state["second"]["name"]), ("tube.nrrd", "second.nrrd"))
    viewer.end()
    for words, message in ((("tube.nrrd", "second.nrrd", "tube.nrrd"), "two volumes can be seen together"),
                           (("tube.nrrd", "second.nrrd", "--html", "page.html"), "--html shows one volume")):
        answer = run("view", "--no-browser" if len(words) == 3 else "--json", *words, cwd=where)
        expect(message, (answer.returncode, message in answer.stderr), (2, True))
    (where / "second.nrrd").unlink()


def look_at_folder(where):
    folder = Viewer(".", cwd=where)
    library = json.loads(folder.get("library"))
    expect("cases of the folder", [case["name"] for case in library["cases"]], ["other.lumen", "tube.lumen"])
    folder.do(op="open_case", index=1)
    folder.wait()
    expect("opened", (folder.state()["title"], folder.state()["save_as"]), ("tube.lumen", "tube.lumen"))
    expect("end of the folder", folder.end()[0], 0)
    answer = run("view", ".", "--html", "page.html", cwd=where)
    expect("a folder as one file", answer.returncode, 2)


def main():
    with tempfile.TemporaryDirectory() as folder:
        where = pathlib.Path(folder)
        expect("phantom", run("phantom", "tube", "tube.nrrd", "--size", "48", "--seeds", "seeds.json", cwd=folder).returncode, 0)

        first = Viewer("tube.nrrd", "tube.lumen", "seeds.json", cwd=folder)
        expect("address", first.address.startswith("http://127.0.0.1:") and len(first.address.split("/")[3]) == 32, True)
        state = first.state()
        expect("no path", [folder in first.get(name).decode() for name in ("", "state")], [False, False])
        expect("new case", (state["has_volume"], state["has_case"], state["save_as"], len(state["seeds"])), (True, False, "tube.lumen", 1))
        first.do(op="track", labels=None)
        first.wait()
        expect("tracked", first.state()["has_case"], True)
        first.do(op="save")
        expect("valid", run("validate", "tube.lumen", cwd=folder).returncode, 0)
        expect("the same as lumen convert's", run("convert", "tube.nrrd", "other.lumen", "--seeds", "seeds.json", "--seeds-only", cwd=folder).returncode, 0)
        expect("bytes", (where / "tube.lumen").read_bytes() == (where / "other.lumen").read_bytes(), True)

        second = Viewer("tube.lumen", cwd=folder)
        expect("a second one", second.state()["has_case"], True)
        second.do(op="rename", branch=0, label="renamed")
        second.do(op="save")
        first.do(op="rename", branch=0, label="mine")
        try:
            first.do(op="save")
            expect("overwriting", "done", "refused")
        except urllib.error.HTTPError as error:
            expect("overwriting", error.code, 409)
        first.post("file?name=x.stl", b"solid x\n")
        first.wait()
        code, err, left = first.end()
        expect("exit code after Ctrl-C", code, 0)
        expect("temporary files", left, [])
        expect("rescued", (where / "tube.unsaved.lumen").exists() and "tube.unsaved.lumen" in err, True)
        expect("the file of the other", run("info", "tube.lumen", cwd=folder).stdout.count("renamed") > 0, True)
        code, err, left = second.end(signal.SIGTERM)
        expect("exit code after SIGTERM", (code, left), (0, []))
        expect("nothing to rescue", "unsaved" in err, False)
        survive_kill(where)
        survive_hangup(where)
        look_at_folder(where)
        keep_without_a_file(where)
        see_two_volumes(where)
        if (pathlib.Path(LUMEN).parent / "../../viewer/page/page.js").exists():
            answer = run("view", "tube.lumen", "--html", "page.html", "--json", "--quiet", cwd=folder)
            expect("one file", answer.returncode, 0)
            html = (where / "page.html").read_text()
            expect("no address", "http-equiv=\"Content-Security-Policy\"" in html and "connect-src" not in html, True)
            expect("no path", folder in html, False)
        else:
            print("the page was not built: --html is not tested")
            expect("without the page", run("view", "tube.lumen", "--html", "page.html", cwd=folder).returncode, 1)
    sys.exit(1 if failures else 0)


main()
