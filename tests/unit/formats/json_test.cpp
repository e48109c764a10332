// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "converters/base/random.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using test::codeOf;

// The text of the rich case with the first `from` replaced.
std::string replaced(const std::string& from, const std::string& to) {
  std::string text = encodeJson(test::richCase());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(Json, GivesBackEveryField) {
  const auto decoded = decodeJson(encodeJson(test::richCase()));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, test::richCase());
}

// spec: M35
TEST(Json, GivesTheSameBinaryBytesAfterBinaryToJsonToBinary) {
  for (const Case& value :
       {test::richCase(), test::fullCase(), test::smallestCase(), test::longCase(50, 3, 2)}) {
    const auto first = encodeBinary(value);
    const auto fromBinary = decodeBinary(first);
    ASSERT_TRUE(fromBinary);
    const auto fromJson = decodeJson(encodeJson(*fromBinary));
    ASSERT_TRUE(fromJson) << fromJson.error().text();
    EXPECT_EQ(encodeBinary(*fromJson), first);
  }
}

TEST(Json, WritesTheSmallestCaseLikeThis) {
  EXPECT_EQ(encodeJson(test::smallestCase()), R"({
  "format": "lumen",
  "version": "1.1",
  "minimumReader": "1.0",
  "metadata": {
    "coordinateSystem": "LPS",
    "units": "mm",
    "steps": []
  },
  "tree": {
    "branches": [
      {"label": "a", "kind": "vessel", "parentNode": -1, "firstNode": 0, "nodeCount": 1, "stopReason": "unknown"}
    ],
    "centre": [[1,2,3]],
    "direction": [[0,0,1]],
    "radius": [1],
    "height": [0.5],
    "parent": [-1],
    "branch": [0]
  }
}
)");
}

TEST(Json, WrapsLongArraysAtAHundredBytes) {
  const std::string text = encodeJson(test::longCase(100, 2, 2));
  std::size_t lines = 0;
  for (std::size_t at = 0; at < text.size(); ++lines) {
    const std::size_t end = text.find('\n', at);
    if (text.find("\"label\"", at) >= end) {
      EXPECT_LE(end - at, 101u) << text.substr(at, end - at);
    }
    at = end + 1;
  }
  EXPECT_LT(lines, text.size() / 60);
}

TEST(Json, WritesFloatsInTheirShortestForm) {
  const std::string text = encodeJson(test::richCase());
  EXPECT_NE(text.find("[0.1,3,1], [1e-20,4,1], [-3,16777216,0.33333334]"), std::string::npos)
      << text;
  EXPECT_NE(text.find("\"width\": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]"), std::string::npos) << text;
}

// spec: M34
TEST(Json, KeepsEveryBitPatternOfFiniteFloats) {
  Random random(7);
  Case value = test::smallestCase();
  value.points = PointSets{{0, 0}, {}};
  for (int i = 0; i < 100000; ++i) {
    const auto a = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
    if (std::isfinite(a)) value.points->position.push_back({a, std::nextafter(a, 0.0f), 1});
  }
  for (const float edge :
       {std::numeric_limits<float>::max(), std::numeric_limits<float>::min(),
        std::numeric_limits<float>::denorm_min(), 8388609.0f, 1e-45f, 1.17549421e-38f})
    value.points->position.push_back({edge, -edge, edge});
  value.points->offset[1] = static_cast<std::uint32_t>(value.points->position.size());
  const auto decoded = decodeJson(encodeJson(value));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(encodeBinary(*decoded), encodeBinary(value));
}

// spec: M30
TEST(Json, KeepsIntegersAndDoublesApart) {
  Case value = test::smallestCase();
  Step step{"s", "t", {}};
  step.parameters = {{"int", std::int64_t{2}},
                     {"double", 2.0},
                     {"big", 1e300},
                     {"max", std::numeric_limits<std::int64_t>::max()},
                     {"third", 1.0 / 3.0}};
  value.metadata.steps = {step};
  const std::string text = encodeJson(value);
  EXPECT_NE(text.find("\"double\": 2.0"), std::string::npos);
  EXPECT_NE(text.find("\"int\": 2,"), std::string::npos);
  const auto decoded = decodeJson(text);
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(decoded->metadata, value.metadata);
}

TEST(Json, RoundsADecimalToTheNearestFloatOnce) {
  // Halfway between 1 and the next float, plus a little that a double cannot hold: reading it as a
  // double first would give the halfway point, and rounding that to even would give 1.
  const auto decoded = decodeJson(replaced("[-1,0.5,0]", "[-1,1.00000005960464477540,0]"));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(decoded->points->position[1].y, std::nextafter(1.0f, 2.0f));
}

