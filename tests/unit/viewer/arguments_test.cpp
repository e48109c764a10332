// SPDX-License-Identifier: Apache-2.0
// Values that a page may write in a request.
#include "viewer/session/document/arguments.h"

#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "tests/unit/formats/json_samples.h"

namespace lumen::viewer {
namespace {

template <class Read>
std::string refusal(const std::string& text, Read read) {
  try {
    const formats::JsonDocument document = parseRequest(text, 10000);
    read(Arguments(document.root()));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    return error.what();
  }
  return "";
}

TEST(Arguments, NumbersOfEveryWriterAreTheNearestDouble) {
  for (const auto& [text, value] : lumen::test::jsonSamples(1e6)) {
    const formats::JsonDocument document = parseRequest("{\"n\":" + text + "}", 10000);
    EXPECT_EQ(Arguments(document.root()).number("n"), value) << text;
  }
}

TEST(Arguments, NumbersOutOfRangeAreRefusedAsTheyAreWritten) {
  const auto number = [](const Arguments& a) { (void)a.number("n"); };
  EXPECT_EQ(refusal(R"({"n":1e400})", number),
            "\"n\" is 1e400, but must be a number that rounds to an f64");
  EXPECT_EQ(refusal(R"({"n":1e7})", number), "\"n\" must be at most 1e6 in size");
  const auto whole = [](const Arguments& a) { (void)a.whole("n"); };
  EXPECT_EQ(refusal(R"({"n":9223372036854775808})", whole),
            "\"n\" is 9223372036854775808, but must be a whole number");
  EXPECT_EQ(refusal(R"({"n":1.5})", whole), "\"n\" must be a whole number");
}

TEST(Arguments, FaultsNameTheMember) {
  const auto points = [](const Arguments& a) { (void)a.points("points"); };
  EXPECT_EQ(refusal("{}", points), "\"points\" is missing");
  EXPECT_EQ(refusal(R"({"points":null})", points), "\"points\" is missing");
  EXPECT_EQ(refusal(R"({"points":[]})", points), "\"points\" must be a list of one to 1000 points");
  EXPECT_EQ(refusal(R"({"points":[{"position":[1,2]}]})", points),
            "\"position\" must be three numbers");
  EXPECT_EQ(refusal(R"({"points":[{"position":[1,2,"3"]}]})", points),
            "\"position\" must be a number");
}

TEST(Arguments, ARequestIsStrictJson) {
  const auto none = [](const Arguments&) {};
  for (const char* text : {"", "{\"a\":1,\"a\":2}", "{\"a\":NaN}", "[1,]"})
    EXPECT_EQ(refusal(text, none), "this is not JSON") << text;
  EXPECT_EQ(refusal(std::string(1000, '['), none), "this is not JSON");
  EXPECT_EQ(refusal("[]", none), "a request is a JSON object");
}

}  // namespace
}  // namespace lumen::viewer
