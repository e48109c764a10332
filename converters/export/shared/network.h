// SPDX-License-Identifier: Apache-2.0
// A case as solvers in no and in one dimension take it: segments of vessels between joints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "converters/export/shared/flow_inlets.h"
#include "converters/export/shared/insertion.h"
#include "formats/case/case.h"

namespace lumen::convert {

enum class JointKind : std::uint8_t {
  Inlet,    ///< start of a root; one segment leaves it
  Outlet,   ///< end of a vessel; one segment reaches it
  Junction  ///< two segments or more
};

struct FlowJoint {
  JointKind kind = JointKind::Junction;
  std::string name;  ///< unique: "inlet" or "inlet-LABEL", "outlet-LABEL", "J0", "J1", ...
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< mm, LPS
  std::vector<std::uint32_t> in, out;               ///< segments that end and begin here, ascending
  std::uint32_t tree = 0;                           ///< index into `trees`
  double inflow = 0;                                ///< m^3/s, into an inlet
};

/// A vessel without forks. Its radius changes linearly between points.
struct FlowSegment {
  std::string name;          ///< unique: the branch's label; from its second part on LABEL_2, ...
  std::uint32_t branch = 0;  ///< index in the case's tree: the branch of its last point
  std::uint32_t from = 0, to = 0;       ///< joints
  std::vector<Eigen::Vector3d> points;  ///< two at least, mm, LPS
  std::vector<double> radii;            ///< radii at them, mm

  [[nodiscard]] double length() const;  ///< mm; 0 if its points lie on each other
};

/// A connected part of the network.
struct FlowTree {
  std::vector<std::uint32_t> inlets, outlets;  ///< joints, one of each at least
  bool hasLoop = false;
};

struct FlowNetwork {
  std::vector<FlowJoint> joints;
  std::vector<FlowSegment> segments;
  std::vector<FlowTree> trees;
  /// Sentences on vessels that were left out or added; labels as they are.
  std::vector<std::string> messages;
};

/// The vessels of a valid case. Ends are named as on its surface. A branch that leaves its parent
/// between the parent's ends splits it, and begins at its wall with its own first radius; one at
/// the parent's end begins at the parent's last node. A segment leads away from its root; one that
/// a link closes a loop with leads from the joint of the lesser node. Aneurysms are left out unless
/// a vessel is connected to them. Where several vessels leave a root's first node, an inlet of one
/// radius is put before it. Throws Error(InvalidInput) if no vessel has a length, or a tree has no
/// end that blood could leave through.
/// Inlets have the flow that `stated` has for the branch of their root, or else blood::meanFlow().
FlowNetwork flowNetwork(const formats::CenterlineTree& tree,
                        const std::vector<StatedInlet>& stated = {});

/// Inlets and outlets, under their names; positions are those of the first and last nodes.
std::vector<NamedEnd> findEnds(const FlowNetwork& network);

/// Numbers of segments, junctions, inlets, outlets and trees: a sentence for the answer.
std::string networkSummary(const FlowNetwork& network);

/// Integrals along a segment, in SI units, by blood.h.
struct Lumped {
  double resistance = 0;  ///< Pa s/m^3: 8 mu / (pi r^4), Poiseuille's
  double inertance = 0;   ///< kg/m^4: rho / (pi r^2)
  /// m^3/Pa: 3 pi r^3 / (2 E h), of a thin elastic wall that keeps its length (Formaggia, Lamponi,
  /// Quarteroni, One-dimensional models for blood flow in arteries, J Eng Math 47, 2003)
  double compliance = 0;
};
Lumped lumped(const FlowSegment& segment);

/// The share of its tree's flow that each outlet takes, by murrayShare() of its endCalibre(), in the
/// order of `outlets`.
std::vector<double> outletShares(const FlowNetwork& network, const FlowTree& tree);

/// The resistance that lets each outlet of a tree take its outletShares() of the flow from all inlets
/// of the tree, at blood::kMeanPressure: Pa s/m^3, in the order of `outlets`.
std::vector<double> outletResistances(const FlowNetwork& network, const FlowTree& tree);

/// mm: of the segment's end at an inlet or outlet.
double endRadius(const FlowNetwork& network, std::uint32_t joint);
/// mm: calibre() of the segment at an inlet or outlet.
double endCalibre(const FlowNetwork& network, std::uint32_t joint);

}  // namespace lumen::convert
