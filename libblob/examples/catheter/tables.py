#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Thesis tables 5.2 and 5.3 again: the same rod against blobs and against triangles.

    tables.py --lumen build/.../lumen --catheter build/.../catheter --shapes build/.../catheter_shapes OUT

Makes the capsule, the spiral and the phantom `patient`, fits them, meshes the exact surfaces (capsule:
marching cubes as the thesis; spiral: regular sweeps; phantom: marching cubes of the fitted model), pushes
rods, and writes OUT/tables.md, OUT/capsule.svg, OUT/patient.svg and
OUT/timing.svg. Needs NumPy and Matplotlib. Everything is synthetic.
"""
import argparse
import json
import pathlib
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

CAPSULE_CELL = 0.17  # mm; gives the thesis' 12,000 triangles
SPIRAL_TRIANGLES = [2740, 11300, 45000]
PATIENT_CELL = 0.5  # mm; narrow vessels get finer ones
THESIS_FIT = ["--accuracy", "0.3", "--iso-level", "0.1"]
CLOSE_FIT = ["--accuracy", "0.02", "--iso-level", "0.1", "--curvature-weight", "0",
             "--cohesion-weight", "0"]
CAPSULE_ROD = ["--element", "0.06", "--tilt", "15", "--roll", "25", "--steps", "1750", "--speed",
               "5", "--friction", "0"]
SPIRAL_ROD = ["--element", "0.6", "--steps", "2000", "--friction", "0"]
PATIENT_ROD = ["--steps", "1900", "--young", "1e4"]


class Bench:
    def __init__(self, args):
        self.lumen, self.catheter, self.shapes = args.lumen, args.catheter, args.shapes
        self.out = pathlib.Path(args.out)
        self.out.mkdir(parents=True, exist_ok=True)

    def run(self, *command):
        return subprocess.run([str(c) for c in command], check=True, capture_output=True,
                              text=True).stdout

    def file(self, name):
        return self.out / name

    def mesh(self, source, cell):
        target = self.file(f"{pathlib.Path(source).stem}-{cell}.obj")
        self.run(self.lumen, "convert", source, target, "--cell", cell, "--quiet")
        return target

    def push(self, label, model, *options):
        """Pushes a rod; returns what the program reports, and the tip's path as columns."""
        path = self.file(f"{label}.csv")
        answer = json.loads(self.run(self.catheter, model, "--path", path, *options))
        answer["label"] = label
        answer["path"] = np.genfromtxt(path, delimiter=",", names=True)
        print(f"{label}: {answer['wall_ms']:.4f} ms", flush=True)
        return answer


def shape(bench, name, rod, triangles=()):
    """Rods in a synthetic shape: two fits and meshes, the wall asked in each iteration or once a step."""
    bench.run(bench.shapes, name, bench.out, *triangles)
    truth = bench.file(f"{name}-truth.lumen")
    meshes = [bench.file(f"{name}-{n}.obj") for n in triangles] or [bench.mesh(truth, CAPSULE_CELL)]
    common = ["--truth", truth, *rod]
    rows = []
    for label, fit in (("LIM", THESIS_FIT), ("LIM close fit", CLOSE_FIT)):
        model = bench.file(f"{name}-{label.replace(' ', '-')}.lumen")
        bench.run(bench.lumen, "fit", bench.file(f"{name}.lumen"), model, "--quiet", *fit)
        rows += pushes(bench, f"{name}, {label}", model, *common)
        rows.append(bench.push(f"{name}, {label}, local", model, *common, "--local", 1))
    for mesh in meshes:
        rows += pushes(bench, f"{name}, mesh {triangle_count(mesh)}", model, "--mesh", mesh, *common)
    return rows


def pushes(bench, label, model, *options):
    return [bench.push(label, model, *options),
            bench.push(f"{label}, once a step", model, *options, "--once", 1)]


def triangle_count(mesh):
    return sum(line.startswith("f ") for line in mesh.open())


def patient(bench):
    volume, seeds, model = (bench.file(f"patient{e}") for e in (".nrrd", ".json", ".lumen"))
    if not model.exists():
        bench.run(bench.lumen, "phantom", "patient", volume, "--seeds", seeds, "--quiet")
        bench.run(bench.lumen, "convert", volume, model, "--seeds", seeds, "--quiet")
    mesh = bench.mesh(model, PATIENT_CELL)
    rows = pushes(bench, "patient, LIM", model, *PATIENT_ROD)
    rows.append(bench.push("patient, LIM, local", model, *PATIENT_ROD, "--local", 1))
    rows += pushes(bench, f"patient, mesh {triangle_count(mesh)}", model, "--mesh", mesh,
                   *PATIENT_ROD)
    return rows


