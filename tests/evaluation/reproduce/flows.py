#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Flows through phantoms and real vessels in OpenFOAM, beside svZeroDSolver, Poiseuille's law and what is known to be added to it.

  flows.py LUMEN SOLVER DATA FOLDER [NAME ...]

LUMEN is the program, SOLVER svZeroDSolver's (`cmake -S ../shared/solvers -B BUILD && cmake --build BUILD`). Makes the cases, runs what
`lumen export openfoam --cells coarse` and `lumen export svzerod` write, and keeps NAME.flow.json, flows_*.plot.json (residuals, which
plots.py draws) and flows.md in FOLDER. A case or result that is there is not made again. NAMEs choose some of the cases.
Debian: openfoam, python3-numpy."""
import csv
import json
import math
import re
import sys
from pathlib import Path

import numpy

from timed_program import run

DENSITY, VISCOSITY = 1060.0, 4e-3  # kg/m^3, Pa s: as the exports state
WHITE_FROM = 11.6                  # Dean number from which on a bend counts
ENTRANCE = 0.33                    # of rho U^2 / 2: friction of a profile that develops, besides its kinetic energy
CLICKS = Path(__file__).resolve().parents[2] / "data"


def phantom(kind, *convert):
    def make(lumen, data, folder, name):
        run(lumen, "phantom", kind, folder / f"{name}.nrrd", "--size", 64, "--seeds", folder / f"{name}.json", "--quiet")
        run(lumen, "convert", folder / f"{name}.nrrd", folder / f"{name}.lumen", "--seeds", folder / f"{name}.json", "--seeds-only", "--quiet")
    return make


def willis(lumen, data, folder, name):
    run(lumen, "phantom", "willis", folder / f"{name}.nrrd", "--quiet")
    run(lumen, "convert", folder / f"{name}.nrrd", folder / f"{name}.lumen", "--quiet")


def volume(file, *options):
    def make(lumen, data, folder, name):
        words = [CLICKS / word[1:] if word.startswith("@") else word for word in options]
        run(lumen, "convert", data / file, folder / f"{name}.lumen", *words, "--quiet")
    return make


CASES = {
    "bifurcation": (phantom("bifurcation"), []),
    "kissing": (phantom("kissing"), []),
    "willis": (willis, []),
    "aorta": (volume("aorta/aorta.mha"), []),
    "3DRA": (volume("aneurism-3dra.nrrd"), []),
}


def found(pattern, text, default=None):
    match = re.findall(pattern, text)
    return match[-1] if match else default


def residuals(log):
    """For each step the initial residuals of the pressure's first solution, and of the speed's greatest component."""
    curve = []
    for line in log.splitlines():
        if line.startswith("Time = "):
            curve.append([0.0, 0.0])
        match = re.match(r"\S+:  Solving for (\w+), Initial residual = (\S+),", line)
        if match and match[1] == "p":
            curve[-1][0] = curve[-1][0] or float(match[2])
        elif match:
            curve[-1][1] = max(curve[-1][1], float(match[2]))
    return curve


def last_value(case, kind, end):
    file = next((case / "postProcessing" / f"{kind}_{end}").rglob("surfaceFieldValue.dat"))
    return float(file.read_text().split()[-1])


class Tree:
    """Nodes, in m, and what flows between them."""

    def __init__(self, lumen, case, losses):
        run(lumen, "convert", case, case.with_suffix(".tree.lumen.json"), "--quiet")
        tree = json.loads(case.with_suffix(".tree.lumen.json").read_text())["tree"]
        self.centre = 1e-3 * numpy.array(tree["centre"])
        self.radius = 1e-3 * numpy.array(tree["radius"])
        self.branch, self.kinds = tree["branch"], [b["kind"] for b in tree["branches"]]
        parent = tree["parent"]
        self.edges = [(p, n, self.branch[p] == self.branch[n]) for n, p in enumerate(parent) if p >= 0]
        labels = [b["label"] for b in tree["branches"]]
        for a, b in tree.get("links", []):
            told = f"{labels[self.branch[a]]} and {labels[self.branch[b]]}: no blood flows through the link between them"
            if not any(loss.startswith(told) for loss in losses):
                self.edges.append((a, b, False))
        self.neighbours = [[] for _ in parent]
        for a, b, own in self.edges:
            if own:
                self.neighbours[a].append(b)
                self.neighbours[b].append(a)
        self.curvature = [self.curvature_at(n) for n in range(len(parent))]

    def walk(self, node, first, distance):
        """The node that lies `distance` along the branch from `node`, by way of `first`."""
        before, at = node, first
        left = distance - numpy.linalg.norm(self.centre[at] - self.centre[before])
        while left > 0:
            onward = [n for n in self.neighbours[at] if n != before]
            if not onward:
                return at
            before, at = at, onward[0]
            left -= numpy.linalg.norm(self.centre[at] - self.centre[before])
        return at

    def curvature_at(self, node):
        """1/m, of the circle through places two radii before and behind."""
        if len(self.neighbours[node]) != 2:
            return 0.0
        a, c = (self.centre[self.walk(node, n, 2 * self.radius[node])] for n in self.neighbours[node])
        u, v = self.centre[node] - a, c - self.centre[node]
        product = numpy.linalg.norm(u) * numpy.linalg.norm(v) * numpy.linalg.norm(c - a)
        return 2 * float(numpy.linalg.norm(numpy.cross(u, v))) / product if product > 0 else 0.0

    def nearest(self, place):
        return int(numpy.argmin(numpy.linalg.norm(self.centre - place, axis=1)))

    def resistance(self, edge, flow, bends):
        """Poiseuille's along an edge, Pa s/m^3; with `bends` times White's factor (Proc R Soc A 123, 1929) for its Dean number. The part
        of a branch's first edge that lies in its parent resists nothing."""
        a, b, own = edge
        length = numpy.linalg.norm(self.centre[a] - self.centre[b])
        if not own:
            length = max(length - self.radius[a], 1e-3 * length)
        r = self.radius[b] if not own else 0.5 * (self.radius[a] + self.radius[b])
        value = 8 * VISCOSITY * length / (math.pi * r ** 4)
        if bends:
            dean = self.dean(b, flow)
            if dean > WHITE_FROM:
                value /= 1 - (1 - (WHITE_FROM / dean) ** 0.45) ** 2.2
        return value

    def dean(self, node, flow):
        r = self.radius[node]
        reynolds = 2 * abs(flow) * DENSITY / (math.pi * r * VISCOSITY)
        return reynolds * math.sqrt(r * self.curvature[node])

    def prune(self, ends):
        """Drops the edges that lead to none of the ends: nothing flows there."""
        count = numpy.zeros(len(self.radius), dtype=int)
        for a, b, _own in self.edges:
            count[a] += 1
            count[b] += 1
        kept = list(self.edges)
        while True:
            still = [e for e in kept if all(count[n] > 1 or n in ends for n in e[:2])]
            if len(still) == len(kept):
                break
            for a, b, _own in set(kept) - set(still):
                count[a] -= 1
                count[b] -= 1
            kept = still
        self.edges = kept

    def pressures(self, into, zero, bends):
        """Pa at the nodes that blood flows through, for flows into nodes; 0 at `zero`, one of each connected part."""
        nodes = sorted({n for e in self.edges for n in e[:2]})
        index = {n: k for k, n in enumerate(nodes)}
        ends = numpy.array([[index[a], index[b]] for a, b, _own in self.edges])
        flows = numpy.zeros(len(self.edges))
        for _ in range(4 if bends else 1):
            conductance = numpy.array([1 / self.resistance(e, f, bends) for e, f in zip(self.edges, flows)])
            matrix = numpy.zeros((len(nodes), len(nodes)))
            for (a, b), g in zip(ends, conductance):
                matrix[[a, b], [a, b]] += g
                matrix[[a, b], [b, a]] -= g
            for node in zero:
                matrix[index[node], index[node]] += conductance.max()
            pressure = numpy.linalg.solve(matrix, [into[n] for n in nodes])
            flows = (pressure[ends[:, 0]] - pressure[ends[:, 1]]) * conductance
        self.flows = flows
        return dict(zip(nodes, pressure))

    def widenings(self, way):
        """Pa that are lost along a path of edges where blood slows down: rho / 2 times the square of each fall of its mean speed, as behind a
        sudden widening (Borda and Carnot)."""
        speeds = [speed(abs(self.flows[k]), self.radius[self.edges[k][1]]) for k in way]
        lost, most = 0.0, speeds[0]
        for here, onward in zip(speeds, speeds[1:] + [math.inf]):
            most = max(most, here)
            if onward > here:  # the slowest place before the next narrowing
                lost += DENSITY / 2 * (most - here) ** 2
                most = here
        return lost

    def path(self, start, goal):
        """Indices of the edges from one node to another, fewest first; None if they are not connected."""
        near = {}
        for k, (a, b, _own) in enumerate(self.edges):
            near.setdefault(a, []).append((k, b))
            near.setdefault(b, []).append((k, a))
        came, queue = {start: None}, [start]
        for at in queue:
            if at == goal:
                way = []
                while came[at] is not None:
                    k, at = came[at]
                    way.append(k)
                return way[::-1]
            for k, to in near.get(at, []):
                if to not in came:
                    came[to] = (k, at)
                    queue.append(to)
        return None


