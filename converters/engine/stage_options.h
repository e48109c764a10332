// SPDX-License-Identifier: Apache-2.0
// Rows of the options that several commands share: how inputs are read, vessels tracked, models
// fitted and cases written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/mask_input.h"
#include "converters/engine/mesh_input.h"
#include "converters/io/seeds/seeds.h"
#include "converters/io/volume/read_volume_options.h"
#include "converters/operations/tracked_vessels.h"
#include "converters/stages/fitting/fit_options.h"
#include "converters/stages/tracking/cylinders/track_options.h"
#include "formats/case/case.h"
#include "formats/case/case_encoding.h"

namespace lumen::engine {

/// The user's statements about a volume's file.
struct VolumeArguments {
  std::string series;
  std::vector<int> crop;                    ///< empty, or i0, i1, j0, j1, k0, k1
  std::optional<std::int64_t> volumeIndex;  ///< from 0
  std::string spacing;  ///< empty, or mm of one or three axes, with commas between them
  std::string unit;     ///< empty, or mm, cm, m, um or nm
  std::vector<std::string> allowDetached;
  std::optional<convert::VolumeGeometry> grid;  ///< on which contours are filled
  bool fillGaps = false;                        ///< interpolate missing slices of DICOM
  bool skipFaulty = false;                      ///< leave out files of DICOM that cannot be read
  [[nodiscard]] convert::ReadVolumeOptions options() const;
};

struct TrackArguments {
  TrackArguments() { options.word = optionWord(); }

  InputFile seeds;
  std::string seedsFrame, seedsUnit;  ///< empty: those of the seeds file
  std::vector<std::string> roots;     ///< texts "X,Y,Z", mm, LPS
  bool isOnlyConnected = false;       ///< without trees in which no seed and no root lies
  std::uint64_t repeats = 0;  ///< further runs that show how far the result depends on chance
  bool isSeedsOnly = false;   ///< seeds start all tracks; else they are hints on what is found
  convert::TrackOptions options;
  [[nodiscard]] convert::SeedReading reading() const;
  /// The vessels that are wanted, without the content of the seeds file.
  [[nodiscard]] operations::VesselOptions vessels() const;
};

/// Each adds rows whose values are stored in its second argument, which must outlive the table.
void addVolumeRows(OptionTable& table, VolumeArguments& volume);
/// Rows of a volume that may be left out: they do nothing without the option `file`.
void addVolumeRows(OptionTable& table, VolumeArguments& volume, const std::string& file);
/// --native.
void addNativeRow(OptionTable& table, InputFile& native);
void addTrackRows(OptionTable& table, TrackArguments& track);
void addMeshRows(OptionTable& table, MeshArguments& mesh);
/// --label-table and --role.
void addLabelTableRows(OptionTable& table, MaskArguments& mask);
/// --label-map, --label-table and --role.
void addLabelMapRows(OptionTable& table, MaskArguments& mask);
void addMaskRows(OptionTable& table, MaskArguments& mask);
void addFitRows(OptionTable& table, convert::FitOptions& fit);
void addEncodingRows(OptionTable& table, formats::EncodeOptions& encoding);
/// --from or --to: the format of the file that `argument` names.
void addFormatRow(OptionTable& table, const std::string& name, std::string& value,
                  const std::string& argument);

/// A name, "=", and another text; `expected` in the message: "NAME=VALUE, such as dark=true".
ValueCheck pairText(std::string expected);

/// Why a text is no place, three coordinates in mm with commas between them; empty if it is one.
std::string placeFault(const std::string& text);
/// Pixels across and down of a text such as "1000x800", 16 to 4096 each; throws Error(Usage) about
/// --size.
std::pair<int, int> pictureSize(const std::string& text);
/// The place that a text without such a fault is.
Eigen::Vector3d placeIn(const std::string& text);

/// mm of the units that --unit and --seeds-unit take.
const std::map<std::string, double>& millimetresByUnit();

// --time: a case with a motion at one time, in place of the case at rest.

/// Adds --time, whose value is stored in `time`, which must outlive the table.
OptionRow& addTimeRow(OptionTable& table, std::optional<double>& time);

/// The case of a file at the time of --time, or as it is without the option. Refuses the option for
/// a case without a motion. Throws Error(InvalidInput) with the file's name.
formats::Case atTime(formats::Case value, const std::optional<double>& time,
                     const std::string& file, const OptionTable& table, Progress& progress);

}  // namespace lumen::engine
