#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds packages/container/Containerfile to rules of its kind (those of hadolint that apply), and the rules to planted faults.

check_container.py. Exit status: 0 all held, 1 something did not."""
import json, pathlib, re, sys

FILE = pathlib.Path(__file__).resolve().parents[2] / "packages/container/Containerfile"
WORDS = {"ARG", "FROM", "LABEL", "RUN", "ENV", "WORKDIR", "USER", "ENTRYPOINT", "CMD", "COPY"}


def instructions(text):
    """(word, arguments) of each instruction, its lines joined and comments left out."""
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    for whole in re.sub(r"\\\n", " ", "\n".join(lines)).splitlines():
        if whole.strip(): yield tuple((whole.split(None, 1) + [""])[:2])


def check_run(command):
    if re.search(r"\bsudo\b|\bcd /", command): yield "a RUN uses sudo or cd"
    if "|" in command.replace("||", ""): yield "a RUN has a pipe, whose failure is not seen"
    if "apt-get install" in command:
        for needed in ("apt-get update", "install -y", "--no-install-recommends", "rm -rf /var/lib/apt/lists/*"):
            if needed not in command: yield f"a RUN installs without {needed}"
    if re.search(r"\bapt (install|update)", command): yield "a RUN uses apt, which is for people"
    if re.search(r"\b(curl|wget)\b|https?://", command): yield "a RUN fetches something besides packages"
    if re.search(r"chmod (-R )?[0-7]?777", command): yield "a RUN lets everybody write"


def faults_of(text, version):
    found = list(instructions(text))
    arguments = lambda word: [rest for each, rest in found if each == word]
    for word, _ in found:
        if word not in WORDS: yield f"{word} is not used here"
    defaults = dict(rest.split("=", 1) for rest in arguments("ARG") if "=" in rest)
    if arguments("FROM")[-1:] != ["scratch"]: yield "the last stage is not made from scratch"
    for image in arguments("FROM"):
        if image == "scratch": continue
        image = re.sub(r"\$\{(\w+)\}", lambda m: defaults.get(m[1], ""), image).split()[0]
        if not re.fullmatch(r"[a-z0-9./-]+:[a-z0-9.-]+(@sha256:[0-9a-f]{64})?", image) or image.endswith(":latest"): yield f"the base {image} has no fixed tag"
    for command in arguments("RUN"): yield from check_run(command)
    if arguments("USER")[-1:] in ([], ["root"], ["0"]): yield "it runs as root"
    words = [word for word, _ in found]
    if "USER" in words and "RUN" in words[words.index("USER"):]: yield "a RUN comes after USER"
    for word in ("ENTRYPOINT", "CMD"):
        if len(arguments(word)) != 1: yield f"there is not one {word}"
        for rest in arguments(word):
            try:
                if not isinstance(json.loads(rest), list): yield f"{word} is no list"
            except ValueError:
                yield f"{word} is no list in JSON"
    for folder in arguments("WORKDIR"):
        if not folder.startswith("/"): yield f"WORKDIR {folder} is not absolute"
    labels = " ".join(arguments("LABEL"))
    for label in ("title", "description", "licenses", "version"):
        if f"org.opencontainers.image.{label}=" not in labels: yield f"there is no label {label}"
    if f'image.version="{version}"' not in labels: yield f"the label of the version is not {version}"
    if re.search(r"(?i)(secret|password|token)\s*=", text): yield "it holds a secret"


PLANTED = (("debian:bookworm-slim", "debian"), ("debian:bookworm-slim", "debian:latest"), ("USER nobody", ""), ("USER nobody", "USER root"),
           ('ENTRYPOINT ["lumen"]', "ENTRYPOINT lumen"), (" --no-install-recommends", ""), ("rm -rf /var/lib/apt/lists/*", "rm -rf"), ("WORKDIR /data", "WORKDIR data"),
           ("sh /packages", "curl -O x && sh /packages"), ("sh /packages", "sudo sh /packages"), ("sh /packages", "true | cat && sh"),
           ("sh /packages", "chmod -R 777 /data && sh"), ("FROM scratch", "FROM packages"),
           ('image.version="', 'image.version="9'), ("WORKDIR /data", "ADD x /data"), ('CMD ["--help"]', ""))


def main():
    version = re.search(r"project\(lumen VERSION ([0-9.]+)", (FILE.parents[2] / "CMakeLists.txt").read_text())[1]
    text = FILE.read_text()
    failures = list(faults_of(text, version))
    for old, new in PLANTED:
        if old not in text or not list(faults_of(text.replace(old, new), version)): failures.append(f"{new!r} for {old!r} is not found")
    for failure in failures: print(f"{FILE.name}: {failure}")
    print(f"{len(PLANTED)} planted faults, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
