// SPDX-License-Identifier: Apache-2.0
#include "converters/io/centerline/case_of_centerline.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "formats/case/node_origin.h"
#include "formats/container/printable.h"
#include "formats/view/limits.h"
#include "formats/view/text_rules.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

// Lengths in radii. Tracking advances by half a radius (docs/method.md, section 1.5).
constexpr double kLongestStep = 1.25, kInserted = 0.6, kDense = 0.2, kResampled = 0.5;
// Tolerance relative to the radius: a point nearer than this to its predecessor is a duplicate.
constexpr double kSamePoint = 0.02;
// Limits relative to the parent's radius: a child within its core, within its lumen, and the length
// that it may run there before it is attached to another node.
constexpr double kCore = 0.5, kInside = 0.9, kLongPathRadii = 1.5;
// Upper bound: a short file may describe long vessels, but not without limit.
constexpr double kNodesForFree = 200000, kNodesPerPoint = 100;

struct Sample {
  Vector3d position;
  double radius;
  std::int32_t point;  // point of the file, or kNoPoint in between
};
using Samples = std::vector<Sample>;

double stepAt(const Samples& path, std::size_t i) {
  return (path[i + 1].position - path[i].position).norm();
}

// The derivative by the chord length at each sample, second order at samples with two neighbours.
std::vector<Vector3d> computeTangents(const Samples& path) {
  std::vector<Vector3d> tangents(path.size(), Vector3d::Zero());
  if (path.size() < 2) return tangents;
  std::vector<Vector3d> secant;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    secant.emplace_back((path[i + 1].position - path[i].position) /
                        std::max(stepAt(path, i), 1e-300));
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (i == 0 || i + 1 == path.size()) {
      tangents[i] = secant[i == 0 ? 0 : i - 1];
      continue;
    }
    const double before = stepAt(path, i - 1), after = stepAt(path, i);
    tangents[i] = (after * secant[i - 1] + before * secant[i]) / std::max(before + after, 1e-300);
  }
  return tangents;
}

// A curve through samples: cubic Hermite pieces over the chord lengths; radii are linear.
class Curve {
public:
  explicit Curve(const Samples& path) : m_path(path), m_tangent(computeTangents(path)) {}

  [[nodiscard]] Sample at(std::size_t piece, double share) const {
    const Sample &from = m_path[piece], &to = m_path[piece + 1];
    const double h = stepAt(m_path, piece), t = share, u = 1 - t;
    const Vector3d position = u * u * (1 + 2 * t) * from.position +
                              t * t * (1 + 2 * u) * to.position +
                              h * t * u * (u * m_tangent[piece] - t * m_tangent[piece + 1]);
    return {position, u * from.radius + t * to.radius, kNoPoint};
  }

private:
  const Samples& m_path;
  std::vector<Vector3d> m_tangent;
};

// Removes samples at the place of their predecessor; the last stays.
Samples apart(const Samples& path) {
  Samples kept;
  for (const Sample& sample : path) {
    const bool isSame =
        !kept.empty() && (sample.position - kept.back().position).norm() <=
                             kSamePoint * std::min(sample.radius, kept.back().radius);
    if (!isSame)
      kept.push_back(sample);
    else if (&sample == &path.back() && kept.size() > 1)
      kept.back() = sample;
  }
  return kept;
}

double radiusOf(const Samples& path, std::size_t piece) {
  return std::min(path[piece].radius, path[piece + 1].radius);
}

bool isDense(const Samples& path) {
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    steps.push_back(stepAt(path, i) / radiusOf(path, i));
  if (steps.size() < 4) return false;
  std::nth_element(steps.begin(), steps.begin() + std::ptrdiff_t(steps.size() / 2), steps.end());
  return steps[steps.size() / 2] < kDense;
}

double nodesFor(const Samples& path) {
  double nodes = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    nodes += 1 + stepAt(path, i) / (kInserted * radiusOf(path, i));
  return nodes;
}

Samples filled(const Samples& path) {
  const Curve curve(path);
  Samples samples{path.front()};
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double length = stepAt(path, i) / radiusOf(path, i);
    const int pieces = length > kLongestStep ? static_cast<int>(std::ceil(length / kInserted)) : 1;
    for (int k = 1; k < pieces; ++k) samples.push_back(curve.at(i, double(k) / pieces));
    samples.push_back(path[i + 1]);
  }
  return samples;
}

// Samples every half radius; each names the nearest of the file's points at most once.
Samples resampled(const Samples& path) {
  std::vector<double> place{0};  // in steps of half a radius
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    place.push_back(place.back() +
                    stepAt(path, i) / (kResampled * 0.5 * (path[i].radius + path[i + 1].radius)));
  const int count = std::max(1, static_cast<int>(std::lround(place.back())));
  const Curve curve(path);
  Samples samples{path.front()};
  std::size_t piece = 0;
  for (int k = 1; k < count; ++k) {
    const double wanted = place.back() * k / count;
    while (piece + 2 < place.size() && place[piece + 1] <= wanted) ++piece;
    const double share =
        (wanted - place[piece]) / std::max(place[piece + 1] - place[piece], 1e-300);
    samples.push_back(curve.at(piece, std::clamp(share, 0.0, 1.0)));
    samples.back().point = path[share < 0.5 ? piece : piece + 1].point;
  }
  samples.push_back(path.back());
  return samples;
}

