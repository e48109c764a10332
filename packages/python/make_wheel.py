#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the wheel of a built package: make_wheel.py PACKAGE VERSION OUT

Shared libraries that not every system has lie in lumen.libs, under names with a digest, so that no other package's copy
is taken for them; the module finds them by its RPATH. The platform tag states the newest symbol version of glibc that
any of the files needs. Equal inputs give equal bytes: SOURCE_DATE_EPOCH is the time of all files."""
import base64, hashlib, os, pathlib, re, shutil, subprocess, sys, tempfile, time, zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# Libraries of every Linux with glibc, as PEP 600 has them.
SYSTEM = re.compile(r"(ld-linux-x86-64|lib(c|m|dl|rt|pthread|util|resolv|gcc_s|stdc\+\+))\.so\.\d+|linux-vdso\.so\.1")
METADATA = """Metadata-Version: 2.1
Name: lumen
Version: {version}
Summary: From an angiogram to vessels that a simulator can touch
License: Apache-2.0
Classifier: Operating System :: POSIX :: Linux
Classifier: Programming Language :: Python :: 3.{minor}
Classifier: Topic :: Scientific/Engineering :: Medical Science Apps.
Requires-Python: >=3.{minor},<3.{next}
Requires-Dist: numpy>=1.20,<2
Description-Content-Type: text/markdown

{description}"""


def run(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def libraries(module):
    """Name and path of every shared library that the module needs, itself or by another one."""
    found = {}
    for line in run("ldd", module).splitlines():
        name, arrow, rest = line.strip().partition(" => ")
        if arrow and not SYSTEM.fullmatch(name):
            if rest.startswith("not found"):
                sys.exit(f"make_wheel.py: {name}: found no such library, which {module} needs")
            found[name] = pathlib.Path(rest.split(" (")[0]).resolve()
    return found


def bundle(module, folder):
    """Copies the libraries into the folder, and lets all find one another there. Returns their paths."""
    needed = libraries(module)
    new = {}
    for name, path in needed.items():
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        # as long as before, so that it takes the old one's place in the file
        new[name] = (name.partition(".so")[0] + "-" + digest)[:len(name)]
    copies = []
    for name, path in needed.items():
        copy = folder / new[name]
        shutil.copyfile(path, copy)
        run("strip", "--strip-unneeded", copy)
        rename(copy, new)
        run("patchelf", "--remove-rpath", copy)
        copies.append(copy)
    run("strip", "--strip-unneeded", module)
    rename(module, new)
    # RPATH, not RUNPATH: it holds for what the libraries need, too
    run("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN/../lumen.libs", module)
    return copies, needed


def bundle_cuda(package, folder):
    """Copies libblob-cuda and the libblob that it needs, which lumen._cuda finds beside itself. Returns their paths."""
    copies = []
    for file in sorted(package.glob("libblob*.so.1")):
        copy = folder / file.name
        shutil.copyfile(file, copy)
        run("strip", "--strip-unneeded", copy)
        run("patchelf", "--set-rpath", "$ORIGIN", copy)
        copies.append(copy)
    return copies


def rename(file, new):
    """Gives libraries their new names in the strings of the dynamic section: needs, their versions, the file's own name.
    patchelf would append all of these strings again for each change: 22 MB for OpenVDB."""
    section = next(line for line in run("objdump", "-h", file).splitlines() if " .dynstr " in line).split()
    start, size = int(section[5], 16), int(section[2], 16)
    data = file.read_bytes()
    strings = data[start:start + size]
    for old, name in new.items():
        strings = strings.replace(f"\0{old}\0".encode(), f"\0{name}\0".encode())
    file.write_bytes(data[:start] + strings + data[start + size:])


def newest(files, prefix):
    """The newest version of the symbols GLIBC_x.y (or of another prefix) that the files need."""
    versions = set()
    for file in files:
        versions |= set(re.findall(rf"\b{prefix}_(\d+(?:\.\d+)+)\b", run("objdump", "-T", file)))
    return max((tuple(map(int, version.split("."))) for version in versions), default=(2, 17))


def licences(needed, folder):
    """Texts of licences: lumen's, and those of the packages that the libraries come from."""
    folder.mkdir()
    for name in ("LICENSE", "THIRD_PARTY.md"):
        shutil.copyfile(ROOT / name, folder / name)
    for name, path in sorted(needed.items()):
        owner = subprocess.run(["dpkg", "-S", path], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
        if not owner:  # a merged /usr: dpkg may know the path without it
            owner = run("dpkg", "-S", str(path).replace("/usr/lib", "/lib", 1))
        package = owner.split(":")[0]
        shutil.copyfile(f"/usr/share/doc/{package}/copyright", folder / f"{package}.txt")


def pack(tree, wheel, info):
    """A zip of the tree whose record is last, as installers want it."""
    stamp = time.gmtime(max(int(os.environ.get("SOURCE_DATE_EPOCH", "315532800")), 315532800))[:6]
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        def add(name, data, mode):
            entry = zipfile.ZipInfo(name, stamp)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, (0o100000 | mode) << 16
            out.writestr(entry, data)

        for path in sorted(p for p in tree.rglob("*") if p.is_file()):
            name, data = path.relative_to(tree).as_posix(), path.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{name},sha256={digest},{len(data)}\n")
            add(name, data, 0o755 if data.startswith(b"\x7fELF") else 0o644)
        add(f"{info}/RECORD", "".join(record) + f"{info}/RECORD,,\n", 0o644)


def main():
    package, version, out = pathlib.Path(sys.argv[1]), sys.argv[2], pathlib.Path(sys.argv[3])
    with tempfile.TemporaryDirectory() as folder:
        tree = pathlib.Path(folder)
        (tree / "lumen").mkdir()
        (tree / "lumen.libs").mkdir()
        for file in sorted(package.iterdir()):
            if file.suffix in (".py", ".pyi", ".so", ".typed"):
                shutil.copyfile(file, tree / "lumen" / file.name)
        shutil.copytree(package / "device", tree / "lumen/device")
        module, = (tree / "lumen").glob("_lumen.*.so")
        python = re.search(r"cpython-3(\d+)", module.name)[1]
        copies, needed = bundle(module, tree / "lumen.libs")
        files = [module, *copies, *bundle_cuda(package, tree / "lumen")]
        low, high = newest(files, "GLIBC"), newest(files, "GLIBCXX")
        tag = f"cp3{python}-cp3{python}-manylinux_{low[0]}_{low[1]}_x86_64"
        info = f"lumen-{version}.dist-info"
        (tree / info).mkdir()
        licences(needed, tree / info / "licenses")
        description = (ROOT / "docs/python.md").read_text(encoding="utf-8")
        (tree / info / "METADATA").write_text(METADATA.format(version=version, minor=python, next=int(python) + 1,
                                                              description=description), encoding="utf-8")
        (tree / info / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: lumen\nRoot-Is-Purelib: false\nTag: {tag}\n")
        strangers = [str(path) for path in libraries(module).values() if tree.resolve() not in path.parents]
        if strangers:
            sys.exit(f"make_wheel.py: found {', '.join(strangers)} outside of the wheel, expected all in lumen.libs")
        wheel = out / f"lumen-{version}-{tag}.whl"
        pack(tree, wheel, info)
        unpacked = sum(p.stat().st_size for p in tree.rglob("*") if p.is_file())
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB, {unpacked / 1e6:.1f} MB unpacked, {len(copies)} libraries, "
          f"GLIBC_{'.'.join(map(str, low))}, GLIBCXX_{'.'.join(map(str, high))}")


if __name__ == "__main__":
    main()
