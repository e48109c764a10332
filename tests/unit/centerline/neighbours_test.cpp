// SPDX-License-Identifier: Apache-2.0
// Networks and centerlines of neighbouring programs: files that they wrote (tests/data/neighbours), and bytes
// as their writers make them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/centerline/network.h"
#include "line_files.h"

namespace lumen::convert {
namespace {

namespace fs = std::filesystem;

fs::path sample(const std::string& name) {
  return fs::path(LUMEN_TEST_DATA) / "neighbours" / name;
}

/// The radius of the point nearest to a place.
double radiusAt(const CenterlineFile& file, const Eigen::Vector3d& place) {
  const auto nearest =
      std::min_element(file.points.begin(), file.points.end(), [&](const auto& a, const auto& b) {
        return (a.position - place).norm() < (b.position - place).norm();
      });
  return nearest->radius;
}

bool hasRemark(const CenterlineFile& file, const std::string& words) {
  return std::any_of(file.remarks.begin(), file.remarks.end(),
                     [&](const std::string& remark) { return remark.find(words) != remark.npos; });
}

template <class Read>
std::string refusedBy(Read read) {
  try {
    (void)read();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// The fork of tests/data/neighbours.
void expectFork(const CenterlineFile& file, double radius = 2) {
  EXPECT_EQ(centerlineChains(file).size(), 2U);
  ASSERT_EQ(test::rootsOf(file).size(), 1U);
  EXPECT_NEAR(test::lengthOf(file), 60, 1e-4);
  EXPECT_NEAR(measureExtent(file).most, radius, 1e-6);
}

TEST(MorphioSwc, EachDialectIsTheTreeThatItIs) {
  struct Expected {
    const char* name;
    std::size_t roots, chains;
    double length;
  };
  for (const Expected& expected :
       {Expected{"simple", 1, 4, 31},
        {"simple-windows-eol", 1, 4, 31},
        {"reversed_NRN_neurite_order", 1, 3, 3 + std::sqrt(3.0) + std::sqrt(5.0) + std::sqrt(27.0)},
        {"simple-all-types", 1, 15, 150},
        {"disconnected_neurite", 2, 5, 31},
        {"multiple_soma", 1, 4, 31},
        {"soma_three_points_cylinder", 1, 1, 0}}) {
    const CenterlineFile file = readSwc(sample(std::string("morphio-") + expected.name + ".swc"));
    EXPECT_EQ(test::rootsOf(file).size(), expected.roots) << expected.name;
    EXPECT_EQ(centerlineChains(file).size(), expected.chains) << expected.name;
    EXPECT_NEAR(test::lengthOf(file), expected.length, 1e-4) << expected.name;
  }
}

TEST(Graphml, OfNetworkxWithItsUnit) {
  CenterlineFile file = readGraphml(sample("networkx.graphml"));
  expectFork(file);
  EXPECT_EQ(file.unit, 1e-3);
  EXPECT_EQ(toPatientSpace(file, {}).unitFrom, "file");
}

TEST(Graphml, APlaceMayBeOneTextAndADiameterCounts) {
  expectFork(readGraphml(sample("networkx-pos.graphml")));
}

TEST(Graphml, OfVesselVioIsInVoxelsWhoseSizeItsLengthsState) {
  const CenterlineFile file = readGraphml(sample("igraph-vesselvio.graphml"));
  expectFork(file);
  EXPECT_TRUE(hasRemark(file, "places are voxels of 0.5 x 0.5 x 2;"));
  EXPECT_TRUE(hasRemark(file, "are straight, with 90.9 % of their stated length"));
  // arms have their own radii, and the fork that of the trunk
  EXPECT_NEAR(radiusAt(file, {3.6, 4.8, 28}), 1.5, 1e-6);
  EXPECT_NEAR(radiusAt(file, {-3.6, -4.8, 28}), 1.2, 1e-6);
  EXPECT_NEAR(radiusAt(file, {0, 0, 20}), 2, 1e-6);
}

TEST(Graphml, ADefaultCountsWhereANodeHasNoValue) {
  const std::string head =
      "<graphml><key id=\"r\" for=\"node\" attr.name=\"radius\"><default>3</default></key>";
  const std::string nodes =
      "<graph><node id=\"a\"><data key=\"x\">0</data><data key=\"y\">0</data><data "
      "key=\"z\">0</data>"
      "</node><node id=\"b\"><data key=\"x\">0</data><data key=\"y\">0</data><data "
      "key=\"z\">9</data>"
      "<data key=\"r\">2</data></node>";
  const std::string keys =
      "<key id=\"x\" for=\"node\" attr.name=\"x\"/><key id=\"y\" for=\"node\" attr.name=\"y\"/>"
      "<key id=\"z\" for=\"node\" attr.name=\"z\"/>";
  const std::string tail = "<edge source=\"a\" target=\"b\"/></graph></graphml>";
  const CenterlineFile file = parseGraphml(head + keys + nodes + tail, "a.graphml");
  EXPECT_EQ(radiusAt(file, {0, 0, 0}), 3);
  EXPECT_EQ(radiusAt(file, {0, 0, 9}), 2);
  EXPECT_EQ(refusedBy([&] {
              return parseGraphml(
                  head + keys + nodes + "\n<edge source=\"a\" target=\"c\"/></graph></graphml>",
                  "a.graphml");
            }),
            "a.graphml: line 2: target is \"c\"; expected the id of a node of a.graphml");
  EXPECT_EQ(refusedBy([&] { return parseGraphml("<graphml></graphml>", "a.graphml"); }),
            "a.graphml: has no <graph>; expected GraphML");
}

TEST(GraphTables, OfVoreenByEitherNameOrByTheirFolder) {
  for (const char* const name : {"voreen_nodes.csv", "voreen_edges.csv"})
    expectFork(readGraphCsv(sample(name)));
  const fs::path folder = fs::path(testing::TempDir()) / "lumen-graph-tables";
  fs::create_directories(folder);
  for (const char* const name : {"voreen_nodes.csv", "voreen_edges.csv"})
    fs::copy_file(sample(name), folder / name, fs::copy_options::overwrite_existing);
  EXPECT_TRUE(hasGraphTables(folder));
  expectFork(readGraphCsv(folder));
  fs::remove(folder / "voreen_edges.csv");
  EXPECT_FALSE(hasGraphTables(folder));
  EXPECT_NE(refusedBy([&] { return readGraphCsv(folder / "voreen_nodes.csv"); })
                .find("has the nodes of a network, but its edges are not beside it; expected two "
                      "tables of one network"),
            std::string::npos);
  fs::remove_all(folder);
}

TEST(GraphTables, OfSkanHaveNoRadiiAndTheAxesOfAnArray) {
  const CenterlineFile file = readGraphCsv(sample("skan.csv"));
  EXPECT_NEAR(test::lengthOf(file), 45, 1e-9);
  EXPECT_TRUE(hasRemark(file, "has no radii"));
  EXPECT_TRUE(hasRemark(file, "are taken as z, y and x"));
  // the path along the first axis of the array, from 2 to 21 in steps of 2
  EXPECT_NEAR(measureExtent(file).diagonal, std::hypot(38, 7), 1e-9);
}

TEST(GraphTables, ANarrowEdgeBetweenWideNodesIsNarrow) {
  const NetworkTable nodes{"n.csv",
                           {"x (um)", "y", "z"},
                           {{2, {"0", "0", "0"}},
                            {3, {"0", "0", "20"}},
                            {4, {"0", "30", "20"}},
                            {5, {"0", "30", "40"}}}};
  const NetworkTable edges{"e.csv",
                           {"Source", "Target", "Radius"},
                           {{2, {"0", "1", "4"}}, {3, {"1", "2.0", "1"}}, {4, {"2", "3", "3"}}}};
  const CenterlineFile file = treeOfTables(nodes, edges);
  EXPECT_EQ(file.unit, 1e-3);
  EXPECT_EQ(radiusAt(file, {0, 4, 20}), 1);  // a radius of the wide node away from it
  EXPECT_EQ(radiusAt(file, {0, 27, 20}), 1);
  EXPECT_EQ(radiusAt(file, {0, 0, 20}), 4);
  NetworkTable wrong = edges;
  wrong.rows[1].cells[2] = "wide";
  EXPECT_EQ(refusedBy([&] { return treeOfTables(nodes, wrong); }),
            "e.csv: line 3: Radius is \"wide\"; expected a number from -1e9 to 1e9");
  wrong.columns = {"a", "b", "c"};
  EXPECT_EQ(
      refusedBy([&] { return treeOfTables(nodes, wrong); }),
      "e.csv: has the columns \"a, b, c\"; expected source and target (or node1id and node2id) "
      "of edges");
}

TEST(NetworkVoxels, AreThoseOfTheLengthsOrNone) {
  Network network;
  for (int n = 0; n <= 24; ++n)  // a course that turns and climbs
    network.nodes.push_back({{30 * std::cos(0.9 * n), 40 * std::sin(1.3 * n), 7.0 * n * n}, 1});
  const Eigen::Vector3d voxel(0.9, 0.9, 2);
  const auto withChords = [&](const Eigen::Vector3d& factors, double noise) {
    network.edges.clear();
    for (std::int32_t n = 0; n < 24; ++n) {
      const Eigen::Vector3d span =
          network.nodes[std::size_t(n) + 1].position - network.nodes[std::size_t(n)].position;
      network.edges.push_back(
          {n, n + 1, 1, span.cwiseProduct(factors).norm() * (1 + noise * std::sin(5.0 * n)), {}});
    }
    return voxelsOfNetwork(network);
  };
  const auto found = withChords(voxel, 0.02);
  ASSERT_TRUE(found.has_value());
  EXPECT_LT((*found - voxel).cwiseQuotient(voxel).cwiseAbs().maxCoeff(), 0.05);
  EXPECT_LT((*withChords({0.65, 0.65, 0.65}, 0) - Eigen::Vector3d::Constant(0.65)).norm(), 1e-6);
  EXPECT_FALSE(withChords({1, 1, 1}, 0));
  EXPECT_FALSE(withChords({1, 1, 1}, 0.08));  // lengths of smoothed courses
  EXPECT_FALSE(withChords({1, 1, 1}, 0.9));   // lengths of something else
}

TEST(Tre, OfItkIsPlacedByItsTransforms) {
  for (const char* const name : {"itk.tre", "itk-binary.tre"}) {
    const CenterlineFile file = readTre(sample(name));
    EXPECT_EQ(test::rootsOf(file), (std::vector<Eigen::Vector3d>{{10, 20, 30}})) << name;
    EXPECT_EQ(centerlineChains(file).size(), 2U);
    // (0, 16, 14) of the child, turned and moved
    EXPECT_NEAR(radiusAt(file, {-6, 20, 44}), 0.9, 1e-6);
  }
}

/// As itktubeTubeXIO.hxx of ITKTubeTK writes it.
const std::string kTubeX =
    "NDims: 3\nDimensions: 128 128 64\nVoxelSize: 0.5 0.5 1\nNObjects: 2\nEnd Header:\n\nID: "
    "1\nType: Tube\n"
    "Anat: artery\nTreeType: root\nColor: 1 0 0\nPointDim: 4 x y z r\nNPoints: 3\nPoints:\n0 0 0 "
    "2\n0 0 10 2\n"
    "0 0 20 2\n\nID: 2\nType: Tube\nTreeType: child\nVParent: 1\nAttachpt: 1\nColor: 1 0 0\n"
    "PointDim: 4 x y z r\nNPoints: 2\nPoints:\n0 0 10 1\n0 32 14 0.9\n\n";

TEST(Tre, OfTubeXIsInVoxelsOfItsHeader) {
  const CenterlineFile file = parseTre(kTubeX, "a.tre");
  EXPECT_EQ(centerlineChains(file).size(), 2U);
  EXPECT_EQ(file.points[1].parent, 0);
  EXPECT_EQ(radiusAt(file, {0, 16, 14}), 0.9);  // 32 voxels of 0.5
  EXPECT_EQ(file.unit, 1);
  std::string bad = kTubeX;
  bad.replace(bad.find("VParent: 1"), 10, "VParent: x");
  EXPECT_EQ(refusedBy([&] { return parseTre(bad, "a.tre"); }),
            "a.tre: line 22 has \"x\"; expected a whole number");
}

/// As VessMorphoVis' addons/swc2vmv/swc2vmv.py writes them; strands of a fork.
const std::string kVmv =
    "$PARAM_BEGIN\nNUM_VERTS\t5\nNUM_STRANDS\t3\nNUM_ATTRIB_PER_VERT\t4\n$PARAM_END\n\n$VERT_LIST_"
    "BEGIN\n"
    "1\t0.00\t0.00\t0.00\t2.00\n2\t0.00\t0.00\t10.00\t2.00\n3\t0.00\t0.00\t20.00\t2.00\n"
    "4\t0.00\t12.00\t36.00\t1.50\n5\t0.00\t-12.00\t36.00\t1.20\n$VERT_LIST_END\n\n$STRANDS_LIST_"
    "BEGIN\n"
    "1 3 2 1 \n2 3 4 \n3 5 3 \n$STRANDS_LIST_END\n\n";

TEST(Vmv, StrandsHaveNoDirection) {
  expectFork(parseVmv(kVmv, "a.vmv"));
  std::string bad = kVmv;
  bad.replace(bad.find("2 3 4 \n"), 7, "2 3 9 \n");
  EXPECT_EQ(refusedBy([&] { return parseVmv(bad, "a.vmv"); }),
            "a.vmv: line 17: has the vertex 9 in a strand, which $VERT_LIST_BEGIN does not list");
}

}  // namespace
}  // namespace lumen::convert
