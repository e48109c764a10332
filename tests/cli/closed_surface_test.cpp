// SPDX-License-Identifier: Apache-2.0
// The surfaces that `lumen convert` writes, from outside: shapes whose volume and area are known in closed form, every
// phantom, and real vessels, measured on the file.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "formats/case/case_field.h"
#include "formats/case/case_file.h"
#include "tests/cli/run_lumen.h"
#include "tests/evaluation/reproduce/surface_facts.h"

namespace lumen::test {
namespace {

using Json = nlohmann::json;
using std::numbers::pi;

constexpr double kRadius = 1.5;  // mm, of the shapes

struct Sample {
  double x, y, z, radius;
};

/// SWC, in mm: one chain of samples, and another that leaves its middle.
std::string swcOf(const std::vector<Sample>& chain, const std::vector<Sample>& side = {}) {
  std::ostringstream text;
  text.precision(9);
  std::size_t id = 0;
  const auto add = [&](const std::vector<Sample>& samples, std::size_t parent) {
    for (const Sample& s : samples) {
      text << ++id << " 3 " << s.x << " " << s.y << " " << s.z << " " << s.radius << " "
           << (parent == 0 ? std::string("-1") : std::to_string(parent)) << "\n";
      parent = id;
    }
  };
  add(chain, 0);
  add(side, (chain.size() + 1) / 2);
  return text.str();
}

std::vector<Sample> sampled(int count, const std::function<Sample(double)>& at) {
  std::vector<Sample> samples;
  for (int i = 0; i <= count; ++i) samples.push_back(at(static_cast<double>(i) / count));
  return samples;
}

}  // namespace

class ClosedSurfaceTest : public CliTest {
protected:
  /// The case as a surface, by its file. Fails unless that is a closed, oriented manifold of the topology of the case's
  /// graph, without self-intersections, whose vertices lie on the field and whose ends are flat, with edges of one length.
  reproduce::ShapeFacts convert(const std::string& name,
                                const std::vector<std::string>& options = {}) {
    std::vector<std::string> line{"convert", name, "surface.vtp", "--json", "--quiet"};
    if (options.empty()) line.insert(line.end(), {"--edge", "0.25r"});
    line.insert(line.end(), options.begin(), options.end());
    const Outcome done = lumen(line);
    EXPECT_EQ(done.code, 0) << name << ": " << done.err;
    if (done.code != 0) return {};
    m_said = Json::parse(done.out)["surface"];
    m_source = *formats::readCaseFile(path(name));
    const auto surface = reproduce::readSurface(path("surface.vtp"));
    const reproduce::ShapeFacts shape = reproduce::measureShape(surface.mesh);
    EXPECT_TRUE(shape.isMesh && shape.closed && shape.outward) << name;
    EXPECT_EQ(shape.euler, reproduce::eulerOfTrees(m_source)) << name;
    EXPECT_EQ(shape.cgalIntersections, 0U) << name;
    EXPECT_EQ(shape.intersections, 0U) << name;
    EXPECT_GE(shape.medianAngle, 45) << name;
    EXPECT_GE(shape.leastAngle, 15) << name;
    expectOnField(name, surface);
    return shape;
  }

  /// Distances of the surface that convert() made.
  [[nodiscard]] const reproduce::FieldFacts& facts() const { return m_facts; }

  /// Fills a surface, written as text STL, by TetGen; its number of tetrahedra, 0 where it refuses.
  [[nodiscard]] int tetrahedra(const std::string& stl) const {
    const std::string command =
        "cd '" + path("").string() + "' && tetgen -pqQF " + stl + " >tetgen.log 2>&1";
    if (std::system(command.c_str()) != 0) return 0;
    int count = 0;
    std::ifstream(path(stl.substr(0, stl.rfind('.')) + ".1.ele")) >> count;
    return count;
  }

private:
  void expectOnField(const std::string& name, const reproduce::WrittenSurface& surface) {
    const field::BlendedField blended = formats::caseField(m_source);
    const convert::SeparatedField field(m_source, blended, {m_said["gap_mm"].get<double>(), 0, 0});
    m_facts = reproduce::distanceFrom(field, surface);
    EXPECT_GT(m_facts.rays, 0U) << name;
    // The answer counts vertices that lie off since models disagree; the factor is for those moved with them.
    EXPECT_LE(m_facts.verticesFar, 2 * m_said["off_field"].get<std::size_t>())
        << name << ", " << m_facts.vertex.radii << " radii at " << m_facts.vertex.place.transpose();
    const reproduce::EndFacts ends = reproduce::measureEnds(m_source, surface);
    EXPECT_EQ(ends.flat, m_said["flat_ends"].get<std::size_t>()) << name;
    EXPECT_LT(ends.tilt, 1) << name;
  }

