// SPDX-License-Identifier: Apache-2.0
#include "converters/export/shared/flow_pressure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "converters/base/number_text.h"
#include "converters/export/shared/frame.h"

namespace lumen::convert {

namespace {

constexpr double kMmHg = 133.322;  // Pa
/// mmHg: mean pressures of arteries are 70 to 105; above 180 in the systole is a hypertensive
/// emergency (Williams et al., 2018 ESC/ESH guidelines for the management of arterial
/// hypertension).
constexpr double kMostPressure = 180;

using Entry = Eigen::Triplet<double>;

/// Conductances of segments; a segment without a length is as good as one of a micrometre.
std::vector<double> computeConductances(const FlowNetwork& network) {
  std::vector<double> conductances;
  double least = INFINITY;
  for (const FlowSegment& segment : network.segments)
    if (const double r = lumped(segment).resistance; r > 0) least = std::min(least, r);
  constexpr double kShortcut = 1e-6;
  for (const FlowSegment& segment : network.segments) {
    const double r = lumped(segment).resistance;
    conductances.push_back(1 / (r > 0 ? r : kShortcut * least));
  }
  return conductances;
}

/// Flows between joints for their pressures.
std::vector<Entry> entriesOf(const FlowNetwork& network, const std::vector<double>& conductances) {
  std::vector<Entry> entries;
  for (std::size_t s = 0; s < conductances.size(); ++s) {
    const auto a = static_cast<int>(network.segments[s].from),
               b = static_cast<int>(network.segments[s].to);
    const double g = conductances[s];
    for (const Entry& entry : {Entry(a, a, g), Entry(b, b, g), Entry(a, b, -g), Entry(b, a, -g)})
      entries.push_back(entry);
  }
  return entries;
}

std::vector<double> solve(const std::vector<Entry>& entries, const Eigen::VectorXd& flow) {
  Eigen::SparseMatrix<double> matrix(flow.size(), flow.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd pressure = solver.solve(flow);
  return {pressure.begin(), pressure.end()};
}

/// The warning of one inlet: the segment of its tree with the greatest drop, and its least radius.
Warning warningAt(const FlowNetwork& network, const std::vector<double>& pressures,
                  std::uint32_t inlet) {
  const FlowSegment* steepest = nullptr;
  double greatest = 0;
  for (const FlowSegment& segment : network.segments) {
    if (network.joints[segment.from].tree != network.joints[inlet].tree) continue;
    const double drop = std::abs(pressures[segment.from] - pressures[segment.to]);
    if (steepest && drop <= greatest) continue;
    steepest = &segment;
    greatest = drop;
  }
  const double thinnest = *std::min_element(steepest->radii.begin(), steepest->radii.end());
  return {WarningCode::FlowDoubt,
          network.joints[inlet].name + ": a solver will find a mean pressure of " +
              fixedText(pressures[inlet] / kMmHg, 0) + " mmHg here, and arteries have 70 to 105; " +
              steepest->name + ", which thins to a radius of " + numberText(thinnest, 3) +
              " mm, takes " + fixedText(greatest / kMmHg, 0) + " of it",
          "lumen trim removes ends that are too thin",
          {network.joints[inlet].place}};
}

}  // namespace

std::vector<double> steadyPressures(const FlowNetwork& network) {
  std::vector<Entry> entries = entriesOf(network, computeConductances(network));
  Eigen::VectorXd flow = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.joints.size()));
  for (const FlowTree& tree : network.trees) {
    for (const std::uint32_t inlet : tree.inlets) flow[inlet] = network.joints[inlet].inflow;
    const std::vector<double> resistances = outletResistances(network, tree);
    for (std::size_t k = 0; k < resistances.size(); ++k) {
      const auto at = static_cast<int>(tree.outlets[k]);
      entries.emplace_back(at, at, 1 / resistances[k]);
    }
  }
  return solve(entries, flow);
}

std::vector<double> pressuresOfFlows(const FlowNetwork& network, const std::vector<double>& into,
                                     const std::vector<std::uint32_t>& zero) {
  const std::vector<double> conductances = computeConductances(network);
  std::vector<Entry> entries = entriesOf(network, conductances);
  // nothing flows through it, as all flows sum to 0
  const double ground = *std::max_element(conductances.begin(), conductances.end());
  for (const std::uint32_t joint : zero)
    entries.emplace_back(static_cast<int>(joint), static_cast<int>(joint), ground);
  const Eigen::Map<const Eigen::VectorXd> flow(into.data(), static_cast<Eigen::Index>(into.size()));
  return solve(entries, flow);
}

std::vector<Warning> pressureWarnings(const FlowNetwork& network) {
  const std::vector<double> pressures = steadyPressures(network);
  std::vector<Warning> warnings;
  for (const FlowTree& tree : network.trees)
    for (const std::uint32_t inlet : tree.inlets)
      if (pressures[inlet] > kMostPressure * kMmHg)
        warnings.push_back(warningAt(network, pressures, inlet));
  return warnings;
}

}  // namespace lumen::convert
