#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_ptx.py PTX [--table]: what the text of blob_cuda's kernels states.

Each operation on floats rounds to the nearest, explicitly, since drivers may fuse those without a rounding; none flushes
denormal numbers, is approximate or in doubles; no function is called; arrays of a thread in memory are small. Exit status:
0 all of this holds, 1 something does not."""
import collections
import pathlib
import re
import sys

KERNELS = {f"{name}{kernel}" for name in ("blob_query_points", "blob_blend_pairs", "blob_blend_crowds")
           for kernel in ("", "_cauchy")} | {"blob_query_exact_points"}
MOST_LOCAL = 128  # bytes of a thread's arrays in memory: 24 nodes that blend, and their number
ROUNDED = {"add", "sub", "mul", "div", "sqrt", "fma", "rcp", "rsqrt"}


def bodies(text):
    """The text of each kernel by its name."""
    starts = [(m.start(), m[1]) for m in re.finditer(r"\.visible \.entry (\w+)\(", text)]
    ends = [start for start, _ in starts[1:]] + [len(text)]
    return {name: text[start:end] for (start, name), end in zip(starts, ends)}


def instructions(body):
    """How often each instruction is in a kernel, with its modifiers."""
    return collections.Counter(re.findall(r"^\s*(?:@!?%p\d+ )?([a-z][a-z0-9_.]*)\s", body, flags=re.M))


def faults_of(name, body):
    count = instructions(body)
    for instruction, times in sorted(count.items()):
        base, *modifiers = instruction.split(".")
        if "f64" in modifiers: yield f"{times} x {instruction}: a double"
        if {"ftz", "approx"} & set(modifiers): yield f"{times} x {instruction} does not round as IEEE 754 states"
        if base == "fma": yield f"{times} x {instruction} fuses a product and a sum"
        if base in ROUNDED and "f32" in modifiers and "rn" not in modifiers: yield f"{times} x {instruction} states no rounding"
        if base == "call": yield f"{times} x call"
    depot = re.search(r"\.local [^;]*__local_depot\d+\[(\d+)\]", body)
    if depot and int(depot[1]) > MOST_LOCAL: yield f"{depot[1]} bytes of a thread are in memory"
    # the query is there: sums over lanes, divisions and square roots
    for instruction, least in (("mul.rn.f32", 200), ("add.rn.f32", 150), ("div.rn.f32", 5), ("sqrt.rn.f32", 3)):
        if count[instruction] < least: yield f"only {count[instruction]} x {instruction}"


def main():
    if len(sys.argv) < 2: sys.exit(__doc__)
    text = pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")
    kernels = bodies(text)
    faults = [f"kernels {sorted(kernels)} instead of {sorted(KERNELS)}"] if set(kernels) != KERNELS else []
    if ".extern" in text: faults.append("a function or variable lies elsewhere")
    if not re.search(r"^\.target sm_70$", text, flags=re.M): faults.append("the target is not sm_70")
    for name, body in kernels.items():
        faults += [f"{name}: {fault}" for fault in faults_of(name, body)]
        if "--table" in sys.argv: print(name, len(body), dict(instructions(body).most_common()))
    print("\n".join(faults) or f"{len(kernels)} kernels round as the library does and call nothing")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
