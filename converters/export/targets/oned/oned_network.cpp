// SPDX-License-Identifier: Apache-2.0
#include "converters/export/targets/oned/oned_network.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "converters/base/error.h"
#include "converters/base/shown_text.h"
#include "converters/export/shared/flow_pressure.h"
#include "converters/export/shared/frame.h"
#include "converters/io/mesh/mesh_parts.h"

namespace lumen::convert {

namespace {

/// The cone with the segment's resistance.
OneDVessel equivalentCone(const FlowSegment& segment) {
  OneDVessel vessel;
  const double a = kMetres * segment.radii.front(), b = kMetres * segment.radii.back();
  vessel.length = kMetres * segment.length();
  const double cone = 8 * blood::kViscosity / std::numbers::pi * vessel.length *
                      (a * a + a * b + b * b) / 3 / (a * a * a * b * b * b);
  const double share = vessel.length > 0 ? std::pow(cone / lumped(segment).resistance, 0.25) : 1;
  vessel.inRadius = share * a;
  vessel.outRadius = share * b;
  return vessel;
}

class OneDBuilder {
public:
  OneDBuilder(const FlowNetwork& network, std::uint32_t tree) : m_network(network), m_tree(tree) {}

  OneDNetwork build() {
    requireOneInlet();
    const FlowTree& tree = m_network.trees[m_tree];
    const std::uint32_t inlet = tree.inlets.front();
    m_made.flow = m_network.joints[inlet].inflow;
    addVessels(inlet);
    splitJunctions();
    splitParallels();
    nameVessels();
    return std::move(m_made);
  }

private:
  void requireOneInlet() const {
    const FlowTree& tree = m_network.trees[m_tree];
    if (tree.inlets.size() > 1)
      throw invalidInput(
          m_network.joints[tree.inlets[0]].name + " and " + m_network.joints[tree.inlets[1]].name +
          " lead into vessels that are joined, and solvers in one dimension take one "
          "inlet; svzerod takes several");
    for (const FlowJoint& joint : m_network.joints)
      if (joint.tree == m_tree && joint.kind == JointKind::Junction &&
          (joint.in.empty() || joint.out.empty()))
        throw invalidInput("the vessels of a loop meet head on at " + placeText(joint.place, 6) +
                           " mm, so which way it flows is not known; svzerod takes such loops");
  }

  std::uint32_t addNode(const Eigen::Vector3d& place) {
    m_made.nodes.push_back(place);
    return static_cast<std::uint32_t>(m_made.nodes.size() - 1);
  }

  void addVessels(std::uint32_t inlet) {
    std::vector<std::uint32_t> nodeOf(m_network.joints.size(), 0);
    nodeOf[inlet] = addNode(m_network.joints[inlet].place);
    for (std::uint32_t j = 0; j < m_network.joints.size(); ++j)
      if (m_network.joints[j].tree == m_tree && j != inlet)
        nodeOf[j] = addNode(m_network.joints[j].place);
    for (const FlowSegment& segment : m_network.segments) {
      if (m_network.joints[segment.from].tree != m_tree) continue;
      OneDVessel vessel = equivalentCone(segment);
      vessel.name = segment.name;
      vessel.from = nodeOf[segment.from];
      vessel.to = nodeOf[segment.to];
      if (const double radius = vessel.meanRadius(); vessel.length < radius) {
        vessel.length = radius;
        ++m_made.lengthened;
      }
      m_made.vessels.push_back(std::move(vessel));
      if (segment.from == inlet) std::swap(m_made.vessels.front(), m_made.vessels.back());
    }
    const FlowTree& tree = m_network.trees[m_tree];
    const std::vector<double> resistances = outletResistances(m_network, tree);
    for (std::size_t k = 0; k < resistances.size(); ++k)
      for (OneDVessel& vessel : m_made.vessels)
        if (vessel.to == nodeOf[tree.outlets[k]]) vessel.resistance = resistances[k];
  }

