// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/motion/track_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/SparseCholesky>

#include "converters/base/error.h"
#include "converters/base/statistics.h"
#include "converters/base/vectors.h"
#include "converters/io/volume/write_volume.h"
#include "converters/stages/fitting/image/fit_to_image.h"
#include "converters/stages/motion/posing.h"
#include "converters/stages/motion/search.h"

namespace lumen::convert {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Triplets = std::vector<Eigen::Triplet<double>>;

constexpr int kRounds = 4;           // of Cauchy's weights
constexpr double kLeastEdge = 1e-3;  // mm

Eigen::VectorXd solve(int size, const Triplets& entries, const Eigen::VectorXd& right) {
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  return factors.solve(right);
}

// Adds weight |x_i - x_k|^2 for numbers i and k.
void tie(int i, int k, double weight, Triplets& entries) {
  entries.emplace_back(i, i, weight);
  entries.emplace_back(k, k, weight);
  entries.emplace_back(i, k, -weight);
  entries.emplace_back(k, i, -weight);
}

template <class Visit>
void eachEdge(const formats::CenterlineTree& tree, Visit visit) {
  for (std::uint32_t i = 0; i < tree.nodeCount(); ++i) {
    if (tree.parent[i] < 0) continue;
    const auto parent = static_cast<std::uint32_t>(tree.parent[i]);
    const double length = (toEigen(tree.centre[i]) - toEigen(tree.centre[parent])).norm();
    visit(i, parent, std::max(length, kLeastEdge));
  }
}

double cauchy(double residual, double deviation) {
  const double share = residual / (2 * deviation);
  return 1 / (1 + share * share);
}

}  // namespace

std::vector<Vector3d> smoothMoves(const formats::CenterlineTree& tree,
                                  const std::vector<MeasuredMove>& measured, double walk) {
  const int size = 3 * static_cast<int>(measured.size());
  Triplets ties;
  eachEdge(tree, [&](std::uint32_t i, std::uint32_t k, double length) {
    for (int axis = 0; axis < 3; ++axis)
      tie(3 * static_cast<int>(i) + axis, 3 * static_cast<int>(k) + axis, 1 / (walk * length),
          ties);
  });
  // a move along the vessel is held by its neighbours alone; this keeps the sum positive definite
  for (int i = 0; i < size; ++i) ties.emplace_back(i, i, 1e-6 / walk);
  Eigen::VectorXd moves = Eigen::VectorXd::Zero(size);
  for (int round = 0; round < kRounds; ++round) {
    Triplets entries = ties;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const MeasuredMove& m = measured[i];
      if (!(m.deviation > 0)) continue;
      const int row = 3 * static_cast<int>(i);
      const Matrix3d across = Matrix3d::Identity() - m.direction * m.direction.transpose();
      const double off = round == 0 ? 0.0 : (across * (moves.segment<3>(row) - m.move)).norm();
      const double weight = cauchy(off, m.deviation) / (m.deviation * m.deviation);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) entries.emplace_back(row + a, row + b, weight * across(a, b));
      right.segment<3>(row) += weight * (across * m.move);
    }
    moves = solve(size, entries, right);
  }
  std::vector<Vector3d> result;
  for (std::size_t i = 0; i < measured.size(); ++i)
    result.emplace_back(moves.segment<3>(3 * static_cast<int>(i)));
  return result;
}

std::vector<double> smoothNumbers(const formats::CenterlineTree& tree,
                                  const std::vector<MeasuredNumber>& measured,
                                  const std::vector<double>& walk, double spread) {
  const int size = static_cast<int>(measured.size());
  Triplets ties;
  eachEdge(tree, [&](std::uint32_t i, std::uint32_t k, double length) {
    tie(static_cast<int>(i), static_cast<int>(k), 1 / (walk[i] * length), ties);
  });
  const double share = 1 / (spread * spread * std::max(1, size));
  for (int i = 0; i < size; ++i) ties.emplace_back(i, i, share);
  Eigen::VectorXd numbers = Eigen::VectorXd::Zero(size);
  for (int round = 0; round < kRounds; ++round) {
    Triplets entries = ties;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (int i = 0; i < size; ++i) {
      const MeasuredNumber& m = measured[static_cast<std::size_t>(i)];
      if (!(m.deviation > 0)) continue;
      const double off = round == 0 ? 0.0 : numbers[i] - m.value;
      const double weight = cauchy(off, m.deviation) / (m.deviation * m.deviation);
      entries.emplace_back(i, i, weight);
      right[i] += weight * m.value;
    }
    numbers = solve(size, entries, right);
  }
  return {numbers.data(), numbers.data() + size};
}

