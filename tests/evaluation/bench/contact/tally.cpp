// SPDX-License-Identifier: Apache-2.0
#include "tally.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include <tbb/parallel_for.h>

namespace lumen::bench {
namespace {

// Where a ray from a node's centre leads into another vessel.
std::optional<Kiss> kissAlong(const ExactField& exact, const formats::CenterlineTree& tree,
                              std::uint32_t station, double angle) {
  constexpr double kStep = 0.05, kFarthest = 0.5;  // radii beyond the wall
  const formats::Vec3f &c = tree.centre[station], &d = tree.direction[station];
  const double axis[3] = {c.x, c.y, c.z}, along[3] = {d.x, d.y, d.z};
  double direction[3];
  across(along, angle, direction);
  const double radius = exact.radius(station);
  const double wall = wallAlong(exact.model(), station, axis, direction);
  Kiss kiss{station, {}, {}};
  for (int k = 0; k < 3; ++k) kiss.inside[k] = axis[k] + 0.9 * wall * direction[k];
  if (!(exact.distance(station, kiss.inside) < 0)) return std::nullopt;
  for (double beyond = kStep; beyond <= kFarthest; beyond += kStep) {
    for (int k = 0; k < 3; ++k) kiss.pushed[k] = axis[k] + (wall + beyond * radius) * direction[k];
    const ExactField::Other other = exact.otherVessel(station, kiss.pushed);
    if (!(other.distance < -kTolerance * exact.radius(other.node))) continue;
    if (exact.ownDistance(station, kiss.pushed) > kTolerance * radius) return kiss;
  }
  return std::nullopt;
}

}  // namespace

void countWires(const std::vector<Truth>& truth, const double* distance, Tally& tally) {
  tally.points += truth.size();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double exact = truth[i].distance, tolerance = kTolerance * truth[i].radius;
    const bool saysInside = distance[i] < 0, saysFree = distance[i] + kWireRadius <= 0;
    if (std::abs(exact) > tolerance && saysInside != (exact < 0)) ++tally.wrongSigns;
    if (!saysFree && exact + kWireRadius < -tolerance) ++tally.falseContacts;
    if (saysFree && exact + kWireRadius > tolerance) ++tally.missed;
  }
}

std::vector<Truth> computeTruth(const ExactField& exact, const Wires& wires, std::size_t frame,
                                std::size_t environments) {
  std::vector<Truth> truth(environments * wires.points);
  tbb::parallel_for(std::size_t{0}, truth.size(), [&](std::size_t i) {
    const std::uint32_t station = wires.station[frame][i];
    truth[i] = {exact.distance(station, &wires.position[frame][3 * i]), exact.radius(station)};
  });
  return truth;
}

std::vector<Kiss> findKisses(const ExactField& exact, const formats::CenterlineTree& tree,
                             std::size_t rays, std::size_t wanted) {
  std::mt19937_64 random(1);
  std::vector<std::uint32_t> station(rays);
  std::vector<double> angle(rays);
  for (std::size_t i = 0; i < rays; ++i) {
    station[i] = static_cast<std::uint32_t>(random() % tree.nodeCount());
    angle[i] = 2 * std::numbers::pi * static_cast<double>(random() >> 11) * 0x1p-53;
  }
  std::vector<std::optional<Kiss>> found(rays);
  tbb::parallel_for(std::size_t{0}, rays, [&](std::size_t i) {
    found[i] = kissAlong(exact, tree, station[i], angle[i]);
  });
  std::vector<Kiss> result;
  for (const auto& kiss : found)
    if (kiss && result.size() < wanted) result.push_back(*kiss);
  return result;
}

void countLeaks(Method& method, const std::vector<Kiss>& kisses, Tally& tally) {
  std::vector<double> inside, pushed, distance(kisses.size()), normal(3 * kisses.size());
  std::vector<std::uint32_t> node;
  for (const Kiss& kiss : kisses) {
    inside.insert(inside.end(), kiss.inside, kiss.inside + 3);
    pushed.insert(pushed.end(), kiss.pushed, kiss.pushed + 3);
    node.push_back(kiss.station);
  }
  const std::size_t n = kisses.size();
  if (n == 0) return;
  const Answers answers{distance.data(), {&normal[0], &normal[n], &normal[2 * n]}};
  method.place({n, inside.data(), node.data()});
  method.query(0, inside.data(), n, answers);
  method.query(0, pushed.data(), n, answers);
  tally.kisses += n;
  tally.leaks += static_cast<std::size_t>(
      std::count_if(distance.begin(), distance.end(), [](double d) { return d < 0; }));
}

}  // namespace lumen::bench
