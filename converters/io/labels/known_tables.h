// SPDX-License-Identifier: Apache-2.0
// Tables of labels that come with the program: a file each below tables/. Its first line is its
// title, lines that begin with # state its source, all others are VALUE,NAME or VALUE,NAME,ROLE.
// Without a role the words of the name show it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "converters/io/labels/label_role.h"

namespace lumen::convert {

struct KnownLabel {
  std::string name;
  LabelRole role = LabelRole::Unknown;
};

struct KnownTable {
  std::string word;   ///< as options take it: "totalsegmentator-v1"
  std::string title;  ///< for people: "TotalSegmentator total v1"
  std::map<std::int64_t, KnownLabel> labels;
};

const std::vector<KnownTable>& knownTables();

/// The table of this word, or null.
const KnownTable* findKnownTable(std::string_view word);

struct KnownName {
  LabelRole role = LabelRole::Unknown;
  std::string table;  ///< the title of the first table that has the name
};

/// The label of this name, whatever its number, in any of the tables; null if none has it. Names
/// are compared as plainName() has them.
const KnownName* findKnownName(std::string_view name);

}  // namespace lumen::convert
