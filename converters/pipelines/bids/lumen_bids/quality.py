# SPDX-License-Identifier: Apache-2.0
"""The page on quality: every volume with its figures, those first that are unlike the others."""
import html
import statistics

TITLES = {
    "wall_offset_voxels": "wall offset, voxels",
    "wall_beyond_voxel_share": "wall over 1 voxel off",
    "no_edge_share": "wall without edge",
    "dark_share": "dark lumen",
    "missing_share": "vessels missed",
    "vessels": "vessels",
    "length_mm": "length, mm"}
SHARES = ("wall_beyond_voxel_share", "no_edge_share", "dark_share", "missing_share")
# Iglewicz and Hoaglin, How to detect and handle outliers, 1993: a modified z-score over 3.5
OUTLIER = 3.5
MAD_TO_SIGMA, MEAN_TO_SIGMA = 1.4826, 1.2533
# least standard deviations, so that equal volumes have no outliers by rounding
LEAST_SPREAD = {"wall_offset_voxels": 0.02, "vessels": 0.5, **{name: 0.01 for name in SHARES}}
LEAST_SHARE = {"length_mm": 0.05}  # of the median


def middle_and_spread(values):
    """Median and robust standard deviation of the values that are there; None where none is."""
    known = [v for v in values if v is not None]
    if not known:
        return None, 0.0
    middle = statistics.median(known)
    distances = [abs(v - middle) for v in known]
    spread = MAD_TO_SIGMA * statistics.median(distances)
    return middle, spread or MEAN_TO_SIGMA * statistics.fmean(distances)


def sort_by_outliers(rows):
    """The rows with their "scores" and "worst", the worst first; equal ones by name."""
    for row in rows:
        row["scores"] = {}
    for figure in TITLES:
        values = [row["figures"][figure] for row in rows]
        middle, spread = middle_and_spread(values)
        if middle is None:
            continue
        spread = max(spread, LEAST_SPREAD.get(figure, 0.0), LEAST_SHARE.get(figure, 0.0) * middle)
        for row, value in zip(rows, values):
            if value is not None:
                row["scores"][figure] = (value - middle) / spread if spread else 0.0
    for row in rows:
        row["worst"] = max((abs(s) for s in row["scores"].values()), default=0.0)
    return sorted(rows, key=lambda row: (-row["worst"], row["name"]))


def shown(figure, value):
    if value is None:
        return "-"
    if figure in SHARES:
        return f"{100 * value:.1f} %"
    return str(value) if isinstance(value, int) else f"{value:.2f}"


def cell(row, figure):
    score = row["scores"].get(figure, 0.0)
    mark = ' class="outlier"' if abs(score) > OUTLIER else ""
    return f'<td{mark} title="{score:+.1f}">{shown(figure, row["figures"][figure])}</td>'


def line(row):
    name, report = html.escape(row["name"]), html.escape(row["report"], quote=True)
    cells = "".join(cell(row, figure) for figure in TITLES)
    return f'<tr><td><a href="{report}">{name}</a></td><td>{row["worst"]:.1f}</td>{cells}</tr>\n'


def page(title, rows, missing):
    """The whole page; rows as sort_by_outliers() returns them, missing as (name, reason)."""
    outliers = sum(row["worst"] > OUTLIER for row in rows)
    heads = "".join(f"<th>{html.escape(t)}</th>" for t in TITLES.values())
    faults = "".join(f"<tr><td>{html.escape(n)}</td><td>{html.escape(w)}</td></tr>\n"
                     for n, w in missing)
    if faults:
        faults = (f"<h2>Without a case: {len(missing)}</h2>\n"
                  f'<table class="faults">\n{faults}</table>\n')
    return PAGE.format(title=html.escape(title), count=len(rows), outliers=outliers, faults=faults,
                       heads=heads, lines="".join(line(row) for row in rows), limit=OUTLIER)


PAGE = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}: quality</title>
<style>
body {{ font: 15px/1.45 system-ui, sans-serif; color: #222; }}
body {{ margin: 2em auto; max-width: 75em; padding: 0 1em; }}
table {{ border-collapse: collapse; width: 100%; }}
th, td {{ padding: .3em .6em; border-bottom: 1px solid #ddd; text-align: right; }}
th {{ vertical-align: bottom; font-weight: 600; }}
th:first-child, td:first-child {{ text-align: left; }}
.faults td {{ text-align: left; }}
td:first-child {{ white-space: nowrap; }}
.outlier {{ background: #fde3dc; color: #8a1c00; font-weight: 600; }}
</style>
<h1>{title}: quality</h1>
<p>{count} volumes; {outliers} with a figure that is unlike the others (marked: over {limit} robust
standard deviations from the median of all; hovering shows them). The worst come first.
Not for clinical use.</p>
{faults}<h2>Volumes</h2>
<table>
<tr><th>volume</th><th>worst</th>{heads}</tr>
{lines}</table>
</html>
"""