def speed(flow, radius):
    return flow / (math.pi * radius ** 2)


def predicted(tree, case, manifest, expected, meshed):
    """For each inlet Poiseuille's pressure and the parts that are added to it, Pa."""
    at = {end["name"]: tree.nearest(numpy.array(end["position"])) for end in manifest["ends"]}
    tree.prune(set(at.values()))
    into, zero = numpy.zeros(len(tree.radius)), []
    for name, row in expected.items():
        into[at[name]] += row["flow"] if row["kind"] == "inlet" else -row["flow"]
        if row["kind"] == "outlet" and row["drop"] == 0:
            zero.append((name, at[name]))
    straight = tree.pressures(into, [node for _, node in zero], False)
    bent = tree.pressures(into, [node for _, node in zero], True)
    rows = []
    for name, row in expected.items():
        if row["kind"] != "inlet":
            continue
        outlet, way = next((outlet, way) for outlet, node in zero if (way := tree.path(at[name], node)) is not None)
        there = at[outlet]
        u_in, u_out = speed(row["flow"], tree.radius[at[name]]), speed(expected[outlet]["flow"], tree.radius[there])
        kinetic = DENSITY / 2 * (2 * u_out ** 2 - u_in ** 2) + ENTRANCE * DENSITY / 2 * u_in ** 2
        deans = sorted(tree.dean(tree.edges[k][1], tree.flows[k]) for k in way)
        path = sum(float(numpy.linalg.norm(tree.centre[tree.edges[k][0]] - tree.centre[tree.edges[k][1]])) for k in way)
        reynolds = 2 * row["flow"] * DENSITY / (math.pi * tree.radius[at[name]] * VISCOSITY)
        rows.append({"inlet": name, "outlet": outlet, "flow": row["flow"], "law": row["drop"], "nodes": float(straight[at[name]] - straight[there]),
                     "bends": float(bent[at[name]] - bent[there]), "kinetic": kinetic, "mesh": meshed ** -2,
                     "widenings": tree.widenings(way), "dynamic": DENSITY / 2 * u_in ** 2, "reynolds": reynolds, "dean": deans[int(0.9 * (len(deans) - 1))],
                     "entrance_mm": 1e3 * 0.06 * reynolds * 2 * tree.radius[at[name]], "path_mm": 1e3 * path,
                     "forks": sum(not tree.edges[k][2] for k in way), "found": DENSITY * (last_value(case, "pressure", name) - last_value(case, "pressure", outlet))})
    return rows