namespace {

using Eigen::Vector3d;

/// The first grid has this many steps to either side within the reach, each later one half the step.
constexpr int kFirstSteps = 4, kLaterSteps = 2;
/// The last step, in voxels; the image finds the rest.
constexpr double kLastStep = 0.5;
/// The least standard deviation of a measured centre or radius, in voxels, and the blur, in voxels, that
/// the fit to the image begins with.
constexpr double kLeastDeviation = 0.1, kUsualBlur = 0.6;
/// The standard deviation by which the logarithm of a radius changes from rest to another phase
/// differently within the length of a radius, and altogether.
constexpr double kWidening = 0.02, kWidest = 0.2;
/// The evidence, as a share of the usual contrast, from which on a vessel is seen.
constexpr double kSeen = 0.3;

class MotionTracker {
public:
  MotionTracker(const formats::Case& rest, const MotionOptions& options, Progress& progress)
      : m_rest(rest),
        m_options(options),
        m_progress(progress),
        m_stations(placeStations(rest.tree)),
        m_moves(m_stations.size(), Vector3d::Zero()),
        m_factors(rest.tree.nodeCount(), 1.0) {
    for (const auto& centre : rest.tree.centre) m_centres.push_back(toEigen(centre));
  }

  PhaseReport follow(const Volume& volume, const std::string& stage) {
    PhaseReport report;
    report.seen = search(volume, stage);
    refine(volume, report);
    for (std::uint32_t i = 0; i < m_centres.size(); ++i)
      report.farthest =
          std::max(report.farthest, (m_centres[i] - toEigen(m_rest.tree.centre[i])).norm());
    for (std::size_t s = 0; s < m_stations.size(); ++s) {
      const std::uint32_t node = m_stations.node[s];
      m_moves[s] = m_centres[node] - toEigen(m_rest.tree.centre[node]);
    }
    return report;
  }

  // Takes a volume, in which the stations are where they are by now, for that of the usual contrasts.
  void learn(Volume volume) {
    m_known = std::move(volume);
    m_knownShapes = shapes();
    m_knownMoves = m_moves;
  }
  [[nodiscard]] bool hasLearnt() const { return m_known.has_value(); }

  // The report on the volume that the case was tracked in.
  [[nodiscard]] PhaseReport rest() const {
    const double voxel = m_known->geometry.voxelSize();
    const std::vector<double> contrasts = usualContrasts(kLastStep * voxel, 0.5 * voxel);
    std::vector<double> sorted = contrasts;
    const double middle = upperMedian(sorted);
    std::vector<double> evidence;
    for (const double contrast : contrasts) evidence.push_back(middle > 0 ? contrast / middle : 0);
    PhaseReport report;
    report.seen = shareSeen(evidence);
    return report;
  }