TEST(Json, TakesNumbersBelowTheSmallestFloatAsZero) {
  const auto decoded = decodeJson(replaced("[-1,0.5,0]", "[-1e-60,0.5,0]"));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(decoded->points->position[1].x, 0.0f);
}

TEST(Json, TakesIntegersWhereANumberIsExpected) {
  const auto decoded = decodeJson(replaced("\"isoLevel\": 0.1", "\"isoLevel\": 1"));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(decoded->models->isoLevel, 1.0);
}

TEST(Json, IgnoresKeysThatStartWithX) {
  const auto decoded = decodeJson(
      replaced("\"tree\": {", "\"x-note\": {\"a\": [1, {}]}, \"tree\": {\"x-b\": null,"));
  ASSERT_TRUE(decoded) << decoded.error().text();
  EXPECT_EQ(*decoded, test::richCase());
}

TEST(Json, IgnoresUnknownKeysOfANewerMinorVersionOnly) {
  std::string text = replaced("\"tree\": {", "\"links\": [], \"tree\": {");
  EXPECT_EQ(codeOf(decodeJson(text)), "JSON_KEY_UNKNOWN");
  text.replace(text.find("\"1.1\""), 5, "\"1.3\"");
  EXPECT_EQ(codeOf(decodeJson(text)), "OK");
}

struct JsonCaseFaultRow {
  const char* name;
  const char *from, *to;
  const char *code, *place;
};

class JsonCaseFault : public testing::TestWithParam<JsonCaseFaultRow> {};

// spec: M1, M28, M32, M33, M45
TEST_P(JsonCaseFault, IsFoundAtItsPlace) {
  const JsonCaseFaultRow& fault = GetParam();
  const auto result = decodeJson(replaced(fault.from, fault.to));
  ASSERT_FALSE(result);
  EXPECT_EQ(test::codeOf(result), fault.code) << result.error().text();
  EXPECT_EQ(result.error().place(), fault.place) << result.error().text();
}

