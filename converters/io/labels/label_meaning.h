// SPDX-License-Identifier: Apache-2.0
// The meanings of the labels of a map: names and roles, each with its source.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "converters/io/labels/label_table.h"
#include "converters/voxels/volume.h"

namespace lumen::convert {

struct LabelMeaning {
  std::int64_t value = 0;
  std::string name;  ///< empty: no table names it
  LabelRole role = LabelRole::Unknown;
  std::string nameFrom;   ///< for people: the source of the name, "dseg.tsv"; or empty
  std::string roleFrom;   ///< the same of the role: "its name"
  bool isStated = false;  ///< the role is that of a table or an option, not a guess from the name
};

/// "dseg.tsv, its name"; one source alone where both are the same; empty without any.
std::string sourcesOf(const LabelMeaning& meaning);

/// The meanings of the labels that a table names, by their values. The role of a label is the one
/// that the table states, or else that of the label of this name in a table that comes with the
/// program (known_tables.h), or else the one that the words of its name show.
std::vector<LabelMeaning> meaningsOf(const LabelTable& table);

/// The names that are known.
LabelNames namesOf(const std::vector<LabelMeaning>& meanings);

/// The role that a person states for a label by its name or its number.
struct RoleStatement {
  std::string label;
  LabelRole role = LabelRole::Unknown;
};

/// Gives the labels of this name or number the role; `from` is its source for people. False if
/// there is none.
bool stateRole(const RoleStatement& statement, const std::string& from,
               std::vector<LabelMeaning>& meanings);

/// The number of voxels of each label but 0; of none if a voxel is no whole number up to 2^24.
std::map<std::int64_t, std::size_t> countLabels(const Volume& volume);

/// Adds the labels that voxels have and no table names.
void addUnnamed(const std::map<std::int64_t, std::size_t>& counts,
                std::vector<LabelMeaning>& meanings);

}  // namespace lumen::convert