def tables(capsule, others):
    lines = ["Table 5.2 again: the tip on the capsule's wall. Lengths in micrometres.", "",
             "| rod and wall | N_P | N_u | line RMS | gap min | median | 90 % | max | jerk |",
             "|---|--:|--:|--:|--:|--:|--:|--:|--:|"]
    for r in capsule:
        gap = [1e3 * r["gap_mm"][k] for k in ("min", "median", "p90", "max")]
        lines.append(f"| {r['label']} | {r['steps']} | {r['used']} | {1e3 * r['line_rms_mm']:.3f} | "
                     + " | ".join(f"{g:.2f}" for g in gap) + f" | {1e3 * r['gap_jerk_mm']:.3f} |")
    lines += ["", "Table 5.3 again: collision detection in one time step, median of the last tenth.", "",
              "| rod and wall | primitives | wall, ms | solver, ms | contacts, mean | most |",
              "|---|--:|--:|--:|--:|--:|"]
    for r in capsule + others:
        lines.append(f"| {r['label']} | {r['primitives']} | {r['wall_ms']:.4f} | "
                     f"{r['solver_ms']:.3f} | {r['contacts_mean']:.1f} | {r['contacts_most']} |")
    return "\n".join(lines) + "\n"


def plot_capsule(rows, file):
    """Side view of the tip's gap and of its jerks along the capsule."""
    figure, axes = plt.subplots(2, 1, figsize=(8, 6), sharex=True)
    for r in rows:
        if "local" in r["label"]:
            continue
        p = r["path"]
        touching = p["touches"] > 0
        radial = np.hypot(p["y"], p["z"])
        axes[0].plot(p["x"][touching], radial[touching], lw=1, label=r["label"].split(", ", 1)[1])
        jerk = np.abs(np.diff(radial, 2))[touching[1:-1]]
        axes[1].semilogy(p["x"][1:-1][touching[1:-1]], np.maximum(jerk, 1e-9), lw=0.6)
    axes[0].set_ylabel("tip's distance from the axis (mm)")
    axes[0].legend(fontsize=7)
    axes[1].set_ylabel("its second difference (mm)")
    axes[1].set_xlabel("along the capsule (mm)")
    axes[0].set_title("Frictionless tip on the capsule's wall, synthetic")
    save(figure, file)


def plot_patient(rows, file):
    figure, axes = plt.subplots(1, 2, figsize=(10, 5))
    for r in rows:
        if "local" in r["label"]:
            continue
        p = r["path"]
        label = r["label"].split(", ", 1)[1]
        axes[0].plot(p["x"], p["z"], lw=1, label=label)
        axes[1].semilogy(p["step"], p["wall_us"], lw=0.5, label=label)
    axes[0].set(xlabel="x (mm)", ylabel="z (mm)", aspect="equal", title="path of the tip")
    axes[1].set(xlabel="step", ylabel="wall (us a step)", title="cost of the wall")
    axes[1].legend(fontsize=7)
    save(figure, file)


def plot_timing(rows, file):
    figure, axis = plt.subplots(figsize=(8, 0.3 * len(rows) + 1))
    colours = ["tab:orange" if r["wall"] == "mesh" else "tab:blue" for r in rows]
    axis.barh([r["label"] for r in rows], [r["wall_ms"] for r in rows], color=colours)
    axis.set(xscale="log", xlabel="collision detection in one time step (ms)")
    axis.invert_yaxis()
    save(figure, file)


def save(figure, file):
    figure.tight_layout()
    figure.savefig(file)
    figure.savefig(file.with_suffix(".png"), dpi=100)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name in ("lumen", "catheter", "shapes"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("out")
    bench = Bench(parser.parse_args())
    capsule = shape(bench, "capsule", CAPSULE_ROD)
    spiral = shape(bench, "spiral", SPIRAL_ROD, SPIRAL_TRIANGLES)
    vessels = patient(bench)
    text = tables(capsule, spiral + vessels)
    bench.file("tables.md").write_text(text)
    print(text)
    plot_capsule(capsule, bench.file("capsule.svg"))
    plot_patient(vessels, bench.file("patient.svg"))
    plot_timing(capsule + spiral + vessels, bench.file("timing.svg"))


if __name__ == "__main__":
    main()
