// SPDX-License-Identifier: Apache-2.0
// The agreement of a case with its volume.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "converters/judge/check/check.h"
#include "converters/judge/facts/check_facts.h"
#include "converters/judge/gate/gate.h"
#include "converters/operations/context.h"
#include "converters/voxels/volume.h"
#include "formats/case/case.h"

namespace lumen::operations {

/// Names of a case and its volume in messages.
struct CheckNames {
  std::string value;   ///< begins a warning: "head.lumen"
  std::string volume;  ///< within a warning: "head.nrrd"
  std::string both;    ///< begins an error: "head.lumen and head.nrrd"
};

struct CheckOptions {
  /// Blur of the volume, a standard deviation in mm; empty: as the case records it, or 0.
  std::optional<double> pointSpread;
  std::optional<convert::GateProfile> profile;  ///< the case gets a verdict by these thresholds
  /// Without names there are no warnings, and errors begin with no name.
  std::optional<CheckNames> names;
};

struct Checked {
  convert::SourceRelation source;
  convert::CheckReport report;             ///< lengths in mm, places in mm and LPS
  std::vector<convert::LumenVoxel> lumen;  ///< voxels inside of the case, by index
  std::optional<convert::GateVerdict> verdict;
};

/// Relation of a case to a volume with the facts `source`, as convert::describeSource() states
/// them. Warns, if there are names, of a case that was made from another volume.
convert::SourceRelation relationOf(const formats::Case& value, const formats::SourceVolume& source,
                                   const std::optional<CheckNames>& names, const Context& context);

/// Holds a case with models against its volume. `source`: facts of the volume, as
/// convert::describeSource() states them. Warns, if there are names, of a case that was made from
/// another volume, and of parts outside of this one. Takes seconds, on all threads. Throws
/// Error(InvalidInput) if no node lies in the volume, and Error(Cancelled).
Checked checked(const formats::Case& value, const convert::Volume& volume,
                const formats::SourceVolume& source, const CheckOptions& options,
                const Context& context);

}  // namespace lumen::operations