  [[nodiscard]] std::vector<formats::Pose> poses() const {
    return posesFromCentres(m_rest.tree, m_centres, m_factors);
  }

private:
  // Moves the stations, and the nodes between, by grids of ever shorter steps. Returns the share of
  // length with evidence.
  double search(const Volume& volume, const std::string& stage) {
    const double voxel = volume.geometry.voxelSize(), last = kLastStep * voxel;
    const double halvings = std::ceil(std::log2(m_options.reach / kFirstSteps / last));
    m_progress.begin(stage,
                     static_cast<std::size_t>(1 + std::max(halvings, 0.0)) * m_stations.size());
    int steps = kFirstSteps;
    SearchResult found;
    for (double step = m_options.reach / kFirstSteps;; step *= 0.5) {
      const double smoothing = 0.5 * std::max(step, voxel);
      const Evidence evidence(volume, m_options.dark, smoothing);
      found = searchMoves(m_stations, shapes(), m_moves, usualContrasts(step, smoothing),
                          {step, steps}, evidence, m_progress);
      m_moves = found.moves;
      const std::vector<Vector3d> spread = m_stations.spread(m_moves);
      for (std::uint32_t i = 0; i < m_centres.size(); ++i)
        m_centres[i] = toEigen(m_rest.tree.centre[i]) + spread[i];
      steps = kLaterSteps;
      m_lastStep = step;
      if (step <= last) break;
    }
    m_progress.end();
    return shareSeen(found.evidence);
  }

  // The contrast of each station in the volume that was learnt; empty if none was.
  [[nodiscard]] std::vector<double> usualContrasts(double step, double smoothing) const {
    if (!m_known) return {};
    return contrastsAt(m_knownShapes, m_knownMoves, step,
                       Evidence(*m_known, m_options.dark, smoothing));
  }

  [[nodiscard]] double shareSeen(const std::vector<double>& evidence) const {
    double seen = 0, all = 0;
    for (std::size_t s = 0; s < m_stations.size(); ++s) {
      all += m_stations.length[s];
      if (evidence[s] > kSeen) seen += m_stations.length[s];
    }
    return all > 0 ? seen / all : 1.0;
  }

  [[nodiscard]] std::vector<StationShape> shapes() const {
    const std::vector<formats::Pose> posed = poses();
    std::vector<StationShape> result;
    for (std::size_t s = 0; s < m_stations.size(); ++s) {
      const std::uint32_t node = m_stations.node[s];
      const Eigen::Quaterniond turn = rotationOf(posed[node]);
      StationShape shape{toEigen(m_rest.tree.centre[node]),
                         (turn * toEigen(m_rest.tree.direction[node])).normalized(),
                         double{posed[node].factor} * double{m_rest.tree.radius[node]}};
      if (m_stations.parent[s] >= 0) {
        const std::uint32_t above = m_stations.node[static_cast<std::size_t>(m_stations.parent[s])];
        const Vector3d edge = shape.centre - toEigen(m_rest.tree.centre[above]);
        shape.turned = 0.5 * (turn * edge + rotationOf(posed[above]) * edge) - edge;
      }
      shape.outward = shape.direction * m_stations.end[s];
      result.push_back(shape);
    }
    return result;
  }

  // Moves the nodes to where the blurred image of their sections lies, smoothed along the tree.
  void refine(const Volume& volume, PhaseReport& report) {
    formats::Case posed = posedWalls(m_rest, poses());
    if (!posed.points)
      posed.points = formats::PointSets{std::vector<std::uint32_t>(m_centres.size() + 1, 0), {}};
    const formats::CenterlineTree before = posed.tree;
    const double voxel = volume.geometry.voxelSize();
    fitToImage(posed, volume, {m_options.dark, kUsualBlur * volume.geometry.spacing.minCoeff()},
               m_progress);
    const std::vector<float> deviations = deviationsOf(posed);
    std::vector<MeasuredMove> moves;
    std::vector<MeasuredNumber> widths;
    std::vector<double> walk, corrections, radii;
    for (std::uint32_t i = 0; i < m_centres.size(); ++i) {
      const double radius = double{before.radius[i]};
      MeasuredMove move{Vector3d::Zero(), toEigen(before.direction[i]).normalized()};
      MeasuredNumber width;
      if (deviations[i] > 0) {
        move.move = toEigen(posed.tree.centre[i]) - toEigen(before.centre[i]);
        move.deviation = std::hypot(double{deviations[i]}, kLeastDeviation * voxel);
        width = {std::log(double{posed.tree.radius[i]} / double{m_rest.tree.radius[i]}),
                 move.deviation / radius};
        corrections.push_back(move.move.norm());
      }
      moves.push_back(move);
      widths.push_back(width);
      walk.push_back(kWidening * kWidening / radius);
      radii.push_back(radius);
    }
    report.fitted = corrections.size();
    if (corrections.empty()) return;
    report.correction = upperMedian(corrections);
    // the search is right to half a step, anew from station to station, which are a radius apart
    const double slack = 0.5 * m_lastStep;
    const std::vector<Vector3d> smooth =
        smoothMoves(before, moves, slack * slack / upperMedian(radii));
    const std::vector<double> wider = smoothNumbers(before, widths, walk, kWidest);
    for (std::uint32_t i = 0; i < m_centres.size(); ++i) {
      m_centres[i] += smooth[i];
      m_factors[i] = std::exp(wider[i]);
    }
  }

