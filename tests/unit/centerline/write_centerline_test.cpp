// SPDX-License-Identifier: Apache-2.0
// A written centerline reads back as the same tree, for any order of its nodes.
#include "converters/io/centerline/write_centerline.h"

#include <cmath>
#include <fstream>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "converters/io/centerline/case_of_centerline.h"
#include "converters/io/centerline/centerline_readers.h"
#include "converters/io/vtk/vtk_xml.h"

namespace lumen::convert {
namespace {

using formats::CenterlineTree;

void addBranch(CenterlineTree& tree, const char* label, std::int32_t parent, formats::Vec3f from,
               formats::Vec3f step, int count, float radius) {
  const auto first = static_cast<std::uint32_t>(tree.nodeCount());
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<float>(i);
    tree.centre.push_back({from.x + k * step.x, from.y + k * step.y, from.z + k * step.z});
    tree.direction.push_back(step);
    tree.radius.push_back(radius + 0.01F * k);
    tree.height.push_back(1);
    tree.parent.push_back(i == 0 ? parent : static_cast<std::int32_t>(tree.nodeCount()) - 2);
    tree.branch.push_back(static_cast<std::uint32_t>(tree.branches.size()));
  }
  formats::Branch branch;
  branch.label = label;
  branch.parentNode = parent;
  branch.firstNode = first;
  branch.nodeCount = static_cast<std::uint32_t>(count);
  tree.branches.push_back(branch);
}

/// A trunk along z; a child that is wider than what goes on; a child of that; and a tree apart.
CenterlineTree exampleTree() {
  CenterlineTree tree;
  addBranch(tree, "ICA", formats::kNoParent, {0, 0, 0}, {0, 0, 1}, 12, 1.25F);
  addBranch(tree, "MCA left", 5, {0.75F, 0, 5.1F}, {1, 0, 0}, 8, 1.5F);
  addBranch(tree, "ACA", 16, {4.75F, 0.8F, 5.1F}, {0, 0.8F, 0}, 6, 0.7F);
  addBranch(tree, "apart", formats::kNoParent, {50, 0, 0}, {0, 0, 1}, 3, 1.1F);
  return tree;
}

using Node = std::tuple<float, float, float, float, float, float, float>;

/// Each node's place and radius, and the place of its parent.
std::multiset<Node> nodesOf(const CenterlineTree& tree) {
  std::multiset<Node> nodes;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const formats::Vec3f& c = tree.centre[n];
    const formats::Vec3f p =
        tree.parent[n] < 0 ? formats::Vec3f{-1, -1, -1} : tree.centre[std::size_t(tree.parent[n])];
    nodes.insert({c.x, c.y, c.z, tree.radius[n], p.x, p.y, p.z});
  }
  return nodes;
}

std::multiset<std::pair<std::string, std::uint32_t>> branchesOf(const CenterlineTree& tree,
                                                                bool named) {
  std::multiset<std::pair<std::string, std::uint32_t>> branches;
  for (const formats::Branch& branch : tree.branches)
    branches.insert({named ? branch.label : "", branch.nodeCount});
  return branches;
}

void expectSame(CenterlineFile file, bool named) {
  EXPECT_EQ(toPatientSpace(file, {}).unit, 1);
  EXPECT_TRUE(file.remarks.empty());
  const CenterlineTree tree = exampleTree(), back = caseOfCenterline(file, "x").tree;
  EXPECT_EQ(nodesOf(back), nodesOf(tree));
  EXPECT_EQ(branchesOf(back, named), branchesOf(tree, named));
}

TEST(WriteCenterline, SwcReadsBackAsTheSameTree) {
  expectSame(parseSwc(encodeSwc(exampleTree()), "x.swc"), true);
}

TEST(WriteCenterline, TubesReadBackAsTheSameTree) {
  expectSame(parseTre(encodeTre(exampleTree()), "x.tre"), true);
}

TEST(WriteCenterline, LinesOfVtkReadBackAsTheSameTree) {
  expectSame(parseVtpCenterline(encodeVtpCenterline(exampleTree()), "x.vtp"), false);
}

