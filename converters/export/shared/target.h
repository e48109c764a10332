// SPDX-License-Identifier: Apache-2.0
// A target of `lumen export`: a simulator, or another program, that gets a folder of files. To add one: a function
// in a file of its own, and a row in targets.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/progress.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/named_end.h"
#include "converters/export/targets/grid/grid_options.h"
#include "converters/export/targets/sofa/scene.h"
#include "converters/stages/surface/closed_surface.h"
#include "formats/case/case.h"

namespace lumen::convert {

/// What targets may be asked for; each takes what concerns it.
struct ExportOptions {
  std::optional<LengthUnit> unit;  ///< one of the target's
  std::optional<Axes> axes;        ///< one of the target's
  ClosedSurfaceOptions surface;
  GridOptions grid;
  SofaOptions sofa;
};

/// What a target is given. The case is valid; it has models if the target asks for them.
struct ExportInput {
  const formats::Case& source;
  const ExportOptions& options;
  ExportFrame frame;  ///< as chosen, or the target's first unit and axes
  Progress& progress;
};

/// A file of the folder. `name` is relative to it, with a / between folders.
struct ExportFile {
  std::string name;
  std::string bytes;
  std::string about;  ///< what README.md says of it; files without it are not in its table
  std::string unit;   ///< of its lengths, where it is not the folder's
};

struct ExportResult {
  std::vector<ExportFile>
      files;                   ///< without README.md and lumen-export.json, which every folder gets
  std::vector<NamedEnd> ends;  ///< under the names that the files use
  std::optional<SurfaceReport> surface;  ///< of the surface among the files
  std::vector<std::string> remarks;      ///< sentences for the answer
  std::vector<std::string> losses;       ///< sentences of what the case has and the folder has not
  std::string
      start;  ///< README.md: how to start, and what to know; Markdown, without headings of level 1
  /// README.md: rows of its table for files that are many, or made later.
  std::vector<std::array<std::string, 2>> others;
};

struct ExportTarget {
  /// Throws lumen::Error: InvalidInput where a case is not what the target can hold, and why.
  using Writer = ExportResult (*)(const ExportInput& input);

  std::string_view name;   ///< as the command takes it
  std::string_view title;  ///< what reads the folder
  std::vector<std::string_view>
      files;  ///< that are in every folder, besides those that all targets write
  std::vector<LengthUnit> units;  ///< that may be chosen, the usual one first
  std::vector<Axes> axes;         ///< likewise
  std::string_view holds;         ///< of a case
  std::string_view lacks;
  std::vector<std::string_view> options;  ///< that it takes, besides --unit and --up
  bool needsModels = true;
  bool needsVessel = true;  ///< one with a length
  Writer write = nullptr;
};

const std::vector<ExportTarget>& exportTargets();

/// What the options of a command were, by their names, as texts.
using OptionTexts = std::map<std::string, std::string>;

/// The whole folder: the target's files, README.md and lumen-export.json (spec/export.md). Throws as the target, and
/// Error(InvalidInput) for a case without the models or the vessel that the target needs.
ExportResult exportCase(const ExportTarget& target, const formats::Case& source,
                        const ExportOptions& options, const OptionTexts& texts, Progress& progress);

}  // namespace lumen::convert
