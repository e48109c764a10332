// SPDX-License-Identifier: Apache-2.0
// Tables of the names of labels, as other programs write them.
//
// | content | table |
// |---|---|
// | `{...}` | JSON object of names by labels: {"1": "BA", "2": "R-PCA"} |
// | the header `# Color table` | colour table of 3D Slicer (.ctbl, .txt): label, name, four numbers of a colour; an underscore in a name is a space |
// | other | comma-separated values: label, name; or a header with a column `value`, `labelvalue`, `label`, `index` or `id`, and one `name` |
// | NRRD header | segments of 3D Slicer (.seg.nrrd): `Segment0_LabelValue:=1`, `Segment0_Name:=BA` |
//
// Formats of 3D Slicer: Slicer documentation, developer guide, modules Colors and Segmentations. The label 0 is
// what is around the vessels: tables may name it, and its name is passed over.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "converters/base/input_file.h"

namespace lumen::convert {

/// The names of labels by their values, which are not 0.
using LabelNames = std::map<std::int64_t, std::string>;

/// Names of the tables that need no file: "topcow".
const std::vector<std::string>& builtInLabelTables();

/// The names in a file, or in the table that is built in under this name. Throws Error(InvalidInput),
/// naming the file and the line or the place, for a file that is missing or is no such table, a label
/// that is no whole number or occurs twice, and a name that a branch cannot have.
LabelNames readLabelTable(const InputFile& file);

/// The names of the segments in the header of `file`; empty if it is no NRRD, or names none. Segments
/// of other layers than the first are passed over. Throws Error(InvalidInput) as readLabelTable() does.
LabelNames segmentNames(const InputFile& file);

}  // namespace lumen::convert
