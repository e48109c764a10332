// SPDX-License-Identifier: Apache-2.0
#include "converters/io/labels/label_meaning.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "converters/io/labels/known_tables.h"

namespace lumen::convert {
namespace {

constexpr double kMostLabel = 1 << 24;  // the largest label that a volume of floats holds

template <class T>
bool isLabel(T voxel) {
  if constexpr (std::is_floating_point_v<T>)
    return std::abs(voxel) <= static_cast<T>(kMostLabel) && std::round(voxel) == voxel;
  return true;
}

}  // namespace

std::string sourcesOf(const LabelMeaning& meaning) {
  if (meaning.roleFrom.empty() || meaning.roleFrom == meaning.nameFrom) return meaning.nameFrom;
  return meaning.nameFrom.empty() ? meaning.roleFrom : meaning.nameFrom + ", " + meaning.roleFrom;
}

std::vector<LabelMeaning> meaningsOf(const LabelTable& table) {
  std::vector<LabelMeaning> meanings;
  for (const auto& [value, name] : table.names) {
    LabelMeaning meaning{value, name, LabelRole::Unknown, table.from, {}};
    if (const auto stated = table.roles.find(value); stated != table.roles.end()) {
      meaning.role = stated->second;
      meaning.roleFrom = table.rolesFrom;
      meaning.isStated = true;
    } else if (const KnownName* known = findKnownName(name)) {
      meaning.role = known->role;
      meaning.roleFrom = known->table;
      meaning.isStated = true;
    } else if (meaning.role = roleOfName(name); meaning.role != LabelRole::Unknown) {
      meaning.roleFrom = "its name";
    }
    meanings.push_back(std::move(meaning));
  }
  return meanings;
}

LabelNames namesOf(const std::vector<LabelMeaning>& meanings) {
  LabelNames names;
  for (const LabelMeaning& meaning : meanings)
    if (!meaning.name.empty()) names.emplace(meaning.value, meaning.name);
  return names;
}

bool stateRole(const RoleStatement& statement, const std::string& from,
               std::vector<LabelMeaning>& meanings) {
  bool isFound = false;
  for (LabelMeaning& meaning : meanings) {
    const bool isNamed =
        !meaning.name.empty() && plainName(meaning.name) == plainName(statement.label);
    if (!isNamed && std::to_string(meaning.value) != statement.label) continue;
    meaning.roleFrom = from;
    meaning.role = statement.role;
    meaning.isStated = isFound = true;
  }
  return isFound;
}

std::map<std::int64_t, std::size_t> countLabels(const Volume& volume) {
  return std::visit(
      [&](const auto& voxels) {
        std::map<std::int64_t, std::size_t> counts;
        for (std::size_t i = 0; i < voxels.size();) {
          const auto voxel = voxels[i];
          if (!isLabel(voxel)) return std::map<std::int64_t, std::size_t>();
          const std::size_t first = i;
          while (i < voxels.size() && !(voxels[i] < voxel) && !(voxels[i] > voxel)) ++i;
          const auto value = static_cast<std::int64_t>(voxel);
          if (value != 0) counts[value] += i - first;
        }
        return counts;
      },
      volume.voxels);
}

void addUnnamed(const std::map<std::int64_t, std::size_t>& counts,
                std::vector<LabelMeaning>& meanings) {
  const auto byValue = [](const LabelMeaning& meaning, std::int64_t value) {
    return meaning.value < value;
  };
  for (const auto& [value, count] : counts) {
    const auto at = std::lower_bound(meanings.begin(), meanings.end(), value, byValue);
    if (at == meanings.end() || at->value != value)
      meanings.insert(at, LabelMeaning{value, {}, LabelRole::Unknown, {}, {}});
  }
}

}  // namespace lumen::convert
