// SPDX-License-Identifier: Apache-2.0
// A case of a source: its vessels are found, tracked, named and fitted.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "converters/judge/compare/repetition.h"
#include "converters/operations/context.h"
#include "converters/operations/label_inventory.h"
#include "converters/operations/labelled_vessels.h"
#include "converters/operations/mesh_vessels.h"
#include "converters/operations/source.h"
#include "converters/operations/tracked_vessels.h"
#include "converters/stages/editing/edit_request.h"
#include "converters/stages/fitting/fit_options.h"
#include "converters/stages/native/subtract_native.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Options of the models of a case.
struct ModelOptions {
  convert::FitOptions fit;
  /// The cohesion weight of `fit` holds for a case without voxels, too, even if it is the default,
  /// in whose place such a case has 0.
  bool isCohesionStated = false;
};

/// A case of the same volume, with corrections by hand.
struct CorrectedCase {
  formats::Case value;
  std::string name;  ///< for messages
};

struct CaseOptions {
  VesselOptions vessels;  ///< of grey voxels; roots and their selection also of other sources
  std::uint64_t repeats =
      0;  ///< runs on grey voxels that show how far the result depends on chance
  std::optional<CorrectedCase> corrected;  ///< its corrections are made again, in grey voxels
  std::set<std::int64_t> chosenLabels;     ///< labels that are vessels; empty: all but 0
  bool isOnlyLabelled = false;             ///< without vessels on no label of the maps
  std::optional<double> meshUnit;          ///< mm in one unit of a mesh, whatever its file states
  /// The case gets models by these, unless it has some; empty: it stays as it is.
  std::optional<ModelOptions> models;
};

struct MadeCase {
  formats::Case value;
  convert::TrackRemarks remarks;                      ///< of tracking; empty for other sources
  std::optional<convert::Repetition> repetition;      ///< with `repeats`
  std::optional<convert::ReplayedEdits> replayed;     ///< with `corrected`
  std::optional<MeshFrame> meshFrame;                 ///< of a mesh
  std::optional<convert::ReadFrame> centerlineFrame;  ///< of a centerline
  LabelInventory labels;                              ///< of the maps beside a volume
  std::optional<convert::NativeReport> native;        ///< of the scan without contrast
};

/// The case of a source: tree and wall points in mm and LPS, and models where the options ask for
/// them. The source is used up: its voxels are gone before models are fitted. Remarks for people
/// become warnings that begin with the name of the part. Time: seconds to minutes for grey voxels
/// and models, on all threads. Throws Error(InvalidInput) for a part that is not what it has to be,
/// or that holds no vessel, Error(Failed) where no vessel is found or a root lies in none, and
/// Error(Cancelled). A source without a part is a mistake of the program.
MadeCase caseOf(Source source, const CaseOptions& options, const Context& context);

/// The case with models fitted to its wall points, in place of those that it had. Lengths of a case
/// without voxels scale with a fifth of the tree's median radius, but for the accuracy, which is a
/// hundredth of it. Throws Error(InvalidInput) for a case without wall points and for options out of
/// range, and Error(Cancelled).
formats::Case fitted(formats::Case value, const ModelOptions& options, const Context& context);

}  // namespace lumen::operations