const JsonCaseFaultRow kFaults[] = {
    {"format", "\"lumen\"", "\"obj\"", "NOT_LUMEN", "/format"},
    {"version_text", "\"1.0\"", "\"1\"", "VERSION", "/version"},
    {"version_zero", "\"1.0\"", "\"0.9\"", "VERSION", "/version"},
    {"version_overflow", "\"1.0\"", "\"1.256\"", "VERSION", "/version"},
    {"reader_newer", "\"version\": \"1.1\",\n  \"minimumReader\": \"1.0\"",
     "\"version\": \"2.3\", \"minimumReader\": \"2.0\"", "VERSION", "/minimumReader"},
    {"coordinate_system", "\"LPS\"", "\"RAS\"", "COORDINATE_SYSTEM", "/metadata/coordinateSystem"},
    {"no_coordinate_system", "\"coordinateSystem\": \"LPS\",", "", "JSON_KEY_MISSING", "/metadata"},
    {"units", "\"mm\"", "\"m\"", "UNITS", "/metadata/units"},
    {"no_units", "\"units\": \"mm\",", "", "JSON_KEY_MISSING", "/metadata"},
    {"no_array", "\"radius\":", "\"x-radius\":", "JSON_KEY_MISSING", "/tree"},
    {"unknown_key", "\"radius\":", "\"radii\": [], \"radius\":", "JSON_KEY_UNKNOWN", "/tree/radii"},
    {"no_tree", "\"tree\":", "\"x-tree\":", "JSON_KEY_MISSING", ""},
    {"tree_is_array", "\"tree\": {", "\"tree\": [], \"x-tree\": {", "JSON_TYPE", "/tree"},
    {"duplicate_key", "\"isoLevel\": 0.1", "\"isoLevel\": 0.1, \"isoLevel\": 0.1",
     "JSON_DUPLICATE_KEY", "/models/isoLevel"},
    {"duplicate_array", "\"offset\":", "\"offset\": [], \"offset\":", "JSON_DUPLICATE_KEY",
     "/points/offset"},
    {"duplicate_parameter", "\"dark\": true", "\"dark\": true, \"dark\": true",
     "JSON_DUPLICATE_KEY", "/metadata/steps/0/parameters/dark"},
    {"duplicate_ignored_key", "\"tree\": {", "\"x-a\": [{\"b\": 1, \"b\": 2}], \"tree\": {",
     "JSON_DUPLICATE_KEY", "/x-a/0/b"},
    {"array_is_number", "\"isoLevel\": 0.1,\n    \"offset\": [0, 1, 2, 4, 4, 5, 6]",
     "\"isoLevel\": 0.1, \"offset\": 0", "JSON_TYPE", "/models/offset"},
    {"array_is_object", "\"isoLevel\": 0.1,\n    \"offset\": [0, 1, 2, 4, 4, 5, 6]",
     "\"isoLevel\": 0.1, \"offset\": {}", "JSON_TYPE", "/models/offset"},
    {"text_in_array", "[0.1, 0.2,", "[0.1, \"0.2\",", "JSON_TYPE", "/models/width/1"},
    {"null_in_array", "[0.1, 0.2,", "[0.1, null,", "JSON_TYPE", "/models/width/1"},
    {"nesting_in_array", "[0.1, 0.2,", "[0.1, [0.2],", "JSON_TYPE", "/models/width/1"},
    {"object_in_array", "[0.1, 0.2,", "[0.1, {},", "JSON_TYPE", "/models/width/1"},
    {"two_components", "[-1,0.5,0]", "[-1,0.5]", "JSON_TYPE", "/points/position/1/2"},
    {"four_components", "[-1,0.5,0]", "[-1,0.5,0,0]", "JSON_TYPE", "/points/position/1/3"},
    {"flat_positions", "[-1,0.5,0]", "-1", "JSON_TYPE", "/points/position/1"},
    {"deep_positions", "[-1,0.5,0]", "[[-1,0.5,0]]", "JSON_TYPE", "/points/position/1/0"},
    {"real_offset", "[0, 2, 2,", "[0, 2.0, 2,", "JSON_TYPE", "/points/offset/1"},
    {"negative_offset", "[0, 2, 2,", "[0, -2, 2,", "NUMBER_RANGE", "/points/offset/1"},
    {"offset_33_bits", "[0, 2, 2,", "[0, 4294967296, 2,", "NUMBER_RANGE", "/points/offset/1"},
    {"offset_65_bits", "[0, 2, 2,", "[0, 18446744073709551616, 2,", "NUMBER_RANGE",
     "/points/offset/1"},
    {"beyond_float", "[0.1, 0.2,", "[0.1, 3.5e38,", "NUMBER_RANGE", "/models/width/1"},
    {"integer_beyond_int64", "9007199254740993", "9223372036854775808", "NUMBER_RANGE",
     "/metadata/steps/0/parameters/seed"},
    {"integer_beyond_uint64", "9007199254740993", "92233720368547758080", "NUMBER_RANGE",
     "/metadata/steps/0/parameters/seed"},
    {"parameter_array", "\"dark\": true", "\"dark\": []", "JSON_TYPE",
     "/metadata/steps/0/parameters/dark"},
    {"kind", "\"aneurysm\"", "\"vein\"", "ENUM_VALUE", "/tree/branches/2/kind"},
    {"stop_reason", "\"met-branch\"", "\"MetBranch\"", "ENUM_VALUE", "/tree/branches/1/stopReason"},
    {"kernel", "\"cauchy\"", "\"Cauchy\"", "ENUM_VALUE", "/models/kernel"},
    {"count_negative", "\"nodeCount\": 2", "\"nodeCount\": -2", "NUMBER_RANGE",
     "/tree/branches/1/nodeCount"},
    {"count_real", "\"nodeCount\": 2", "\"nodeCount\": 2.0", "JSON_TYPE",
     "/tree/branches/1/nodeCount"},
    {"size_of_two", "[512, 511, 300]", "[512, 511]", "JSON_TYPE", "/metadata/source/size"},
    {"label_number", "\"dome\"", "5", "JSON_TYPE", "/tree/branches/2/label"},
    {"label_zero_escape", "\"dome\"", "\"do\\u0000me\"", "TEXT_CONTROL", "/tree/branches/2/label"},
    {"radius_negative", "\"radius\": [2, 2", "\"radius\": [2, -2", "RADIUS_RANGE",
     "/tree/radius/1"},
    {"missing_point_array", "\"position\":", "\"x-position\":", "JSON_KEY_MISSING", "/points"},
    {"points_null", "\"points\": {", "\"points\": null, \"x-points\": {", "JSON_TYPE", "/points"},
};

INSTANTIATE_TEST_SUITE_P(All, JsonCaseFault, testing::ValuesIn(kFaults),
                         [](const auto& instance) { return std::string(instance.param.name); });

// spec: M49
TEST(JsonSyntax, TakesNoHalfOfASurrogatePairWhereverItStands) {
  const std::string good = encodeJson(test::smallestCase());
  const auto withComment = [&](const std::string& comment) {
    std::string text = good;
    return codeOf(decodeJson(text.insert(text.find("\"tree\""), comment + ", ")));
  };
  EXPECT_EQ(withComment(R"("x-\\udc00": "\ud83d\ude00")"), "OK");
  EXPECT_EQ(withComment(R"("x-\udc00": 1)"), "JSON_SYNTAX");
  EXPECT_EQ(withComment(R"("x-": "\ud83d\u0041")"), "JSON_SYNTAX");
}

