// SPDX-License-Identifier: Apache-2.0
// Tables of the names of labels, as other programs write them. The content decides, not the ending
// of the name:
//
// | content | table |
// |---|---|
// | `{"labels": {...}}` | dataset.json of nnU-Net: numbers by names, or names by numbers as its first version has them; a region of several numbers is passed over |
// | other `{...}` | JSON object of names by labels: {"1": "BA", "2": "R-PCA"} |
// | the header `# Color table` | colour table of 3D Slicer (.ctbl, .txt): label, name, four numbers of a colour; an underscore in a name is a space |
// | rows of the same six words | colour table of FreeSurfer |
// | rows of seven numbers and a text | label descriptions of ITK-SNAP |
// | a tab in the first row, and no comma | tab-separated values, as BIDS has them (dseg.tsv) |
// | other | comma-separated values: label, name; or a header with a column `value`, `labelvalue`, `label`, `index` or `id`, one `name`, and perhaps one `role` |
//
// Maps name their labels themselves:
//
// | map | names |
// |---|---|
// | NRRD | segments of 3D Slicer (.seg.nrrd): `Segment0_LabelValue:=1`, `Segment0_Name:=BA`; the type of its terminology shows the role |
// | DICOM SEG | segments: number, label; the type of their coded terminology shows the role |
// | RTSTRUCT | structures: number, or the place in the list if one has none; name |
// | NIfTI | the extension of Connectome Workbench, as TotalSegmentator writes it: `<Label Key="1" ...><![CDATA[aorta]]></Label>` |
//
// Formats: Slicer documentation, developer guide, modules Colors and Segmentations; ITK-SNAP 4,
// label description files; FreeSurferColorLUT.txt; BIDS 1.9, derivatives, imaging, segmentations;
// nnU-Net v2, dataset format. The label 0 is what is around the vessels: tables may name it, and
// its name is passed over.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "converters/base/input_file.h"
#include "converters/io/labels/label_role.h"

namespace lumen::convert {

/// The names of labels by their values, which are not 0.
using LabelNames = std::map<std::int64_t, std::string>;

struct LabelTable {
  LabelNames names;
  std::map<std::int64_t, LabelRole> roles;  ///< as far as the table states them
  std::string from;       ///< for people: "dseg.tsv", "its header", the title of a built-in table
  std::string rolesFrom;  ///< the part of it that states the roles; empty: the same
};

/// Names of the tables that need no file: "topcow" and others.
const std::vector<std::string>& builtInLabelTables();

/// The table in a file, or the one that is built in under this name. Throws Error(InvalidInput),
/// naming the file and the line or the place, for a file that is missing or is no such table, a
/// label that is no whole number or occurs twice, a name that a branch cannot have, and a role that
/// is none.
LabelTable readLabelTable(const InputFile& file);

/// The names that the header of `file` itself states; without names if it states none. Segments of
/// other layers than `layer` are passed over. Throws Error(InvalidInput) as readLabelTable()
/// does.
LabelTable ownNames(const InputFile& file, std::int64_t layer = 0);

/// The tables that lie beside a map on this disk: NAME.tsv beside NAME.nii.gz whose name ends in
/// `dseg`, `dseg.tsv`, and `dataset.json`, also beside the folder labelsTr or labelsTs of the map.
/// Only names are looked at.
std::vector<InputFile> tablesBeside(const InputFile& map);

}  // namespace lumen::convert
