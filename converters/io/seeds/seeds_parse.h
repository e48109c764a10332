// SPDX-License-Identifier: Apache-2.0
// Reading seeds from JSON. Private to the sources of seeds.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/json_place.h"
#include "converters/io/seeds/seeds.h"

namespace lumen::convert {

/// Millimetres in the unit that `unit` names: "mm" or "m". The reading states another.
double unitInMillimetres(const JsonPlace& unit, const SeedReading& reading);

/// Sets the kind that "vessel", "aneurysm" or "root" names; false for another word.
bool setKind(const std::string& word, SeedBranch& branch);
/// The word of a branch's kind.
std::string kindOf(const SeedBranch& branch);

// Rules for the branches of every seeds file. Private to the sources of seeds.

/// Branches in file order, checked, with doubled points merged and unit directions, parents first.
/// A parent is another branch, or one of `vessels`. Throws Error(InvalidInput), naming `file` and
/// the label.
std::vector<SeedBranch> checkedSeeds(std::vector<SeedBranch> branches,
                                     const std::filesystem::path& file,
                                     const std::set<std::string>& vessels = {});

// Descriptions of control points, for data that 3D Slicer has no field for. Private to the sources
// of seeds.

/// Reads "parent=LABEL; kind=aneurysm; radius=2.5" into `branch`, its frame included; words without
/// "=" are remarks. Calls `refuse`, which throws, with the expectation.
void applyDescription(const std::string& text, SeedBranch& branch,
                      const std::function<void(const std::string&)>& refuse);

// lumen's own seeds format (spec/seeds.md). Private to the sources of seeds.

/// `version` of a file of seeds, spec/seeds.md.
inline constexpr int kSeedsVersion = 1;

/// The branches in file order, not yet checked across branches. Throws Error(InvalidInput).
std::vector<SeedBranch> parseSeeds(const JsonPlace& root, const SeedReading& reading);

/// The text of a seeds file, in LPS mm.
std::string seedsText(const std::vector<SeedBranch>& seeds);

// The fiducials of 3D Slicer before version 5: comma-separated values. Private to the sources of
// seeds.

/// One vessel for each row, in file order, not yet checked across branches; `stem` labels rows
/// without a label. Throws Error(InvalidInput) with `file`, the line and the column.
std::vector<SeedBranch> parseFcsv(std::string_view text, const std::filesystem::path& file,
                                  const std::string& stem, const SeedReading& reading);

// 3D Slicer Markups as seeds. Private to the sources of seeds.

/// The branches in file order, not yet checked across branches; `stem` labels a curve without a
/// name. Throws Error(InvalidInput).
std::vector<SeedBranch> parseMarkups(const JsonPlace& root, const std::string& stem,
                                     const SeedReading& reading);

/// The text of a Markups file in LPS mm: a curve for each branch, with its radii as a measurement,
/// and parent and kind in the description of its first point.
std::string markupsText(const std::vector<SeedBranch>& seeds);

}  // namespace lumen::convert
