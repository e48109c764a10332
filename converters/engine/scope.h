// SPDX-License-Identifier: Apache-2.0
// Kinds of inputs and outputs, by which rows state where an option counts.
#pragma once

#include <string>
#include <vector>

#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/engine/file_format.h"

namespace lumen::engine {

/// Kinds of inputs.
constexpr ContentMask kFileImage = 1 << 0;    ///< a volume of grey values in a file
constexpr ContentMask kDicomImage = 1 << 1;   ///< a volume of grey values in a folder of DICOM
constexpr ContentMask kFileLabels = 1 << 2;   ///< a volume of labels in a file
constexpr ContentMask kDicomLabels = 1 << 3;  ///< a volume of labels in a folder of DICOM
constexpr ContentMask kImage = kFileImage | kDicomImage;
constexpr ContentMask kLabels = kFileLabels | kDicomLabels;
constexpr ContentMask kDicom = kDicomImage | kDicomLabels;
constexpr ContentMask kVolumes = kImage | kLabels;
constexpr ContentMask kFileVolumes = kFileImage | kFileLabels;
constexpr ContentMask kPlainMesh = 1 << 4;  ///< a mesh of a file that holds nothing else
constexpr ContentMask kScene = 1 << 5;      ///< a mesh of a scene
constexpr ContentMask kMeshes = kPlainMesh | kScene;
constexpr ContentMask kCenterline = 1 << 6;
constexpr ContentMask kUnfittedCase = 1 << 7;  ///< a case to which models are going to be fitted
constexpr ContentMask kFittedCase = 1 << 8;    ///< a case that is taken as it is
constexpr ContentMask kCases = kUnfittedCase | kFittedCase;
constexpr ContentMask kFitted = kVolumes | kMeshes | kCenterline | kUnfittedCase;

/// Kinds of outputs.
constexpr ContentMask kBinaryCase = 1 << 0;  ///< .lumen
constexpr ContentMask kJsonCase = 1 << 1;    ///< .lumen.json
constexpr ContentMask kGltf = 1 << 2;
constexpr ContentMask kStl = 1 << 3;
constexpr ContentMask kOtherMesh = 1 << 4;
constexpr ContentMask kAllSurfaces = kGltf | kStl | kOtherMesh;
constexpr ContentMask kTree = 1 << 5;   ///< a centerline
constexpr ContentMask kCells = 1 << 6;  ///< a volume mesh
constexpr ContentMask kAllMeshes = kAllSurfaces | kCells;
constexpr ContentMask kModelled = kBinaryCase | kJsonCase | kAllMeshes;  ///< models show in them

/// Contents of the files that are read and written; any where they do not matter.
struct FileContents {
  ContentMask input = kAnyContent;
  ContentMask output = kAnyContent;
  std::string inputName, outputName;  ///< names of the files, for messages
  bool isAllRead = false;             ///< the files that options name were read before
};

/// One bit: the content of an input of this format. A case is taken as it is.
ContentMask inputContent(const FileFormat& format, bool holdsLabels);
/// One bit: the content of an output of this format.
ContentMask outputContent(const FileFormat& format);

/// "does nothing without --seeds or --root", if the options of the table meet none of the needs;
/// empty if they meet one, or there are none.
std::string missingNeed(const OptionTable& table, const std::vector<OptionNeed>& needs);

/// Throws Error(Usage) for the option of a row that would do nothing; `reason` ends the sentence. A
/// preference of a configuration file is warned of instead, as such a file serves several runs.
void refuseUnused(const OptionRow& row, const std::string& reason, Progress& progress);

/// Throws Error(Usage) for options that are given and exclude one another.
void requireCompatible(const OptionTable& table);

/// Refuses, as refuseUnused(), an option that is given and would do nothing: --stl-solids when a
/// .glb is written: the message states what it is for, which other option it needs, or beside which
/// one it does nothing. Then looks at the files that the options name (named_files.h).
void requireInScope(const OptionTable& table, const FileContents& contents, Progress& progress);

}  // namespace lumen::engine