def zero_d(lumen, solver, folder, name, manifest):
    """svZeroDSolver's pressures at ends, Pa, in a model without the ends that the mesh cannot resolve."""
    source, case = folder / f"{name}.lumen", folder / f"{name}-0d"
    thin = found(r"ends thinner than (\S+) mm", " ".join(manifest["remarks"]))
    if thin:
        source = folder / f"{name}.trimmed.lumen"
        run(lumen, "trim", folder / f"{name}.lumen", source, "--min-radius", thin, "--quiet")
    if not case.exists():
        run(lumen, "export", "svzerod", source, case, "--quiet")
    run(solver, case / "model.json", case / "out.csv")
    last = {}
    with open(case / "out.csv", newline="") as rows:
        for row in csv.DictReader(rows):
            last[row["name"]] = {k: float(v) for k, v in row.items() if k != "name"}
    pressure = {}
    for vessel in json.loads((case / "model.json").read_text())["vessels"]:
        for kind, end in vessel.get("boundary_conditions", {}).items():
            pressure[end] = 0.1 * last[vessel["vessel_name"]]["pressure_in" if kind == "inlet" else "pressure_out"]
    return pressure


def volume_of(file):
    """m^3 that an STL in ASCII encloses."""
    corners = [[float(word) for word in line.split()[1:]] for line in open(file) if line.lstrip().startswith("vertex")]
    t = numpy.array(corners).reshape(-1, 3, 3)
    return float(numpy.einsum("ij,ij->i", t[:, 0], numpy.cross(t[:, 1], t[:, 2])).sum() / 6)


