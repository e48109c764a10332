#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Installs lumen elsewhere and looks at what is there.

check_install.py CMAKE BUILD

Installs component `lumen` of BUILD into a temporary prefix, moves the prefix, and checks the list of files, the
program, its manual page and completion, the links of the documentation, that nothing tells where it was built, that
every library that the program needs is named in THIRD_PARTY.md, and that the manifest removes all of it. Exit status:
0 all is well, 1 something is not."""
import json, os, pathlib, re, shutil, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCHEMAS = {f"share/lumen/{p.relative_to(ROOT / 'spec')}" for p in (ROOT / "spec/schema").glob("*.json")}
NAMES = re.findall(r"^== (\S+)", (ROOT / "spec/answers/answers.txt").read_text(), re.M)
ANSWERS = {f"share/lumen/schema/answers/{p}" for p in ("README.md", "answers.txt", *(f"{name}.schema.json" for name in NAMES))}
PIPELINES = ROOT / "converters/pipelines"
WORKFLOW = {f"share/lumen/pipelines/{p.relative_to(PIPELINES)}" for part in ("bids/lumen_bids", "snakemake")
            for p in (PIPELINES / part).rglob("*") if p.is_file() and p.suffix != ".pyc"}
EXPECTED = SCHEMAS | ANSWERS | WORKFLOW | {
    "bin/lumen", "bin/lumen-bids", "share/man/man1/lumen.1", "share/bash-completion/completions/lumen",
    "share/zsh/site-functions/_lumen", "share/fish/vendor_completions.d/lumen.fish",
    *(f"share/doc/lumen/{name}" for name in ("LICENSE", "THIRD_PARTY.md", "CITATION.cff")),
    *(f"share/doc/lumen/spec/{name}" for name in ("lumen.md", "seeds.md", "errors.md", "coverage.md", "schema", "answers")),
    *(f"share/doc/lumen/spec/figures/{p.name}" for p in (ROOT / "spec/figures").glob("*.png"))}
failures = []


def check(holds, what):
    if not holds:
        failures.append(what)
        print(what)


def run(*command, **more):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=120, **more)


def files_below(folder):
    return {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_symlink() or not p.is_dir()}


def install(cmake, build, prefix):
    result = run(cmake, "--install", build, "--prefix", prefix, "--component", "lumen")
    check(result.returncode == 0, f"cmake --install: {result.stdout}{result.stderr}")
    return files_below(prefix)


def check_program(lumen, work):
    version = re.search(r"project\(lumen VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    told = run(lumen, "--version")
    check(told.returncode == 0 and told.stdout == f"lumen {version}\n", f"lumen --version: {told}")
    made = run(lumen, "phantom", "tube", "t.nrrd", "--size", "32", "--seeds", "s.json", "--json", "--quiet", cwd=work)
    check(made.returncode == 0 and json.loads(made.stdout)["seeds"] == 1, f"the installed program: {made}")
    made = run(lumen, "convert", "t.nrrd", "t.glb", "--seeds", "s.json", cwd=work)
    check(made.returncode == 0 and (work / "t.glb").stat().st_size > 1000, f"the installed program: {made}")


def check_pipelines(prefix, work):
    """lumen-bids finds its modules and the program beside it."""
    (work / "raw/sub-01/anat").mkdir(parents=True)
    (work / "raw/dataset_description.json").write_text('{"Name": "Synthetic", "BIDSVersion": "1.8.0"}')
    run(prefix / "bin/lumen", "phantom", "tube", "raw/sub-01/anat/sub-01_angio.nii.gz", "--size", "32", "--quiet", cwd=work)
    made = run(prefix / "bin/lumen-bids", "raw", "out", "list", cwd=work)
    check(made.returncode == 0 and (work / "out/volumes.csv").is_file(), f"the installed lumen-bids: {made}")


def check_libraries(lumen, notices):
    objdump = shutil.which("objdump")
    if not objdump: return print("objdump is missing: the needed libraries are not looked at")
    needed = re.findall(r"NEEDED\s+(\S+)", run(objdump, "-p", lumen).stdout)
    check(len(needed) > 3, f"objdump found {needed}")
    known = [n.rstrip("*") for n in re.findall(r"`((?:lib|ld-)[^`]+)`", notices.read_text())]
    for library in needed:
        check(any(library.startswith(name) for name in known), f"{library} is not in THIRD_PARTY.md")


def listed(program, *group):
    """The commands that a help lists, and in place of a group its own."""
    commands = run(program, *group, "--help").stdout.partition("lumen help TOPIC")[0]
    names = re.findall(r"^  ([a-z]+) {2,}\S", commands, re.M)
    if group: return [" ".join([*group, name]) for name in names]
    lists = {name: "[SUBCOMMAND]" in run(program, name, "--help").stdout for name in names}
    return [command for name in names for command in (listed(program, name) if lists[name] else [name])]


def check_manual(prefix):
    page = prefix / "share/man/man1/lumen.1"
    text = page.read_text()
    commands = listed(prefix / "bin/lumen")
    check(len(commands) > 20 and "library add" in commands, f"lumen --help lists {commands}")
    for command in commands:
        section = re.search(rf"^\.SS \\fBlumen {command}\\fR.*?(?=^\.S[SH] )", text, re.M | re.S)
        check(section, f"the manual page does not have the command {command}")
        options = re.findall(r"(?<![\w-])--[a-z][a-z-]+", run(prefix / "bin/lumen", *command.split(), "--help").stdout)
        for option in options:
            check(f"\\fB{option}\\fR".replace("-", "\\-") in text, f"the manual page does not have {option} of {command}")
    for tool, arguments in (("groff", ["-man", "-ww", "-Tutf8", "-z"]), ("mandoc", ["-Tlint", "-Wwarning"]),
                            ("man", ["--warnings", "-l", "-Tutf8"])):
        if not shutil.which(tool):
            print(f"{tool} is missing: it does not judge the manual page")
            continue
        # of "man" as of the others, complaints are what is on standard error
        result = run(tool, *arguments, page, env=dict(os.environ, LC_ALL="C.UTF-8", MANROFFSEQ=""))
        complaints = result.stdout if tool == "mandoc" else result.stderr
        lines = [line for line in complaints.splitlines() if "missing date" not in line]
        check(not lines, f"{tool} on the manual page: {lines[:5]}")
    check("\n." in text and not re.search(r"^'", text, re.M), "the manual page holds a stray request")


def check_completion(script):
    ask = f"source '{script}'; COMP_WORDS=(lumen valid); COMP_CWORD=1; _lumen; complete -p lumen; echo ${{COMPREPLY[*]}}"
    told = run("bash", "-c", ask)
    check(told.stdout.endswith(" lumen\nvalidate\n"), f"the completion: {told}")


def check_links(documents):
    """Every link of the Markdown files leads to a file that is installed too."""
    links = 0
    for page in documents.rglob("*.md"):
        for target in re.findall(r"\]\(([^)#]+?)(?:#[^)]*)?\)", page.read_text()):
            if "://" in target: continue
            links += 1
            check((page.parent / target).exists(), f"{page.name} links to {target}, which is not installed")
    check(links > 10, f"only {links} links were found")


def check_traces(prefix, build):
    if "CMAKE_BUILD_TYPE:STRING=Release" not in (build / "CMakeCache.txt").read_text():
        return print("not a release: debug information and assertions may hold paths")
    traces = {os.fsencode(str(p)) for p in (ROOT, pathlib.Path(build).resolve(), pathlib.Path.home() / "")}
    traces = {t for t in traces if len(t.strip(b"/")) > 4}
    for file in prefix.rglob("*"):
        if not file.is_file(): continue
        content = file.read_bytes()
        for trace in traces: check(trace not in content, f"{file.name} holds the path {os.fsdecode(trace)}")


def main():
    if len(sys.argv) != 3: sys.exit(__doc__)
    cmake, build = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory(prefix="lumen-install-") as name:
        work = pathlib.Path(name)
        installed = install(cmake, build, work / "first")
        # the page, where npm has built it
        netgen = {"bin/lumen-netgen"} if (build / "converters/cli/lumen-netgen").exists() else set()
        expected = EXPECTED | netgen | {f"share/lumen/viewer/{page.name}" for page in (ROOT / "viewer/page/dist").glob("*")}
        for file in sorted(expected - installed): check(False, f"{file} is not installed")
        for file in sorted(installed - expected): check(False, f"{file} is installed, but not expected")
        manifest = (build / "install_manifest_lumen.txt").read_text().split("\n")
        prefix = work / "moved"
        shutil.copytree(work / "first", prefix, symlinks=True)
        for file in manifest: pathlib.Path(file).unlink() if file else None
        check(not files_below(work / "first"), f"the manifest leaves {files_below(work / 'first')}")
        check_program(prefix / "bin/lumen", work)
        check_pipelines(prefix, work)
        check_libraries(prefix / "bin/lumen", prefix / "share/doc/lumen/THIRD_PARTY.md")
        check_manual(prefix)
        check_completion(prefix / "share/bash-completion/completions/lumen")
        check_links(prefix / "share/doc/lumen/spec")
        check_traces(prefix, build)
    print(f"{len(installed)} files, {len(failures)} failures")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