class CaseMaker {
public:
  CaseMaker(const CenterlineFile& file, const std::string& name)
      : m_file(file),
        m_name(formats::printable(name)),
        m_node(file.points.size(), formats::kNoParent) {}

  formats::Case make() {
    const std::vector<CenterlineChain> chains = centerlineChains(m_file);
    if (chains.empty()) throw invalidInput(m_name + ": has no points");
    for (const CenterlineChain& chain : chains) add(chain, chains);
    closeLoops();
    m_case.points.emplace().offset.assign(m_tree.nodeCount() + 1, 0);
    formats::setNodeOrigins(m_case, std::vector(m_tree.nodeCount(), formats::NodeOrigin::Given));
    m_case.metadata.steps.push_back({"centerline",
                                     "lumen " LUMEN_VERSION,
                                     {{"points", static_cast<std::int64_t>(m_file.points.size())},
                                      {"chains", static_cast<std::int64_t>(chains.size())}}});
    return std::move(m_case);
  }

private:
  void add(const CenterlineChain& chain, const std::vector<CenterlineChain>& chains) {
    Samples path;
    for (const std::int32_t index : chain.points) path.push_back(sampleAt(index));
    std::int32_t on = kNoPoint;
    if (chain.parent >= 0) {
      on = chains[std::size_t(chain.parent)].points[chain.parentSample];
      // the child is not wider where it leaves its parent
      path.insert(path.begin(), {sampleAt(on).position, path.front().radius, kNoPoint});
    }
    if (!m_file.isOfLumen) path = apart(path);
    m_allowed += kNodesPerPoint * double(chain.points.size());
    m_asked += nodesFor(path);
    if (!(m_asked <= m_allowed))
      throw invalidInput(m_name +
                         ": its vessels are so long for their radii that they would take " +
                         "more than " + std::to_string(std::int64_t(m_allowed)) +
                         " nodes; expected radii and positions of one unit");
    Samples samples = m_file.isOfLumen ? path : isDense(path) ? resampled(path) : filled(path);
    std::int32_t parent = formats::kNoParent;
    if (on != kNoPoint) {
      parent = static_cast<std::int32_t>(nodeOf(on));
      samples.erase(samples.begin());
      if (!m_file.isOfLumen) parent = leaveEarly(samples, parent);
    }
    if (!samples.empty()) append(samples, chain, parent);
    nameNodes(chain, parent);
  }

  [[nodiscard]] Sample sampleAt(std::int32_t index) const {
    const CenterlinePoint& point = m_file.points[std::size_t(index)];
    if (!(static_cast<float>(point.radius) > 0))  // as the case holds it
      throw invalidInput(m_name +
                         ": its points have no radii; expected a centerline with radii, "
                         "such as VMTK's MaximumInscribedSphereRadius");
    return {point.position, point.radius, index};
  }

