// SPDX-License-Identifier: Apache-2.0
// The fit of one node: two blobs, refined by selection and subdivision (thesis 4.4 and 4.5).
#pragma once

#include <span>
#include <vector>

#include "converters/common/progress.h"
#include "converters/fitting/energy.h"
#include "converters/fitting/levenberg_marquardt.h"

namespace lumen::convert::fitting {

/// In the fit's frame (see energy.h), like every length of this file.
struct LocalModelOptions {
  EnergyParameters energy;
  int maxSubdivisions = 100;  ///< N_s
  double accuracy = 0.3;      ///< t_g
  double maxDistance = 20;    ///< blobs farther than this from the node are dropped
  double minWidth = 0.02;     ///< narrower blobs are dropped
};

/// A node at the origin.
struct NodeData {
  std::span<const formats::Vec3d> points;  ///< of its neighbourhood
  double radius = 0;
  formats::Vec3d direction;  ///< unit vector along the vessel
  /// Inscribed balls of the neighbourhood: the centre of every blob stays in one of them. Where the
  /// points end, a wide blob out there would fit them as well as a good one. If empty, blobs stay
  /// close to the points.
  std::span<const Ball> lumen = {};
  /// The model to begin with; if empty, two blobs along the direction.
  std::span<const Blob> start = {};
};

/// Fewer points than this say less than the two blobs that the fit begins with.
constexpr std::size_t kFewestPoints = 8;

/// Fits nodes one after the other and keeps its memory from one to the next. Not thread-safe.
class LocalModel {
public:
  explicit LocalModel(const LocalModelOptions& options);

  /// The model of a node. At least one blob; valid until the next call, which must not outlive the
  /// node's points and lumen. Throws Error(Cancelled).
  std::span<const Blob> fit(const NodeData& node, const Progress& progress);

  /// Moves and resizes the blobs of a model that fit() gave for `node`, to bring its surface closer
  /// to points that it shares with its neighbours' models: they weigh `tieShare` times as much as
  /// all points of the node. `parameters` are those that the fit ended with.
  std::span<const Blob> refine(const NodeData& node, std::span<const formats::Vec3d> ties,
                               std::span<const Blob> blobs, double tieShare,
                               const EnergyParameters& parameters);

  /// Of the last fit(), in the weights that it ended with.
  [[nodiscard]] const EnergyParameters& parameters() const { return m_energy.parameters(); }
  /// Of the last fit() or refine().
  [[nodiscard]] double energy() const { return m_value; }
  [[nodiscard]] int subdivisions() const { return m_subdivisions; }

private:
  void start(const NodeData& node);
  void startInLumen(const NodeData& node);
  void grow(const NodeData& node, const Progress& progress);
  [[nodiscard]] double meanDistance() const;
  std::span<const Ball> lumenOf(const NodeData& node);
  [[nodiscard]] EnergyParameters scaledEnergy() const;
  void beginEnergy(std::span<const formats::Vec3d> points);
  void minimise(std::size_t active, MinimiseOptions options);
  void minimiseAll();
  void weighPriors();
  bool subdivide();
  void part(const Blob& kept);
  bool cleanUp();
  [[nodiscard]] std::size_t farthestPoint(double& distance) const;
  [[nodiscard]] std::size_t nearestBlob(const formats::Vec3d& point) const;

  LocalModelOptions m_options;
  Energy m_energy;
  LevenbergMarquardt m_minimiser;
  std::vector<Blob> m_blobs, m_spare, m_first;
  std::vector<double> m_along;
  std::span<const Ball> m_lumen;
  std::vector<Ball> m_around;
  std::vector<std::size_t> m_refused;  ///< points that a subdivision did not help
  double m_value = 0, m_radius = 0, m_reach = 0;
  int m_subdivisions = 0;
};

/// Replaces a blob by two of equal width whose union has its surface: the first in place, the
/// second moved by a tenth of the old width towards `point` (thesis eq. 4.26 and 4.27). A blob that
/// is too narrow to reach the level is replaced by two of half its width.
void split(const EnergyParameters& parameters, const formats::Vec3d& point, Blob& first,
           Blob& second);

}  // namespace lumen::convert::fitting