  Json m_said;
  formats::Case m_source;
  reproduce::FieldFacts m_facts;
};

/// Tubes end half a radius beyond their last nodes: docs/method.md, section 5, Ends.
class ClosedFormTest : public ClosedSurfaceTest {
protected:
  static constexpr double kBeyond = kRadius;  // of both ends together

  void expectVolumeAndArea(const std::string& swc, double volume, double area) {
    write("shape.swc", swc);
    ASSERT_EQ(lumen({"convert", "shape.swc", "shape.lumen", "--quiet"}).code, 0);
    // Corners lie on the wall, so what edges cut off falls with their square: 0.25r alone takes 0.5 % of the volume.
    const reproduce::ShapeFacts shape = convert("shape.lumen", {"--edge", "0.15r"});
    EXPECT_NEAR(shape.volume / volume, 1, 0.005);
    EXPECT_NEAR(shape.area / area, 1, 0.005);
  }
};

/// Few triangles enclose what many do: corners lie as far outside of the wall as sides inside.
TEST_F(ClosedFormTest, ACylinderOfFewTriangles) {
  const double length = 40 + kBeyond;
  write("shape.swc", swcOf(sampled(80, [](double t) { return Sample{0, 0, 40 * t, kRadius}; })));
  ASSERT_EQ(lumen({"convert", "shape.swc", "shape.lumen", "--quiet"}).code, 0);
  const Outcome done =
      lumen({"convert", "shape.lumen", "surface.vtp", "--json", "--quiet", "--max-error", "0.03r"});
  ASSERT_EQ(done.code, 0) << done.err;
  const Json said = Json::parse(done.out)["surface"];
  const reproduce::ShapeFacts shape =
      reproduce::measureShape(reproduce::readSurface(path("surface.vtp")).mesh);
  EXPECT_TRUE(shape.isMesh && shape.closed && shape.outward);
  EXPECT_EQ(shape.intersections, 0U);
  EXPECT_NEAR(shape.volume / (pi * kRadius * kRadius * length), 1, 0.01);
  EXPECT_NEAR(said["volume_mm3"].get<double>(), shape.volume, 1e-3 * shape.volume);
  EXPECT_NEAR(said["area_mm2"].get<double>(), shape.area, 1e-3 * shape.area);
  EXPECT_LT(said["triangles"].get<int>(), 1500);
  EXPECT_LE(said["field_error"]["greatest_mm"].get<double>(), 1.2 * 0.03 * kRadius);
  EXPECT_EQ(said["field_error"]["beyond"].get<int>(), 0);
}

TEST_F(ClosedFormTest, ABudgetOfTrianglesIsKept) {
  write("shape.swc", swcOf(sampled(80, [](double t) { return Sample{0, 0, 40 * t, kRadius}; })));
  ASSERT_EQ(lumen({"convert", "shape.swc", "shape.lumen", "--quiet"}).code, 0);
  const Outcome done =
      lumen({"convert", "shape.lumen", "surface.vtp", "--json", "--quiet", "--triangles", "400"});
  ASSERT_EQ(done.code, 0) << done.err;
  const Json said = Json::parse(done.out)["surface"];
  EXPECT_LE(said["triangles"].get<int>(), 400);
  EXPECT_GE(said["triangles"].get<int>(), 392);
  EXPECT_GT(said["field_error"]["greatest_mm"].get<double>(), 0);
}

TEST_F(ClosedFormTest, ACylinder) {
  const double length = 40 + kBeyond;
  expectVolumeAndArea(swcOf(sampled(80,
                                    [](double t) {
                                      return Sample{0, 0, 40 * t, kRadius};
                                    })),
                      pi * kRadius * kRadius * length, 2 * pi * kRadius * (length + kRadius));
}

/// The volume of a tube is the area of its section times the length of its axis, as long as the axis runs through the
/// sections' centroids and bends less than their radius, and so for its area: Pappus of Alexandria, Collection, VII.
TEST_F(ClosedFormTest, AHelix) {
  const double turn = 2 * pi, across = 6, rise = 10;
  const double length = 2 * std::hypot(turn * across, rise) + kBeyond;
  expectVolumeAndArea(swcOf(sampled(140,
                                    [&](double t) {
                                      const double angle = 2 * turn * t;
                                      return Sample{across * std::cos(angle),
                                                    across * std::sin(angle), 2 * rise * t,
                                                    kRadius};
                                    })),
                      pi * kRadius * kRadius * length, 2 * pi * kRadius * (length + kRadius));
}

/// r(z) = R (1 - (1 + cos(pi z / 10)) / 4) within 10 mm of the middle, and R elsewhere. With c for the cosine the mean of
/// (3 - c)^2 / 16 is 19/32. The area is Simpson's sum of 2 pi r sqrt(1 + r'^2).
TEST_F(ClosedFormTest, AStenosis) {
  const auto radius = [](double z) {
    return std::abs(z) < 10 ? kRadius * (1 - (1 + std::cos(pi * z / 10)) / 4) : kRadius;
  };
  double area = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = -10 + 20.0 * i / kSteps, slope = kRadius * pi / 40 * std::sin(pi * z / 10);
    const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
    area += weight * 2 * pi * radius(z) * std::hypot(1, slope) * 20 / kSteps / 3;
  }
  const double rest = 20 + kBeyond;
  expectVolumeAndArea(swcOf(sampled(100,
                                    [&](double t) {
                                      const double z = 40 * t - 20;
                                      return Sample{0, 0, z, radius(z)};
                                    })),
                      pi * kRadius * kRadius * (rest + 20 * 19.0 / 32),
                      area + 2 * pi * kRadius * (rest + kRadius));
}