  // A child that runs within its parent for long, as one that leaves it at a narrow angle does, is
  // attached to the node beside which it leaves the core: neighbours are found along the tree
  // (spec/lumen.md), and that path would get too long for parent and child to blend. Returns the
  // node.
  std::int32_t leaveEarly(Samples& samples, std::int32_t parent) const {
    const formats::Branch& branch = m_tree.branches[m_tree.branch[std::size_t(parent)]];
    std::int32_t nearest = parent, last = parent;
    std::size_t core = 0;  // number of samples that lie in it
    double length = 0;
    Vector3d from = centreOf(parent);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      length += (samples[i].position - from).norm();
      from = samples[i].position;
      nearest = nearestNode(from, nearest, branch);
      const double distance =
          (from - centreOf(nearest)).norm() / m_tree.radius[std::size_t(nearest)];
      if (distance <= kCore) {
        core = i;
        last = nearest;
      }
      if (distance <= kInside) continue;
      if (length <= kLongPathRadii * m_tree.radius[std::size_t(nearest)]) return parent;
      samples.erase(samples.begin(), samples.begin() + std::ptrdiff_t(core));
      return last;
    }
    return parent;
  }

  [[nodiscard]] Vector3d centreOf(std::int32_t node) const {
    return toEigen(m_tree.centre[std::size_t(node)]);
  }

  // Searches from a node of a branch along its neighbours while the distance decreases.
  [[nodiscard]] std::int32_t nearestNode(const Vector3d& p, std::int32_t node,
                                         const formats::Branch& branch) const {
    const auto first = static_cast<std::int32_t>(branch.firstNode);
    const auto end = first + static_cast<std::int32_t>(branch.nodeCount);
    const auto distance = [&](std::int32_t n) { return (p - centreOf(n)).norm(); };
    for (;;) {
      if (node + 1 < end && distance(node + 1) < distance(node))
        ++node;
      else if (node > first && distance(node - 1) < distance(node))
        --node;
      else
        return node;
    }
  }

  void append(const Samples& samples, const CenterlineChain& chain, std::int32_t parent) {
    const auto first = static_cast<std::uint32_t>(m_tree.nodeCount());
    if (first + samples.size() > formats::kMaxNodes)
      throw invalidInput(m_name + ": takes more than " + std::to_string(formats::kMaxNodes) +
                         " nodes");
    Samples run = samples;
    if (parent != formats::kNoParent)
      run.insert(run.begin(), {centreOf(parent), samples.front().radius, kNoPoint});
    const std::vector<Vector3d> tangents = computeTangents(run);
    const std::size_t shift = run.size() - samples.size();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t r = i + shift;
      const Vector3d tangent =
          tangents[r].norm() > 0 ? tangents[r].normalized() : Vector3d::UnitZ();
      const double before = r > 0 ? stepAt(run, r - 1) : 0,
                   after = r + 1 < run.size() ? stepAt(run, r) : 0;
      const double ends = (r > 0) + (r + 1 < run.size());
      m_tree.centre.push_back(toVec3f(samples[i].position));
      m_tree.direction.push_back(toVec3f(tangent));
      m_tree.radius.push_back(static_cast<float>(samples[i].radius));
      m_tree.height.push_back(
          static_cast<float>(ends > 0 ? 2 * (before + after) / ends : samples[i].radius));
      m_tree.parent.push_back(i == 0 ? parent : static_cast<std::int32_t>(m_tree.nodeCount()) - 2);
      m_tree.branch.push_back(static_cast<std::uint32_t>(m_tree.branches.size()));
      if (samples[i].point != kNoPoint)
        m_node[std::size_t(samples[i].point)] = static_cast<std::int32_t>(first + i);
    }
    formats::Branch branch;
    branch.label = labelOf(chain);
    branch.parentNode = parent;
    branch.firstNode = first;
    branch.nodeCount = static_cast<std::uint32_t>(samples.size());
    m_tree.branches.push_back(std::move(branch));
  }

  // Points without a node of their own map to the node before them.
  void nameNodes(const CenterlineChain& chain, std::int32_t node) {
    if (node == formats::kNoParent) node = m_node[std::size_t(chain.points.front())];
    for (const std::int32_t index : chain.points) {
      if (m_node[std::size_t(index)] != formats::kNoParent) node = m_node[std::size_t(index)];
      m_node[std::size_t(index)] = node;
    }
  }

  std::string labelOf(const CenterlineChain& chain) {
    const std::int32_t vessel = m_file.points[std::size_t(chain.points.front())].vessel;
    std::string label;
    if (vessel != kNoVessel) label = m_file.vessels[std::size_t(vessel)];
    if (label.empty() || formats::checkText(label, formats::kMaxNameBytes - 12, "")) {
      const std::string number = std::to_string(m_tree.branches.size());
      label.assign(number.size() < 3 ? 3 - number.size() : 0, '0');
      label.insert(label.begin(), 'b');
      label += number;
    }
    int& count = m_seen[label];
    std::string unique = label;
    while (!m_labels.insert(unique).second) unique = label + "-" + std::to_string(++count + 1);
    return unique;
  }

  void closeLoops() {
    std::set<std::array<std::uint32_t, 2>> links;
    for (const auto& [a, b] : m_file.links) {
      const std::uint32_t from = nodeOf(a), to = nodeOf(b);
      const auto [low, high] = std::minmax(from, to);
      if (low != high && m_tree.parent[high] != static_cast<std::int32_t>(low))
        links.insert({low, high});
    }
    m_tree.links.assign(links.begin(), links.end());
  }

  // A point at the place of its parent maps to the parent's node.
  [[nodiscard]] std::uint32_t nodeOf(std::int32_t point) const {
    while (m_node[std::size_t(point)] == formats::kNoParent)
      point = m_file.points[std::size_t(point)].parent;
    return static_cast<std::uint32_t>(m_node[std::size_t(point)]);
  }

  const CenterlineFile& m_file;
  std::string m_name;
  formats::Case m_case;
  formats::CenterlineTree& m_tree = m_case.tree;
  std::vector<std::int32_t> m_node;  // node of each point of the file
  std::set<std::string> m_labels;
  std::map<std::string, int> m_seen;
  double m_asked = 0, m_allowed = kNodesForFree;
};

}  // namespace

formats::Case caseOfCenterline(const CenterlineFile& file, const std::string& name) {
  return CaseMaker(file, name).make();
}

}  // namespace lumen::convert
