// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/derived.h"

#include <algorithm>
#include <set>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/sha256.h"
#include "tests/unit/library/made_library.h"

namespace lumen::convert {
namespace {

using Json = nlohmann::ordered_json;

std::string digestOf(const std::string& text) {
  return sha256(std::as_bytes(std::span(text)));
}

RevisionTexts textsOf(const LibraryFile& library) {
  LibraryTexts maker(library);
  for (const LibraryEntry& entry : library.cases) {
    const CaseRecord record = madeRecord(entry.id);
    maker.add(entry, record, caseCrate(record));
  }
  return maker.finish();
}

std::string entityText(const std::string& crate, const std::string& id) {
  const Json document = Json::parse(crate);
  for (const Json& entity : document["@graph"])
    if (entity["@id"] == id) return entity.dump();
  return "none";
}

/// Every reference within the document names an entity of it, and no two entities have one id.
void expectClosed(const std::string& crate) {
  std::set<std::string> ids;
  const Json graph = Json::parse(crate)["@graph"];
  for (const Json& entity : graph) EXPECT_TRUE(ids.insert(entity["@id"]).second) << entity["@id"];
  const auto check = [&](const Json& value) {
    if (!value.is_object() || std::string(value["@id"]).starts_with("https://w3id.org/ro/crate"))
      return;
    EXPECT_TRUE(ids.contains(value["@id"])) << value["@id"];
  };
  for (const Json& entity : graph)
    for (const auto& [key, value] : entity.items()) {
      check(value);
      if (value.is_array())
        for (const Json& one : value) check(one);
    }
}

TEST(DerivedTexts, ManifestHasEveryFileOnce) {
  const RevisionTexts texts = textsOf(madeLibrary());
  EXPECT_NE(texts.manifest.find(madeDigest('c') + "  data/siphon-01/exports/mujoco/scene.xml\n"),
            std::string::npos);
  EXPECT_NE(texts.manifest.find(madeDigest('f') + "  data/siphon-01/record.json\n"),
            std::string::npos);
  EXPECT_NE(texts.manifest.find(digestOf(caseCrate(madeRecord("siphon-02"))) +
                                "  data/siphon-02/ro-crate-metadata.json\n"),
            std::string::npos);
  EXPECT_TRUE(texts.manifest.ends_with(digestOf(texts.crate) + "  data/ro-crate-metadata.json\n"));
  EXPECT_EQ(std::count(texts.manifest.begin(), texts.manifest.end(), '\n'), 2 * 5 + 1);
}

TEST(DerivedTexts, TagFilesCountThePayloadAndStateEachOther) {
  const LibraryFile library = madeLibrary();
  const RevisionTexts texts = textsOf(library);
  const std::size_t crates = caseCrate(madeRecord("siphon-01")).size() +
                             caseCrate(madeRecord("siphon-02")).size() + texts.crate.size();
  EXPECT_NE(texts.bagInfo.find("Payload-Oxum: " + std::to_string(2 * 600 + 4021 + 4022 + crates) +
                               ".11\n"),
            std::string::npos)
      << texts.bagInfo;
  EXPECT_EQ(texts.tagManifest, digestOf(texts.bagInfo) + "  bag-info.txt\n" + digestOf(texts.bag) +
                                   "  bagit.txt\n" + digestOf(libraryText(library)) +
                                   "  library.json\n" + digestOf(texts.manifest) +
                                   "  manifest-sha256.txt\n");
}

TEST(DerivedTexts, CratesAreClosedAndSayWhatTheSpecificationAsks) {
  const RevisionTexts texts = textsOf(madeLibrary());
  const std::string nested = caseCrate(madeRecord());
  for (const std::string& crate : {texts.crate, nested}) {
    expectClosed(crate);
    const Json root = Json::parse(entityText(crate, "./"));
    for (const char* key : {"name", "description", "datePublished", "license", "hasPart"})
      EXPECT_TRUE(root.contains(key)) << key;
    EXPECT_EQ(Json::parse(entityText(crate, "ro-crate-metadata.json"))["conformsTo"]["@id"],
              "https://w3id.org/ro/crate/1.2");
  }
  EXPECT_NE(entityText(texts.crate, "siphon-02/").find(R"({"@id":"https://w3id.org/ro/crate"})"),
            std::string::npos);
  EXPECT_NE(entityText(nested, "picture.png").find("image/png"), std::string::npos);
  EXPECT_NE(entityText(nested, "https://spdx.org/licenses/CC-BY-4.0"), "none");
}

TEST(DerivedTexts, LicencesThatAreNotOneIdentifierHaveANameInTheDocument) {
  CaseRecord record = madeRecord();
  record.about.licence = "(MIT OR LicenseRef-a)";
  expectClosed(caseCrate(record));
  EXPECT_NE(entityText(caseCrate(record), "#licence-%28MIT%20OR%20LicenseRef-a%29"), "none");
}

}  // namespace
}  // namespace lumen::convert
