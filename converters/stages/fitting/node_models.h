// SPDX-License-Identifier: Apache-2.0
// The models of a case in the making: of all of its nodes, or of some beside those that it has.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "converters/base/progress.h"
#include "converters/stages/fitting/fit_options.h"
#include "converters/stages/fitting/local_model.h"
#include "formats/case/case.h"
#include "formats/case/topology.h"

namespace lumen::convert::fitting {

/// A node's frame is x' = (x - centre) * scale. The constructor's arguments must outlive the
/// object.
class NodeModels {
public:
  /// Prepares the fit of all nodes of a case that has wall points; or of `nodes`, ascending, of a
  /// case that also has models, where the others keep theirs. `options` are resolved.
  NodeModels(const formats::Case& value, const FitOptions& options);
  NodeModels(const formats::Case& value, const FitOptions& options,
             std::span<const std::uint32_t> nodes);

  /// Fits every node independently. Throws Error(Cancelled).
  void fit(Progress& progress);

  /// Brings the surfaces of adjacent models together where they meet. Reads the models of the sweep
  /// before only, so that the order of the nodes does not matter. Throws Error(Cancelled).
  void refine(Progress& progress);

  [[nodiscard]] formats::BlobbyModels assemble() const;

private:
  struct Worker {
    FitWorkspace workspace;
    std::vector<formats::Vec3d> points, seams;
    std::vector<FitBall> lumen;
  };

  [[nodiscard]] formats::Vec3d toLocal(std::uint32_t node, const formats::Vec3f& p) const;
  [[nodiscard]] bool isInSac(std::uint32_t node) const;
  [[nodiscard]] FitBall ball(std::uint32_t frame, std::uint32_t node) const;
  [[nodiscard]] NodeData data(std::uint32_t node, const Worker& worker) const;

  template <class Action>
  void forEachNode(Progress& progress, const Action& action) {
    tbb::parallel_for(std::size_t{0}, m_nodes.size(), [&](std::size_t i) {
      progress.check();
      action(m_nodes[i], m_workers.local());
      progress.advance();
    });
  }

  void takeModels(std::uint32_t node);
  void gatherPoints(std::uint32_t node, Worker& worker) const;
  void gatherSeams(std::uint32_t node, std::vector<formats::Vec3d>& seams) const;
  void findSeam(std::uint32_t node);

  const formats::Case& m_case;
  const formats::CenterlineTree& m_tree;
  const FitOptions& m_options;
  double m_scale;
  LocalModelOptions m_local;
  formats::Neighbours m_neighbours;
  std::vector<std::uint32_t> m_nodes;  ///< nodes that are fitted
  std::vector<std::uint32_t>
      m_seams;                       ///< nodes whose seam with their parent is theirs or next to it
  std::vector<bool> m_isKept;        ///< nodes that are not fitted
  std::vector<LocalModel> m_models;  ///< seam of a node and its parent
  std::vector<std::vector<formats::Vec3d>> m_seam;   ///< seam of a node and its parent
  std::vector<std::vector<formats::Vec3f>> m_drawn;  ///< points of nodes without measured ones
  tbb::enumerable_thread_specific<Worker> m_workers;
};

}  // namespace lumen::convert::fitting

namespace lumen::convert {

// Wall points where none could be measured: on the cylinders of nodes that were bridged or given.

/// A ring of points for every node that was not measured and has no points: around it at its
/// radius, mm, LPS, without points in another branch's lumen near by along the tree. Empty for all
/// other nodes.
std::vector<std::vector<formats::Vec3f>> pointsOfUnmeasured(const formats::Case& value,
                                                            const formats::Neighbours& neighbours);

}  // namespace lumen::convert
