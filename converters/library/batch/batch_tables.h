// SPDX-License-Identifier: Apache-2.0
// The table and the page of a batch. Private to the sources of this folder and their tests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "converters/library/batch/batch.h"

namespace lumen::convert {

/// A row for each input, below a row of names: RFC 4180. Lengths and radii in mm.
std::string batchTable(const std::vector<BatchResult>& results);

/// The cases that passed, as a list for `lumen library build` (docs/library.md).
std::string passedList(const std::vector<BatchResult>& results);

/// A page with a picture and the key figures of each case, those that need a look first. It asks for
/// nothing but files of the batch's folder, and runs no script.
std::string batchPage(const std::vector<BatchResult>& results, const std::filesystem::path& folder);

/// Writes cases.csv, passed.csv and index.html into the folder, each atomically. Throws
/// Error(Failed), naming the file.
void writeBatchTables(const std::vector<BatchResult>& results, const std::filesystem::path& folder);

}  // namespace lumen::convert
