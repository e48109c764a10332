// SPDX-License-Identifier: Apache-2.0
// The stages' option structs as command-line options. Names are the keys under which a case stores
// the values.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_input.h"
#include "converters/io/seeds/seeds.h"
#include "converters/io/volume/read_volume.h"
#include "converters/stages/fitting/fit.h"
#include "converters/stages/phantom/phantom.h"
#include "converters/stages/tracking/track_case.h"

namespace lumen::app {

/// Options as the parser fills them, where that differs from what the stage takes.
struct VolumeArguments {
  std::string series;
  std::vector<int> crop;  ///< empty, or i0, i1, j0, j1, k0, k1
  std::string spacing;    ///< empty, or mm of one or three axes, with commas between them
  std::string unit;       ///< empty, or mm, cm, m or um
  std::vector<std::string> allowDetached;
  [[nodiscard]] convert::ReadVolumeOptions options() const;
};

struct TrackArguments {
  std::string seeds;
  std::string seedsFrame, seedsUnit;  ///< empty: as the seeds file says
  convert::TrackOptions options;
  [[nodiscard]] convert::SeedReading reading() const;
};

struct FitArguments {
  std::string kernel = "cauchy";
  convert::FitOptions values;
  [[nodiscard]] convert::FitOptions options() const;
};

/// How a .lumen file is written.
void addEncodingOptions(CLI::App& app, formats::EncodeOptions& encoding);
void addVolumeOptions(CLI::App& app, VolumeArguments& volume);
void addTrackOptions(CLI::App& app, TrackArguments& track);
void addCenterlineOptions(CLI::App& app, MeshArguments& mesh);
void addSceneOptions(CLI::App& app, MeshArguments& mesh);
void addMaskOptions(CLI::App& app, MaskArguments& mask);
void addFitOptions(CLI::App& app, FitArguments& fit);
void addPhantomOptions(CLI::App& app, convert::PhantomOptions& phantom);

}  // namespace lumen::app
