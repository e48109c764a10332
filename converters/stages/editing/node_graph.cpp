// SPDX-License-Identifier: Apache-2.0
#include "converters/stages/editing/node_graph.h"

#include <algorithm>
#include <cmath>

#include "converters/base/statistics.h"
#include "converters/base/vectors.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::BranchKind;

constexpr double kMostRadii = 0.75;  // share of an arm's radii that its ratio holds for

}  // namespace

NodeGraph::NodeGraph(EditableCase& edited)
    : m_edited(edited), m_isVessel(edited.nodes.size(), false), m_neighbours(edited.nodes.size()) {
  for (const EditableBranch& branch : edited.branches) {
    if (branch.record.kind != BranchKind::Vessel) continue;
    for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
      m_isVessel[branch.nodes[i]] = true;
      if (i > 0) connect(branch.nodes[i - 1], branch.nodes[i]);
    }
    if (branch.parent != kNoNode) connect(branch.parent, branch.nodes.front());
  }
}

void NodeGraph::connect(std::uint32_t a, std::uint32_t b) {
  m_neighbours[a].push_back(b);
  m_neighbours[b].push_back(a);
}

std::vector<std::uint32_t> NodeGraph::formerRoots() const {
  std::vector<std::uint32_t> roots;
  for (const EditableBranch& branch : m_edited.branches)
    if (branch.record.kind == BranchKind::Vessel && branch.parent == kNoNode)
      roots.push_back(branch.nodes.front());
  return roots;
}

std::vector<std::uint32_t> NodeGraph::cutBetweenSystems() {
  std::vector<std::uint32_t> roots;
  for (EditableBranch& branch : m_edited.branches) {
    if (branch.parent == kNoNode || !areApart(branch.parent, branch.nodes.front())) continue;
    if (branch.record.kind == BranchKind::Vessel) {
      cut(branch.parent, branch.nodes.front());
      const auto isBridge = [&](std::uint32_t node) {
        return m_edited.nodes[node].origin == formats::NodeOrigin::Bridged &&
               m_neighbours[node].size() == 1 && !isLinked(node) && !hasAneurysm(node);
      };
      std::size_t first = 0;
      for (; isBridge(branch.nodes[first]); ++first)
        drop(std::span(branch.nodes).subspan(first, 1));
      roots.push_back(branch.nodes[first]);
    }
    branch.parent = kNoNode;
  }
  std::erase_if(m_edited.links, [&](const auto& link) { return areApart(link[0], link[1]); });
  return roots;
}

void NodeGraph::orient(const std::vector<std::uint32_t>& roots) {
  m_order.clear();
  m_parent.assign(m_neighbours.size(), kNoNode);
  m_main.assign(m_neighbours.size(), kNoNode);
  for (const std::uint32_t root : roots) {
    std::size_t next = m_order.size();
    for (m_order.push_back(root); next < m_order.size(); ++next)
      for (const std::uint32_t j : m_neighbours[m_order[next]]) {
        if (j == m_parent[m_order[next]]) continue;
        m_parent[j] = m_order[next];
        m_order.push_back(j);
      }
  }
  for (auto node = m_order.rbegin(); node != m_order.rend(); ++node)
    m_main[*node] = findMain(*node);
}

Vector3d NodeGraph::position(std::uint32_t node) const {
  return toEigen(m_edited.nodes[node].centre);
}

double NodeGraph::radius(std::uint32_t node) const {
  return double{m_edited.nodes[node].radius};
}

std::optional<Arm> NodeGraph::armOf(std::span<const std::uint32_t> nodes) const {
  std::vector<float> all;
  for (std::size_t i = 0; i < std::min<std::size_t>(nodes.size(), 9); ++i)
    all.push_back(m_edited.nodes[nodes[i]].radius);
  if (all.size() < 3) return std::nullopt;
  const double width = double{upperMedian(all)};
  std::vector<float> radii;
  std::optional<Vector3d> from;
  Vector3d to = position(nodes.front());
  double along = 0;
  for (std::size_t i = 1; i < nodes.size() && along < kArmEndRadii * width; ++i) {
    const Vector3d at = position(nodes[i]);
    along += (at - position(nodes[i - 1])).norm();
    if (along < width) continue;
    if (!from) from = at;
    to = at;
    radii.push_back(m_edited.nodes[nodes[i]].radius);
  }
  if (!from || (to - *from).norm() < 0.5 * width) return std::nullopt;
  const double median = double{upperMedian(radii)};
  std::vector<double> ratios;
  for (const float radius : radii)
    ratios.push_back(std::max(double{radius} / median, median / double{radius}));
  return Arm{(to - *from).normalized(), median, nearestRank(ratios, kMostRadii)};
}

