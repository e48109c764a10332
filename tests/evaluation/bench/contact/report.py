#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables and a picture of what contact_bench has measured; tables of contact_cuda.

report.py RESULTS.json [--picture FILE.png]

Prints two tables for each case as Markdown; docs/benchmarks.md says what the numbers are."""
import argparse
import json
import sys

COLOURS = {"libblob": "#1f6f8b", "Embree": "#c8553d", "FCL": "#8f5fa8", "OpenVDB": "#6a994e", "dense": "#888888"}


def rate(method, environments, threads):
    """Queries per second."""
    for r in method["rates"]:
        if (r["environments"], r["threads"]) == (environments, threads):
            return r["queries_per_s"]
    return 0


def million(number):
    """Three digits."""
    return f"{float(f'{number / 1e6:.3g}'):,g}"


def rows_of_rates(case):
    """The table of rates, and the sentence on Embree."""
    counts = sorted({r["environments"] for r in case["methods"][0]["rates"]})
    most, own = counts[-1], rate(case["methods"][0], counts[-1], 1)
    threads = [2] if rate(case["methods"][0], most, 2) else []  # a graphics card has none
    heads = [f"{n:,}" for n in counts] + [f"{most:,}, two threads" for _ in threads] + ["times libblob's time", "MB"]
    yield "| million queries/s | " + " | ".join(heads) + " |"
    yield "|---|" + "---:|" * len(heads)
    for m in case["methods"]:
        cells = [million(rate(m, n, 1)) for n in counts] + [million(rate(m, most, n)) for n in threads]
        cells += [f"{own / rate(m, most, 1):.1f}", f"{m['megabytes']:.1f}"]
        yield f"| {m['name']} | " + " | ".join(cells) + " |"


def rows_of_counts(case):
    """The table of what was got wrong."""
    first = case["methods"][0]
    yield f"| of {first['points']:,} points | wrong signs | false contacts | missed contacts | leaks of {first['kisses']:,} |"
    yield "|---|" + "---:|" * 4
    for m in case["methods"]:
        yield f"| {m['name']} | {m['wrong_signs']} | {m['false_contacts']} | {m['missed_contacts']} | {m['leaks']} |"


def tables(cases):
    """All of it as Markdown."""
    for case in cases:
        yield f"### {case['name']}\n"
        yield (f"{case['nodes']:,} nodes, {case['length_mm']:,.0f} mm, voxels of {case['voxel_mm']:.2g} mm, "
               f"{case['triangles']:,} triangles.\n")
        yield from rows_of_rates(case)
        yield ""
        yield from rows_of_counts(case)
        yield ""


def short(name):
    """Without sizes of cells, which differ between cases."""
    name = name.replace(" closest point", "").replace(" sphere to mesh", "")
    return name.split(",")[0] + (", coherent" if "coherent" in name else "")


def draw(cases, file):
    """Rates over environments above, leaks below; one column for each case."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(2, len(cases), figsize=(4.6 * len(cases), 7), squeeze=False,
                                gridspec_kw={"height_ratios": [3, 2]}, constrained_layout=True)
    for column, case in enumerate(cases):
        above, below = axes[0][column], axes[1][column]
        names, colours, leaks = [], [], []
        for m in case["methods"]:
            colour = COLOURS.get(m["name"].split()[0], "black")
            style = {"LOCAL": "--", "EXACT": ":", "coherent": "--"}.get(m["name"].split()[-1], "-")
            counts = sorted({r["environments"] for r in m["rates"]})
            above.plot(counts, [rate(m, n, 1) for n in counts], style, color=colour, marker="o", markersize=3,
                       label=short(m["name"]))
            names.append(short(m["name"]))
            colours.append(colour)
            leaks.append(100 * m["leaks"] / m["kisses"] if m["kisses"] else 0)
        above.set(xscale="log", yscale="log", title=case["name"], xlabel="environments of 100 points",
                  ylim=(2e4, 2e8))
        above.grid(alpha=0.3)
        below.barh(range(len(names)), leaks, color=colours)
        below.set(yticks=range(len(names)), yticklabels=names, xlim=(0, 100),
                  xlabel=f"% of {case['methods'][0]['kisses']} points that leak where vessels touch"
                  if case["methods"][0]["kisses"] else "no vessels touch here")
        below.invert_yaxis()
        for i, share in enumerate(leaks):
            below.text(share + 1 if share < 85 else share - 1, i, f"{share:.0f}", va="center", fontsize=8,
                       ha="left" if share < 85 else "right")
        if column:
            below.set_yticklabels([])
    axes[0][0].set_ylabel("contact queries per second, one thread")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=9, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=4)
    figure.savefig(file, dpi=80, bbox_inches="tight")


def main():
    """Reads, prints, draws."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", help="what contact_bench or contact_cuda --json has written")
    parser.add_argument("--picture", help="PNG or SVG to write")
    options = parser.parse_args()
    with open(options.results, encoding="utf-8") as file:
        cases = json.load(file)
    print("\n".join(tables(cases)))
    if options.picture:
        draw(cases, options.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
