// SPDX-License-Identifier: Apache-2.0
// Reader of centerlines as curves of 3D Slicer's Markups (`.mrk.json`).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "converters/base/input_file.h"
#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// The curves of a file, or of all `.mrk.json` of a folder in the order of their names, as one tree
/// (join_curves.h). A curve's points need radii, in its measurement "Radius". Lengths are converted
/// to mm, axes to LPS. Markups other than curves of at least two points are left out with a remark.
/// Throws Error(InvalidInput) with the file's name, the finding and the expectation.
CenterlineFile readCurves(const InputFile& fileOrFolder);

/// Whether a folder has a file that readCurves() would read.
bool hasCurves(const std::filesystem::path& folder);

// SWC: points of trees as text (Cannon, Turner, Pyapali and Wheal, "An on-line archive of
// reconstructed hippocampal neurons", 1998).

/// Reads an SWC file of at most 64 MiB. A line is a point: id, type, x, y, z, radius, and the id of
/// its parent or -1, with blanks or tabs in between; lines end with LF, CR LF or CR. Text after #,
/// and columns beyond the seventh (as Vaa3D's), are ignored. Ids may have gaps, any order and any
/// start, and may be written as 1.0; a parent may follow its children; there may be several roots.
/// Points keep the file's order as far as parents come first. Radii of 0 or less are placeholders,
/// and filled in (fill_radii.h); NeuroMorpho's files are in micrometres, and their soma of three
/// points is one; comments of lumen's own files name vessels. Throws Error(InvalidInput) with the
/// line, the finding and the expectation: for malformed or non-finite numbers, trees without any
/// radius, ids that occur twice, missing parents, and cycles.
CenterlineFile readSwc(const InputFile& file);

/// Reads a text as readSwc() does; `name` is the name of its file, for messages.
CenterlineFile parseSwc(std::string_view text, const std::string& name);

// Reader of TubeTK's tubes (`.tre`): a scene of ITK's MetaIO, text or binary.

/// The tubes of a scene as one tree: each is attached to its parent where ParentID names a tube,
/// else to the tube in which it begins (join_curves.h). Spacing, matrix and offset of the objects
/// are applied as ITK does, so lengths are mm and the axes LPS. Other objects of the scene are left
/// out with a remark. Throws Error(InvalidInput) with `name`, the line, the finding and the
/// expectation.
CenterlineFile parseTre(std::string_view text, const std::string& name);

/// Reads a file of at most 64 MiB as parseTre() does.
CenterlineFile readTre(const InputFile& file);

// Reader of centerlines of VMTK and others as lines of VTK (`.vtp`, and `.vtk` of the legacy format).

/// The lines of a file as trees (tree_of_lines.h): lines from a root to every tip share their
/// trunk, by their points or their course; tracts cut by vmtkbranchextractor (CenterlineIds,
/// TractIds) are joined first. Radii are those of MaximumInscribedSphereRadius, or Radius; without
/// either all are 0. Field data Unit and SPACE, the title of a legacy file and a comment of lumen's own
/// files state unit and axes; BranchId and BifurcationId are SimVascular's. Throws Error(InvalidInput) with `name`, the finding and the expectation.
CenterlineFile parseVtpCenterline(std::string_view text, const std::string& name);

CenterlineFile parseVtkCenterline(std::string_view bytes, const std::string& name);

/// Each reads a file of at most 64 MiB as the parser of its format does.
CenterlineFile readVtpCenterline(const InputFile& file);
CenterlineFile readVtkCenterline(const InputFile& file);

// Readers of networks: nodes, and edges without a direction (network.h).

/// GraphML of igraph, networkx, VesselVio: nodes with x, y, z or one attribute of three numbers (pos), and
/// radii of nodes or of edges. Attributes unit and space of the graph state both. Throws
/// Error(InvalidInput) with `name`, the line, the finding and the expectation.
CenterlineFile parseGraphml(std::string_view text, const std::string& name);
CenterlineFile readGraphml(const InputFile& file);

/// Two tables of comma-, semicolon- or tab-separated values, as Voreen writes them and VesselVio reads
/// them: one of them, whose other lies beside it by its name (nodes or vertices, and edges), or their folder;
/// or skan's table of branches alone. Throws as readGraphml().
CenterlineFile readGraphCsv(const InputFile& fileOrFolder);

/// Whether a folder has tables of nodes and of edges.
bool hasGraphTables(const std::filesystem::path& folder);

/// Spatial graphs of Amira and Avizo (`.am`), text or binary: edges with points, radii in thickness,
/// radius or diameter of points, edges or vertices. Units { Coordinates } states the unit,
/// TransformationMatrix is applied. Throws as readGraphml(), and Error(Unsupported) for other content.
CenterlineFile parseSpatialGraph(std::string_view bytes, const std::string& name);
CenterlineFile readSpatialGraph(const InputFile& file);

/// VessMorphoVis' strands (`.vmv`). Throws as readGraphml().
CenterlineFile parseVmv(std::string_view text, const std::string& name);
CenterlineFile readVmv(const InputFile& file);

// SimVascular: paths, and contours around them.

/// A path (`.pth`), contours (`.ctgr`), or the folder of a project with its Paths and Segmentations: the
/// contours' middles and radii, of the area within them, along the path between them. The first of
/// several times is read. Throws as readGraphml().
CenterlineFile readSimVascular(const InputFile& fileOrFolder);

/// One file of these alone.
CenterlineFile parseSimVascular(std::string_view text, const std::string& name);

/// Whether a folder is a project of SimVascular, with paths or contours.
bool hasSimVascular(const std::filesystem::path& folder);

}  // namespace lumen::convert