def measure(lumen, solver, data, folder, name):
    kept = folder / f"{name}.flow.json"
    if kept.exists():
        return json.loads(kept.read_text())
    make, options = CASES[name]
    if not (folder / f"{name}.lumen").exists():
        make(lumen, data, folder, name)
    case, ran = folder / name, folder / f"{name}.ran.json"
    if not ran.exists():
        _, exporting = run(lumen, "export", "openfoam", f"{name}.lumen", case, "--cells", "coarse", "--quiet", *options, folder=folder)
        printed, seconds = run("./Allrun", folder=case)
        ran.write_text(json.dumps({"printed": printed, "seconds": seconds, "exporting": exporting}) + "\n")
    result = json.loads(ran.read_text())
    printed = result.pop("printed")
    logs = {p: (case / f"log.{p}").read_text() for p in ("snappyHexMesh", "checkMesh", "simpleFoam")}
    result["cells"] = int(found(r"cells: +(\d+)", logs["checkMesh"]))
    result["ok"] = "Mesh OK." in logs["checkMesh"]
    result["layers"] = float(found(r"Extruding \d+ out of \d+ faces \(([0-9.]+)%\)", logs["snappyHexMesh"], "nan"))
    result["non_orthogonal"] = float(found(r"Mesh non-orthogonality Max: (\S+)", logs["checkMesh"]))
    result["skew"] = float(found(r"Max skewness = (\S+)", logs["checkMesh"]))
    result["converged"] = "SIMPLE solution converged" in logs["simpleFoam"]
    result["steps"] = logs["simpleFoam"].count("\nTime = ")
    result["balance"] = float(found(r"balance (\S+) %", printed))
    result["residuals"] = residuals(logs["simpleFoam"])
    manifest = json.loads((case / "lumen-export.json").read_text())
    with open(case / "expected.csv", newline="") as rows:
        expected = {row["end"]: {"kind": row["kind"], "flow": float(row["flow_m3_s"]), "drop": float(row["pressure_Pa"])} for row in csv.DictReader(rows)}
    fine = folder / f"{name}-fine"
    if not fine.exists():
        run(lumen, "export", "openfoam", f"{name}.lumen", fine, "--cells", "coarse", "--edge", "0.15r", "--quiet", *options, folder=folder)
    meshed = float(found(r"Total volume = ([0-9.]+(?:e[+-][0-9]+)?)", logs["checkMesh"])) / volume_of(fine / "constant/triSurface/vessel.stl")
    result["meshed"] = meshed
    result["ends"] = {end: {**row, "measured": last_value(case, "flow", end)} for end, row in expected.items()}
    result["inlets"] = predicted(Tree(lumen, folder / f"{name}.lumen", manifest["losses"]), case, manifest, expected, meshed)
    result["zero_d"] = zero_d(lumen, solver, folder, name, manifest)
    kept.write_text(json.dumps(result, indent=1) + "\n")
    return result


def table(head, rows):
    line = "| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n"
    return line + "".join("| " + " | ".join(str(cell) for cell in row) + " |\n" for row in rows) + "\n"