TEST(WriteCenterline, SlicersCurvesReadBackAsTheSameTree) {
  const auto file = std::filesystem::path(testing::TempDir()) / "write_centerline_test.mrk.json";
  std::ofstream(file) << encodeCurves(exampleTree());
  const CenterlineFile curves = readCurves(file);
  std::filesystem::remove(file);
  expectSame(curves, true);
}

TEST(WriteCenterline, TypesOfSwcSayForksAndEnds) {
  const CenterlineFile file = parseSwc(encodeSwc(exampleTree()), "x.swc");
  EXPECT_EQ(file.points[5].type, 5);
  EXPECT_EQ(file.points[11].type, 6);
  EXPECT_EQ(file.points[3].type, 0);
}

TEST(WriteCenterline, LinesHaveTheArraysOfVmtk) {
  const std::string text = encodeVtpCenterline(exampleTree());
  const std::array<std::string_view, 6> names = {"MaximumInscribedSphereRadius",
                                                 "CenterlineIds",
                                                 "TractIds",
                                                 "GroupIds",
                                                 "Blanking",
                                                 "Branch"};
  const VtkPolyData data = parseVtkXml(text, "x.vtp", names);
  ASSERT_EQ(data.cellData.size(), 4U);
  // four tips, each with its own way from a root
  std::set<double> centerlines(data.cellArray("CenterlineIds")->values.begin(),
                               data.cellArray("CenterlineIds")->values.end());
  EXPECT_EQ(centerlines.size(), 4U);
  const auto& group = data.cellArray("GroupIds")->values;
  const auto& blanking = data.cellArray("Blanking")->values;
  std::set<std::pair<double, double>> groups;
  for (std::size_t cell = 0; cell < group.size(); ++cell)
    groups.insert({group[cell], blanking[cell]});
  // trunk before and behind the fork, child before and behind its own, grandchild, the tree apart;
  // and two blanked ones
  EXPECT_EQ(groups.size(), 8U);
  EXPECT_EQ(
      std::count_if(groups.begin(), groups.end(), [](const auto& g) { return g.second == 1; }), 2);
  // consecutive tracts of a way meet
  const auto& centerline = data.cellArray("CenterlineIds")->values;
  for (std::size_t cell = 1; cell < data.lines.size(); ++cell)
    if (centerline[cell] == centerline[cell - 1]) {
      EXPECT_EQ(data.lines.point[data.lines.begin(cell)],
                data.lines.point[data.lines.end[cell - 1] - 1]);
    }
}

TEST(WriteNetwork, HoldsPlacesRadiiAndLinksWithUnitAndAxes) {
  CenterlineTree tree = exampleTree();
  tree.links = {{11, 25}};  // from the trunk's tip to that of the second child
  std::multiset<std::tuple<float, float, float, float>> expected;
  double length = 0;
  for (std::size_t n = 0; n < tree.nodeCount(); ++n) {
    const formats::Vec3f& c = tree.centre[n];
    expected.insert({c.x, c.y, c.z, tree.radius[n]});
    if (tree.parent[n] < 0) continue;
    const formats::Vec3f& p = tree.centre[std::size_t(tree.parent[n])];
    length += std::hypot(c.x - p.x, c.y - p.y, c.z - p.z);
  }
  for (const CenterlineFile& file :
       {parseVmv(encodeVmv(tree), "a.vmv"), parseGraphml(encodeGraphml(tree), "a.graphml"),
        parseSpatialGraph(encodeSpatialGraph(tree), "a.am")}) {
    std::multiset<std::tuple<float, float, float, float>> found;
    for (const CenterlinePoint& point : file.points) {
      const Eigen::Vector3f p = point.position.cast<float>();
      found.insert({p.x(), p.y(), p.z(), static_cast<float>(point.radius)});
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(file.unit, 1);
    EXPECT_EQ(file.axes, CenterlineAxes::Lps);
    EXPECT_EQ(file.links.size(), 1U);
    const formats::Vec3f& a = tree.centre[11];
    const formats::Vec3f& b = tree.centre[25];
    double total = measureExtent(file).length;
    for (const auto& [from, to] : file.links)
      total +=
          (file.points[std::size_t(from)].position - file.points[std::size_t(to)].position).norm();
    EXPECT_NEAR(total, length + std::hypot(a.x - b.x, a.y - b.y, a.z - b.z), 1e-4);
  }
}

}  // namespace
}  // namespace lumen::convert
