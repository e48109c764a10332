# SPDX-License-Identifier: Apache-2.0
"""Descriptions that BIDS asks of derivatives: data set, sidecars, columns of tables."""
import pathlib

from .files import read_json, write_json, write_text

BIDS_VERSION = "1.8.0"
# files of derivatives for which BIDS has no name yet
IGNORED = ("*_desc-*", "library/", "measures.*", "quality.html", "volumes.csv", "library.csv",
           "logs/")


def describe_dataset(out, root, version):
    """Writes dataset_description.json, README and .bidsignore of the derivatives."""
    source = read_json(pathlib.Path(root) / "dataset_description.json", "description")
    value = {
        "Name": f"Vessels of {source.get('Name', 'a data set')}",
        "BIDSVersion": BIDS_VERSION,
        "DatasetType": "derivative",
        "GeneratedBy": [{"Name": "lumen-bids", "Version": version,
                         "Description": "Vessels of angiograms as surfaces and centerlines"}],
        "SourceDatasets": [{"URL": source["DatasetDOI"]} if "DatasetDOI" in source else {}]}
    if not value["SourceDatasets"][0]:
        del value["SourceDatasets"]
    if "License" in source:
        value["License"] = source["License"]
    out = pathlib.Path(out)
    write_json(value, out / "dataset_description.json")
    write_text("".join(f"{name}\n" for name in IGNORED), out / ".bidsignore")
    write_text(README, out / "README")


def case_sidecar(volume, recipe, version):
    """Provenance of a case, of its mesh, and of its centerline."""
    return {
        "Description": "Vessels of an angiogram: centerlines, radii and wall (case of lumen)",
        "Sources": [f"bids:raw:{volume.place}"],
        "GeneratedBy": [{"Name": "lumen", "Version": version}],
        "Units": "mm",
        "Frame": "LPS",
        "Inputs": recipe.parts,
        "RecipeSHA256": recipe.digest}


def measure_columns():
    """The data dictionary of a table of measures; docs/measures.md of lumen derives each."""
    return {
        "kind": {"Description": "Kind of the thing that is measured: stations along a vessel, "
                                "vessels, paths, forks, narrowings or sacs"},
        "of": {"Description": "Name of the vessel, path, fork, narrowing or sac"},
        "x_mm": {"Description": "Place in LPS, +x left", "Units": "mm"},
        "y_mm": {"Description": "Place in LPS, +y back", "Units": "mm"},
        "z_mm": {"Description": "Place in LPS, +z head", "Units": "mm"},
        "measure": {"Description": "Name of the number; its end is the unit"},
        "value": {"Description": "The number, in the unit that ends the name of the measure"},
        "plus_minus": {"Description": "Half of its 95 % interval"},
        "absent": {"Description": "Reason why there is no number"}}


README = """Vessels of angiograms, made by lumen-bids.

Each volume has, beside the place of its file in the raw data set,

  *_desc-vessels_*.lumen     the case: centerlines, radii, wall; lumen reads it
  *_desc-vessels_*.json      its provenance: inputs with digests, version
  *_desc-vessels_*.glb       the wall as a mesh; metres, +Y up
  *_desc-centerline_*.swc    the centerlines with radii; mm, LPS
  *_desc-check_*.json        agreement of the case with its volume
  *_desc-measures_*.tsv      measures with uncertainties
  *_desc-report_*.html       a page to print
  *_desc-fault_*.json        the reason why a volume has none of these

The level group writes library/ (lumen library check reads it), measures.tsv and quality.html.
Not for clinical use.
"""
