// SPDX-License-Identifier: Apache-2.0
// Networks of other programs: nodes at forks and ends, edges between them, and tables of both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "converters/io/centerline/centerline_file.h"
#include "converters/io/centerline/join_curves.h"

namespace lumen::convert {

struct NetworkEdge {
  std::int32_t from = kNoPoint, to = kNoPoint;  ///< nodes
  double radius = 0;                            ///< of the whole edge; 0: its points have their own
  double chord = 0;                             ///< stated distance of its nodes; 0: not stated
  std::vector<CurvePoint> course{};             ///< points from the one node to the other
};

struct Network {
  std::vector<CurvePoint> nodes;
  std::vector<NetworkEdge> edges;
};

/// The trees of a network (tree_of_lines.h), whose edges have no direction. An edge without a course
/// is straight, and has its radius outside of its nodes' balls. Nodes without radius take the widest
/// of their edges. Nodes without edges are left out with a remark. Where the chords that edges state
/// differ from the distances of their nodes by one factor for each axis, places are multiplied by it,
/// as VesselVio's are voxels; a remark states the factors. Radii remain 0 where the network has none.
/// Throws Error(InvalidInput) with `name` for a network without edges.
CenterlineFile treeOfNetwork(Network network, const std::string& name);

/// The size of the voxels in which a network's nodes are placed; empty where chords do not state one,
/// or one of 1 x 1 x 1.
std::optional<Eigen::Vector3d> voxelsOfNetwork(const Network& network);

/// Takes unit and axes from the comment of lumen's own files at the beginning of a text, if it is there.
void takeOwnFrame(std::string_view text, CenterlineFile& file);

// Tables of nodes and edges, by the names that programs give their columns.

struct NetworkRow {
  std::size_t line = 0;
  std::vector<std::string> cells;  ///< in the order of the columns; may be fewer
};

struct NetworkTable {
  std::string name;                  ///< of its file, in messages
  std::vector<std::string> columns;  ///< the first of equal names counts
  std::vector<NetworkRow> rows;

  [[nodiscard]] bool hasPlaces() const;  ///< x, y and z
  [[nodiscard]] bool hasEnds() const;    ///< both nodes of edges
};

/// The trees of two tables: nodes with places (x, y, z; pos_x; X) and maybe ids and radii, edges with the
/// ids of two nodes and maybe radii, in `radius`, `radius_avg`, `avgRadiusAvg` or `diameter`. Without ids
/// nodes are counted from 0. Columns may state their unit: "x (um)". Throws Error(InvalidInput) with the
/// file, the line, the finding and the expectation.
CenterlineFile treeOfTables(const NetworkTable& nodes, const NetworkTable& edges);

}  // namespace lumen::convert
