// SPDX-License-Identifier: Apache-2.0
// The inputs of `lumen batch`: the volumes below a folder, or the rows of a list.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "converters/engine/command.h"
#include "converters/library/batch/batch.h"

namespace lumen::engine {

/// Options of lumen convert for every input that does not state them itself: names without dashes,
/// and values.
using BatchDefaults = std::vector<std::pair<std::string, std::string>>;

struct FoundInputs {
  std::vector<convert::BatchInput> inputs;  ///< by name
  std::vector<std::string> passedOver;      ///< files of no format of volumes, below the folder
};

/// The volumes of a folder and of all folders below it but `out` and those whose names begin with a
/// full stop: each file of a format of volumes, and each series of DICOM in a folder that can be read
/// as a volume. Ids are of their paths. Throws Error(InvalidInput) for a folder without one, or that
/// cannot be listed, Error(Cancelled).
FoundInputs volumesBelow(const std::filesystem::path& folder, const std::filesystem::path& out,
                         Progress& progress);

/// The rows of a list (library/rows/build_list.h), whose faults are those of inputs; only those that
/// begin on `lines`, if there are any. A row has the same id in every choice. Throws
/// Error(InvalidInput) for a file that is no list, and for a line on which no row begins.
FoundInputs inputsOfList(const std::string& list, const std::set<std::size_t>& lines);

/// States the defaults where a row has no value of its own, the number of its voxels where its header
/// can be read, and a fault where lumen convert has no such option or refuses its value. Throws
/// Error(Usage) for a default that it has not or refuses.
void completeInputs(const BatchDefaults& defaults, const Engine& engine,
                    std::vector<convert::BatchInput>& inputs, Progress& progress);

}  // namespace lumen::engine
