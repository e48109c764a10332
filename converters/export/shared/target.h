// SPDX-License-Identifier: Apache-2.0
// A target of `lumen export`: a simulator, or another program, that gets a folder of files. A new
// target needs a folder below targets with its row and its function, and a line in targets.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "converters/base/field_word.h"
#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/base/warning.h"
#include "converters/export/shared/flow_outlets.h"
#include "converters/export/shared/frame.h"
#include "converters/export/shared/insertion.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "converters/stages/volume_mesh/volume_options.h"
#include "formats/case/case.h"

namespace lumen::convert {

// Options that several targets of `lumen export` take.

/// Edges of exported walls, in radii: a simulator asks a wall of triangles many times a step, and
/// its curvature needs edges of half the radius.
inline constexpr double kExportedEdge = 0.5;

inline ClosedSurfaceOptions exportedSurfaceOptions() {
  ClosedSurfaceOptions options;
  options.edge.share = kExportedEdge;
  return options;
}

struct CommonOptions {
  FieldWord word{};                ///< names fields of the options in messages and texts
  std::optional<LengthUnit> unit;  ///< one of the target's; none: the first of these
  std::optional<Axes> axes;        ///< one of the target's; none: the first of these
  ClosedSurfaceOptions surface = exportedSurfaceOptions();
  VolumeMeshOptions volume{};  ///< of cells within it
  double spacing = 0;          ///< mm between samples of grids; 0: by the size of the vessels
  /// Inlets of a flow, as statedInlets() takes them; empty: found by the case.
  std::vector<std::string> inlets;
  bool keepEnds = false;  ///< of a flow: tapers and stubs at the ends of vessels stay
  /// Greatest number of pieces of a wall that is divided; 0: the target's own.
  std::uint64_t maxPieces = 0;
  std::string insert;  ///< label of the branch where an instrument enters; empty: the root
};

/// The case is valid; it has models if the target asks for them.
struct ExportInput {
  const formats::Case& source;
  const CommonOptions& options;
  ExportFrame frame;  ///< as chosen, or the target's first unit and axes
  Progress& progress;

  [[nodiscard]] std::string field(std::string_view name) const { return options.word(name); }
};

/// A file of the folder. `name` is relative to it, with a / between folders.
struct ExportFile {
  std::string name;
  std::string bytes;
  std::string about;       ///< its line in the table of README.md, Markdown; empty: it has none
  std::string unit;        ///< unit of its lengths, where it is not the folder's
  bool isProgram = false;  ///< people run it
};

struct ExportResult {
  /// Files besides README.md and lumen-export.json, which every folder gets.
  std::vector<ExportFile> files;
  std::vector<NamedEnd> ends;            ///< under the names that the files use
  std::optional<SurfaceReport> surface;  ///< report on the surface among the files
  std::vector<std::string> remarks;      ///< sentences for the answer
  std::vector<std::string> assumptions;  ///< sentences: taken for granted by the volume's reader
  std::vector<std::string> losses;       ///< sentences: parts of the case that the folder lacks
  std::vector<Warning> warnings;         ///< reasons to doubt what a program makes of the folder
  std::vector<OutletRow> outlets;        ///< of a flow
  bool playsMotion = false;              ///< the folder moves the vessels as the case's motion does
  /// README.md: first steps and facts to know; Markdown, without headings of level 1.
  std::string start;
  /// README.md: rows of its table for files that are many, or made later.
  std::vector<std::array<std::string, 2>> others;
};

/// An option that a target takes, and the value of another without which it does nothing there.
struct TakenOption {
  TakenOption(const char* taken) : name(taken) {}
  TakenOption(const char* taken, const char* other, const char* word)
      : name(taken), needs{{other, word}} {}

  std::string_view name;          ///< of its row: "max-error"
  std::vector<OptionNeed> needs;  ///< none or one
};

/// The description of a target; targets.cpp joins it with the function that writes the folder.
struct TargetRow {
  std::string_view name;   ///< as the command takes it
  std::string_view title;  ///< the program that reads the folder
  /// Files of every folder, besides those that all targets write.
  std::vector<std::string_view> files;
  std::vector<LengthUnit> units;  ///< units that may be chosen, the usual one first
  std::vector<Axes> axes;         ///< axes that may be chosen, the usual ones first
  std::string_view holds;         ///< parts of a case
  std::string_view lacks;
  std::string_view unless{};  ///< the option without which it lacks the last of that; or empty
  std::vector<TakenOption> options;  ///< options that it takes, besides unit and axes
  bool needsModels = true;
  bool needsVessel = true;  ///< one with a length
};

/// The options of a command by their names, as texts.
using OptionTexts = std::map<std::string, std::string>;

}  // namespace lumen::convert
