# SPDX-License-Identifier: Apache-2.0
"""Libraries of synthetic cases, made and signed as a user would."""
import hashlib, json, pathlib, shutil, subprocess


def digest(file): return hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest()


def read_json(file): return json.loads(pathlib.Path(file).read_text())


def write_json(file, value): pathlib.Path(file).write_text(json.dumps(value, indent=1))


def minisign_key(folder, name):
    """A key without a password, as nobody is there to type it."""
    secret, public = folder / f"{name}.key", folder / f"{name}.pub"
    subprocess.run(["minisign", "-G", "-W", "-s", secret, "-p", public], check=True, stdout=subprocess.DEVNULL)
    return secret, public


def ssh_key(folder, name):
    key = folder / f"{name}_ed25519"
    subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-C", "", "-f", key], check=True)
    return key


class Maker:
    """`batch`: the Batch that runs lumen."""
    def __init__(self, batch, folder):
        self.batch, self.folder = batch, folder

    def lumen(self, *arguments):
        result = self.batch.run(arguments, self.folder)
        if result.returncode: raise RuntimeError(f"{' '.join(map(str, arguments))}: {result.returncode}: {result.stdout}{result.stderr}")
        return result.stdout

    def case(self, name):
        """A bent tube with a branch, of another width for each name: some 20 kB."""
        file = self.folder / f"{name}.lumen"
        if not file.exists():
            radius = 1 + 0.1 * (ord(name[0]) - ord("a"))
            trunk = [(i + 1, i, 0.02 * i * i, 0, i if i else -1) for i in range(12)]
            branch = [(13 + i, 6 + 0.3 * i, 1.5 + i, 0, 12 + i if i else 7) for i in range(6)]
            lines = [f"{n} 3 {x} {y} {z} {radius:.2f} {parent}" for n, x, y, z, parent in trunk + branch]
            file.with_suffix(".swc").write_text("\n".join(lines) + "\n")
            self.lumen("convert", file.with_suffix(".swc"), file)
        return file

    def init(self, library, title):
        self.lumen("library", "init", library, "--title", title, "--licence", "CC0-1.0", "--publisher", "Nobody")

    def add(self, library, name, case, *options):
        self.lumen("library", "add", library, case, "--id", name, "--synthetic", "--modality", "synthetic",
                   "--title", f"Tube {name}", "--description", "made by a program", "--anatomy", "none", *options)

    def make_keys(self):
        self.key, self.public = minisign_key(self.folder, "publisher")
        self.other_key, _ = minisign_key(self.folder, "stranger")
        self.ssh, self.other_ssh = ssh_key(self.folder, "publisher"), ssh_key(self.folder, "stranger")
        self.allowed = self.folder / "allowed_signers"
        key = pathlib.Path(f"{self.ssh}.pub").read_text().split()
        self.allowed.write_text("# who may sign\npublisher@example.org namespaces=\"lumen-library\" " + " ".join(key[:2]) + "\n")

    def make_signed(self):
        """`signed`: revision 5 of a library of a, b and c, by both keys; `older`: its revision 4; `another`: another library."""
        self.make_keys()
        self.signed, self.older, self.another = (self.folder / name for name in ("signed", "older", "another"))
        self.init(self.signed, "Three tubes")
        self.add(self.signed, "a", self.case("a"), "--export", "steve")
        self.add(self.signed, "b", self.case("b"))
        self.add(self.signed, "c", self.case("c"), "--picture", "none")
        self.lumen("library", "sign", self.signed, "--key", self.key)
        shutil.copytree(self.signed, self.older)
        self.add(self.signed, "c", self.case("e"), "--replace", "--picture", "none")
        for key in (self.key, self.ssh): self.lumen("library", "sign", self.signed, "--key", key)
        self.init(self.another, "Another")
        self.lumen("library", "sign", self.another, "--key", self.key)
        self.state = self.folder / "state.json"
        self.lumen("library", "verify", self.signed, "--key", self.public, "--state", self.state)
