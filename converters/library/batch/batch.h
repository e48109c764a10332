// SPDX-License-Identifier: Apache-2.0
// Cases of many inputs, side by side, with a verdict on each (docs/cohorts.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "converters/base/progress.h"
#include "converters/library/rows/build.h"
#include "converters/library/rows/build_list.h"

namespace lumen::convert {

/// An input, and what is known of it before any work.
struct BatchInput {
  BuildRow row;              ///< with an id
  std::string name;          ///< of the input, relative to the folder or the list: for people
  std::uint64_t voxels = 0;  ///< 0: not known, or no volume
  std::string fault;         ///< why it cannot be made; empty: it can
};

enum class BatchEnd : std::uint8_t {
  Passed,       ///< its case keeps the thresholds of the profile, or none judges it
  NeedsPerson,  ///< its case is there, and a person has to look at it
  NoVessels,    ///< the volume shows none
  Failed
};

/// "passed", "needs a person", "no vessels", "failed".
const char* batchWord(BatchEnd end);

/// Key figures of a case.
struct BatchFigures {
  std::size_t vessels = 0, trees = 0, links = 0;
  double length = 0, least = 0, greatest = 0;  ///< mm: all vessels together, radii
};

struct BatchResult {
  std::string id, name;
  BatchEnd end = BatchEnd::Failed;
  bool isKept = false;  ///< an earlier run made and judged it
  std::string why;      ///< one sentence; empty where it passed
  int code = 0;         ///< exit code of the command that ended it; 0 where it passed
  double seconds = 0;   ///< of its commands, by the clock
  std::size_t warnings = 0;
  std::string at;  ///< worst place, as `lumen view` takes it: "--at=1,2,3"; may be empty
  std::optional<BatchFigures> figures;  ///< of its case, where there is one
};

/// Words of the command that opens the viewer at the worst place of a case; empty if it has none.
std::vector<std::string> viewWords(const BatchResult& result, const std::string& volume,
                                   const std::string& caseFile);

/// Files of a batch below its folder.
std::filesystem::path batchCase(const std::string& id);     ///< ID.lumen
std::filesystem::path batchPicture(const std::string& id);  ///< pictures/ID.png
std::filesystem::path batchLog(const std::string& id);      ///< logs/ID.log

/// Memory that the commands of a row take at most, in bytes.
std::uint64_t batchMemory(std::uint64_t voxels);

/// Makes a case of every input in `folder`, judges it and draws it: the largest inputs first, at
/// most `options.jobs` at once, and only as many as memory has room for. A case stays as it is if
/// input, options, version and profile are those of the earlier run that made it; one that a person
/// has changed since is judged again and not made again. Where the volume or an option is another
/// one, corrections by hand are made again in the new case, and the one that a person changed is kept
/// in replaced/. `options.work` is not used. Writes
/// cases.csv, passed.csv and index.html, also where it is cancelled, unless the phase is to make
/// alone: several processes may make the inputs of one batch at once, and each input is made once. Results are in the order of the
/// inputs. Throws Error(Failed) where the folder cannot be written, Error(Cancelled).
std::vector<BatchResult> makeBatch(const std::vector<BatchInput>& inputs,
                                   const std::filesystem::path& folder, const BuildOptions& options,
                                   Progress& progress);

}  // namespace lumen::convert
