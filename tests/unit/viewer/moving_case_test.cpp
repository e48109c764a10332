// SPDX-License-Identifier: Apache-2.0
// A case with a motion, as pages fetch it: poses of its nodes, and bones of its surface.
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "served.h"
#include "viewer/session/packs/case_pack.h"

namespace lumen::test {

namespace {

constexpr std::size_t kMovingNodes = 3;
constexpr double kQuarter = std::numbers::pi / 4;  // half of a quarter turn

/// Two vessels, of which the last nodes of the left one rise by 2 mm and turn within half a second.
formats::Case movingVessels() {
  formats::Case value = twoVessels();
  formats::Motion motion;
  motion.time = {0, 0.5};
  motion.period = 0.75;
  motion.node = {5, 6, 7};
  for (const double height : {0.0, 2.0})
    for (const std::uint32_t node : motion.node) {
      formats::Pose pose;
      pose.centre = value.tree.centre[node];
      pose.centre.z += static_cast<float>(height);
      if (height > 0)
        pose.rotation = {static_cast<float>(std::sin(kQuarter)), 0, 0,
                         static_cast<float>(std::cos(kQuarter))};
      motion.pose.push_back(pose);
    }
  value.motion = motion;
  return value;
}

/// Positions of a compact pack, mm (viewer/README.md, "Packs").
std::vector<std::array<double, 3>> positionsOf(const ReadPack& pack) {
  const Json& about = pack.json["arrays"]["position"];
  const auto count = about["shape"][0].get<std::size_t>();
  const std::size_t begin = pack.base + about["offset"].get<std::size_t>();
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(pack.bytes[begin + i]));
  };
  std::vector<std::array<double, 3>> place(count);
  for (std::size_t c = 0; c < 3; ++c) {
    std::uint32_t number = 0;
    for (std::size_t v = 0; v < count; ++v) {
      number += byte(2 * c * count + v) + (byte((2 * c + 1) * count + v) << 8);
      place[v][c] =
          about["low"][c].get<double>() + about["step"][c].get<double>() * (number & 0xffffU);
    }
  }
  return place;
}

/// The vertex nearest to a place.
std::size_t nearest(const std::vector<float>& position, const std::array<double, 3>& place) {
  std::size_t best = 0;
  double least = INFINITY;
  for (std::size_t v = 0; v < position.size() / 3; ++v) {
    const double away = std::hypot(position[3 * v] - place[0], position[3 * v + 1] - place[1],
                                   position[3 * v + 2] - place[2]);
    if (away >= least) continue;
    least = away;
    best = v;
  }
  return best;
}

}  // namespace

using MovingCaseTest = ServedTest;

TEST_F(MovingCaseTest, PackHasThePosesOfItsNodes) {
  writeCase("moving.lumen", movingVessels());
  serve({"moving.lumen"});
  const ReadPack pack(get("case").body);
  EXPECT_EQ(pack.json["motion"], (Json{{"times_s", {0, 0.5}}, {"period_s", 0.75}}));
  EXPECT_EQ(pack.array<std::uint32_t>("motion_node"), (std::vector<std::uint32_t>{5, 6, 7}));
  const auto centre = pack.array<float>("motion_centre"),
             rotation = pack.array<float>("motion_rotation"),
             factor = pack.array<float>("motion_factor");
  ASSERT_EQ(centre.size(), 3 * 2 * kMovingNodes);
  EXPECT_EQ(centre[3 * kMovingNodes + 2] - centre[2], 2);
  ASSERT_EQ(rotation.size(), 4 * 2 * kMovingNodes);
  EXPECT_EQ(rotation[3], 1);
  EXPECT_NEAR(rotation[4 * kMovingNodes], std::sqrt(0.5), 1e-7);
  EXPECT_EQ(factor, std::vector<float>(2 * kMovingNodes, 1));
  EXPECT_EQ(state()["time_s"], nullptr);
}

TEST_F(MovingCaseTest, PackOfAStillCaseHasNoMotion) {
  writeCase("still.lumen", twoVessels());
  serve({"still.lumen"});
  const ReadPack pack(get("case").body), surface(get("surface?quick=1").body);
  EXPECT_EQ(pack.json["motion"], nullptr);
  EXPECT_FALSE(pack.json["arrays"].contains("motion_node"));
  EXPECT_FALSE(surface.json["arrays"].contains("joint"));
}

TEST_F(MovingCaseTest, SurfaceHangsOnTheNodesAroundItsVertices) {
  writeCase("moving.lumen", movingVessels());
  serve({"moving.lumen"});
  const ReadPack pack(get("surface?quick=1").body);
  const auto node = pack.array<std::int32_t>("joint_node");
  EXPECT_EQ(std::set<std::int32_t>(node.begin(), node.end()),
            (std::set<std::int32_t>{-1, 5, 6, 7}));
  const auto position = pack.array<float>("position");
  const auto joint = pack.array<std::uint16_t>("joint"),
             weight = pack.array<std::uint16_t>("weight");
  ASSERT_EQ(joint.size(), position.size() / 3 * 4);
  ASSERT_EQ(weight.size(), joint.size());
  const auto first = movingVessels().tree.centre[5].x, before = movingVessels().tree.centre[2].x;
  std::size_t moving = 0;
  for (std::size_t v = 0; v < position.size() / 3; ++v) {
    int sum = 0, resting = 0;
    for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
      sum += weight[i];
      if (node.at(joint[i]) < 0) resting += weight[i];
    }
    EXPECT_EQ(sum, 65535);
    const bool isLeft = position[3 * v + 1] < 5;
    if (!isLeft || position[3 * v] < before) {
      EXPECT_EQ(resting, 65535) << v;
    }
    if (isLeft && position[3 * v] > first + 1 && resting == 0) ++moving;
  }
  EXPECT_GT(moving, 20U);
}

TEST_F(MovingCaseTest, CompactSurfaceHasTheSameBonesAtTheSamePlaces) {
  writeCase("moving.lumen", movingVessels());
  serve({"moving.lumen"});
  const std::string full = get("surface?quick=1").body;
  const ReadPack before(full), after(viewer::compactPack(full));
  EXPECT_EQ(after.array<std::int32_t>("joint_node"), before.array<std::int32_t>("joint_node"));
  const auto position = before.array<float>("position");
  const auto joint = before.array<std::uint16_t>("joint"),
             weight = before.array<std::uint16_t>("weight");
  const auto newJoint = after.array<std::uint16_t>("joint"),
             newWeight = after.array<std::uint16_t>("weight");
  ASSERT_EQ(newJoint.size(), joint.size());
  const auto place = positionsOf(after);
  for (std::size_t v = 0; v < place.size(); ++v) {
    const std::size_t was = nearest(position, place[v]);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(newJoint[4 * v + i], joint[4 * was + i]) << v;
      EXPECT_EQ(newWeight[4 * v + i], weight[4 * was + i]) << v;
    }
  }
}

TEST_F(MovingCaseTest, PageBeginsAtTheTimeThatItIsGiven) {
  writeCase("moving.lumen", movingVessels());
  viewer::SessionOptions options;
  options.time = 0.25;
  session = std::make_unique<viewer::Session>(options);
  Progress silent;
  session->open({path("moving.lumen"), "moving.lumen"}, silent);
  serveSession();
  EXPECT_EQ(state()["time_s"], 0.25);
  const std::string page = viewer::htmlPage(*session, smallPage(), {}, silent);
  EXPECT_NE(page.find("\"time_s\":0.25"), std::string::npos);
}

}  // namespace lumen::test
