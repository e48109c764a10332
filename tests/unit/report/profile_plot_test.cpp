// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/profile_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/base/number_text.h"
#include "converters/draw/report/report_page.h"

namespace lumen::convert {
namespace {

/// The places of the path with this class, or all that are in `svg`.
std::vector<std::pair<int, int>> placesOf(const std::string& svg, const std::string& type) {
  std::smatch path;
  const std::regex wanted("class=\"" + type + "\" d=\"([^\"]*)\"");
  std::vector<std::pair<int, int>> places;
  if (!std::regex_search(svg, path, wanted)) return places;
  const std::string d = path[1];
  const std::regex place("([0-9]+) ([0-9]+)");
  for (auto it = std::sregex_iterator(d.begin(), d.end(), place); it != std::sregex_iterator();
       ++it)
    places.emplace_back(std::stoi((*it)[1]), std::stoi((*it)[2]));
  return places;
}

TreeProfile threeNodes() {
  TreeProfile profile;
  profile.along = {0, 5, 10};
  profile.radius = {1, 3, 1};
  return profile;
}

TEST(ProfilePlot, TheCurveIsScaledToItsAxes) {
  const auto places = placesOf(profilePlot(threeNodes(), {}).html, "radius");
  ASSERT_EQ(places.size(), 3U);
  EXPECT_EQ(places[1].first - places[0].first, places[2].first - places[1].first);
  EXPECT_EQ(places[0].second, places[2].second);
  EXPECT_LT(places[1].second, places[0].second) << "larger is higher";
  EXPECT_GT(places[1].second, 0);
}

TEST(ProfilePlot, ConfidenceIsThereIfItIsKnown) {
  TreeProfile profile = threeNodes();
  EXPECT_EQ(profilePlot(profile, {}).html.find("confidence"), std::string::npos);
  profile.confidence = {0, 1, 0.5F};
  const auto places = placesOf(profilePlot(profile, {}).html, "confidence");
  ASSERT_EQ(places.size(), 5U);
  EXPECT_EQ(places[1].second, places[0].second) << "0 is on the axis";
  EXPECT_EQ(2 * places[3].second, places[1].second + places[2].second) << "0.5 is halfway";
}

TEST(ProfilePlot, NeighboursThatAgreeAlikeShareAPiece) {
  const std::vector<Agreement> agreement = {Agreement::Good, Agreement::Good, Agreement::Poor};
  const std::string svg = profilePlot(threeNodes(), agreement).html;
  EXPECT_NE(svg.find("<rect class=\"good\""), svg.npos);
  EXPECT_NE(svg.find("<rect class=\"poor\""), svg.npos);
  EXPECT_EQ(std::count(svg.begin(), svg.end(), '<'), std::count(svg.begin(), svg.end(), '>'));
  EXPECT_EQ(svg.find("<rect", svg.find("<rect", svg.find("<rect") + 1) + 1), svg.npos);
}

TEST(ProfilePlot, OneNodeIsADot) {
  TreeProfile profile;
  profile.along = {0};
  profile.radius = {2};
  EXPECT_NE(profilePlot(profile, {}).html.find("<circle"), std::string::npos);
}

TEST(ProfilePlot, AxesNameTheirUnits) {
  const std::string svg = profilePlot(threeNodes(), {}).html;
  EXPECT_NE(svg.find(">radius, mm<"), svg.npos);
  EXPECT_NE(svg.find(">along the vessel, mm<"), svg.npos);
}

std::string marksOf(const Axis& axis) {
  std::string text;
  for (const double mark : axis.marks)
    text.append(text.empty() ? "" : " ").append(fixedText(mark, axis.digits));
  return text;
}

TEST(Axis, MarksAreRoundAndReachNoFartherThanTheEnd) {
  EXPECT_EQ(marksOf(axisTo(469.5, 5)), "0 100 200 300 400");
  EXPECT_EQ(marksOf(axisTo(1.3, 4)), "0.0 0.5 1.0");
  EXPECT_EQ(marksOf(axisTo(0.012, 5)), "0.000 0.005 0.010");
  EXPECT_EQ(marksOf(axisTo(2, 4)), "0.0 0.5 1.0 1.5 2.0");
  EXPECT_EQ(axisTo(469.5, 5).end, 469.5);
}

TEST(Axis, HasAtMostAsManyMarksAsItMay) {
  for (double end = 1e-6; end < 1e7; end *= 1.37)
    for (const int most : {3, 4, 5}) {
      const Axis axis = axisTo(end, most);
      EXPECT_LE(axis.marks.size(), static_cast<std::size_t>(most) + 1) << end;
      EXPECT_GE(axis.marks.size(), 2U) << end << " has no mark but 0";
    }
}

TEST(Axis, WithoutAnEndItIsOne) {
  for (const double end : {0.0, -3.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(axisTo(end, 5).end, 1.0);
    EXPECT_FALSE(axisTo(end, 5).marks.empty());
  }
}

TEST(ReportTable, ANameInACellIsText) {
  Table table("t", {{"no."}, {"vessel", false}});
  table.row({text("1"), name("<img src=x onerror=alert(1)>")});
  EXPECT_EQ(table.rows(), 1U);
  const std::string html = table.markup().html;
  EXPECT_EQ(html.find("<img"), html.npos);
  EXPECT_NE(html.find("<bdi>&lt;img src=x onerror=alert(1)&gt;</bdi>"), html.npos) << html;
}

TEST(ReportTable, ARowHasACellForEachColumn) {
  Table table("t", {{"a"}, {"b"}, {"c"}});
  table.row({text("1")});
  EXPECT_NE(table.markup().html.find("<tr><td class=\"number\">1</td><td class=\"number\"></td><td "
                                     "class=\"number\"></td></tr>"),
            std::string::npos);
}

}  // namespace
}  // namespace lumen::convert