  static std::vector<float> deviationsOf(const formats::Case& value) {
    for (const formats::NodeArray& array : value.nodeArrays)
      if (array.name == "LUMEN_image.deviation") return std::get<std::vector<float>>(array.values);
    return std::vector<float>(value.tree.nodeCount(), 0.0F);
  }

  const formats::Case& m_rest;
  MotionOptions m_options;
  Progress& m_progress;
  Stations m_stations;
  std::vector<Vector3d> m_moves;    ///< of the stations, mm from rest
  std::vector<Vector3d> m_centres;  ///< of all nodes, mm
  std::vector<double> m_factors;
  double m_lastStep = 0;
  std::optional<Volume> m_known;  ///< the volume of the usual contrasts
  std::vector<StationShape> m_knownShapes;
  std::vector<Vector3d> m_knownMoves;
};

// Whether a case was tracked in a volume: its voxels are the same, and lie at the same places but for what
// formats of files round.
bool isOf(const formats::Case& rest, const Volume& volume) {
  constexpr double kRounded = 1e-3;  // voxels
  if (!rest.metadata.source) return false;
  const formats::SourceVolume &was = *rest.metadata.source, now = describeSource(volume);
  if (was.sha256 != now.sha256 || was.size != now.size) return false;
  bool isThere = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const double near = kRounded * now.spacing[a],
                 most = std::max(1.0, static_cast<double>(now.size[a]) - 1);
    isThere = isThere && std::abs(was.origin[a] - now.origin[a]) <= near &&
              most * std::abs(was.spacing[a] - now.spacing[a]) <= near;
    for (std::size_t row = 0; row < 3; ++row)
      isThere =
          isThere &&
          std::abs(was.direction[3 * row + a] - now.direction[3 * row + a]) * most <= kRounded;
  }
  return isThere;
}

}  // namespace

TrackedMotion trackMotion(const formats::Case& rest, const std::vector<double>& time, double period,
                          const PhaseSource& read, const MotionOptions& options,
                          Progress& progress) {
  TrackedMotion result;
  result.motion.time = time;
  result.motion.period = period;
  const std::size_t nodes = rest.tree.nodeCount();
  for (std::uint32_t i = 0; i < nodes; ++i) result.motion.node.push_back(i);
  result.motion.pose.resize(time.size() * nodes);
  result.phases.resize(time.size());
  MotionTracker tracker(rest, options, progress);
  const auto keep = [&](std::size_t phase, const PhaseReport& report) {
    const std::vector<formats::Pose> poses = tracker.poses();
    std::copy(poses.begin(), poses.end(),
              result.motion.pose.begin() + static_cast<std::ptrdiff_t>(phase * nodes));
    result.phases[phase] = report;
  };
  for (std::size_t phase = 0; phase < time.size(); ++phase) {
    Volume volume = read(phase);
    if (phase == 0 && isOf(rest, volume)) {
      tracker.learn(std::move(volume));
      keep(phase, tracker.rest());
      continue;
    }
    keep(phase, tracker.follow(volume, "phase " + std::to_string(phase + 1) + " of " +
                                           std::to_string(time.size())));
    if (!tracker.hasLearnt()) tracker.learn(std::move(volume));
  }
  return result;
}

}  // namespace lumen::convert
