// SPDX-License-Identifier: Apache-2.0
// lumen report, from outside. How the page looks: tests/report.
#include <regex>

#include <nlohmann/json.hpp>

#include "converters/base/number_text.h"
#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

class ReportTest : public FittedTubeTest {
protected:
  /// The page of these arguments, new.
  [[nodiscard]] std::string newPage(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "report");
    arguments.insert(arguments.begin() + 2, "page.html");
    const Outcome made = lumen(arguments);
    EXPECT_EQ(made.code, 0) << made.err;
    m_said = made.out;
    return read("page.html");
  }
  /// The page of the case with its volume, made once in this process.
  [[nodiscard]] const std::string& fullPage() const {
    static const std::string page = newPage({"tube.lumen", "--volume", "tube.nrrd", "--json"});
    static const std::string said = m_said;
    m_said = said;
    return page;
  }
  /// The page of the case alone, made once in this process.
  [[nodiscard]] const std::string& pageWithoutVolume() const {
    static const std::string page = newPage({"tube.lumen"});
    return page;
  }

  mutable std::string m_said;  ///< standard output of the run that made the last page
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++n;
  return n;
}

/// The part of a page between the section's beginning and its end.
std::string sectionOf(const std::string& page, const std::string& id) {
  const std::size_t from = page.find("<section id=\"" + id + "\">");
  EXPECT_NE(from, page.npos) << id;
  if (from == page.npos) return {};
  return page.substr(from, page.find("</section>", from) - from);
}

/// The end of a table's cell with a whole number.
std::string cell(const Json& number) {
  return std::string(">").append(std::to_string(number.get<int>())).append("</td>");
}

}  // namespace

TEST_F(ReportTest, WithTheVolumeNothingIsMissing) {
  const std::string& html = fullPage();
  const Json answer = Json::parse(m_said);
  EXPECT_EQ(answer["bytes"], html.size());
  EXPECT_EQ(answer["branches"], 1);
  EXPECT_EQ(answer["pictures"], 8) << "four sides, confidence, three projections";
  EXPECT_EQ(answer["source"], "same");
  EXPECT_EQ(answer["warnings"], 0);
  EXPECT_EQ(count(html, "src=\"data:image/png;base64,"), 8U);
  for (const char* id : {"warnings", "sides", "branches", "profiles", "measures", "confidence",
                         "agreement", "projection", "parameters", "provenance"})
    EXPECT_GT(sectionOf(html, id).size(), 100U) << id;
  EXPECT_EQ(html.find("No volume was given"), html.npos);
  EXPECT_NE(sectionOf(html, "provenance").find(answer["case_sha256"].get<std::string>()),
            html.npos);
}

TEST_F(ReportTest, TellsWhatInfoAndCheckTell) {
  const std::string& html = fullPage();
  const Json info = Json::parse(lumen({"info", "tube.lumen", "--json"}).out);
  const Json check = Json::parse(lumen({"check", "tube.nrrd", "tube.lumen", "--json"}).out);
  const Json& branch = info["branches"][0];
  const std::string row = sectionOf(html, "branches");
  EXPECT_NE(row.find("<bdi>" + branch["label"].get<std::string>() + "</bdi>"), row.npos);
  EXPECT_NE(row.find(cell(branch["nodes"])), row.npos);
  EXPECT_NE(sectionOf(html, "agreement").find(cell(check["wall"]["samples"])), html.npos);
  const std::string parameters = sectionOf(html, "parameters");
  for (const Json& step : info["provenance"]["steps"])
    for (const auto& [key, value] : step["parameters"].items())
      EXPECT_NE(parameters.find("<bdi>" + key + "</bdi>"), parameters.npos) << key;
  EXPECT_NE(html.find(info["provenance"]["source"]["sha256"].get<std::string>()), html.npos);
}

TEST_F(ReportTest, HasTheMeasuresOfLumenMeasure) {
  const std::string measures = sectionOf(pageWithoutVolume(), "measures");
  const Json vessel =
      Json::parse(lumen({"measure", "tube.lumen", "--json"}).out)["cases"][0]["vessels"][0];
  const auto shown = [](const Json& m, int decimals) {
    return fixedText(m["value"].get<double>(), decimals) + " \u00b1 " +
           fixedText(m["plus_minus"].get<double>(), decimals) + "</td>";
  };
  EXPECT_NE(measures.find(shown(vessel["length_mm"], 1)), measures.npos);
  EXPECT_NE(measures.find(shown(vessel["smallest_radius_mm"], 2)), measures.npos);
  EXPECT_NE(measures.find(shown(vessel["volume_mm3"], 1)), measures.npos);
  EXPECT_NE(measures.find("This case has no forks."), measures.npos);
  // a value that is not defined has its reason
  const std::string tree = sectionOf(newPage({"truth.lumen"}), "measures");
  EXPECT_NE(tree.find("title=\"the case has no models: fit it first\""), tree.npos);
}

TEST_F(ReportTest, WithoutTheVolumeThePartsThatNeedItSaySo) {
  const std::string& html = pageWithoutVolume();
  for (const char* id : {"agreement", "projection"})
    EXPECT_NE(sectionOf(html, id).find("o volume was given (--volume)"), html.npos) << id;
  EXPECT_NE(html.find("not known: no volume was given"), html.npos);
  EXPECT_EQ(count(html, "<img "), 5U);
}

