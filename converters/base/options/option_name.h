// SPDX-License-Identifier: Apache-2.0
// Names of options that messages mention, with all that messages below the engine do. A row takes
// its name from here, too, so that a rename is a change of one line.
#pragma once

#include <string>

namespace lumen {

/// The name of an option, as its row has it.
struct OptionName {
  const char* name;  ///< without dashes: "spacing"

  /// The name as people write it: "--spacing".
  [[nodiscard]] std::string shown() const { return std::string("--") + name; }
};

/// Options that messages mention. Every member is an OptionName, so a test can walk them and
/// find each in the table of a command. A row of an equal name with another meaning, such as `step`
/// of tracking, keeps a literal of its own.
struct OptionNames {
  // all commands
  OptionName json{"json"};
  // volumes, meshes and centerlines that are read
  OptionName unit{"unit"};
  OptionName spacing{"spacing"};
  OptionName series{"series"};
  OptionName volumeIndex{"volume-index"};
  OptionName crop{"crop"};
  OptionName allowDetached{"allow-detached"};
  OptionName volume{"volume"};
  // volumes of labels
  OptionName labels{"labels"};
  OptionName labelMap{"label-map"};
  OptionName labelTable{"label-table"};
  // seeds and tracking
  OptionName seeds{"seeds"};
  OptionName seedsFrame{"seeds-frame"};
  OptionName seedsUnit{"seeds-unit"};
  OptionName root{"root"};
  OptionName onlyConnected{"only-connected"};
  OptionName dark{"dark"};
  OptionName inlierRate{"inlier-rate"};
  OptionName noiseMargin{"noise-margin"};
  // fitting
  OptionName kernel{"kernel"};
  OptionName cohesionWeight{"cohesion-weight"};
  OptionName seamSweeps{"seam-sweeps"};
  // surfaces and meshes that are written
  OptionName edge{"edge"};
  OptionName maxError{"max-error"};
  OptionName thickness{"thickness"};
  OptionName gap{"gap"};
  OptionName extend{"extend"};
  OptionName meshopt{"meshopt"};
  OptionName draco{"draco"};
  OptionName colour{"colour"};
  // lumen export, where `unit` is that of the folder
  OptionName up{"up"};
  OptionName grid{"grid"};
  OptionName format{"format"};
  OptionName band{"band"};
  OptionName half{"half"};
  OptionName perBranch{"per-branch"};
  OptionName exact{"exact"};
  OptionName maxPieces{"max-pieces"};
  OptionName instrument{"instrument"};
  OptionName wall{"wall"};
  OptionName dialect{"dialect"};
  OptionName step{"step"};
  OptionName insert{"insert"};
  // lumen phantom
  OptionName tree{"tree"};
  OptionName size{"size"};
  OptionName voxel{"voxel"};
  OptionName sliceThickness{"slice-thickness"};
  OptionName fade{"fade"};
  OptionName clutter{"clutter"};
  OptionName noise{"noise"};
  OptionName bias{"bias"};
  OptionName psf{"psf"};
  OptionName motion{"motion"};
  OptionName phases{"phases"};
  // lumen motion
  OptionName period{"period"};
  OptionName times{"times"};
  OptionName frames{"frames"};
  // lumen validate
  OptionName privacy{"privacy"};
  // libraries
  OptionName id{"id"};
  OptionName replace{"replace"};
  OptionName licence{"licence"};
  OptionName consent{"consent"};
  OptionName deidentification{"deidentification"};
  OptionName synthetic{"synthetic"};
  OptionName resume{"resume"};
  OptionName key{"key"};
  OptionName state{"state"};
};

inline constexpr OptionNames kOption{};

}  // namespace lumen
