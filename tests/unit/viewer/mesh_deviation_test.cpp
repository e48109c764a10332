// SPDX-License-Identifier: Apache-2.0
// How far meshes lie from the wall of the open case.
#include "viewer/session/packs/mesh_deviation.h"

#include <cmath>
#include <sstream>

#include "converters/geometry/icosphere.h"
#include "served.h"

namespace lumen::test {

namespace {

constexpr double kRadius = 2;
const Eigen::Vector3d kCentre(0.03, 0.05, 0.07);  // of sphereCase()

/// One blob, the surface of which is a sphere: f = w / (1 + 0.2 (r / w)^2)^2 is 0.1 mm at r.
formats::Case ball() {
  double low = 0, high = 2 * kRadius;
  for (int step = 0; step < 60; ++step) {
    const double w = 0.5 * (low + high), d = 1 + 0.2 * kRadius * kRadius / (w * w);
    (w / (d * d) > 0.1 ? high : low) = w;
  }
  return sphereCase(kRadius, high);
}

/// An icosphere as a file in OBJ.
std::string sphereObj(double radius) {
  std::ostringstream text;
  text.precision(9);
  const auto points = convert::icosphere(2);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d at = kCentre + radius * p;
    text << "v " << at.x() << ' ' << at.y() << ' ' << at.z() << '\n';
  }
  for (std::size_t i = 0; i + 2 < points.size(); i += 3)
    text << "f " << i + 1 << ' ' << i + 2 << ' ' << i + 3 << '\n';
  return text.str();
}

}  // namespace

class MeshDeviationTest : public ServedTest {
protected:
  [[nodiscard]] ReadPack deviation(int id) const {
    return ReadPack(get("deviation?id=" + std::to_string(id)).body);
  }
};

