#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs what `lumen export svzerod` writes in svZeroDSolver itself.

check_svzerod.py LUMEN --solve [CASE...]
check_svzerod.py LUMEN SOLVER_SOURCE BUILD_FOLDER [CASE...]

Checks that flow is conserved at every junction, that pressures there agree, that a tube has Poiseuille's resistance to
1 %, and that outlets get their share. With --solve the steady flow of the model is solved here; else the solver is built
from its source (a folder with a CMakeLists.txt that makes `svzerodsolver`) into BUILD_FOLDER. CASEs are run too. Exit
status: 0 all held, 1 something did not, 77 there is no solver."""
import csv, json, math, pathlib, subprocess, sys, tempfile
from flow_cases import *

MU, DYN = 0.04, 1e-6  # poise; agreement of flows and pressures as shares of the greatest


def build(source, folder):
    if not (source / "CMakeLists.txt").is_file(): skip(f"{source} is not there, so there is no svZeroDSolver to run")
    for command in (["cmake", "-S", source, "-B", folder, "-DCMAKE_BUILD_TYPE=Release"], ["cmake", "--build", folder]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0: sys.exit(f"svZeroDSolver does not build:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return folder / "svzerodsolver"


def solved(rows):
    """The solution of linear equations, each a list of coefficients and the right side, by elimination."""
    count = len(rows)
    for k in range(count):
        best = max(range(k, count), key=lambda r: abs(rows[r][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for r in range(count):
            if r == k or rows[r][k] == 0: continue
            factor = rows[r][k] / rows[k][k]
            rows[r] = [a - factor * b for a, b in zip(rows[r], rows[k])]
    return [rows[k][count] / rows[k][k] for k in range(count)]


def steady(model):
    """The flow and pressures of each vessel, as the solver has them when the walls have taken up what they can: the unknowns are
    the pressures at its two ends and its flow."""
    vessels, conditions = model["vessels"], {b["bc_name"]: b for b in model["boundary_conditions"]}
    column = lambda vessel, what: 3 * vessel + ("pressure_in", "pressure_out", "flow").index(what)
    def equation(right, *terms):
        row = [0.0] * (3 * len(vessels)) + [right]
        for at, factor in terms: row[at] += factor
        return row
    rows = []
    for vessel in vessels:
        at = lambda what: column(vessel["vessel_id"], what)
        values, ends = vessel["zero_d_element_values"], vessel.get("boundary_conditions", {})
        expect(all(v > 0 for k, v in values.items() if k != "stenosis_coefficient"), f"{vessel['vessel_name']}: {values}")
        rows.append(equation(0, (at("pressure_in"), 1), (at("pressure_out"), -1), (at("flow"), -values["R_poiseuille"])))
        if "inlet" in ends: rows.append(equation(conditions[ends["inlet"]]["bc_values"]["Q"][-1], (at("flow"), 1)))
        if "outlet" in ends:
            outlet = conditions[ends["outlet"]]["bc_values"]
            rows.append(equation(outlet["Pd"], (at("pressure_out"), 1), (at("flow"), -outlet["R"])))
    for junction in model["junctions"]:
        ends = [(v, "pressure_out", 1) for v in junction["inlet_vessels"]]
        ends += [(v, "pressure_in", -1) for v in junction["outlet_vessels"]]
        rows.append(equation(0, *((column(v, "flow"), sign) for v, _, sign in ends)))
        first = column(ends[0][0], ends[0][1])
        rows += [equation(0, (column(v, end), 1), (first, -1)) for v, end, _ in ends[1:]]
    if len(rows) != 3 * len(vessels): sys.exit(f"the model has {len(rows)} conditions, expected {3 * len(vessels)}")
    found = solved(rows)
    answer = {}
    for vessel in vessels:
        pressure_in, pressure_out, flow = found[3 * vessel["vessel_id"]:3 * vessel["vessel_id"] + 3]
        answer[vessel["vessel_name"]] = dict(pressure_in=pressure_in, pressure_out=pressure_out, flow_in=flow, flow_out=flow)
    return answer


def run(solver, program, folder, case, name):
    """The exported model, and of each of its vessels flows and pressures at the end. `solver`: None for steady()."""
    lumen(program, folder, "export", "svzerod", str(case), name, "--quiet")
    model = json.loads((folder / name / "model.json").read_text())
    if solver is None: return model, steady(model)
    done = subprocess.run([solver, folder / name / "model.json", folder / name / "out.csv"], capture_output=True, text=True)
    if done.returncode != 0: sys.exit(f"{name}: svZeroDSolver gives up: {done.stdout[-500:]}{done.stderr[-500:]}")
    last = {}
    with open(folder / name / "out.csv", newline="") as rows:
        for row in csv.DictReader(rows): last[row["name"]] = {k: float(v) for k, v in row.items() if k != "name"}
    expect(set(last) == {v["vessel_name"] for v in model["vessels"]}, f"{name}: the solver answers for every vessel")
    return model, last


def check_balance(name, model, last):
    by_id = {v["vessel_id"]: last[v["vessel_name"]] for v in model["vessels"]}
    greatest = max(abs(v["flow_in"]) for v in by_id.values())
    expect(greatest > 0, f"{name}: something flows")
    for vessel in by_id.values(): expect(all(map(math.isfinite, vessel.values())), f"{name}: numbers are finite")
    for junction in model["junctions"]:
        into, out = junction["inlet_vessels"], junction["outlet_vessels"]
        expect(into and len(into) + len(out) > 1, f"{name} {junction['junction_name']}: joins vessels")
        rest = sum(by_id[v]["flow_out"] for v in into) - sum(by_id[v]["flow_in"] for v in out)
        expect(abs(rest) <= DYN * greatest, f"{name} {junction['junction_name']}: {rest} cm^3/s are lost of {greatest}")
        pressures = [by_id[v]["pressure_out"] for v in into] + [by_id[v]["pressure_in"] for v in out]
        expect(max(pressures) - min(pressures) <= DYN * max(map(abs, pressures)), f"{name}: one pressure at a junction")
    inlets = {b["bc_name"]: b["bc_values"]["Q"][0] for b in model["boundary_conditions"] if b["bc_type"] == "FLOW"}
    ends = [(v, v.get("boundary_conditions", {})) for v in model["vessels"]]
    into = sum(last[v["vessel_name"]]["flow_in"] for v, e in ends if "inlet" in e)
    out = sum(last[v["vessel_name"]]["flow_out"] for v, e in ends if "outlet" in e)
    near(into, sum(inlets.values()), 1e-6, f"{name}: what flows in")
    near(out, into, 1e-6, f"{name}: what flows out")
    named = [e[k] for _, e in ends for k in e]
    expect(sorted(named) == sorted(b["bc_name"] for b in model["boundary_conditions"]), f"{name}: each condition is at one end")


def check_tube(solver, program, folder):
    write_case(folder / "tube.lumen.json", tube())
    model, last = run(solver, program, folder, folder / "tube.lumen.json", "tube")
    row = last["branch0_seg0"]
    near((row["pressure_in"] - row["pressure_out"]) / row["flow_in"], 8 * MU * 10 / (math.pi * 0.2 ** 4), 1e-5, "tube: Poiseuille's resistance")
    near(row["pressure_out"], 133320, 1e-5, "tube: 100 mmHg at its outlet")
    near(row["flow_in"], 20 * math.pi * 0.04, 1e-5, "tube: 20 cm/s at its inlet")


def check_traced_tube(solver, program, folder):
    """The true centerline of a phantom, which is what a user has."""
    lumen(program, folder, "phantom", "tube", "t.nrrd", "--size", "64", "--truth", "t.lumen.json", "--quiet")
    tree = json.loads((folder / "t.lumen.json").read_text())["tree"]
    length = sum(math.dist(a, b) for a, b in zip(tree["centre"], tree["centre"][1:]))
    radius = sum(tree["radius"]) / len(tree["radius"])
    _, last = run(solver, program, folder, folder / "t.lumen.json", "phantom")
    row = last["branch0_seg0"]
    near((row["pressure_in"] - row["pressure_out"]) / row["flow_in"], 8 * MU * length / 10 / (math.pi * (radius / 10) ** 4), 0.01,
         "phantom of a tube: Poiseuille's resistance")


def check_fork(solver, program, folder):
    """Two outlets of radii 2 and 1 get 8 to 1, but for what the vessels themselves resist."""
    write_case(folder / "fork.lumen.json", [branch("trunk", line([0, 0, 0], [0, 0, 2], 3), 2.0),
                                            branch("wide", line([1, 0, 2], [2, 0, 2], 2), 2.0, parent=2),
                                            branch("thin", line([-1, 0, 2], [-2, 0, 2], 2), 1.0, parent=2)])
    model, last = run(solver, program, folder, folder / "fork.lumen.json", "fork")
    check_balance("fork", model, last)
    flows = {v["_label"]: last[v["vessel_name"]]["flow_out"] for v in model["vessels"]}
    near(flows["wide"] / flows["thin"], 8, 0.01, "fork: outlets take r^3")


def check(program, solver, cases):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_tube(solver, program, folder)
        check_traced_tube(solver, program, folder)
        check_fork(solver, program, folder)
        write_case(folder / "landmarks.lumen.json", landmarks())
        write_case(folder / "looped.lumen.json", *looped())
        write_case(folder / "forest.lumen.json", forest())
        for one in ("landmarks", "looped", "forest"):
            check_balance(one, *run(solver, program, folder, folder / f"{one}.lumen.json", one))
        for k, case in enumerate(cases):
            model, last = run(solver, program, folder, pathlib.Path(case).resolve(), f"case{k}")
            check_balance(case, model, last)
            print(f"{case}: {len(model['vessels'])} vessels, {len(model['junctions'])} junctions")
    return 1 if failures else 0


if __name__ == "__main__":
    program, *words = sys.argv[1:]
    solver, cases = (None, words[1:]) if words[0] == "--solve" else (build(*map(pathlib.Path, words[:2])), words[2:])
    sys.exit(check(str(pathlib.Path(program).resolve()), solver, cases))
