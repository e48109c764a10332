#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads what `lumen export oned` writes as svOneDSolver and openBF read it, and compares both with the case.

check_oned.py LUMEN [CASE...]

Cards of the .in files have their number and kinds of fields, keys of the .yml files their types and ranges, as below.
At every node what comes in goes on; nodes are counted without gaps, node 1 alone is an inlet, at most three vessels meet.
CASEs are read too. Exit status: 0 all held, 1 something did not, 77 Python has no yaml (python3-yaml)."""
import json, math, pathlib, re, sys, tempfile
from flow_cases import *

try: import yaml
except ImportError: yaml = None

RESISTANCE = 1e5  # Pa s/m^3 in a dyn s/cm^5
POSITIVE = lambda v: isinstance(v, (int, float)) and math.isfinite(v) and v > 0
NATURAL = lambda v: isinstance(v, int) and v > 0
TOP = {"project_name": lambda v: isinstance(v, str), "inlet_file": lambda v: isinstance(v, str),
       "write_results": lambda v: set(v) <= {"P", "Q", "A", "u"}, "blood": dict.__instancecheck__, "solver": dict.__instancecheck__,
       "network": list.__instancecheck__}
TOP["blood"], TOP["solver"], TOP["network"] = (lambda v: set(v) == {"rho", "mu"} and all(map(POSITIVE, v.values())),
                                               lambda v: set(v) == {"Ccfl", "cycles", "jump", "convergence_tolerance"} and 0 < v["Ccfl"] <= 1,
                                               lambda v: isinstance(v, list) and v)
VESSEL = {"label": lambda v: isinstance(v, str) and re.fullmatch(r"[\w.-]+", v), "sn": NATURAL, "tn": NATURAL, "L": POSITIVE, "M": NATURAL,
          "Rp": POSITIVE, "Rd": POSITIVE, "h0": POSITIVE, "E": POSITIVE, "Pext": POSITIVE}
OUTLET = {"R1": POSITIVE, "R2": POSITIVE, "Cc": POSITIVE}
CARDS = {"MODEL": "w", "NODE": "ifff", "JOINT": "wiww", "JOINTINLET": "wi*", "JOINTOUTLET": "wi*", "SEGMENT": "wifiiifffwwfiiww", "DATATABLE": "ww",
         "ENDDATATABLE": "", "MATERIAL": "wwfffffff", "SOLVEROPTIONS": "fiiiwwfii", "OUTPUT": "w"}


def field(kind, word): return int(word) if kind in "i*" else float(word) if kind == "f" else word


def read_cards(file):
    """Cards by their names; tables by theirs."""
    cards, tables, table = {name: [] for name in CARDS}, {}, None
    for row in file.read_text().splitlines():
        words = row.split()
        if not words or words[0].startswith("#"): continue
        if table is not None and words[0] != "ENDDATATABLE":
            expect(len(words) == 2, f"{file.name}: a row of a table has two numbers: {row}")
            tables[table].append([float(w) for w in words])
            continue
        name, rest = words[0], words[1:]
        expect(name in CARDS, f"{file.name}: no such card: {row}")
        kinds = CARDS[name]
        kinds = kinds[:-1] + "*" * (len(rest) - len(kinds) + 1) if kinds.endswith("*") else kinds
        expect(len(rest) == len(kinds), f"{file.name}: {len(kinds)} fields in {row}")
        cards[name].append([field(k, w) for k, w in zip(kinds, rest)])
        if name == "DATATABLE": tables[table := rest[0]] = []
        if name == "ENDDATATABLE": table = None
    return cards, tables


def check_nodes(name, vessels, count):
    """Balance: `vessels` are (from, to) with nodes 0 .. count - 1."""
    ins, outs = [[t for _, t in vessels].count(n) for n in range(count)], [[f for f, _ in vessels].count(n) for n in range(count)]
    expect(all(f != t and 0 <= f < count and 0 <= t < count for f, t in vessels), f"{name}: vessels lead from node to node")
    expect(len(set(vessels)) == len(vessels), f"{name}: no two vessels between the same nodes")
    expect(all(i + o > 0 for i, o in zip(ins, outs)), f"{name}: no node is alone")
    expect([n for n in range(count) if ins[n] == 0] == [0] and outs[0] == 1, f"{name}: the first node alone is an inlet, of one vessel")
    expect(all(i + o <= 3 for i, o in zip(ins, outs)), f"{name}: three vessels at a node at most")
    reached, ahead = {0}, [0]
    while ahead:
        node = ahead.pop()
        for t in (t for f, t in vessels if f == node and t not in reached):
            reached.add(t)
            ahead.append(t)
    expect(len(reached) == count, f"{name}: all nodes are reached from the inlet")
    return [n for n in range(count) if outs[n] == 0]


def check_openbf(file):
    name, data = file.name, yaml.safe_load(file.read_text())
    expect(set(data) == set(TOP), f"{name}: keys {sorted(data)}")
    for key, holds in TOP.items(): expect(holds(data[key]), f"{name}: {key} is {data[key]!r:.80}")
    network = data["network"]
    count = max(v["tn"] for v in network)
    expect({n for v in network for n in (v["sn"], v["tn"])} == set(range(1, count + 1)), f"{name}: nodes are 1 to {count}")
    ends = check_nodes(name, [(v["sn"] - 1, v["tn"] - 1) for v in network], count)
    expect(len({v["label"] for v in network}) == len(network), f"{name}: labels are unique")
    for v in network:
        keys = {**VESSEL, **(OUTLET if v["tn"] - 1 in ends else {})}
        expect(set(v) == set(keys), f"{name} {v['label']}: keys {sorted(v)}")
        for key, holds in keys.items(): expect(holds(v[key]), f"{name} {v['label']}: {key} is {v.get(key)!r}")
        expect(v["M"] == max(5, math.ceil(1000 * v["L"] - 1e-6)), f"{name} {v['label']}: M = max(5, L / 1 mm)")
        expect(v["L"] >= 0.49 * (v["Rp"] + v["Rd"]) / 2, f"{name} {v['label']}: half of its radius long at least")
        near(v["h0"], 0.1 * (v["Rp"] + v["Rd"]) / 2, 1e-6, f"{name} {v['label']}: h0")
    rows = [[float(w) for w in row.split()] for row in (file.parent / data["inlet_file"]).read_text().splitlines()]
    expect(len(rows) >= 2 and all(len(r) == 2 for r in rows) and rows[0][0] == 0 and rows[-1][0] > 0, f"{name}: an inflow over time")
    near(rows[0][1], 0.2 * math.pi * network[0]["Rp"] ** 2, 0.2, f"{name}: 0.2 m/s at the inlet")
    return network, rows[0][1]


def check_svoned(file):
    name, (cards, tables) = file.name, read_cards(file)
    nodes, segments = cards["NODE"], cards["SEGMENT"]
    expect([n[0] for n in nodes] == list(range(len(nodes))), f"{name}: nodes are counted from 0")
    expect([s[1] for s in segments] == list(range(len(segments))), f"{name}: segments are counted from 0")
    ends = check_nodes(name, [(s[4], s[5]) for s in segments], len(nodes))
    joints = {j[1]: (j[2], j[3]) for j in cards["JOINT"]}
    inlets, outlets = ({j[0]: j[1:] for j in cards[k]} for k in ("JOINTINLET", "JOINTOUTLET"))
    expect(set(joints) == set(range(len(nodes))) - {0} - set(ends), f"{name}: a joint at each node between vessels")
    for node, (into, out) in joints.items():
        for (count, *listed), side in ((inlets[into], 5), (outlets[out], 4)):
            expect(count == len(listed) > 0 and sorted(listed) == [s[1] for s in segments if s[side] == node], f"{name}: joint {node} lists its segments")
    for s in segments:
        expect(s[2] > 0 and s[3] >= 5 and s[6] > 0 and s[7] > 0, f"{name} {s[0]}: length, elements, areas")
        expect(s[9] == cards["MATERIAL"][0][0], f"{name} {s[0]}: its material is there")
        outlet = s[5] in ends
        expect((s[14] == "RESISTANCE" and POSITIVE(tables[s[15]][0][1])) if outlet else s[14:] == ["NOBOUND", "NONE"], f"{name} {s[0]}: its end")
    expect(cards["SOLVEROPTIONS"][0][4] in tables, f"{name}: the inflow is there")
    return nodes, segments, tables


def check_both(name, folder, stem):
    """The two files say the same in their own units."""
    network, flow = check_openbf(folder / f"{stem}.yml")
    nodes, segments, tables = check_svoned(folder / f"{stem}.in")
    expect([(v["label"], v["sn"] - 1, v["tn"] - 1) for v in network] == [(s[0], s[4], s[5]) for s in segments], f"{name}: the same vessels")
    for v, s in zip(network, segments):
        near(s[2], 100 * v["L"], 1e-6, f"{name} {s[0]}: cm")
        near(s[6], 1e4 * math.pi * v["Rp"] ** 2, 1e-6, f"{name} {s[0]}: cm^2")
        if "R1" in v: near(v["R1"] + v["R2"], RESISTANCE * tables[s[15]][0][1], 1e-6, f"{name} {s[0]}: resistance of the outlet")
    near(tables["INFLOW"][0][1], 1e6 * flow, 1e-6, f"{name}: cm^3/s")
    outlets = [RESISTANCE * tables[s[15]][0][1] for s in segments if s[14] == "RESISTANCE"]
    near(sum(1 / r for r in outlets) * 13332, flow, 1e-6, f"{name}: at 100 mmHg outlets take what comes in")
    return network, nodes


def poiseuille(v):
    a, b = v["Rp"], v["Rd"]
    return 8 * 0.004 / math.pi * v["L"] * (a * a + a * b + b * b) / 3 / (a * b) ** 3


def export(program, folder, case, name):
    lumen(program, folder, "export", "oned", str(case), name, "--quiet")
    return folder / name


def check(program, folder, cases):
    made = {"tube": (tube(),), "landmarks": (landmarks(),), "looped": looped(), "forest": (forest(),)}
    for name, case in made.items(): write_case(folder / f"{name}.lumen.json", *case)
    out = {name: export(program, folder, f"{name}.lumen.json", name) for name in made}
    network, _ = check_both("tube", out["tube"], "vessels")
    near(poiseuille(network[0]), 8 * 0.004 * 0.1 / (math.pi * 0.002 ** 4), 1e-6, "tube: Poiseuille's resistance")
    network, nodes = check_both("landmarks", out["landmarks"], "vessels")
    expect(sum(v["label"].startswith("stub") for v in network) == 1, "landmarks: a stub where four vessels meet")
    places = {tuple(round(10 * x, 4) for x in n[1:]) for n in nodes}
    expect(places == {(3, 5, 7), (3, 5, 27), (3, 5, 47), (46, 5, 27), (3, 66, 57), (-8, 5, 67), (3, -16, 47)}, f"landmarks: nodes where they are: {places}")
    check_both("looped", out["looped"], "vessels")
    stems = sorted(p.stem for p in out["forest"].glob("*.in"))
    expect(len(stems) == 10, f"forest: ten trees: {stems}")
    for stem in stems: check_both(f"forest {stem}", out["forest"], stem)
    check_refusals(program, folder)
    for k, case in enumerate(cases):
        network, _ = check_both(case, export(program, folder, pathlib.Path(case).resolve(), f"case{k}"), "vessels")
        print(case, len(network), "vessels")


def check_refusals(program, folder):
    two = [branch("left", line([-5, 0, 0], [0, 0, 10], 11), 1.0), branch("right", line([5, 0, 0], [1, 0, 10], 11), 1.0),
           branch("onward", line([0, 0, 12], [0, 0, 20], 9), 1.2, parent=10)]
    write_case(folder / "two.lumen.json", two, [(21, 22)])
    said = lumen(program, folder, "export", "oned", "two.lumen.json", "two", code=3).stderr
    expect("take one inlet" in said and not (folder / "two").exists(), f"two inlets into one vessel are refused: {said}")
    write_case(folder / "sac.lumen.json", [branch("sac", line([0, 0, 0], [0, 0, 5], 5), 3.0, kind="aneurysm")])
    for target in ("oned", "svzerod", "openfoam"):
        said = lumen(program, folder, "export", target, "sac.lumen.json", "sac", code=3).stderr
        expect(said.count("error:") == 1 and not (folder / "sac").exists(), f"{target}: an aneurysm alone is refused: {said}")


def main():
    if yaml is None: skip("Python's yaml (python3-yaml) is not installed")
    with tempfile.TemporaryDirectory() as folder: check(str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(folder), sys.argv[2:])
    return 1 if failures else 0


if __name__ == "__main__": sys.exit(main())
