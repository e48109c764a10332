// SPDX-License-Identifier: Apache-2.0
#include "converters/library/index/library_file.h"

#include <fstream>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "converters/base/error.h"
#include "converters/library/publish/library_fault.h"
#include "tests/unit/library/made_library.h"

namespace lumen::convert {
namespace {

using Json = nlohmann::ordered_json;

std::string refusal(const Json& library) {
  try {
    readLibrary(library.dump(), "x/library.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    return error.what();
  }
  return "accepted";
}

TEST(FaultList, CountsAllFaultsAndKeepsErrorsBeforeWarnings) {
  FaultList faults(2);
  faults.add({FaultCode::Privacy, "a", "", "", ""});
  for (const char* id : {"b", "c"}) faults.add({FaultCode::Bag, id, "", "", ""});
  faults.add({FaultCode::Privacy, "d", "", "", ""});
  EXPECT_EQ(faults.counts(), (formats::FaultCounts{2, 2, 0}));
  ASSERT_EQ(faults.kept().size(), 2U);
  EXPECT_EQ(faults.kept()[0].caseId, "b");
  EXPECT_EQ(faults.kept()[1].caseId, "c");
}

TEST(FaultList, AppendsInTheOrderOfTheLists) {
  FaultList faults(3), more(3);
  faults.add({FaultCode::Privacy, "a", "", "", ""});
  more.add({FaultCode::Bag, "b", "", "", ""});
  faults.append(std::move(more));
  ASSERT_EQ(faults.kept().size(), 2U);
  EXPECT_EQ(faults.kept()[0].caseId, "a");
  EXPECT_EQ(faults.kept()[1].caseId, "b");
  EXPECT_EQ(faults.firstError()->caseId, "b");
}

TEST(LibraryFile, IsReadAsItWasWritten) {
  const std::string text = libraryText(madeLibrary());
  const LibraryFile read = readLibrary(text, "library.json");
  EXPECT_EQ(libraryText(read), text);
  EXPECT_EQ(read.cases.size(), 2U);
  EXPECT_EQ(read.cases[0].recordBytes, 4021U);
  EXPECT_EQ(read.previous, madeDigest('e'));
  EXPECT_EQ(Json::parse(text)["cases"][1]["record"]["sha256"], madeDigest('0'));
}

TEST(LibraryFile, WithoutCasesAndBeforeIsWrittenToo) {
  LibraryFile library = madeLibrary();
  library.cases.clear();
  library.previous.reset();
  const std::string text = libraryText(library);
  EXPECT_TRUE(Json::parse(text)["cases"].is_array());
  EXPECT_TRUE(Json::parse(text)["previous"].is_null());
  EXPECT_EQ(libraryText(readLibrary(text, "library.json")), text);
}

TEST(LibraryFile, RefusesWhatTheSchemaRefusesAndSaysWhere) {
  const Json good = Json::parse(libraryText(madeLibrary()));
  const struct {
    const char* pointer;
    Json value;
    const char* message;
  } faults[] = {
      {"/format", "lumen", "at \"/format\": found \"lumen\"; expected \"lumen-library\""},
      {"/formatVersion", 2, "at \"/formatVersion\": found 2; expected 1"},
      {"/formatVersion", 1.0, "/formatVersion"},
      {"/id", "0B8F2AC0-58A8-4D3C-93C9-3F3F39F1F2A4", "a UUID"},
      {"/revision", 0, "a whole number from 1"},
      {"/revision", 1.5, "a whole number from 1"},
      {"/revision", -1, "a whole number from 1"},
      {"/previous", "abc", "SHA-256"},
      {"/title", "", "a text of 1 to 255 bytes"},
      {"/title", std::string(256, 'x'), "a text of 1 to 255 bytes"},
      {"/title", "two\nlines", "without control characters"},
      {"/publisher", 3, "a string"},
      {"/date", "2026-02-30", "a date such as"},
      {"/date", "2026-2-3", "a date such as"},
      {"/generator", "other 1", "\"lumen \" and a version"},
      {"/cases", Json::object(), "an array"},
      {"/cases/0/id", "Siphon", "an id of 1 to 64"},
      {"/cases/0/id", "../x", "an id of 1 to 64"},
      {"/cases/0/version", 0, "a whole number from 1"},
      {"/cases/0/record/sha256", madeDigest('F'), "SHA-256"},
      {"/cases/0/record/bytes", "12", "a whole number"},
      {"/cases/1/files", -3, "at \"/cases/1/files\""},
      {"/cases/1/more", 1, "unknown key"},
      {"/more", 1, "unknown key"},
  };
  for (const auto& fault : faults) {
    Json bad = good;
    bad[Json::json_pointer(fault.pointer)] = fault.value;
    const std::string message = refusal(bad);
    EXPECT_NE(message.find(fault.message), std::string::npos) << fault.pointer << ": " << message;
    EXPECT_TRUE(message.starts_with("x/library.json: ")) << message;
  }
  for (const auto& [key, value] : good.items()) {
    Json bad = good;
    bad.erase(key);
    EXPECT_NE(refusal(bad).find("\"" + key + "\" is missing"), std::string::npos) << key;
  }
}

TEST(LibraryFile, OfAFolderWithoutOneSaysHowToMakeIt) {
  const std::filesystem::path folder = testing::TempDir() + "no-library";
  std::filesystem::create_directories(folder);
  try {
    openLibrary(folder);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("lumen library init"), std::string::npos);
  }
}

TEST(LibraryFile, CasesAreFoundById) {
  const LibraryFile library = madeLibrary();
  ASSERT_NE(findCase(library, "siphon-02"), nullptr);
  EXPECT_EQ(findCase(library, "siphon-02")->title, "Right carotid siphon");
  EXPECT_EQ(findCase(library, "siphon-03"), nullptr);
  EXPECT_EQ(findCase(library, "a"), nullptr);
}

}  // namespace
}  // namespace lumen::convert
