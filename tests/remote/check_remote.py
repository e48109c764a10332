#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Files and libraries by address, from a server with faults on the loopback interface.

check_remote.py LUMEN

Exit status: 0 all held, 1 not, 77 without curl."""
import json, os, pathlib, shutil, signal, subprocess, sys, tempfile, time, urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "tests/cli"), str(ROOT / "tests/library")]
from batch import Program
from fault_server import FaultServer
from made import Maker, digest

failures = []


def expect(held, what):
    if not held:
        failures.append(what)
        print("FAILED:", what)


class Place:
    def __init__(self, lumen, folder):
        self.lumen, self.folder, self.scratch = lumen, folder, folder / "scratch"
        self.scratch.mkdir()
        self.environment = {**os.environ, "TMPDIR": str(self.scratch), "no_proxy": "127.0.0.1", "NO_PROXY": "127.0.0.1",
                            "XDG_STATE_HOME": str(folder / "state")}

    def run(self, *words, code=0, **variables):
        done = subprocess.run([self.lumen, *map(str, words)], cwd=self.folder, env={**self.environment, **variables},
                              capture_output=True, text=True, timeout=300)
        expect(done.returncode == code, f"lumen {' '.join(map(str, words))}: ended with {done.returncode}, not {code}: {done.stderr}")
        expect(not os.listdir(self.scratch), f"{words}: leaves {os.listdir(self.scratch)}")
        return done

    def json(self, *words, **more): return json.loads(self.run(*words, "--json", **more).stdout)


def headers_alone(place, server):
    """lumen info asks for the beginning of a file, and reads no more."""
    size = (place.folder / "a.lumen").stat().st_size
    server.taken()
    far = place.json("info", server.address("plain", "a.lumen"))
    log = server.taken()
    expect([(r["range"], r["sent"]) for r in log] == [("bytes=0-4159", 4160)], f"requests for a case's header: {log}")
    expect(far.pop("fetched") == [dict(address=server.address("plain", "a.lumen"), bytes=size, read=4160, sha256=None)], "fetched")
    near = place.json("info", "a.lumen", "--chunks")
    expect(near.pop("fetched") == [], "a local file was fetched")
    for chunk in near["chunks"]: chunk["intact"] = None
    expect(far == near, "the header of a case elsewhere is another")
    expect(far["counts"]["nodes"] == place.json("info", "a.lumen")["nodes"], f"counts: {far['counts']}")
    for name in ("tube.nii", "tube.nrrd", "tube.nii.gz", "tube.mha"):
        far, log = place.json("info", server.address("plain", name)), server.taken()
        whole = (place.folder / name).stat().st_size
        expect([r["range"] for r in log] == ["bytes=0-65535"], f"requests for a volume's header: {log}")
        expect(far.pop("fetched")[0]["bytes"] == whole, "size of a volume")
        near = place.json("info", name)
        near.pop("fetched")
        expect(far == near, f"{name}: the header elsewhere is another: {far} {near}")
    done = place.run("info", server.address("noranges", "a.lumen"))
    expect("does not send parts" in done.stderr and digest(place.folder / "a.lumen") in done.stdout, f"without ranges: {done}")


def whole_files(place, server):
    """Faults of a server cost time, never bytes."""
    want, size = digest(place.folder / "a.lumen"), (place.folder / "a.lumen").stat().st_size
    for fault, requests in (("plain", 1), ("cut", 2), ("noranges", 1), ("norangescut", 2), ("wrongrange", 3), ("slow", 1), ("busy", 3), ("redirect", 2)):
        server.taken()
        answer = place.json("validate", server.address(fault, "a.lumen?key=secret"))
        expect(answer["fetched"] == [dict(address=server.address(fault, "a.lumen"), bytes=size, read=size, sha256=want)], f"{fault}: {answer['fetched']}")
        log = server.taken()
        expect(len(log) == requests, f"{fault}: {log}")
        expect("secret" not in json.dumps(answer) and log[0]["query"] == "?key=secret", f"{fault}: the query")
    for fault, name, code, said in (("short", "a.lumen", 1, "breaks off after"), ("tofile", "a.lumen", 1, "does not follow"),
                                    ("plain", "no.lumen", 3, "no such file (HTTP status 404)"), ("page", "tube.nrrd", 3, "is a web page")):
        done = place.run("info" if fault == "page" else "validate", server.address(fault, name) + "?key=secret", code=code)
        expect(said in done.stderr and server.address(fault, name) in done.stderr and "secret" not in done.stderr + done.stdout, f"{fault}: {done.stderr}")
    place.run("validate", server.address("altered", "a.lumen"), code=3)


def provenance(place, server):
    """A case from elsewhere has the digest of its volume, and no address."""
    place.run("convert", "tube.nii", "near.lumen.json")
    place.run("convert", server.address("cut", "tube.nii?key=secret"), "far.lumen.json")
    near, far = (json.loads((place.folder / name).read_text()) for name in ("near.lumen.json", "far.lumen.json"))
    steps = lambda case: case["metadata"]["steps"] if "metadata" in case else case["steps"]
    step = steps(far).pop(0)
    expect(step["name"] == "fetch" and step["parameters"] == {"file-1-bytes": (place.folder / "tube.nii").stat().st_size,
                                                            "file-1-sha256": digest(place.folder / "tube.nii")}, f"step: {step}")
    expect(near == far, "the case of a volume elsewhere is another")
    text = (place.folder / "far.lumen.json").read_text()
    expect(not any(word in text for word in ("127.0.0.1", "secret", "tube.nii", str(place.scratch))), "the case has an address")
    place.run("validate", "far.lumen.json", "--privacy")


def only_the_command_line(place, server):
    """Addresses in files are not followed."""
    server.taken()
    address = server.address("plain", "tube.nii")
    (place.folder / "list.csv").write_text(f"input,id,title,synthetic\n{address},a,A,yes\n")
    place.run("library", "build", "list.csv", "lib", code=3)
    (place.folder / "list.csv").write_text(f"input,id,title,synthetic,--seeds\ntube.nii,a,A,yes,{address}\n")
    done = place.run("library", "build", "list.csv", "lib", code=1)
    expect("only for addresses of its own command line" in done.stdout, f"a list with an address: {done.stdout}")
    (place.folder / "lumen.toml").write_text(f'[convert]\nseeds = "{address}"\n')
    done = place.run("convert", "tube.nii", "x.lumen", "--config", "lumen.toml", code=2)
    expect("only for addresses of its own command line" in done.stderr, f"a configuration with an address: {done.stderr}")
    expect(server.taken() == [], "an address in a file was asked for")
    done = place.run("info", "https://me:word@127.0.0.1/a.lumen", code=2)
    expect("word" not in done.stderr.replace("password", ""), f"a password: {done.stderr}")
    shutil.rmtree(place.folder / "lib.build", ignore_errors=True)


def libraries(place, server):
    """One case of a library comes without the rest, and is what its digests state."""
    near = place.json("library", "list", "lib")
    server.taken()
    far = place.json("library", "list", server.address("plain", "lib/"))
    expect([r["path"] for r in server.taken()] == [f"/plain/lib/{name}" for name in ("library.json", "data/a/record.json", "data/b/record.json")], "list")
    expect({**far, "fetched": []} == near, "the list of a library elsewhere is another")
    viewer = subprocess.Popen([place.lumen, "view", server.address("plain", "lib/index.html"), "--case", "b", "--no-browser"], cwd=place.folder,
                              env=place.environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    page = viewer.stdout.readline().strip()
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    state = json.loads(opener.open(page + "state", timeout=60).read())
    case = opener.open(page + "case.lumen", timeout=60).read()
    viewer.send_signal(signal.SIGINT)
    _, errors = viewer.communicate(timeout=60)
    log = [r["path"] for r in server.taken()]
    expect(log == [f"/plain/lib/{name}" for name in ("library.json", "data/b/record.json", "data/b/case.lumen")], f"view: {log}")
    expect((viewer.returncode, state["saveAs"], [f["name"] for f in state["files"]]) == (0, None, ["b.lumen"]), f"view: {viewer.returncode} {errors} {state}")
    expect(len(case) > 1000 and not os.listdir(place.scratch), f"view leaves {os.listdir(place.scratch)}")
    done = place.run("view", server.address("altered", "lib"), "--case", "b", "--html", "b.html", code=3)
    expect("is not what library.json states" in done.stderr or "library.json" in done.stderr, f"an altered library: {done.stderr}")
    record = place.folder / "lib/data/b/case.lumen"
    good = record.read_bytes()
    record.write_bytes(good[:-1] + bytes([good[-1] ^ 1]))
    done = place.run("view", server.address("plain", "lib"), "--case", "b", "--html", "b.html", code=3)
    expect("is not what record.json states" in done.stderr and server.address("plain", "lib/data/b/case.lumen") in done.stderr, f"altered: {done.stderr}")
    record.write_bytes(good)
    done = place.run("view", server.address("plain", "lib"), "--case", "z", "--html", "z.html", code=2)
    expect("no case z" in done.stderr, f"no such case: {done.stderr}")
    place.run("view", "lib", "--case", "z", "--html", "z.html", code=2)


def interrupted(place, server):
    """Ctrl-C leaves nothing behind."""
    child = subprocess.Popen([place.lumen, "validate", server.address("slow", "tube.nii")], cwd=place.folder, env=place.environment,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while not os.listdir(place.scratch): time.sleep(0.01)
    child.send_signal(signal.SIGINT)
    child.communicate(timeout=60)
    expect(child.returncode == 130 and not os.listdir(place.scratch), f"interrupted: {child.returncode}, left: {os.listdir(place.scratch)}")


def object_stores(place, server):
    """s3:// by rclone, or else aws, with the server as the store."""
    keys = dict(AWS_ACCESS_KEY_ID="any", AWS_SECRET_ACCESS_KEY="any", AWS_DEFAULT_REGION="us-east-1", AWS_EC2_METADATA_DISABLED="true",
                AWS_ENDPOINT_URL=server.address("").rstrip("/"), RCLONE_S3_ENDPOINT=server.address("").rstrip("/"), RCLONE_S3_PROVIDER="Other",
                RCLONE_S3_ACCESS_KEY_ID="any", RCLONE_S3_SECRET_ACCESS_KEY="any", RCLONE_CONFIG=str(place.folder / "none.conf"))
    works = lambda program: shutil.which(program) and subprocess.run([program, "--version"], capture_output=True).returncode == 0
    program = next(filter(works, ("rclone", "aws")), None)
    if program is None:
        print("SKIPPED: object stores, as neither rclone nor aws is installed")
    else:
        answer = place.json("validate", "s3://plain/a.lumen", **keys)
        expect(answer["fetched"][0]["sha256"] == digest(place.folder / "a.lumen"), f"{program}: {answer['fetched']}")
        far = place.json("info", "s3://plain/a.lumen", **keys)
        expect(far["fetched"][0]["read"] == 4160, f"{program}: {far['fetched']}")
        place.run("validate", "s3://plain/none.lumen", code=1, **keys)
    done = place.run("validate", "s3://plain/a.lumen", code=4, PATH=str(place.folder))
    expect("rclone or aws" in done.stderr, f"no program: {done.stderr}")


def main():
    if shutil.which("curl") is None: sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        place = Place(str(pathlib.Path(sys.argv[1]).resolve()), folder)
        maker = Maker(Program(place.lumen), folder)
        maker.case("a")
        for name in ("tube.nii", "tube.nrrd", "tube.nii.gz", "tube.mha"): maker.lumen("phantom", "tube", folder / name, "--size", "64")
        maker.init(folder / "lib", "Tubes")
        for name in "ab": maker.add(folder / "lib", name, maker.case(name))
        with FaultServer(folder) as server:
            for part in (headers_alone, whole_files, provenance, only_the_command_line, libraries, interrupted, object_stores): part(place, server)
    sys.exit(1 if failures else 0)


main()