// spec: M31
TEST(JsonSyntax, IsStrict) {
  const std::string good = encodeJson(test::smallestCase());
  ASSERT_EQ(codeOf(decodeJson(good)), "OK");
  EXPECT_EQ(codeOf(decodeJson("")), "JSON_SYNTAX");
  EXPECT_EQ(codeOf(decodeJson("\xef\xbb\xbf" + good)), "JSON_SYNTAX");
  EXPECT_EQ(codeOf(decodeJson(good + "x")), "JSON_SYNTAX");
  EXPECT_EQ(codeOf(decodeJson(good + std::string(1, '\0') + "x")), "JSON_SYNTAX");
  for (const char* bad :
       {"NaN", "Infinity", "-inf", "+1", ".5", "1.", "01", "0x1", "1,", "/**/1"}) {
    std::string text = good;
    text.replace(text.find("0.5"), 3, bad);
    EXPECT_EQ(codeOf(decodeJson(text)), "JSON_SYNTAX") << bad;
  }
  for (const char* bad : {"\"\xff\"", "\"\\ud800\"", "\"\n\"", "'a'"}) {
    std::string text = good;
    text.replace(text.find("\"a\""), 3, bad);
    EXPECT_EQ(codeOf(decodeJson(text)), "JSON_SYNTAX") << bad;
  }
}

// spec: M46
TEST(JsonSyntax, TakesNoIntegerWithAPointOrAnExponent) {
  for (const char* one : {"1.0", "1e0", "10e-1"}) {
    EXPECT_EQ(
        codeOf(decodeJson(replaced("\"firstNode\": 0", std::string("\"firstNode\": ") + one))),
        "JSON_TYPE");
    EXPECT_EQ(codeOf(decodeJson(replaced("\"parent\": [-1", std::string("\"parent\": [") + one))),
              "JSON_TYPE");
  }
}

TEST(JsonSyntax, TakesNumbersOfAnySizeInComments) {
  for (const char* number : {"1e400", "-1e99999999999999999999", "123456789012345678901234567890"})
    EXPECT_TRUE(decodeJson(
        replaced("\"format\"", std::string("\"x-a\": [{\"b\": ") + number + "}], \"format\"")));
}

TEST(JsonSyntax, RefusesANumberBeyondADouble) {
  EXPECT_EQ(codeOf(decodeJson(replaced("\"isoLevel\": 0.1", "\"isoLevel\": 1e999"))),
            "NUMBER_RANGE");
  EXPECT_EQ(codeOf(decodeJson(replaced("[0.1, 0.2,", "[0.1, 1e999,"))), "NUMBER_RANGE");
}

TEST(JsonSyntax, IsPlacedByItsByte) {
  const auto result = decodeJson("{\"format\" 5}");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().place(), "byte 10");
}

TEST(JsonSyntax, RefusesEveryTruncation) {
  const std::string text = encodeJson(test::smallestCase());
  for (std::size_t size = 0; size + 2 < text.size(); ++size)  // the last byte is a line end
    ASSERT_FALSE(decodeJson(std::string(text, 0, size))) << size;
}

// spec: M41
TEST(JsonDepth, OfSixtyFourIsAllowedAndNoMore) {
  const auto nested = [](std::size_t depth) {
    return replaced("\"tree\": {", "\"x-deep\": " + std::string(depth, '[') +
                                       std::string(depth, ']') + ", \"tree\": {");
  };
  EXPECT_EQ(codeOf(decodeJson(nested(63))), "OK");
  EXPECT_EQ(codeOf(decodeJson(nested(64))), "JSON_DEPTH");
  EXPECT_EQ(codeOf(decodeJson(std::string(1000000, '['))), "JSON_DEPTH");
  EXPECT_EQ(codeOf(decodeJson(replaced("\"dark\": true", "\"dark\": " + std::string(100000, '[')))),
            "JSON_DEPTH");
}

TEST(Json, SurvivesEveryChangedByte) {
  const std::string text = encodeJson(test::smallestCase());
  std::size_t accepted = 0;
  for (std::size_t at = 0; at < text.size(); ++at)
    for (const char c : {'\0', '"', '9', '-', ']', '{', '\xff'}) {
      std::string changed = text;
      changed[at] = c;
      if (const auto decoded = decodeJson(changed)) {
        ++accepted;
        EXPECT_TRUE(validate(*decoded));
      }
    }
  EXPECT_GT(accepted, 0u);  // a digit for a digit
}

}  // namespace
}  // namespace lumen::formats