TEXT = f"""# Flows

Steady flows of `lumen export openfoam --cells coarse`, by its `Allrun` on one core, made by `flows.py`. The balance is what flows out beside
what flows in. Residuals are those of the last step, of pressure and of the greatest component of the speed.
"""

PARTS = """**Pressure at each inlet** above the outlet that holds the pressure, in Pa. *Poiseuille* is that of `expected.csv`. *Bends* multiplies it
along the path by White's factor for its Dean number (Proc R Soc A 123, 1929; 90 % of the path have a Dean number below the one that is
shown). *Mesh* multiplies by (volume of a fine surface / mesh's volume)^2, as the resistance goes with the fourth power of the radius: triangles
and cells cut the corners of round sections. *Speed* is the
kinetic energy: of a parabola at the outlet, twice rho u^2 / 2, less that of an even flow at the inlet, with 0.33 rho u^2 / 2 for the friction of
the entrance (Shah and London, Laminar flow forced convection in ducts, 1978). *Widenings* is rho / 2 times the square of each fall of the mean
speed along the path (Borda and Carnot), where forks and narrowings end. An even flow becomes a parabola over 0.06 R diameters, the *entrance*.
"""


def summed(inlet):
    return inlet["bends"] * inlet["mesh"] + inlet["kinetic"] + inlet["widenings"]


def report(results):
    text = TEXT + "\n" + table(
        ["case", "cells", "layers on the wall", "non-orthogonality, degrees", "skewness", "checkMesh", "steps", "residuals", "balance, %", "processor s"],
        [[name, f"{r['cells']:,}", f"{r['layers']:.0f} %", f"{r['non_orthogonal']:.1f}", f"{r['skew']:.2f}", "OK" if r["ok"] else "**faults**",
          r["steps"] if r["converged"] else f"**{r['steps']}, not converged**",
          "{:.1g}, {:.1g}".format(*r["residuals"][-1]), f"{r['balance']:.4f}", f"{r['seconds']:.0f}"]
         for name, r in results.items()])
    text += "Pictures `flows_pressure.svg` and `flows_speed.svg`: residuals of the pressure and of the speed.\n\n" + PARTS + "\n"
    text += table(
        ["case, inlet", "Reynolds", "Dean", "path, mm", "entrance, mm", "rho u^2 / 2", "svZeroD", "Poiseuille", "bends", "x mesh", "+ speed", "+ widenings", "sum",
         "OpenFOAM", "beside the sum"],
        [[f"{name}, {i['inlet']}", f"{i['reynolds']:.0f}", f"{i['dean']:.0f}", f"{i['path_mm']:.0f}", f"{i['entrance_mm']:.0f}", f"{i['dynamic']:.0f}",
          f"{r['zero_d'][i['inlet']] - r['zero_d'][i['outlet']]:.0f}" if i["outlet"] in r["zero_d"] else "-", f"{i['law']:.0f}", f"{i['bends']:.0f}",
          f"{i['mesh']:.3f}", f"{i['kinetic']:.0f}", f"{i['widenings']:.0f}", f"{summed(i):.0f}", f"{i['found']:.0f}", f"{100 * (i['found'] / summed(i) - 1):+.0f} %"]
         for name, r in results.items() for i in r["inlets"]])
    return text


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    lumen, solver, data, folder = (Path(word).resolve() for word in sys.argv[1:5])
    folder.mkdir(parents=True, exist_ok=True)
    results = {name: measure(lumen, solver, data, folder, name) for name in sys.argv[5:] or CASES}
    text = report(results)
    for k, what in enumerate(("pressure", "speed")):
        curves = [{"name": name, "dashed": False, "points": [[n + 1, values[k]] for n, values in enumerate(r["residuals"])]} for name, r in results.items()]
        plot = {"title": f"Residuals of the {what}", "x": "step", "y": "initial residual", "logarithmic": True, "curves": curves}
        (folder / f"flows_{what}.plot.json").write_text(json.dumps(plot) + "\n")
    (folder / "flows.md").write_text(text.rstrip() + "\n")
    print(text, end="")


if __name__ == "__main__":
    main()
