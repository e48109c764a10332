// SPDX-License-Identifier: Apache-2.0
// lumen ends, from outside.
#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/cli/run_lumen.h"

namespace lumen::test {

namespace {

using Json = nlohmann::ordered_json;

class EndsTest : public CliTest {
protected:
  [[nodiscard]] Json ends(std::vector<std::string> words) const {
    words.insert(words.begin(), "ends");
    words.emplace_back("--json");
    const Outcome outcome = lumen(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out, nullptr, false);
  }

  /// Two vessels of radius 2 mm side by side, 20 mm apart, which a vessel of 0.8 mm joins in the
  /// middle, as one tree from the end of the first: an H.
  void makeH() const {
    std::string text;
    int id = 0;
    const auto add = [&](double x, double y, double radius, int parent) {
      text += std::to_string(++id) + " 2 " + std::to_string(x) + " " + std::to_string(y) + " 0 " +
              std::to_string(radius) + " " + std::to_string(parent) + "\n";
      return id;
    };
    int last = -1, middle = -1, far = -1;
    for (int y = 0; y <= 40; ++y) {
      last = add(0, y, 2, last);
      if (y == 20) middle = last;
    }
    for (int x = 1, parent = middle; x < 20; ++x) far = parent = add(x, 20, 0.8, parent);
    int fork = add(20, 20, 2, far);
    for (const int step : {1, -1})
      for (int k = 1, parent = fork; k <= 20; ++k) parent = add(20, 20 + step * k, 2, parent);
    write("h.swc", text);
    make({"convert", "h.swc", "h.lumen", "--quiet"});
  }
};

}  // namespace

TEST_F(EndsTest, EveryOpenEndHasItsPlaceAndItsRadius) {
  makeH();
  const Json answer = ends({"h.lumen"});
  EXPECT_EQ(answer["trees"], 1);
  ASSERT_EQ(answer["ends"].size(), 4U);
  int inlets = 0;
  for (const Json& end : answer["ends"]) {
    inlets += end["inlet"].get<bool>() ? 1 : 0;
    EXPECT_NEAR(end["radius_mm"].get<double>(), 2, 0.05);
    EXPECT_TRUE(end["leaves_volume"].is_null());
    const double y = end["position"][1].get<double>();
    EXPECT_NEAR(std::min(std::abs(y), std::abs(y - 40)), 0, 0.1) << end;
  }
  EXPECT_EQ(inlets, 1);
}

TEST_F(EndsTest, AnotherEndBecomesTheInletAndNoWallChanges) {
  makeH();
  const Json before = ends({"h.lumen"});
  std::string number;
  for (const Json& end : before["ends"])
    if (!end["inlet"].get<bool>()) number = std::to_string(end["number"].get<int>());
  const Json after = ends({"h.lumen", "--root", number, "--out", "turned.lumen"});
  EXPECT_EQ(after["fitted"], false);
  EXPECT_EQ(after["trees"], 1);
  EXPECT_EQ(after["blobs"], Json::parse(lumen({"info", "h.lumen", "--json"}).out)["blobs"]);
  const Json& was = before["ends"][std::stoul(number) - 1]["position"];
  for (const Json& end : after["ends"])
    if (end["inlet"].get<bool>()) {
      for (int a = 0; a < 3; ++a) EXPECT_NEAR(end["position"][a], was[a], 1e-4);
    }
  EXPECT_EQ(lumen({"validate", "turned.lumen"}).code, 0);
}

TEST_F(EndsTest, TwoInletsOfOneTreeAreANetworkOfTwoTreesByALink) {
  makeH();
  const Json before = ends({"h.lumen"});
  std::vector<std::string> words{"h.lumen", "--out", "both.lumen"};
  for (const Json& end : before["ends"])
    if (std::abs(end["position"][1].get<double>()) < 1) {
      words.emplace_back("--root");
      words.push_back(std::to_string(end["number"].get<int>()));
    }
  ASSERT_EQ(words.size(), 7U);
  const Json after = ends(words);
  EXPECT_EQ(after["trees"], 2);
  EXPECT_EQ(after["links"], 1);
  EXPECT_EQ(after["fitted"], true);
  const Json info = Json::parse(lumen({"info", "both.lumen", "--json"}).out);
  EXPECT_EQ(info["trees"], 2);
  EXPECT_EQ(info["networks"], 1);
  EXPECT_EQ(info["reachable"]["networks"], 1);
  EXPECT_TRUE(contains(lumen({"info", "both.lumen"}).out, "2, 1 network by 1 link"));
}

TEST_F(EndsTest, AWideEndOfTheVolumeMayBeAnInletAndANarrowOneNot) {
  makeH();
  make({"convert", "h.lumen", "h.lumen.json", "--quiet"});
  Json value = Json::parse(read("h.lumen.json"));
  // a volume whose faces cut the four ends off
  value["metadata"]["source"] = {{"size", {60, 41, 30}},
                                 {"spacing", {1, 1, 1}},
                                 {"origin", {-20, 0, -15}},
                                 {"direction", {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                                 {"sha256", std::string(64, 'a')}};
  const auto written = [&](const char* file, double share) {
    // the second vessel as wide as this share of the first
    Json changed = value;
    for (std::size_t i = 0; i < changed["tree"]["radius"].size(); ++i)
      if (changed["tree"]["centre"][i][0].get<double>() > 19.9)
        changed["tree"]["radius"][i] = 2 * share;
    write(file, changed.dump());
    int reasons = 0;
    const Json answer = ends({file});
    for (const Json& end : answer["ends"])
      if (end["position"][0].get<double>() > 15 && end["why"].is_string()) ++reasons;
    return reasons;
  };
  EXPECT_EQ(written("wide.lumen.json", 0.82), 2);  // over half of the flow: 1 / 1.26 = 0.79
  EXPECT_EQ(written("narrow.lumen.json", 0.77), 0);
}

TEST_F(EndsTest, MistakesAreRefused) {
  makeH();
  EXPECT_EQ(lumen({"ends", "gone.lumen"}).code, 3);
  EXPECT_EQ(lumen({"ends", "h.lumen", "--root", "1"}).code, 2);
  EXPECT_EQ(lumen({"ends", "h.lumen", "--out", "x.lumen"}).code, 2);
  const Outcome far = lumen({"ends", "h.lumen", "--root", "9", "--out", "x.lumen"});
  EXPECT_EQ(far.code, 2);
  EXPECT_TRUE(contains(far.err, "found 9, expected the number of an end, 1 to 4")) << far.err;
  EXPECT_EQ(lumen({"ends", "h.lumen", "--root", "0", "--out", "x.lumen"}).code, 2);
  EXPECT_FALSE(exists("x.lumen"));
}

}  // namespace lumen::test