TEST(MeshDeviation, IsTheExactSignedDistanceToASphereNearItAndFarFromIt) {
  Progress silent;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> expected;
  for (const Eigen::Vector3d& p : convert::icosphere(2))
    for (const double r : {0.5, 1.7, 2.0, 2.6, 5.0, 60.0}) {
      points.push_back(kCentre + r * p);
      expected.push_back(r - kRadius);
    }
  const auto made = viewer::meshDeviation(ball(), points, silent);
  ASSERT_EQ(made.distance.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(double{made.distance[i]}, expected[i], 1e-3) << i;
  // absolute distances of 1.5, 0.3, 0, 0.6, 3 and 58 mm, equally many of each
  EXPECT_NEAR(made.median, 0.5 * (0.6 + 1.5), 1e-3);
  EXPECT_NEAR(made.percentile90, 58, 1e-3);
  EXPECT_NEAR(made.greatest, 58, 1e-3);
}

TEST(MeshDeviation, OfNoPointsIsEmpty) {
  Progress silent;
  const auto made = viewer::meshDeviation(ball(), {}, silent);
  EXPECT_TRUE(made.distance.empty());
  EXPECT_EQ(made.greatest, 0);
}

TEST(MeshDeviation, EndsWhenItIsCancelled) {
  Progress progress;
  progress.cancel();
  const std::vector<Eigen::Vector3d> points(1000, kCentre);
  EXPECT_THROW(viewer::meshDeviation(ball(), points, progress), Error);
}

TEST(MeshDeviation, IsNegativeInTheOtherVesselAsWell) {
  Progress silent;
  // in both vessels of twoVessels(), whose radii are 1.0 and 0.8, between them, and beside one
  const std::vector<Eigen::Vector3d> points = {
      {3.6, 0, 0.5}, {2.6, 10, 0.5}, {2.6, 5, 0}, {2.6, 10, 1.2}};
  const auto made = viewer::meshDeviation(twoVessels(), points, silent);
  EXPECT_NEAR(double{made.distance[0]}, -0.5, 0.05);
  EXPECT_NEAR(double{made.distance[1]}, -0.3, 0.05);
  EXPECT_NEAR(double{made.distance[2]}, 4.0, 0.05);
  EXPECT_NEAR(double{made.distance[3]}, 0.4, 0.05);
}

TEST_F(MeshDeviationTest, ThePackBelongsToTheVerticesOfItsMesh) {
  writeCase("ball.lumen", ball());
  write("inner.obj", sphereObj(1.75));
  write("outer.obj", sphereObj(2.5));
  serve({"ball.lumen", "inner.obj", "outer.obj"});
  const Json meshes = state()["meshes"];
  ASSERT_EQ(meshes.size(), 2U);
  const std::vector<double> expected = {-0.25, 0.5};
  for (std::size_t m = 0; m < 2; ++m) {
    const int id = meshes[m]["id"].get<int>();
    const ReadPack pack = deviation(id), mesh(get("mesh?id=" + std::to_string(id)).body);
    const auto distance = pack.array<float>("distance_mm");
    ASSERT_EQ(3 * distance.size(), mesh.array<float>("position").size());
    for (const float d : distance) EXPECT_NEAR(double{d}, expected[m], 1e-3);
    const Json& figures = pack.json["figures"];
    EXPECT_EQ(figures["vertices"], distance.size());
    for (const char* name : {"median_mm", "percentile90_mm", "greatest_mm"})
      EXPECT_NEAR(figures[name].get<double>(), std::abs(expected[m]), 1e-3) << name;
  }
}

TEST_F(MeshDeviationTest, AMeshThatIsReadAgainHasANumberOfItsOwn) {
  writeCase("ball.lumen", ball());
  write("mesh.obj", sphereObj(2));
  serve({"ball.lumen", "mesh.obj"});
  const Json before = state()["meshes"];
  write("mesh.obj", sphereObj(2.5));
  performAll({{"op", "reload"}, {"id", before[0]["id"]}});
  const Json after = state()["meshes"];
  ASSERT_EQ(after.size(), 1U);
  EXPECT_EQ(after[0]["name"], "mesh.obj");
  EXPECT_NE(after[0]["id"], before[0]["id"]) << "a page would keep the old one";
  EXPECT_EQ(state()["files"][1]["id"], after[0]["id"]);
  EXPECT_NEAR(deviation(after[0]["id"].get<int>()).json["figures"]["median_mm"].get<double>(), 0.5,
              1e-3);
  ASSERT_EQ(perform({{"op", "undo"}}).status, 200);
  EXPECT_EQ(state()["meshes"], before);
}

TEST_F(MeshDeviationTest, APageAsOneFileHasTheDistancesOfItsMeshes) {
  formats::Case bare = ball();
  bare.models.reset();
  writeCase("ball.lumen", ball());
  writeCase("bare.lumen", bare);
  write("mesh.obj", sphereObj(2.5));
  Progress silent;
  serve({"ball.lumen", "mesh.obj"});
  EXPECT_NE(viewer::htmlPage(*session, smallPage(), {}, silent).find("\"deviation?id="),
            std::string::npos);
  serve({"bare.lumen", "mesh.obj"});
  const std::string without = viewer::htmlPage(*session, smallPage(), {}, silent);
  EXPECT_NE(without.find("\"mesh?id="), std::string::npos);
  EXPECT_EQ(without.find("\"deviation?id="), std::string::npos);
}

TEST_F(MeshDeviationTest, ThereIsNoneWithoutModelsOrWithoutThatMesh) {
  formats::Case bare = ball();
  bare.models.reset();
  writeCase("bare.lumen", bare);
  writeCase("ball.lumen", ball());
  write("mesh.obj", sphereObj(2));
  serve({"bare.lumen", "mesh.obj"});
  const std::string id = state()["meshes"][0]["id"].dump();
  EXPECT_EQ(get("deviation?id=" + id).status, 404);
  serve({"mesh.obj"});
  EXPECT_EQ(get("deviation?id=" + state()["meshes"][0]["id"].dump()).status, 404);
  serve({"ball.lumen", "mesh.obj"});
  EXPECT_EQ(get("deviation?id=" + state()["meshes"][0]["id"].dump()).status, 200);
  EXPECT_EQ(get("deviation?id=77").status, 404);
  EXPECT_EQ(get("deviation?id=x").status, 400);
}

TEST_F(MeshDeviationTest, AnotherWallAndAnotherMeshHaveOtherDistances) {
  writeCase("two.lumen", twoVessels());
  write("mesh.obj", sphereObj(2));
  serve({"two.lumen", "mesh.obj"});
  const std::string name = "deviation?id=" + state()["meshes"][0]["id"].dump();
  const httplib::Response before = get(name);
  const std::string tag = before.get_header_value("ETag");
  EXPECT_EQ(get(name, {{"If-None-Match", tag}}).status, 304);
  performAll({{"op", "delete"}, {"branch", 0}});
  const httplib::Response after = get(name);
  EXPECT_NE(after.get_header_value("ETag"), tag);
  const auto farther = ReadPack(after.body).array<float>("distance_mm"),
             nearer = ReadPack(before.body).array<float>("distance_mm");
  ASSERT_EQ(farther.size(), nearer.size());
  EXPECT_GT(farther[0], nearer[0] + 1);

  write("mesh.obj", sphereObj(3));
  session->lookAtFiles();
  const std::string other = get(name).get_header_value("ETag");
  performAll({{"op", "reload"}, {"id", state()["meshes"][0]["id"]}});
  EXPECT_NE(get(name).get_header_value("ETag"), other);
}

}  // namespace lumen::test
