// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "converters/export/shared/frame.h"
#include "converters/export/shared/paths.h"
#include "converters/export/shared/text_files.h"

namespace lumen::convert {

TEST(ExportText, ReplacesEachPlaceholderByItsValue) {
  EXPECT_EQ(filled("{a} and {b}, {a}", {{"a", "1"}, {"b", "{c}"}}), "1 and {c}, 1");
}

TEST(ExportText, LeavesOtherBracesAsTheyAre) {
  const char* const text = "{ a; } {} {A} {1} {a1} {a\n} {";
  EXPECT_EQ(filled(text, {}), text);
}

TEST(ExportText, DropsTheLineOfAPlaceholderWhoseValueIsLinesOrNothing) {
  EXPECT_EQ(filled("x\n{a}\ny\n", {{"a", ""}}), "x\ny\n");
  EXPECT_EQ(filled("{a}\ny\n", {{"a", "1\n2\n"}}), "1\n2\ny\n");
  EXPECT_EQ(filled("{a}\ny\n", {{"a", "1"}}), "1\ny\n");
  EXPECT_EQ(filled("x {a}\ny\n", {{"a", ""}}), "x \ny\n");
}

TEST(ExportText, RefusesAPlaceholderWithoutAValueAndAValueWithoutAPlaceholder) {
  EXPECT_THROW(filled("{a}", {}), std::logic_error);
  EXPECT_THROW(filled("{a}", {{"a", "1"}, {"b", "2"}}), std::logic_error);
  EXPECT_THROW(exportText("sofa/README.md"), std::logic_error);
  EXPECT_THROW(exportText("sofa/no such text"), std::logic_error);
}

TEST(ExportText, IsTheFileBesideItsTarget) {
  EXPECT_EQ(exportText("openfoam/turbulenceProperties").substr(0, 8), "FoamFile");
}

TEST(MarkdownText, LeavesOrdinaryTextAsItIs) {
  for (const char* const text :
       {"ICA_L", "outlet-ICA_L.2", "A guidewire at (1, 2.5) mm: 3 steps (kg / mm^3).", "Größe"})
    EXPECT_EQ(markdownText(text), text);
}

TEST(MarkdownText, HasNoLinkAndNoPicture) {
  EXPECT_EQ(markdownText("![a](http://b)"), "\\!\\[a\\](http\\://b)");
  EXPECT_EQ(markdownText("<img>"), "\\<img\\>");
  EXPECT_EQ(markdownText("www.b.c"), "www\\.b.c");
}

TEST(MarkdownText, HasNoEmphasisCodeAndCells) {
  EXPECT_EQ(markdownText("_a_ *b* `c` | ~~d~~"), "\\_a\\_ \\*b\\* \\`c\\` \\| \\~\\~d\\~\\~");
  EXPECT_EQ(markdownText("&lt;"), "\\&lt;");
}

TEST(MarkdownText, BeginsNoHeadingAndNoList) {
  EXPECT_EQ(markdownText("# a"), "\\# a");
  EXPECT_EQ(markdownText("- a"), "\\- a");
  EXPECT_EQ(markdownText("12. a"), "12\\. a");
}

TEST(MarkdownText, IsOneLine) {
  EXPECT_EQ(markdownText("a\nb").find('\n'), std::string::npos);
}

TEST(Paths, HaveNamesOfFilesThatNoProgramTakesForOptions) {
  EXPECT_EQ(fileWord("-rf"), "_rf");
  EXPECT_EQ(fileWord("--Edge"), "_-edge");
  EXPECT_EQ(fileWord("ICA-L"), "ica-l");
}

namespace {

const Eigen::Vector3d kPlace(10, 20, 30);  // left, posterior, superior

}  // namespace

TEST(ExportFrame, KeepsMillimetresAndLpsWithoutAChoice) {
  EXPECT_EQ(ExportFrame{}.position(kPlace), kPlace);
}

TEST(ExportFrame, TurnsToTheAxesThatItNames) {
  const ExportFrame ras{LengthUnit::Millimetre, Axes::Ras}, lsa{LengthUnit::Metre, Axes::Lsa};
  EXPECT_EQ(ras.position(kPlace), Eigen::Vector3d(-10, -20, 30));
  EXPECT_TRUE(lsa.position(kPlace).isApprox(Eigen::Vector3d(0.010, 0.030, -0.020)));
  EXPECT_EQ(lsa.direction(Eigen::Vector3d::UnitZ()), Eigen::Vector3d::UnitY());
  EXPECT_DOUBLE_EQ((ExportFrame{LengthUnit::Centimetre, Axes::Lps}.length(25)), 2.5);
}

TEST(ExportFrame, MirrorsNothing) {
  for (const Axes axes : {Axes::Lps, Axes::Ras, Axes::Lsa})
    EXPECT_NEAR((ExportFrame{LengthUnit::Metre, axes}.rotation().determinant()), 1, 1e-15);
}

TEST(ExportFrame, ItsMatrixIsWhatItDoesToAPosition) {
  const ExportFrame frame{LengthUnit::Metre, Axes::Lsa};
  const Eigen::Vector4d moved = frame.matrix() * kPlace.homogeneous();
  EXPECT_TRUE(moved.head<3>().isApprox(frame.position(kPlace)));
}

TEST(ExportFrame, TakesASurfaceWithItsRadiiAndNormals) {
  SurfaceMesh mesh;
  mesh.position = {{10, 20, 30}};
  mesh.normal = {{0, 0, 1}};
  mesh.radius = {2};
  mesh.triangle = {{0, 1, 2}};
  const SurfaceMesh moved = ExportFrame{LengthUnit::Centimetre, Axes::Lsa}.of(mesh);
  EXPECT_EQ(moved.position[0], (Float3{1, 3, -2}));
  EXPECT_EQ(moved.normal[0], (Float3{0, 1, 0}));
  EXPECT_FLOAT_EQ(moved.radius[0], 0.2F);
  const SurfaceMesh over = turnedOver(mesh);
  EXPECT_EQ(over.normal[0][2], -1);
  EXPECT_EQ(over.triangle[0], (Triangle{0, 2, 1}));
}

}  // namespace lumen::convert
