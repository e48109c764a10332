// SPDX-License-Identifier: Apache-2.0
// Guidewires in vessels: they stay inside, friction is Coulomb's, and bits do not depend on threads.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "allocations.h"
#include "blob_wire.h"
#include "tree.h"

namespace lumen::blob::test {

namespace {

struct CloseFleet {
  void operator()(blob_wires* wires) const { blob_wires_close(wires); }
};
using Fleet = std::unique_ptr<blob_wires, CloseFleet>;

Fleet fleetOf(std::size_t count, std::size_t nodes, std::size_t threads) {
  blob_wires* made = nullptr;
  EXPECT_EQ(blob_wires_create(count, nodes, threads, &made), BLOB_OK);
  return Fleet(made);
}

/// Definition for vessels of radius 1.
blob_wire_def thin(double friction) {
  blob_wire_def def = blob_wire_def_default();
  def.spacing = 0.5;
  def.radius = 0.1;
  def.bending = 1.0;
  def.tip_bending = 0.05;
  def.tip_length = 10.0;
  def.curve_length = 2.0;
  def.friction = friction;
  return def;
}

/// Random pushes and turns, the same for the same wire and step.
double action(std::size_t wire, std::size_t step, std::size_t which) {
  const double at =
      std::sin(12.9898 * static_cast<double>(wire) + 78.233 * static_cast<double>(step) +
               37.719 * static_cast<double>(which));
  return std::fmod(std::fabs(at) * 43758.5453, 1.0);
}

/// Positions after `steps` random steps of `count` wires in a vessel, on `threads` threads.
std::vector<double> wander(const blob_model* vessel, std::size_t count, std::size_t steps,
                           std::size_t threads) {
  const Fleet fleet = fleetOf(count, 60, threads);
  for (std::size_t w = 0; w < count; ++w) {
    const blob_wire_def def = thin(0.05 * static_cast<double>(w % 4));
    const blob_node first = blob_model_node(vessel, 2), second = blob_model_node(vessel, 3);
    blob_wire_place place{};
    for (int a = 0; a < 3; ++a) {
      place.entry[a] = first.centre[a];
      place.direction[a] = second.centre[a] - first.centre[a];
    }
    EXPECT_EQ(blob_wires_set(fleet.get(), w, vessel, &def, &place), BLOB_OK);
  }
  const blob_wires_state s = blob_wires_describe(fleet.get());
  std::vector<double> push(count), turn(count);
  for (std::size_t k = 0; k < steps; ++k) {
    for (std::size_t w = 0; w < count; ++w) {
      push[w] = 1.2 * action(w, k, 0) - 0.4;
      turn[w] = action(w, k, 1) - 0.5;
    }
    const std::size_t before = countAllocations();
    blob_wires_step(fleet.get(), push.data(), turn.data());
    if (count == 1) {
      EXPECT_EQ(countAllocations(), before);
    }
    for (std::size_t w = 0; w < count; ++w)
      for (std::size_t i = 0; i + 1 < s.free[w]; ++i)
        for (int k5 = 0; k5 < 5; ++k5) {
          const double* x = s.position + 3 * (w * s.nodes + i);
          std::array<double, 3> at{};
          for (std::size_t a = 0; a < 3; ++a) at[a] = x[a] + 0.2 * k5 * (x[a + 3] - x[a]);
          std::uint32_t cursor = s.node[w * s.nodes + i];
          EXPECT_TRUE(blob_inside(vessel, 0, at.data(), &cursor)) << w << " at step " << k;
        }
  }
  return {s.position, s.position + 3 * count * s.nodes};
}

TEST(WireInVessel, RandomStepsStayInsideOfAForkAHelixAndTouchingTubes) {
  for (const Tree& tree : {fork(0.5, 0.02), helix(60, 0.02), kissing(0.02)}) {
    const Model vessel = tree.build();
    wander(vessel.get(), 8, 300, 1);
  }
}

TEST(WireInVessel, ThreadsAndNeighboursDoNotChangeBits) {
  const Model vessel = helix(60, 0.02).build();
  const auto alone = wander(vessel.get(), 1, 100, 1), one = wander(vessel.get(), 9, 100, 1),
             two = wander(vessel.get(), 9, 100, 2);
  EXPECT_EQ(one, two);
  EXPECT_TRUE(std::equal(alone.begin(), alone.end(), one.begin()));
}

TEST(WireInVessel, PullsABendAsTheCapstan) {
  // A slack wire around an arc of angle a: the hand's pull is exp(mu a) times the pull at the tip.
  const double mu = 0.2, r = 12.0, angle = std::numbers::pi / 2;
  std::vector<Point> line;
  for (int k = 0; k < 20; ++k) line.push_back({-12.0 + 0.6 * k, 0, 0});
  for (int k = 0; k <= 32; ++k) {
    const double at = angle * k / 32;
    line.push_back({r * std::sin(at), r - r * std::cos(at), 0});
  }
  for (int k = 1; k < 30; ++k) line.push_back({r, r + 0.6 * k, 0});
  Tree tree;
  addVessel(tree, line, 1.0, -1, 0.0);
  const Model vessel = tree.build();
  std::array<double, 2> pull{};
  for (const std::size_t k : {0u, 1u}) {
    blob_wire_def def = thin(k == 0 ? 0.0 : mu);
    def.bending = def.tip_bending = 0.02;
    def.curve_angle = 0.0;
    def.push_limit = 100.0;
    const Fleet fleet = fleetOf(1, 100, 1);
    const blob_wire_place place{{-10, 0, 0}, {1, 0, 0}, 38.0, 0.0};
    ASSERT_EQ(blob_wires_set(fleet.get(), 0, vessel.get(), &def, &place), BLOB_OK);
    const blob_wires_state s = blob_wires_describe(fleet.get());
    EXPECT_NEAR(s.inserted[0], 38.0, 0.5);
    const double load = 0.5, none = 0.0, back = -0.05;
    s.load[1] = load;  // at the tip, along the straight part behind the arc
    for (int step = 0; step < 100; ++step) blob_wires_step(fleet.get(), &back, &none);
    pull[k] = -s.force[0] / load;
  }
  EXPECT_NEAR(pull[0], 1.0, 0.03);
  EXPECT_NEAR(pull[1], std::exp(mu * angle), 0.05);
}

TEST(WireInVessel, RefusesPlacesOutsideAndDefinitionsOutOfRange) {
  const Model vessel = tube(40).build();
  const Fleet fleet = fleetOf(2, 40, 1);
  const blob_wire_place outside{{3, 1.2, 0}, {1, 0, 0}, 0, 0}, nowhere{{3, 0, 0}, {0, 0, 0}, 0, 0},
      good{{3, 0, 0}, {1, 0, 0}, 0, 0};
  blob_wire_def def = thin(0.1);
  EXPECT_EQ(blob_wires_set(fleet.get(), 0, vessel.get(), &def, &outside), BLOB_ERROR_RANGE);
  EXPECT_EQ(blob_wires_set(fleet.get(), 0, vessel.get(), &def, &nowhere), BLOB_ERROR_RANGE);
  EXPECT_EQ(blob_wires_set(fleet.get(), 2, vessel.get(), &def, &good), BLOB_ERROR_ARGUMENT);
  EXPECT_EQ(blob_wires_set(fleet.get(), 0, vessel.get(), &def, &good), BLOB_OK);
  def.friction = -1.0;
  EXPECT_EQ(blob_wires_set(fleet.get(), 0, vessel.get(), &def, &good), BLOB_ERROR_RANGE);
  def.cookie = 0;
  EXPECT_EQ(blob_wires_set(fleet.get(), 0, vessel.get(), &def, &good), BLOB_ERROR_ARGUMENT);
  blob_wires* made = nullptr;
  EXPECT_EQ(blob_wires_create(1, 7, 1, &made), BLOB_ERROR_RANGE);
  EXPECT_EQ(made, nullptr);
}

}  // namespace

}  // namespace lumen::blob::test