std::vector<std::uint32_t> NodeGraph::follow(std::uint32_t node,
                                             const std::vector<std::uint32_t>& next) const {
  std::vector<std::uint32_t> nodes;
  double along = 0;
  const double reach = 2 * kArmEndRadii * radius(node);
  for (std::uint32_t i = node; i != kNoNode && along < reach; i = next[i]) {
    if (!nodes.empty()) along += (position(i) - position(nodes.back())).norm();
    nodes.push_back(i);
  }
  return nodes;
}

std::vector<std::uint32_t> NodeGraph::stretchAround(std::uint32_t node) const {
  std::vector<std::uint32_t> nodes = follow(node, m_parent);
  const std::vector<std::uint32_t> behind = follow(node, m_main);
  nodes.insert(nodes.end(), behind.begin() + 1, behind.end());
  return nodes;
}

// Children have their own main neighbours already.
std::uint32_t NodeGraph::findMain(std::uint32_t node) const {
  const auto into = armOf(follow(node, m_parent));  // against the stream
  std::uint32_t best = kNoNode, any = kNoNode;
  double most = -1;
  for (const std::uint32_t child : m_neighbours[node]) {
    if (child == m_parent[node] || m_parent[child] != node) continue;
    any = child;
    if (m_neighbours[node].size() == 2 && m_parent[node] != kNoNode) return child;
    const auto arm = armOf(follow(child, m_main));
    if (!arm) continue;
    // a vessel that is wider than the one before it is another one that passes by
    const double width =
        into ? std::min(arm->radius, into->radius * into->radius / arm->radius) : arm->radius;
    const double straight = into ? 0.5 * (1 - into->direction.dot(arm->direction)) : 1;
    if (width * straight <= most) continue;
    most = width * straight;
    best = child;
  }
  return best == kNoNode ? any : best;
}

std::vector<std::uint32_t> NodeGraph::inwardFrom(std::uint32_t node, double reach,
                                                 std::uint32_t before) const {
  std::vector<std::uint32_t> nodes;
  double along = 0;
  for (std::uint32_t i = node; i != kNoNode && along < reach;) {
    if (!nodes.empty()) along += (position(i) - position(nodes.back())).norm();
    nodes.push_back(i);
    std::uint32_t next = kNoNode;
    float widest = -1;
    for (const std::uint32_t j : m_neighbours[i]) {
      if (j == before || m_edited.nodes[j].radius <= widest) continue;
      widest = m_edited.nodes[j].radius;
      next = j;
    }
    before = i;
    i = next;
  }
  return nodes;
}

std::optional<Arm> NodeGraph::armFrom(std::uint32_t end) const {
  return armOf(inwardFrom(end, 2 * kArmEndRadii * radius(end)));
}

std::optional<Arm> NodeGraph::armInto(std::uint32_t node, std::uint32_t next) const {
  return armOf(inwardFrom(next, 2 * kArmEndRadii * radius(next), node));
}

std::vector<std::uint32_t> NodeGraph::throughAllBut(std::uint32_t node,
                                                    std::uint32_t excluded) const {
  std::vector<std::uint32_t> nodes{node};
  for (const std::uint32_t next : m_neighbours[node]) {
    if (next == excluded) continue;
    const auto arm = inwardFrom(next, 2 * kArmEndRadii * radius(node), node);
    nodes.insert(nodes.end(), arm.begin(), arm.end());
  }
  return nodes;
}

Vector3d NodeGraph::outwardAt(std::uint32_t end) const {
  Vector3d sum = Vector3d::Zero();
  const std::vector<std::uint32_t> nodes = inwardFrom(end, 2 * radius(end));
  const Vector3d away = position(end) - position(nodes.back());
  for (const std::uint32_t node : nodes) {
    const Vector3d direction = toEigen(m_edited.nodes[node].direction);
    sum += direction.dot(away) < 0 ? -direction : direction;
  }
  return sum.normalized();
}

std::vector<NodeGraph::Width> NodeGraph::widthsAlong(std::span<const std::uint32_t> nodes) const {
  std::vector<Width> widths;
  const double width = radius(nodes.front());
  double along = 0;
  for (std::size_t i = 1; i < nodes.size() && along < kArmEndRadii * width; ++i) {
    along += (position(nodes[i]) - position(nodes[i - 1])).norm();
    if (along >= width) widths.push_back({along, radius(nodes[i])});
  }
  return widths;
}

