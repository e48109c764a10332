// SPDX-License-Identifier: Apache-2.0
// The rod of libblob/wire against closed forms, without a vessel.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "blob_wire.h"

namespace {

constexpr double kPi = std::numbers::pi;

struct CloseWires {
  void operator()(blob_wires* wires) const { blob_wires_close(wires); }
};
using Wires = std::unique_ptr<blob_wires, CloseWires>;

/// A wire of 60 mm and even stiffness along x, clamped at x = 0, free of walls.
struct Rod {
  static constexpr double kLength = 60.0;
  explicit Rod(double spacing, double angle = 0.0) {
    blob_wires* made = nullptr;
    EXPECT_EQ(blob_wires_create(1, static_cast<std::size_t>(kLength / spacing) + 4, 1, &made),
              BLOB_OK);
    wires.reset(made);
    def = blob_wire_def_default();
    def.spacing = spacing;
    def.tip_bending = def.bending;
    def.curve_length = kLength;
    def.curve_angle = angle;
    def.push_limit = 1e9;
    const blob_wire_place place{{0, 0, 0}, {1, 0, 0}, kLength, 0.0};
    EXPECT_EQ(blob_wires_set(made, 0, nullptr, &def, &place), BLOB_OK);
    state = blob_wires_describe(made);
    EXPECT_NEAR(state.inserted[0], kLength, 1e-9);
  }

  void settle(int steps = 3000) const {
    const double none = 0.0;
    for (int k = 0; k < steps; ++k) blob_wires_step(wires.get(), &none, &none);
  }

  Wires wires;
  blob_wire_def def{};
  blob_wires_state state{};
};

/// Deflections of a cantilever's tip under an end load, across and along, in lengths, at loads P L^2 / EI.
/// K. Mattiasson, Numerical results from large deflection beam and frame problems analysed by means of
/// elliptic integrals, 1981, table 1.
struct Elastica {
  double load, across, along;
};
constexpr std::array<Elastica, 4> kElastica{{{0.2, 0.06636, 0.00265},
                                             {1.0, 0.30172, 0.05643},
                                             {5.0, 0.71379, 0.38763},
                                             {10.0, 0.81061, 0.55500}}};

TEST(WireRod, CantileverBendsAsTheElastica) {
  for (const Elastica& e : kElastica) {
    std::array<double, 2> errors{};
    for (const std::size_t fineness : {0u, 1u}) {
      const Rod rod(fineness == 0 ? 2.0 : 1.0);
      rod.state.load[1] = e.load * rod.def.bending / (Rod::kLength * Rod::kLength);
      rod.settle();
      const double across = rod.state.position[1] / Rod::kLength;
      const double along = 1.0 - rod.state.position[0] / Rod::kLength;
      errors[fineness] = std::hypot(across - e.across, along - e.along);
    }
    // of second order in the length of elements
    EXPECT_LT(errors[1], 3e-4) << e.load;
    EXPECT_LT(errors[0], 1.2e-3) << e.load;
  }
}

TEST(WireRod, SmallLoadBendsAsTheLinearBeam) {
  const Rod rod(1.0);
  const double load = 0.01 * rod.def.bending / (Rod::kLength * Rod::kLength);
  rod.state.load[1] = load;
  rod.settle();
  for (const int i : {0, 15, 30, 45}) {
    const double x = Rod::kLength - i;
    const double expected = load * x * x * (3.0 * Rod::kLength - x) / (6.0 * rod.def.bending);
    EXPECT_NEAR(rod.state.position[3 * i + 1], expected, 5e-4 * expected) << i;
  }
}

TEST(WireRod, BucklesByMoreThanEulersLoadAlone) {
  // P = pi^2 EI / (4 L^2) of a cantilever; a side load of a thousandth shows which way it goes
  for (const double share : {0.95, 1.05}) {
    const Rod rod(1.0);
    const double euler = kPi * kPi * rod.def.bending / (4.0 * Rod::kLength * Rod::kLength);
    rod.state.load[0] = -share * euler;
    rod.state.load[1] = 1e-4 * euler;
    rod.settle(20000);
    const double across = rod.state.position[1] / Rod::kLength;
    if (share < 1.0) {
      EXPECT_LT(across, 0.02);
    } else {
      EXPECT_GT(across, 0.2);
    }
  }
}

TEST(WireRod, MomentBendsItIntoACircle) {
  // a moment M at the end bends a rod to the curvature M / EI everywhere, as the same curve at rest
  const Rod rod(1.0, 2.0 * kPi);
  rod.settle();
  for (const int i : {0, 15, 30, 45}) {
    const double angle = 2.0 * kPi * (Rod::kLength - i) / Rod::kLength,
                 r = Rod::kLength / (2.0 * kPi);
    const double across = std::hypot(rod.state.position[3 * i + 1], rod.state.position[3 * i + 2]);
    EXPECT_NEAR(rod.state.position[3 * i], r * std::sin(angle), 1e-3 * Rod::kLength);
    EXPECT_NEAR(across, r * (1.0 - std::cos(angle)), 1e-3 * Rod::kLength);
  }
}

TEST(WireRod, TurnAtTheHandTurnsTheTip) {
  const Rod rod(1.0, 0.5);
  rod.settle(200);
  const double y = rod.state.position[1], z = rod.state.position[2];
  const double none = 0.0, turn = 1.0;
  blob_wires_step(rod.wires.get(), &none, &turn);
  rod.settle(2000);
  EXPECT_NEAR(rod.state.position[1], std::cos(1.0) * y - std::sin(1.0) * z, 1e-3);
  EXPECT_NEAR(rod.state.position[2], std::sin(1.0) * y + std::cos(1.0) * z, 1e-3);
}

}  // namespace