/// A branch of the same radius at a right angle: half of what two such cylinders have in common, 16/3 R^3 with an area of
/// 16 R^2 (Archimedes, The Method, proposition 15), is counted twice; each loses a quarter of that area.
TEST_F(ClosedFormTest, AFork) {
  const double length = 40 + kBeyond + 25 + kBeyond / 2;
  expectVolumeAndArea(
      swcOf(sampled(80,
                    [](double t) {
                      return Sample{0, 0, 40 * t - 20, kRadius};
                    }),
            sampled(49,
                    [](double t) {
                      return Sample{0, 0.5 + 24.5 * t, 0, kRadius};
                    })),
      pi * kRadius * kRadius * length - 8.0 / 3 * std::pow(kRadius, 3),
      2 * pi * kRadius * length - 8 * kRadius * kRadius + 3 * pi * kRadius * kRadius);
}

/// A loop that a link closes: Pappus again. Its genus is 1.
TEST_F(ClosedFormTest, ATorus) {
  constexpr double kAcross = 8;
  write("shape.swc", swcOf(sampled(95, [](double t) {
          const double angle = 2 * pi * t * 95 / 96;
          return Sample{kAcross * std::cos(angle), kAcross * std::sin(angle), 0, kRadius};
        })));
  ASSERT_EQ(lumen({"convert", "shape.swc", "open.lumen", "--quiet"}).code, 0);
  formats::Case ring = *formats::readCaseFile(path("open.lumen"));
  ring.tree.links.push_back({0, static_cast<std::uint32_t>(ring.tree.nodeCount() - 1)});
  ring.models.reset();
  ASSERT_TRUE(formats::writeCaseFile(ring, path("linked.lumen")));
  // as for a centerline, docs/method.md, section 2.10
  ASSERT_EQ(
      lumen({"fit", "linked.lumen", "torus.lumen", "--iso-level", "0.15", "--accuracy", "0.0075",
             "--max-distance", "30", "--min-width", "0.03", "--cohesion-weight", "0", "--quiet"})
          .code,
      0);
  const reproduce::ShapeFacts shape = convert("torus.lumen", {"--edge", "0.15r"});
  EXPECT_EQ(shape.euler, std::vector<std::ptrdiff_t>{0});
  EXPECT_NEAR(shape.volume / (2 * pi * pi * kAcross * kRadius * kRadius), 1, 0.005);
  EXPECT_NEAR(shape.area / (4 * pi * pi * kAcross * kRadius), 1, 0.005);
}

/// From voxels to a surface, as a user would.
class PhantomSurfaceTest : public ClosedSurfaceTest,
                           public ::testing::WithParamInterface<const char*> {};

TEST_P(PhantomSurfaceTest, IsClosedAndOnItsField) {
  const std::string name = GetParam();
  ASSERT_EQ(lumen({"phantom", name, "x.nrrd", "--seeds", "s.json", "--quiet"}).code, 0);
  ASSERT_EQ(
      lumen({"convert", "x.nrrd", "case.lumen", "--seeds", "s.json", "--seeds-only", "--quiet"})
          .code,
      0);
  convert("case.lumen");
  EXPECT_EQ(facts().verticesFar, 0U)
      << facts().vertex.radii << " radii at " << facts().vertex.place.transpose();
  // In the creases of forks, too, nothing is farther off than an edge is long.
  EXPECT_LT(facts().middle.radii, 0.25) << facts().middle.place.transpose();
  EXPECT_LT(facts().field.radii, 0.25) << facts().field.place.transpose();
}

