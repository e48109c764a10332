// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/check/shared_lumen.h"

#include <algorithm>
#include <functional>
#include <map>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>

#include "converters/base/vectors.h"
#include "converters/geometry/box_tree.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::CenterlineTree;

/// Times both radii: the path from one axis to the other over a fork of 29 degrees, 1 / sin(29 / 2),
/// where the two walls part.
constexpr double kJointRadii = 4;

/// Two tubes at a place.
struct Contact {
  std::uint32_t node = 0, other = 0;
  double depth = 0;  ///< mm
};

class SharedLumenSearch {
public:
  SharedLumenSearch(const CenterlineTree& tree, double tolerance)
      : m_tree(tree), m_tolerance(tolerance), m_neighbours(tree.nodeCount()) {
    std::vector<Box3d> boxes(tree.nodeCount());
    for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
      boxes[n].add(at(n), radius(n));
      if (tree.parent[n] >= 0) connect(n, static_cast<std::uint32_t>(tree.parent[n]));
    }
    for (const auto& link : tree.links) connect(link[0], link[1]);
    m_nodes = BoxTree<double>(boxes);
  }

  std::vector<SharedLumen> find() {
    for (std::uint32_t n = 0; n < m_tree.nodeCount(); ++n)
      for (const Contact& contact : beyondJoint(n, contactsOf(n))) add(contact);
    std::vector<SharedLumen> found;
    for (auto& [pair, shared] : m_found) {
      shared.length = std::max(lengthOf(m_ours[pair]), lengthOf(m_ours[{pair.second, pair.first}]));
      found.push_back(shared);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const SharedLumen& a, const SharedLumen& b) { return a.depth > b.depth; });
    return found;
  }

private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  [[nodiscard]] Vector3d at(std::uint32_t n) const { return toEigen(m_tree.centre[n]); }
  [[nodiscard]] double radius(std::uint32_t n) const {
    return static_cast<double>(m_tree.radius[n]);
  }
  [[nodiscard]] bool isVessel(std::uint32_t n) const {
    return m_tree.branches[m_tree.branch[n]].kind == formats::BranchKind::Vessel;
  }
  void connect(std::uint32_t a, std::uint32_t b) {
    const double length = (at(a) - at(b)).norm();
    m_neighbours[a].push_back({b, length});
    m_neighbours[b].push_back({a, length});
  }

  /// The nodes of other vessels whose tubes overlap that of a node.
  [[nodiscard]] std::vector<Contact> contactsOf(std::uint32_t n) const {
    std::vector<Contact> contacts;
    if (!isVessel(n)) return contacts;
    Box3d box;
    box.add(at(n), radius(n));
    anyItemNear(m_nodes, box, [&](std::uint32_t other) {
      if (m_tree.branch[other] == m_tree.branch[n] || !isVessel(other)) return false;
      const double both = radius(n) + radius(other) - (at(n) - at(other)).norm();
      const double depth = std::min(both, 2 * std::min(radius(n), radius(other)));
      if (depth > m_tolerance) contacts.push_back({n, other, depth});
      return false;
    });
    return contacts;
  }

  /// The contacts of a node that no short path along the tree joins.
  [[nodiscard]] std::vector<Contact> beyondJoint(std::uint32_t n,
                                                 std::vector<Contact> contacts) const {
    if (contacts.empty()) return contacts;
    double reach = 0;
    for (const Contact& c : contacts)
      reach = std::max(reach, kJointRadii * (radius(n) + radius(c.other)));
    using Front = std::pair<double, std::uint32_t>;
    std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
    std::unordered_map<std::uint32_t, double> path{{n, 0.0}};
    for (front.push({0.0, n}); !front.empty();) {
      const auto [length, node] = front.top();
      front.pop();
      if (length > path.at(node)) continue;
      for (const auto& [next, step] : m_neighbours[node]) {
        const double there = length + step;
        const auto known = path.find(next);
        if (there > reach || (known != path.end() && known->second <= there)) continue;
        path[next] = there;
        front.push({there, next});
      }
    }
    std::erase_if(contacts, [&](const Contact& c) {
      const auto known = path.find(c.other);
      return known != path.end() && known->second <= kJointRadii * (radius(n) + radius(c.other));
    });
    return contacts;
  }

  void add(const Contact& contact) {
    const Pair pair{m_tree.branch[contact.node], m_tree.branch[contact.other]};
    std::vector<std::uint32_t>& ours = m_ours[pair];
    if (ours.empty() || ours.back() != contact.node) ours.push_back(contact.node);
    if (pair.first > pair.second) return;
    SharedLumen& shared = m_found[pair];
    if (contact.depth <= shared.depth) return;
    const double thinner = std::min(radius(contact.node), radius(contact.other));
    shared = {pair.first, pair.second,   contact.node,
              0,          contact.depth, std::min(1.0, contact.depth / (2 * thinner))};
  }

  /// The length that nodes of a branch stand for, mm: half of the edges on both sides of each.
  [[nodiscard]] double lengthOf(std::span<const std::uint32_t> nodes) const {
    double length = 0;
    for (const std::uint32_t n : nodes) {
      const formats::Branch& branch = m_tree.branches[m_tree.branch[n]];
      if (n > branch.firstNode) length += 0.5 * (at(n) - at(n - 1)).norm();
      if (n + 1 < branch.firstNode + branch.nodeCount) length += 0.5 * (at(n + 1) - at(n)).norm();
    }
    return length;
  }

  const CenterlineTree& m_tree;
  double m_tolerance;
  std::vector<std::vector<std::pair<std::uint32_t, double>>> m_neighbours;
  BoxTree<double> m_nodes;
  std::map<Pair, SharedLumen> m_found;
  std::map<Pair, std::vector<std::uint32_t>> m_ours;  ///< nodes of the first in the second
};

}  // namespace

std::vector<SharedLumen> findSharedLumen(const CenterlineTree& tree, double tolerance) {
  return SharedLumenSearch(tree, tolerance).find();
}

}  // namespace lumen::convert