  /// A vessel of one radius from one node to another.
  void addStub(std::uint32_t from, std::uint32_t to, double radius) {
    OneDVessel stub;
    stub.name = "stub" + std::to_string(++m_made.stubs);
    stub.from = from;
    stub.to = to;
    stub.length = stub.inRadius = stub.outRadius = radius;
    m_made.vessels.push_back(std::move(stub));
  }

  void splitJunctions() {
    const std::size_t nodes = m_made.nodes.size();
    for (std::uint32_t node = 0; node < nodes; ++node) {
      std::vector<std::size_t> in, out;
      double widest = 0;
      for (std::size_t v = 0; v < m_made.vessels.size(); ++v) {
        if (m_made.vessels[v].to == node) in.push_back(v);
        if (m_made.vessels[v].from == node) out.push_back(v);
        if (m_made.vessels[v].to == node || m_made.vessels[v].from == node)
          widest = std::max(widest, m_made.vessels[v].meanRadius());
      }
      if (in.size() + out.size() <= 3) continue;
      mergeIn(node, std::move(in), widest);
      spreadOut(node, std::move(out), widest);
    }
  }

  /// Joins the flows into a node before it, two at a time, until one vessel reaches it.
  void mergeIn(std::uint32_t node, std::vector<std::size_t> in, double radius) {
    while (in.size() > 1) {
      const std::uint32_t before = addNode(m_made.nodes[node]);
      m_made.vessels[in[in.size() - 1]].to = m_made.vessels[in[in.size() - 2]].to = before;
      in.resize(in.size() - 2);
      addStub(before, node, radius);
      in.push_back(m_made.vessels.size() - 1);
    }
  }

  /// All but the first go on at a node behind it, until two vessels leave each.
  void spreadOut(std::uint32_t node, std::vector<std::size_t> out, double radius) {
    while (out.size() > 2) {
      const std::uint32_t behind = addNode(m_made.nodes[node]);
      out.erase(out.begin());
      for (const std::size_t v : out) m_made.vessels[v].from = behind;
      addStub(node, behind, radius);
      node = behind;
    }
  }

  /// All vessels but the first between the same nodes get a node in their middle, and so does a
  /// vessel that ends where it begins.
  void splitParallels() {
    std::set<std::pair<std::uint32_t, std::uint32_t>> taken;
    for (std::size_t v = 0; v < m_made.vessels.size(); ++v) {
      const auto [from, to] = std::pair(m_made.vessels[v].from, m_made.vessels[v].to);
      if (from != to && taken.insert({from, to}).second) continue;
      const std::uint32_t middle = addNode(0.5 * (m_made.nodes[from] + m_made.nodes[to]));
      OneDVessel& first = m_made.vessels[v];
      OneDVessel second = first;
      first.length = second.length = 0.5 * first.length;
      first.outRadius = second.inRadius = first.meanRadius();
      first.to = second.from = middle;
      first.resistance = 0;
      second.name += "_half";
      taken.insert({from, middle});
      m_made.vessels.push_back(std::move(second));
    }
  }

  void nameVessels() {
    std::vector<std::string> labels;
    for (const OneDVessel& vessel : m_made.vessels) labels.push_back(vessel.name);
    const std::vector<std::string> names = distinct(labels, openFoamWord);
    for (std::size_t v = 0; v < names.size(); ++v) m_made.vessels[v].name = names[v];
  }

  const FlowNetwork& m_network;
  std::uint32_t m_tree;
  OneDNetwork m_made;
};

}  // namespace

int OneDVessel::cells() const {
  constexpr int kFewestCells = 5;
  return std::max(kFewestCells, static_cast<int>(std::ceil(1e3 * length)));
}

OneDNetwork oneDNetwork(const FlowNetwork& network, std::uint32_t tree) {
  return OneDBuilder(network, tree).build();
}

}  // namespace lumen::convert