TEST_P(PhantomSurfaceTest, IsClosedWithFewTriangles) {
  const std::string name = GetParam();
  ASSERT_EQ(lumen({"phantom", name, "x.nrrd", "--seeds", "s.json", "--quiet"}).code, 0);
  ASSERT_EQ(
      lumen({"convert", "x.nrrd", "case.lumen", "--seeds", "s.json", "--seeds-only", "--quiet"})
          .code,
      0);
  const Outcome done = lumen({"convert", "case.lumen", "surface.vtp", "--json", "--quiet"});
  ASSERT_EQ(done.code, 0) << done.err;
  const reproduce::ShapeFacts shape =
      reproduce::measureShape(reproduce::readSurface(path("surface.vtp")).mesh);
  EXPECT_TRUE(shape.isMesh && shape.closed && shape.outward);
  EXPECT_EQ(shape.euler, reproduce::eulerOfTrees(*formats::readCaseFile(path("case.lumen"))));
  EXPECT_EQ(shape.cgalIntersections, 0U);
  const Json said = Json::parse(done.out)["surface"];
  EXPECT_LT(said["field_error"]["beyond"].get<double>(),
            0.05 * said["field_error"]["places"].get<double>());
}

/// Vessels that are found have twice as many nodes. Their surface is closed, and no vertex is farther
/// off the field than the answer states.
TEST_P(PhantomSurfaceTest, IsClosedWhereSeedsAreHints) {
  const std::string name = GetParam();
  ASSERT_EQ(lumen({"phantom", name, "x.nrrd", "--seeds", "s.json", "--quiet"}).code, 0);
  ASSERT_EQ(lumen({"convert", "x.nrrd", "case.lumen", "--seeds", "s.json", "--quiet"}).code, 0);
  convert("case.lumen");
}

std::string withoutHyphens(const ::testing::TestParamInfo<const char*>& kind) {
  std::string name = kind.param;
  std::erase(name, '-');
  return name;
}

/// One with a fork, one with vessels that touch, one with a sac; all others by night.
INSTANTIATE_TEST_SUITE_P(Each, PhantomSurfaceTest,
                         ::testing::Values("bifurcation", "kissing", "sac-lobes"), withoutHyphens);
INSTANTIATE_TEST_SUITE_P(Others, PhantomSurfaceTest,
                         ::testing::Values("tube", "helix", "aneurysm", "stenosis", "dropout",
                                           "companion", "hairpin", "right-angle", "fading",
                                           "thick-slices"),
                         withoutHyphens);

class TetgenTest : public ClosedSurfaceTest {
protected:
  void SetUp() override {
    if (std::system("command -v tetgen >/dev/null") != 0) GTEST_SKIP() << "tetgen is not installed";
  }
  void expectFilled(const std::string& name) {
    convert(name);
    ASSERT_EQ(
        lumen({"convert", name, "surface.stl", "--edge", "0.25r", "--stl-solids", "--quiet"}).code,
        0);
    EXPECT_GT(tetrahedra("surface.stl"), 1000) << name << ": " << read("tetgen.log");
  }
};

TEST_F(TetgenTest, MeshesTheInsideOfAFork) {
  ASSERT_EQ(
      lumen({"phantom", "bifurcation", "x.nrrd", "--size", "64", "--seeds", "s.json", "--quiet"})
          .code,
      0);
  ASSERT_EQ(lumen({"convert", "x.nrrd", "fork.lumen", "--seeds", "s.json", "--quiet"}).code, 0);
  expectFilled("fork.lumen");
}

TEST_F(TetgenTest, MeshesTheInsideOfRealVessels) {
  const std::filesystem::path data = LUMEN_SHARED_DATA;
  for (const auto& [volume, clicks] : std::vector<std::array<std::string, 2>>{
           {"aorta/aorta.mha", "aorta.seeds.json"}, {"avf/avf.nii", "avf.seeds.json"}}) {
    if (!std::filesystem::exists(data / volume)) GTEST_SKIP() << "there is no " << data / volume;
    ASSERT_EQ(lumen({"convert", (data / volume).string(), "real.lumen", "--seeds",
                     std::string(LUMEN_TEST_DATA) + "/" + clicks, "--seeds-only", "--quiet"})
                  .code,
              0);
    expectFilled("real.lumen");
  }
}

}  // namespace lumen::test
