// SPDX-License-Identifier: Apache-2.0
// Parts of the readers of tables of labels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "converters/io/labels/label_table.h"

namespace lumen::convert {

/// "FILE: line N: ".
std::string linePlace(const std::string& file, std::size_t line);

/// Adds one name; `place` begins messages. Throws Error(InvalidInput) for a label or a name that is
/// none, and for a label that has a name.
void addLabelName(const std::string& place, const std::string& value, const std::string& name,
                  LabelNames& names);

/// True for the rows of label, name and colour of 3D Slicer or FreeSurfer, or label descriptions of
/// ITK-SNAP.
bool isColourTable(const std::string& text);
/// Their names. Throws as readLabelTable().
LabelNames namesOfColourTable(const std::string& text, const std::string& file);

}  // namespace lumen::convert