TEST_F(ReportTest, ACaseWithoutModelsHasAReportOfWhatThereIs) {
  const std::string html = newPage({"truth.lumen", "--volume", "tube.nrrd"});
  EXPECT_NE(sectionOf(html, "sides").find("this case has no models"), html.npos);
  EXPECT_NE(sectionOf(html, "agreement").find("This case has no models"), html.npos);
  EXPECT_NE(sectionOf(html, "confidence").find("records no inlier rates"), html.npos);
  EXPECT_EQ(count(sectionOf(html, "projection"), "<img "), 3U);
  EXPECT_EQ(count(sectionOf(html, "profiles"), "<svg "), 1U);
}

TEST_F(ReportTest, TheSameInputGivesTheSameBytes) {
  const std::string again = newPage({"tube.lumen", "--volume", "tube.nrrd", "--threads", "1"});
  EXPECT_TRUE(again == fullPage());
}

TEST_F(ReportTest, NothingIsFetchedAndNothingRuns) {
  const std::string& html = fullPage();
  EXPECT_NE(html.find("default-src 'none'; img-src data:; style-src 'unsafe-inline'"), html.npos);
  EXPECT_EQ(html.find("<script"), html.npos);
  EXPECT_EQ(html.find("://"), html.npos);
  EXPECT_EQ(count(html, "src="), count(html, "src=\"data:"));
}

TEST_F(ReportTest, NoPathOfThisMachineIsOnThePage) {
  const std::string folder = path("").string();
  const std::string html = newPage({folder + "truth.lumen", "--volume", folder + "tube.nrrd"});
  EXPECT_EQ(html.find(folder), std::string::npos);
}

TEST_F(ReportTest, HostileTextsAreText) {
  ASSERT_EQ(lumen({"convert", "tube.lumen", "tube.lumen.json"}).code, 0);
  Json value = Json::parse(read("tube.lumen.json"));
  value["tree"]["branches"][0]["label"] = "<script>alert('\"')</script>\u202e";
  value["metadata"]["note"] = "</section><img src=x>" + std::string(10000, '<');
  value["metadata"]["steps"][0]["parameters"]["<b>"] = "</b>";
  write("hostile.lumen.json", value.dump());
  const std::string html = newPage({"hostile.lumen.json", "--title", "<i>title</i>"});
  EXPECT_EQ(html.find("<script"), html.npos);
  EXPECT_EQ(html.find("<img src=x"), html.npos);
  EXPECT_EQ(html.find("<i>"), html.npos);
  EXPECT_EQ(html.find("\u202e"), html.npos);
  EXPECT_NE(html.find("&lt;script&gt;alert(&#39;&quot;&#39;)&lt;/script&gt;\\u202e"), html.npos);
  EXPECT_NE(html.find("(10021 bytes)"), html.npos) << "a long note is cut, and says so";
}

TEST_F(ReportTest, WhatLooksLikeAPersonIsWarnedOf) {
  ASSERT_EQ(lumen({"convert", "tube.lumen", "tube.lumen.json"}).code, 0);
  Json value = Json::parse(read("tube.lumen.json"));
  value["tree"]["branches"][0]["label"] = "Doe^Jane";
  write("Doe 1999-12-31.lumen.json", value.dump());
  const Outcome made = lumen({"report", "Doe 1999-12-31.lumen.json", "page.html", "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(Json::parse(made.out)["warnings"], 2);
  const std::string warnings = sectionOf(read("page.html"), "warnings");
  EXPECT_NE(warnings.find("PRIVACY_NAME at /tree/branches/0/label"), warnings.npos);
  EXPECT_NE(warnings.find("PRIVACY_DATE: a name on this page"), warnings.npos) << warnings;
  EXPECT_NE(made.err.find("2 warnings, which the page lists"), std::string::npos) << made.err;
  const Outcome strict = lumen({"report", "Doe 1999-12-31.lumen.json", "strict.html", "--strict"});
  EXPECT_EQ(strict.code, 3);
  EXPECT_FALSE(exists("strict.html"));
}

TEST_F(ReportTest, AnotherVolumeIsAWarningOnThePage) {
  ASSERT_EQ(lumen({"phantom", "tube", "other.nrrd", "--size", "64", "--seed", "2"}).code, 0);
  const Outcome made =
      lumen({"report", "tube.lumen", "page.html", "--volume", "other.nrrd", "--json"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(Json::parse(made.out)["source"], "other voxels");
  EXPECT_NE(sectionOf(read("page.html"), "warnings").find("was made from another volume"),
            std::string::npos);
}

TEST_F(ReportTest, WhatCannotBeReportedLeavesNoPage) {
  ASSERT_EQ(lumen({"check", "tube.nrrd", "tube.lumen", "--mask", "mask.mha"}).code, 0);
  const std::string offset = "Offset = 0 0 0";
  std::string text = read("mask.mha");
  ASSERT_NE(text.find(offset), std::string::npos);
  write("far.mha", text.replace(text.find(offset), offset.size(), "Offset = 999 0 0"));
  write("broken.lumen", read("tube.lumen").substr(0, 500));
  EXPECT_EQ(lumen({"report", "tube.lumen", "page.html", "--volume", "far.mha"}).code, 3);
  EXPECT_EQ(lumen({"report", "broken.lumen", "page.html"}).code, 3);
  EXPECT_EQ(lumen({"report", "tube.nrrd", "page.html"}).code, 3);
  EXPECT_EQ(lumen({"report", "tube.lumen", "page.html", "--volume", "truth.lumen"}).code, 4);
  EXPECT_EQ(lumen({"report", "tube.lumen", "page.pdf"}).code, 2);
  EXPECT_EQ(lumen({"report", "tube.lumen", "page.html", "--point-spread", "1"}).code, 2);
  EXPECT_EQ(lumen({"report", "tube.lumen", "no/page.html"}).code, 1);
  for (const std::string& name : entries()) EXPECT_EQ(name.find("page"), name.npos) << name;
}

}  // namespace lumen::test