std::optional<std::pair<double, double>> NodeGraph::widthsAround(std::uint32_t a,
                                                                 std::uint32_t b) const {
  const auto isAbove = [&](std::uint32_t up, std::uint32_t down) {
    const std::vector<std::uint32_t> path = follow(down, m_parent);
    return std::find(path.begin(), path.end(), up) != path.end();
  };
  const bool isAFirst = isAbove(a, b);
  if (!isAFirst && !isAbove(b, a)) return std::nullopt;
  std::vector<Width> before = widthsAlong(follow(isAFirst ? a : b, m_parent));
  const std::vector<Width> after = widthsAlong(follow(isAFirst ? b : a, m_main));
  if (before.empty() || after.empty()) return std::nullopt;
  for (Width& width : before) width.at = -width.at;
  std::vector<double> slopes;
  for (const std::span<const Width> side : {std::span<const Width>(before), std::span(after)})
    for (std::size_t i = 0; i < side.size(); ++i)
      for (std::size_t k = i + 1; k < side.size(); ++k)
        slopes.push_back((side[k].radius - side[i].radius) / (side[k].at - side[i].at));
  const double slope = slopes.empty() ? 0 : upperMedian(slopes);
  const auto here = [&](const std::vector<Width>& side) {
    std::vector<double> radii;
    for (const Width& width : side) radii.push_back(width.radius - slope * width.at);
    return upperMedian(radii);
  };
  return std::pair(here(before), here(after));
}

void NodeGraph::cut(std::uint32_t a, std::uint32_t b) {
  std::erase(m_neighbours[a], b);
  std::erase(m_neighbours[b], a);
}

void NodeGraph::detach(std::uint32_t node, std::span<const std::uint32_t> stem) {
  if (m_parent[node] != kNoNode) cut(node, m_parent[node]);
  m_parent[node] = kNoNode;
  drop(stem);
}

void NodeGraph::drop(std::span<const std::uint32_t> nodes) {
  for (const std::uint32_t gone : nodes) {
    for (const std::uint32_t other : std::vector<std::uint32_t>(m_neighbours[gone]))
      cut(gone, other);
    m_isVessel[gone] = false;
  }
}

void NodeGraph::join(std::uint32_t a, std::uint32_t b) {
  const bool isLoop = pathLength(a, b).has_value();
  std::uint32_t last = a;
  const std::vector<EditableNode> between = bridge(m_edited.nodes[a], m_edited.nodes[b]);
  for (const EditableNode& node : between) {
    const auto next = static_cast<std::uint32_t>(m_edited.nodes.size());
    m_edited.nodes.push_back(node);
    m_neighbours.emplace_back();
    m_isVessel.push_back(true);
    m_parent.push_back(kNoNode);
    connect(last, next);
    last = next;
  }
  if (isLoop)
    m_edited.links.push_back({last, b});
  else
    connect(last, b);
}

std::vector<formats::StopReason> NodeGraph::reasonsAtEnds() const {
  std::vector<formats::StopReason> reasons(m_neighbours.size(), formats::StopReason::Unknown);
  for (const EditableBranch& branch : m_edited.branches)
    reasons[branch.nodes.back()] = branch.record.stopReason;
  return reasons;
}

std::vector<Chain> NodeGraph::chains() const {
  std::vector<std::vector<Chain>> trees;
  std::vector<std::size_t> sizes;
  const auto branchFrom = [&](std::uint32_t node) {
    std::vector<std::uint32_t> nodes;
    for (; node != kNoNode; node = m_main[node]) nodes.push_back(node);
    return nodes;
  };
  for (const std::uint32_t root : m_order) {
    if (m_parent[root] != kNoNode) continue;
    std::vector<Chain> tree{{kNoNode, branchFrom(root)}};
    for (std::size_t c = 0; c < tree.size(); ++c)
      for (std::size_t k = 0; k < tree[c].nodes.size(); ++k) {
        const std::uint32_t node = tree[c].nodes[k];
        for (const std::uint32_t child : m_neighbours[node])
          if (m_parent[child] == node && child != m_main[node])
            tree.push_back({node, branchFrom(child)});
      }
    trees.push_back(std::move(tree));
  }
  const auto countOf = [](const std::vector<Chain>& tree) {
    std::size_t count = 0;
    for (const Chain& chain : tree) count += chain.nodes.size();
    return count;
  };
  std::stable_sort(trees.begin(), trees.end(),
                   [&](const auto& a, const auto& b) { return countOf(a) > countOf(b); });
  std::vector<Chain> out;
  for (std::vector<Chain>& tree : trees)
    std::move(tree.begin(), tree.end(), std::back_inserter(out));
  return out;
}

void NodeGraph::turnDirections() {
  for (const std::uint32_t node : m_order) {
    const std::uint32_t to = m_main[node], from = m_parent[node];
    const Vector3d ahead = (to == kNoNode ? position(node) : position(to)) -
                           (from == kNoNode ? position(node) : position(from));
    formats::Vec3f& direction = m_edited.nodes[node].direction;
    if (toEigen(direction).dot(ahead) < 0) direction = toVec3f(-toEigen(direction));
  }
}

}  // namespace lumen::convert
