// SPDX-License-Identifier: Apache-2.0
// Lines of a file as a graph: what their points at equal places connect, whatever the lines'
// directions and however they are cut into pieces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "converters/io/centerline/centerline_file.h"

namespace lumen::convert {

/// Lines through points. Parents of points do not count.
struct LineSet {
  std::vector<CenterlinePoint> points;
  std::vector<std::vector<std::int32_t>> lines;  ///< points of each, as in the file
  bool isDirected = true;                        ///< false: the writer gives lines no direction
};

/// The point that stands for the place of each point: the first of those whose places differ by the
/// rounding of floats, or of which one is the end of a line and nearer than a tenth of the least
/// steps beside both.
std::vector<std::int32_t> samePlaces(const LineSet& set);

/// Limit of trees and of parts that are compared with one another.
constexpr std::size_t kMostParts = 10000;

/// The graph of a set of lines. A *part* is connected by points at equal places; a *run* leads from
/// an end or a fork to the next. The root of a part is the place that all of its lines have in common, if
/// they run through one vessel there, or the one open end from which all run away; without one, it is
/// the widest open end.
class LineGraph {
public:
  /// The set has to outlive the graph.
  explicit LineGraph(const LineSet& set);

  [[nodiscard]] std::size_t partCount() const { return m_parts.size(); }

  /// Whether a tree has no more trees and, unless the file names vessels, no more chains than the
  /// graph has parts and runs, and begins at the roots of parts.
  [[nodiscard]] bool agreesWith(const CenterlineFile& tree, bool hasVessels) const;

  /// The lines that run towards their root.
  [[nodiscard]] std::vector<bool> turnedLines() const;

  /// The shortest paths from the roots, with a link for each further edge. A part with an open end in
  /// the lumen of another part is attached there. Remarks state all that was mended.
  [[nodiscard]] CenterlineFile tree() const;

  /// The remark on roots that lines do not agree on; empty if there are none.
  [[nodiscard]] std::string rootRemark() const;

private:
  using Index = std::int32_t;
  struct Edge {
    Index a, b;
    double votes;  ///< length of lines that run from a to b, less that of those that run back
  };
  struct Run {
    std::vector<Index> nodes;
    double votes = 0;
  };
  struct Part {
    std::vector<std::size_t> runs, lines;
    std::vector<Index> ends;  ///< open ends, ascending
    Index root = kNoPoint;
    bool isAgreed = false;   ///< all lines run away from the root
    std::size_t chains = 0;  ///< of a tree of its lines, if these may be more than runs
  };

  [[nodiscard]] bool hasLength(const std::vector<Index>& line) const;
  void findEdges();
  void findParts();
  void findRuns();
  void trace(Index from, std::size_t edge, std::vector<bool>& used);
  void chooseRoot(Part& part) const;
  [[nodiscard]] bool feedsWider(const Part& part, Index source) const;
  [[nodiscard]] double medianRadius(const Run& run) const;
  [[nodiscard]] bool takeHub(Part& part) const;
  [[nodiscard]] bool isOneVessel(const std::vector<std::size_t>& lines, Index hub) const;
  [[nodiscard]] Index sourceOf(const Part& part) const;
  [[nodiscard]] Index widest(const std::vector<Index>& nodes) const;
  [[nodiscard]] double distance(Index a, Index b) const;
  [[nodiscard]] Index otherEnd(std::size_t edge, Index node) const;
  [[nodiscard]] std::vector<std::array<Index, 2>> edges() const;
  std::vector<Index> attachParts(std::vector<std::array<Index, 2>>& edges,
                                 std::size_t& attached) const;
  [[nodiscard]] std::vector<std::string> remarks(std::size_t links, std::size_t attached) const;

  const LineSet& m_set;
  std::vector<Index> m_node;              // the point that stands for the place of each
  std::vector<CenterlinePoint> m_points;  // with the widest radius of each place
  std::vector<Edge> m_edges;
  std::vector<std::vector<std::size_t>> m_next;  // edges at each node
  std::vector<Index> m_partOf;                   // of each node; -1: on no line
  std::vector<Run> m_runs;
  std::vector<Part> m_parts;
  bool m_hasLinesThroughForks = false;
  std::size_t m_degenerate = 0;  // lines without length
};

/// Attaches trees whose root lies in the lumen of another tree to the nearest point of its axis. A
/// remark reports them.
void attachTrees(CenterlineFile& file);

// An axis near a place, for both.

/// A place in the lumen of a part.
struct AxisContact {
  std::int32_t point = kNoPoint;  ///< the nearer end of the nearest segment
  double distance = 0;            ///< from the axis, in radii there; below 1
};

/// Segments of several parts.
class AxisSearch {
public:
  AxisSearch(const std::vector<CenterlinePoint>& points,
             const std::vector<std::array<std::int32_t, 2>>& segments,
             const std::vector<std::int32_t>& partOf);
  /// The nearest axis, in radii, of another part than `self` whose lumen holds a point.
  [[nodiscard]] AxisContact nearest(std::int32_t point, std::int32_t self) const;

private:
  struct Part {
    std::vector<std::array<std::int32_t, 2>> segments;
    Eigen::Vector3d low, high;
  };
  const std::vector<CenterlinePoint>& m_points;
  std::vector<Part> m_parts;
};

/// Orders points so that parents come first, otherwise as they are.
void orderParentsFirst(CenterlineFile& file);

}  // namespace lumen::convert
