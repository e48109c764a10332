// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/record.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "converters/library/index/record_of_case.h"
#include "converters/library/publish/record_faults.h"
#include "formats/case/vessel_system.h"
#include "tests/unit/formats/json_samples.h"
#include "tests/unit/library/made_library.h"

namespace lumen::convert {
namespace {

using Json = nlohmann::ordered_json;

std::string recordRefusal(const Json& record) {
  try {
    readRecord(record.dump(), "x/record.json");
  } catch (const PathError& error) {
    return std::string("path: ") + error.what();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return "accepted";
}

TEST(Record, IsReadAsItWasWritten) {
  const std::string text = recordText(madeRecord());
  EXPECT_EQ(recordText(readRecord(text, "record.json")), text);
}

TEST(Record, NumbersOfEveryWriterAreTheNearestDouble) {
  Json record = Json::parse(recordText(madeRecord()));
  record["bounds"]["min"] = {"NUMBER", 0, 0};
  const std::string text = record.dump();
  for (const auto& sample : lumen::test::jsonSamples(INFINITY)) {
    std::string changed = text;
    changed.replace(changed.find("\"NUMBER\""), 8, sample.text);
    EXPECT_EQ(readRecord(changed, "record.json").boundsMin.x(), sample.value) << sample.text;
  }
}

TEST(Record, OfAFileWithoutItsFaultyPathsIsStillChecked) {
  Json record = Json::parse(recordText(madeRecord()));
  record["bounds"]["min"][0] = 9.745131015777588;
  record["files"][0]["path"] = "../a";
  FaultList faults(10);
  readRecordFaults(record.dump(), "a", "record.json", faults);
  ASSERT_FALSE(faults.kept().empty());
  EXPECT_EQ(faults.kept()[0].code, FaultCode::FilePath);
  for (const auto& fault : faults.kept())
    EXPECT_EQ(fault.text().find("found {"), std::string::npos) << fault.text();
}

TEST(Record, WithoutWhatMayBeMissingToo) {
  CaseRecord record = madeRecord();
  record.figures.errorMedian.reset();
  record.figures.errorP90.reset();
  record.figures.reachable.reset();
  record.figures.geometry = GeometryFigures{};
  record.figures.systems = {"unknown", "artery"};
  record.insertions.clear();
  record.ends.clear();
  record.about.codes.clear();
  record.provenance["source"] = nullptr;
  record.provenance["steps"] = Json::array();
  const std::string text = recordText(record);
  EXPECT_EQ(recordText(readRecord(text, "record.json")), text);
}

TEST(Record, OfACaseWithSystemsStatesThem) {
  formats::Case value;
  formats::CenterlineTree& tree = value.tree;
  for (std::uint32_t n = 0; n < 6; ++n) {
    const bool isFirst = n % 2 == 0;
    tree.parent.push_back(isFirst ? formats::kNoParent : static_cast<std::int32_t>(n) - 1);
    tree.centre.push_back({isFirst ? 0.0F : 10.0F, 10.0F * static_cast<float>(n / 2), 0});
    tree.direction.push_back({1, 0, 0});
    tree.radius.push_back(1);
    tree.height.push_back(1);
    tree.branch.push_back(n / 2);
    if (!isFirst) continue;
    formats::Branch& branch = tree.branches.emplace_back();
    branch.label = "b" + std::to_string(n);
    branch.firstNode = n;
    branch.nodeCount = 2;
  }
  Progress progress;
  CaseRecord record = madeRecord();
  describe(value, "", record, progress);
  EXPECT_TRUE(record.figures.systems.empty());
  using enum formats::VesselSystem;
  setNodeSystems(value, {Vein, Vein, Artery, Artery, Vein, Vein});
  describe(value, "", record, progress);
  EXPECT_EQ(record.figures.systems, (std::vector<std::string>{"artery", "vein"}));
  FaultList faults(10);
  record.figures.systems.clear();  // as lumen wrote it before
  checkFigures(value, record, "record.json", faults);
  EXPECT_TRUE(faults.kept().empty());
  record.figures.systems = {"artery"};
  checkFigures(value, record, "record.json", faults);
  EXPECT_EQ(faults.kept().size(), 1U);
  setNodeSystems(value, std::vector(6, Unknown));
  checkFigures(value, record, "record.json", faults);
  EXPECT_EQ(faults.kept().size(), 2U);
}

TEST(Record, RefusesWhatTheSchemaRefusesAndSaysWhere) {
  const Json good = Json::parse(recordText(madeRecord()));
  const struct {
    const char* pointer;
    Json value;
    const char* message;
  } faults[] = {
      {"/format", "x", "/format"},
      {"/formatVersion", 2, "/formatVersion"},
      {"/id", "a/b", "an id"},
      {"/version", 0, "a whole number from 1"},
      {"/date", "22.11.2026", "a date"},
      {"/title", "", "a text of 1 to 255"},
      {"/description", std::string(4097, 'x'), "a text of 0 to 4096"},
      {"/anatomy/codes/0/system", "ICD", "one of \"SNOMED CT\", \"FMA\""},
      {"/anatomy/codes/0/code", "12a", "digits"},
      {"/laterality", "Left", "one of \"left\""},
      {"/modality", "MRI", "one of \"XA\""},
      {"/synthetic", 0, "true or false"},
      {"/licence", "a\tb", "control"},
      {"/doi", "https://doi.org/10.1234/x", "a DOI such as"},
      {"/doi", "10.123/x", "a DOI such as"},
      {"/doi", "10.1234/", "a DOI such as"},
      {"/units", "cm", "\"mm\""},
      {"/frame", "RAS", "\"LPS\""},
      {"/bounds/min", {1, 2}, "three numbers"},
      {"/bounds/mid", {1, 2, 3}, "unknown key"},
      {"/figures/nodes", -1, "a whole number"},
      {"/figures/length_mm", -1, "at least 0"},
      {"/figures/length_mm", nullptr, "a number"},
      {"/figures/fit_error_mm", 3, "an object"},
      {"/figures/reachable_mm", "far", "a number"},
      {"/figures/geometry", nullptr, "an object"},
      {"/figures/geometry", Json::object(), "path_tortuosity"},
      {"/figures/geometry/nascet_percent", -1, "at least 0"},
      {"/figures/geometry/more", 1, "unknown key"},
      {"/figures/systems", "artery", "an array"},
      {"/figures/systems", {"artery", "nerve"}, "\"false-lumen\""},
      {"/insertions/0/direction", {0, 0, 2}, "length 1"},
      {"/insertions/0/radius", 0, "above 0"},
      {"/insertions/0/label", "", "1 to 255"},
      {"/ends/0/kind", "cap", "\"inlet\""},
      {"/provenance/case_sha256", "x", "SHA-256"},
      {"/provenance/generator", "x", "lumen"},
      {"/provenance/source", "x", "an object"},
      {"/provenance/steps/0/name", "", "1 to 255"},
      {"/provenance/steps/0/parameters/gamma", {1}, "true, false, a number or a text"},
      {"/provenance/steps/0/other", 1, "name, tool and parameters"},
      {"/files/0/role", "thing", "one of \"case\""},
      {"/files/0/media", "png", "a media type"},
      {"/files/0/media", "Image/png", "a media type"},
      {"/files/0/bytes", 1e300, "a whole number"},
      {"/files/0/sha256", "x", "SHA-256"},
      {"/files/0/target", "mujoco", "a target for an export, and for nothing else"},
      {"/files/1/target", "a b", "the name of a target"},
      {"/more", 1, "unknown key"},
  };
  for (const auto& fault : faults) {
    Json bad = good;
    bad[Json::json_pointer(fault.pointer)] = fault.value;
    const std::string message = recordRefusal(bad);
    EXPECT_NE(message.find(fault.message), std::string::npos) << fault.pointer << ": " << message;
    EXPECT_TRUE(message.starts_with("x/record.json: ")) << message;
  }
  for (const auto& [key, value] : good.items()) {
    Json bad = good;
    bad.erase(key);
    EXPECT_NE(recordRefusal(bad).find("\"" + key + "\" is missing"), std::string::npos) << key;
  }
}

TEST(Record, ListsExactlyOneCaseAndSortedFiles) {
  Json bad = Json::parse(recordText(madeRecord()));
  std::swap(bad["files"][1], bad["files"][2]);
  EXPECT_NE(recordRefusal(bad).find("sorted by path"), std::string::npos);
  bad = Json::parse(recordText(madeRecord()));
  bad["files"][0]["role"] = "other";
  EXPECT_NE(recordRefusal(bad).find("exactly one file"), std::string::npos);
  bad["files"][2]["role"] = "case";
  EXPECT_NE(recordRefusal(bad).find("for case.lumen alone"), std::string::npos);
}

TEST(Record, HasNoPathThatLeavesTheFolderOrClashes) {
  const Json good = Json::parse(recordText(madeRecord()));
  for (const char* path : {"../library.json",
                           "/etc/passwd",
                           "",
                           "a//b",
                           "a/",
                           "/",
                           ".hidden",
                           "a/.b",
                           "a/../b",
                           "a\\b",
                           "a b",
                           "a\nb",
                           "C:x",
                           "exports/mujoco/scene.xml/x",
                           "picture.png/..",
                           "é",
                           "pic%2Fture",
                           "ro-crate-metadata.json",
                           "record.json",
                           "RECORD.json"}) {
    Json bad = good;
    bad["files"][2]["path"] = path;
    std::sort(bad["files"].begin(), bad["files"].end(),
              [](const Json& a, const Json& b) { return a["path"] < b["path"]; });
    EXPECT_TRUE(recordRefusal(bad).starts_with("path: x/record.json: at \"/files/"))
        << path << recordRefusal(bad);
  }
  for (const auto& [first, second] : {std::pair{"a/b", "a/B"}, {"x", "x/y"}, {"X/y", "x"}}) {
    Json bad = good;
    for (const char* path : {first, second}) {
      bad["files"].push_back(good["files"][2]);
      bad["files"].back()["path"] = path;
    }
    std::sort(bad["files"].begin(), bad["files"].end(),
              [](const Json& a, const Json& b) { return a["path"] < b["path"]; });
    EXPECT_TRUE(recordRefusal(bad).starts_with("path: "))
        << first << ' ' << second << recordRefusal(bad);
  }
}

TEST(Record, PathsAndIdsAreSpeltAsTheSpecificationHasThem) {
  for (const char* path : {"case.lumen", "a/b/c-d_e+f.G", "a-", "console", "com10", "nul-1"})
    EXPECT_TRUE(isRecordedPath(path)) << path;
  EXPECT_TRUE(isRecordedPath(std::string(128, 'x')));
  EXPECT_FALSE(isRecordedPath(std::string(129, 'x')));
  const std::string part(99, 'x');
  EXPECT_TRUE(isRecordedPath(part + "/" + part));
  EXPECT_FALSE(isRecordedPath(part + "/" + part + "/" + part));
  for (const char* path : {"-", "a/-b", "A.", "a./b", "con", "a/NUL", "aux.txt", "Com1.tar.gz"})
    EXPECT_FALSE(isRecordedPath(path)) << path;
  for (const char* id : {"con", "prn", "aux", "nul", "com0", "com9", "lpt1"})
    EXPECT_FALSE(isCaseId(id)) << id;
  for (const char* id : {"a", "0", "case-0123456789ab"}) EXPECT_TRUE(isCaseId(id)) << id;
  for (const char* id : {"", "-a", "A", "a.b", "a/b", "..", "a b"})
    EXPECT_FALSE(isCaseId(id)) << id;
  EXPECT_TRUE(isCaseId(std::string(64, 'x')));
  EXPECT_FALSE(isCaseId(std::string(65, 'x')));
}

TEST(Record, WhatPeopleTellMayBePartial) {
  const CaseAbout about =
      readAbout(R"({"title": "A", "synthetic": true, "anatomy": {"text": "aorta", "codes": []}})",
                "about.json");
  EXPECT_EQ(about.title, "A");
  EXPECT_EQ(about.anatomy, "aorta");
  EXPECT_TRUE(about.synthetic);
  EXPECT_EQ(about.laterality, "unknown");
  EXPECT_THROW(readAbout(R"({"titel": "A"})", "about.json"), Error);
  EXPECT_THROW(readAbout(R"({"laterality": "links"})", "about.json"), Error);
  EXPECT_THROW(readAbout("[]", "about.json"), Error);
  EXPECT_THROW(readAbout(R"({"title": "A", "title": "B"})", "about.json"), Error);
}

TEST(Record, IsTakenAsAWholeForWhatPeopleTell) {
  const CaseRecord record = madeRecord();
  const CaseAbout about = readAbout(recordText(record), "record.json");
  EXPECT_EQ(about.title, record.about.title);
  EXPECT_EQ(about.consent, record.about.consent);
  ASSERT_EQ(about.codes.size(), 2U);
}

TEST(Record, KeysThatPeopleLeaveOutStayAsTheyWere) {
  const CaseAbout known = madeRecord().about;
  const CaseAbout about = readAbout(R"({"title": "A"})", "about.json", known);
  EXPECT_EQ(about.title, "A");
  EXPECT_EQ(about.consent, known.consent);
  EXPECT_EQ(about.codes.size(), known.codes.size());
  const CaseAbout other =
      readAbout(R"({"anatomy": {"text": "aorta", "codes": []}})", "about.json", known);
  EXPECT_TRUE(other.codes.empty());
}

TEST(Record, OfAPatientStatesConsentAndDeidentification) {
  CaseAbout about = madeRecord().about;
  EXPECT_EQ(missingStatement(about), "");
  about.consent.clear();
  EXPECT_NE(missingStatement(about).find("--consent"), std::string::npos);
  about.synthetic = true;
  EXPECT_EQ(missingStatement(about), "");
  about.licence.clear();
  EXPECT_NE(missingStatement(about).find("--licence"), std::string::npos);
  about = madeRecord().about;
  about.deidentification.clear();
  EXPECT_NE(missingStatement(about).find("--deidentification"), std::string::npos);
}

}  // namespace
}  // namespace lumen::convert
