// SPDX-License-Identifier: Apache-2.0
// The trees of a file's lines.
#pragma once

#include <string>

#include "converters/io/centerline/line_graph.h"

namespace lumen::convert {

/// The trees of lines: of the points that they share, if these state the point before each; or else
/// of the lines as curves (join_curves.h). Where their graph (line_graph.h) has fewer trees or vessels,
/// or other roots, lines that run towards the root are turned, and if that is not enough the trees are the
/// graph's. Trees that begin in the lumen of another are attached to it. Remarks state what was mended.
/// `cells`: lines as the file has them; `courses`: the same, whole; those of lumen's own files
/// (`isExact`) are taken as they are. Throws Error(InvalidInput) with `name` for more lines than can be compared.
CenterlineFile treeOfLines(const LineSet& cells, const LineSet& courses, bool isExact,
                           const std::string& name);

/// The trees of a network, whose lines are no vessels: those of its graph, from the widest ends. Throws
/// Error(InvalidInput) with `name` for more parts than can be compared.
CenterlineFile treeOfGraph(const LineSet& lines, const std::string& name);

}  // namespace lumen::convert
