# SPDX-License-Identifier: Apache-2.0
"""The level group: the library, the table of measures, the page on quality."""
import csv
import io
import json
import pathlib

from .dataset import label_table
from .describe import measure_columns
from .errors import FAILED, Fault
from .files import read_json, write_json, write_text
from .participant import CASE, CHECK, FAULT, MEASURES, REPORT
from .quality import page, sort_by_outliers

STATEMENTS = ("description", "anatomy", "codes", "laterality", "modality", "synthetic", "licence",
              "attribution", "doi", "origin", "consent", "deidentification")
# stations along vessels are a hundred rows for each vessel; each volume's own table has them
LEFT_OUT_KINDS = ("stations",)


def read_statements(file):
    """Statements about all cases: columns of lumen library build. Raises Fault."""
    if not file:
        return {}
    statements = read_json(file, "file of statements")
    for key, value in statements.items():
        if key not in STATEMENTS:
            raise Fault(f"{file}: found {key!r}, expected some of {', '.join(STATEMENTS)}")
        if not isinstance(value, (str, bool)):
            raise Fault(f"{file}: {key}: found {value!r}, expected a text")
    return statements


def list_text(rows, statements, targets):
    """The list of lumen library build; `rows` are (input, id, title, options)."""
    given = {k: ("yes" if v else "no") if isinstance(v, bool) else v for k, v in statements.items()}
    options = sorted({name for row in rows for name in row[3]})
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(["input", "id", "title", "targets", *given, *options])
    for file, name, title, own in rows:
        table.writerow([file, name, title, ";".join(targets), *given.values(),
                        *(own.get(option, "") for option in options)])
    return out.getvalue()


def write_volume_list(volumes, out, options):
    """The list that makes a library of the volumes themselves: for library build and Snakemake."""
    rows = []
    for volume in volumes:
        own = {}
        if volume.labels:
            own["--label-map"] = str(volume.labels.resolve())
            if table := label_table(volume.labels):
                own["--label-table"] = str(table.resolve())
        rows.append((volume.file.resolve(), volume.case_id, volume.name, own))
    file = pathlib.Path(out) / "volumes.csv"
    write_text(list_text(rows, read_statements(options.statements), options.export), file)
    print(f"{file}: {len(rows)} volumes")
    return 0


def build_library(volumes, out, options, program):
    """Puts the cases that are there into OUT/library, without those that are gone."""
    library = pathlib.Path(out) / "library"
    if not (library / "library.json").exists():
        words = ["library", "init", library, "--title", options.title]
        if options.licence:
            words += ["--licence", options.licence]
        program.run(*words)
    rows = [(v.derivative(out, *CASE).relative_to(out).as_posix(), v.case_id, v.name, {}) for v in volumes]
    file = pathlib.Path(out) / "library.csv"
    write_text(list_text(rows, read_statements(options.statements), options.export), file)
    program.run("library", "build", file, library, "--jobs", options.jobs)


def measure_table(volumes, out):
    """Measures of all volumes as one table, with participant and session. Writes both files."""
    text = io.StringIO()
    table = csv.writer(text, delimiter="\t", lineterminator="\n")
    columns = measure_columns()
    table.writerow(["participant_id", "session_id", "volume", *columns])
    for volume in volumes:
        with open(volume.derivative(out, *MEASURES), encoding="utf-8", newline="") as rows:
            for row in list(csv.reader(rows, delimiter="\t"))[1:]:
                if row[0] not in LEFT_OUT_KINDS:
                    table.writerow([f"sub-{volume.subject}",
                                    f"ses-{volume.session}" if volume.session else "n/a",
                                    volume.name, *row])
    out = pathlib.Path(out)
    write_text(text.getvalue(), out / "measures.tsv")
    write_json({"participant_id": {"Description": "Participant"},
                "session_id": {"Description": "Session, or n/a"},
                "volume": {"Description": "Name of the volume's file, without its ending"},
                **columns}, out / "measures.json")


def quality_rows(volumes, out):
    """Figures of agreement of each volume that has them."""
    rows = []
    for volume in volumes:
        file = volume.derivative(out, *CHECK)
        check = json.loads(file.read_text(encoding="utf-8"))
        wall = check["wall"]
        vessels = vessel_figures(volume.derivative(out, *MEASURES))
        rows.append({
            "name": volume.name,
            "report": volume.derivative(out, *REPORT).relative_to(out).as_posix(),
            "figures": {
                "wall_offset_voxels": wall["offset_voxels"]["median_absolute"],
                "wall_beyond_voxel_share": wall["beyond_voxel_share"],
                "no_edge_share": wall["no_edge_share"],
                "dark_share": check["dark_share"],
                "missing_share": check["missing_share"],
                **vessels}})
    return rows


def vessel_figures(table):
    """Number of vessels and their length in mm, of a table of measures."""
    count, length = 0, 0.0
    with open(table, encoding="utf-8", newline="") as rows:
        for row in csv.DictReader(rows, delimiter="\t"):
            if row["kind"] == "vessels" and row["measure"] == "length_mm":
                count += 1
                length += float(row["value"]) if row["value"] != "n/a" else 0.0
    return {"vessels": count, "length_mm": length}


def run(volumes, out, options, program):
    """Writes library, table and page of what the level participant made; the exit code."""
    made = [v for v in volumes if all(v.derivative(out, *k).is_file()
                                      for k in (CASE, CHECK, MEASURES, REPORT))]
    missing = [(v.name, why_missing(v, out)) for v in volumes if v not in made]
    if not made:
        raise Fault(f"{out}: found no case, expected those of lumen-bids BIDS OUT participant")
    build_library(made, out, options, program)
    measure_table(made, out)
    rows = sort_by_outliers(quality_rows(made, out))
    write_text(page(options.title, rows, missing), pathlib.Path(out) / "quality.html")
    print(f"{out}: {len(made)} volumes in library, measures.tsv and quality.html, "
          f"{len(missing)} without a case")
    return FAILED if missing else 0


def why_missing(volume, out):
    try:
        return read_json(volume.derivative(out, *FAULT), "fault")["Why"]
    except (Fault, KeyError):
        return "the level participant has not made it"
