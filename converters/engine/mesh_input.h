// SPDX-License-Identifier: Apache-2.0
// The surface of vessels as an input: its file, its unit, and the centerline that it may come with.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "converters/base/progress.h"
#include "converters/engine/answers/answer_text.h"
#include "converters/engine/file_format.h"
#include "converters/operations/mesh_vessels.h"
#include "converters/operations/source.h"

namespace lumen::engine {

/// The user's statements about a mesh.
struct MeshArguments {
  InputFile centerline;         ///< a file; empty: the tree is found
  std::string centerlineFrame;  ///< lps or ras; empty: the file's, or the mesh's
  std::string centerlineUnit;   ///< empty: the file's, or the mesh's
  std::string sceneMesh;        ///< the vessels' mesh of a scene; empty: as the scene shows it
};

/// "mm", for 1 mm.
std::string unitName(double millimetres);

/// "mm, by its size".
std::string unitText(const convert::ReadFrame& frame);
/// "LPS", or "not stated; taken as LPS".
std::string axesText(const convert::ReadFrame& frame);

/// A line for the answer, about a "mesh" or "centerline"; empty without one.
std::string frameLine(const char* what, const std::optional<convert::ReadFrame>& frame);
/// The frame as an object; null without one.
Json frameJson(const std::optional<convert::ReadFrame>& frame);

/// Turns a mesh to LPS from the axes that a person states, lps or ras, whatever its file states.
void stateAxes(convert::MeshFile& file, const std::string& frame);

/// Whether the file is a model of SimVascular, which names its faces in an array or beside it.
bool isOfSimVascular(const InputFile& file, const convert::MeshFile& read);

/// The mesh in `file`; shows a stage of progress. Throws as the reader of the format.
operations::MeshPart loadMesh(const InputFile& file, const FileFormat& format,
                              const SceneArguments& scene, Progress& progress);

/// The centerline that a mesh comes with, by the user's statements about its unit and axes, or else
/// by those of its file; empty without a file. Remarks of the reader become warnings. Throws
/// Error(InvalidInput), and Error(Unsupported) for the name of no such file.
std::optional<operations::CenterlinePart> loadGivenCenterline(const MeshArguments& arguments,
                                                              Progress& progress);

}  // namespace lumen::engine
