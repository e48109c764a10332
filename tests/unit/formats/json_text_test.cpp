// SPDX-License-Identifier: Apache-2.0
// Our reader of JSON text against another: what it takes, and the byte at which it stops.
#include "formats/json/json_text.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "formats/container/printable.h"
#include "formats/container/utf8.h"
#include "formats/json/json_document.h"
#include "unit/formats/json_samples.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

using nlohmann::json;

// Puts the events together again.
class JsonBuilder final : public JsonEvents {
public:
  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool string(std::string& value) override { return put(value); }
  bool number(std::string_view text, bool) override {
    json value = json::parse(text, nullptr, false);
    tooLarge = tooLarge || value.is_discarded();  // for the other, not for us
    return put(std::move(value));
  }
  bool beginObject() override { return open(json::object()); }
  bool key(std::string& name) override {
    m_keys.back() = name;
    return true;
  }
  bool endObject() override { return close(); }
  bool beginArray() override { return open(json::array()); }
  bool endArray() override { return close(); }
  json root;
  bool tooLarge = false;

private:
  bool open(json value) {
    m_open.push_back(std::move(value));
    m_keys.emplace_back();
    return true;
  }
  bool close() {
    json value = std::move(m_open.back());
    m_open.pop_back();
    m_keys.pop_back();
    return put(std::move(value));
  }
  bool put(json value) {
    if (m_open.empty())
      root = std::move(value);
    else if (m_open.back().is_object())
      m_open.back()[m_keys.back()] = std::move(value);
    else
      m_open.back().push_back(std::move(value));
    return true;
  }
  std::vector<json> m_open;
  std::vector<std::string> m_keys;
};

const char* const kTexts[] = {
    R"({"a": [1, -2.5e-3, 0, -0, 1E+2], "b": {"c": null, "d": [true, false, {}]}, "e": []})",
    "[\"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u00e9\\ud83d\\ude00\", \"\xc3\xa9 \xf0\x9f\x98\x80\", \"\"]",
    " \r\n\t[ 0.5 , [ ] , { \"\" : \"x\" } ] "};

void compare(const std::string& text) {
  JsonBuilder builder;
  const auto fault = readJsonText(text, builder);
  const json other = json::parse(text, nullptr, false);
  // the other takes a zero byte for the end, and a byte order mark
  if (text.find('\0') != std::string::npos || text.starts_with("\xef\xbb\xbf")) return;
  if (builder.tooLarge) return;
  ASSERT_EQ(fault.has_value(), other.is_discarded()) << text;
  if (!fault) {
    ASSERT_EQ(builder.root, other) << text;
  }
}

TEST(JsonText, IsTakenOrNotAsByAnotherReader) {
  std::mt19937 random(3);
  std::string alphabet = "\"\\{}[]:, \n0123456789+-.eEutfnr\x01\x80\xc3\xe2\xff";
  alphabet += '\0';
  for (const std::string text : kTexts) {
    compare(text);
    for (std::size_t i = 0; i < text.size(); ++i) {
      compare(text.substr(0, i));
      for (const char c : alphabet) {
        std::string changed = text;
        changed[i] = c;
        compare(changed);
        changed = text;
        compare(changed.insert(i, 1, c));
      }
      std::string changed = text;
      compare(changed.erase(i, 1));
    }
  }
  for (int round = 0; round < 50000; ++round) {
    std::string text;
    for (std::size_t n = random() % 10; n > 0; --n) text += alphabet[random() % alphabet.size()];
    compare(text);
  }
}

// Up to the byte, the text can be completed to JSON; with it, it cannot.
TEST(JsonText, IsRefusedAtItsFirstByteThatCannotBeRight) {
  const std::pair<const char*, std::size_t> cases[] = {{"{x", 1},
                                                       {"", 0},
                                                       {"[1 2]", 3},
                                                       {"{\"a\" 5}", 5},
                                                       {"{\"a\":1,}", 7},
                                                       {"[1,]", 3},
                                                       {"[01]", 2},
                                                       {"[1.]", 3},
                                                       {"[-]", 2},
                                                       {"[1e]", 3},
                                                       {"tru", 3},
                                                       {"trUe", 2},
                                                       {"[] x", 3},
                                                       {"\"a\nb\"", 2},
                                                       {"\"\xff\"", 1},
                                                       {"\"\\x\"", 1},
                                                       {"\"\\ud800\"", 1},
                                                       {"\"ab", 3},
                                                       {"[", 1},
                                                       {"{\"a\":", 5},
                                                       {"// no\n1", 0},
                                                       {"'a'", 0},
                                                       {"[NaN]", 1},
                                                       {"+1", 0},
                                                       {"\xef\xbb\xbf[]", 0}};
  for (const auto& [text, at] : cases) {
    JsonBuilder builder;
    const auto fault = readJsonText(text, builder);
    ASSERT_TRUE(fault) << text;
    EXPECT_EQ(fault->at, at) << text << ": " << fault->message;
  }
  JsonBuilder builder;
  EXPECT_EQ(readJsonText("{\n  \"a\": }", builder)->message,
            "line 2, column 8: found \"}\", expected a value");
}

JsonDocument numberDocument(std::string_view text) {
  IssueList issues(1);
  return *parseJson(text, 0, "", issues);
}

// spec: M34
TEST(JsonNumber, IsRoundedOnceToTheTypeOfItsField) {
  EXPECT_EQ(floatFromText("1.000000059604644775390625"), 1.0f);  // a tie: to even
  EXPECT_EQ(floatFromText("1.000000059604644775390626"), 0x1.000002p0f);
  const JsonDocument tie = numberDocument("1.0000000596046447753906250000001");
  EXPECT_EQ(tie.root().number()->asFloat(), 0x1.000002p0f);  // a double would have made it the tie
  EXPECT_EQ(tie.root().number()->asDouble(), 0x1.000001p0);
  EXPECT_EQ(floatFromText("3.4028235677973366e38"), std::numeric_limits<float>::max());
  EXPECT_FALSE(floatFromText("3.4028235677973367e38"));
  EXPECT_FALSE(floatFromText("-1e39"));
  EXPECT_EQ(floatFromText("1e-999999999999999999999"), 0.0f);
  EXPECT_TRUE(std::signbit(*floatFromText("-1e-60")));
  EXPECT_EQ(doubleFromText("0.0000001e310"), 1e303);
  EXPECT_FALSE(doubleFromText("1e99999999999999999999"));
  EXPECT_FALSE(doubleFromText("1" + std::string(400, '0')));
  EXPECT_EQ(doubleFromText("0." + std::string(400, '0') + "1e401"), 1.0);
  EXPECT_EQ(doubleFromText("0e999"), 0.0);
}

TEST(JsonNumber, OfAnySizeIsARealAndFitsAnIntegerOrNot) {
  const JsonDocument two63 = numberDocument("9223372036854775808");
  const JsonNumber large = *two63.root().number();
  EXPECT_EQ(large.asDouble(), 0x1p63);
  EXPECT_FALSE(large.asInteger<std::int64_t>());
  EXPECT_EQ(large.asInteger<std::uint64_t>(), std::uint64_t{1} << 63);
  const auto unsignedOf = [](const char* text) {
    return numberDocument(text).root().number()->asInteger<std::uint64_t>();
  };
  EXPECT_FALSE(unsignedOf("18446744073709551616"));
  EXPECT_FALSE(unsignedOf("-1"));
  EXPECT_FALSE(unsignedOf("1.0"));
  EXPECT_EQ(unsignedOf("-0"), 0u);
  const JsonDocument beyond = numberDocument("1e400");
  EXPECT_FALSE(beyond.root().number()->isWhole());
  EXPECT_FALSE(beyond.root().number()->asDouble());
  EXPECT_EQ(beyond.root().number()->shown(), "1e400");
  EXPECT_STREQ(beyond.root().kind(), "number");
}

TEST(JsonNumber, OfEveryWriterIsTheNearestValueOfItsType) {
  for (const auto& [text, value] : lumen::test::jsonSamples(INFINITY)) {
    const JsonDocument document = numberDocument(text);
    const auto number = document.root().number();
    ASSERT_TRUE(number) << text;
    EXPECT_EQ(number->asDouble(), value) << text;
    const float nearest = std::strtof(text.c_str(), nullptr);
    EXPECT_EQ(number->asFloat(), std::isfinite(nearest) ? std::optional(nearest) : std::nullopt)
        << text;
  }
}

TEST(JsonNumber, OfALongArrayIsTheNearestFloat) {
  const auto samples = lumen::test::jsonSamples(std::numeric_limits<float>::max());
  std::string text = "{\"tree\":{\"radius\":[0";
  for (const auto& sample : samples) text += "," + sample.text;
  std::vector<float> radii;
  ArraySlots slots;
  slots.byPointer["/tree/radius"] = {&radii};
  IssueList issues(1);
  ASSERT_TRUE(parseJson(text + "]}}", 0, "", slots, issues));
  ASSERT_EQ(radii.size(), samples.size() + 1);
  for (std::size_t i = 0; i < samples.size(); ++i)
    EXPECT_EQ(radii[i + 1], std::strtof(samples[i].text.c_str(), nullptr)) << samples[i].text;
}

TEST(Printable, LeavesOrdinaryTextAlone) {
  for (const std::string text :
       {"", "aneurysm 3", "A. carotis interna \xe2\x80\x93 links",
        "\xe8\x84\x91\xe5\x8a\xa8\xe8\x84\x89", "\xd8\xb4\xd8\xb1\xd9\x8a\xd8\xa7\xd9\x86",
        "C:\\data\\x.lumen", "\xf0\x9f\xa7\xa0"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesEveryControlCharacter) {
  EXPECT_EQ(printable("a\nvalid: b"), "a\\u000avalid: b");
  EXPECT_EQ(printable(std::string("\0\x1b[2J\x7f", 6)), "\\u0000\\u001b[2J\\u007f");
  EXPECT_EQ(printable("\xc2\x85\xc2\x9b"), "\\u0085\\u009b");
}

TEST(Printable, EscapesWhatTurnsHidesOrBreaksTheLine) {
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "dilav"),
            "\\u202edilav");                                             // override
  EXPECT_EQ(printable("\xe2\x81\xa6x\xe2\x81\xa9"), "\\u2066x\\u2069");  // isolate
  EXPECT_EQ(printable("a\xe2\x80\x8b"
                      "b\xef\xbb\xbf"),
            "a\\u200bb\\ufeff");  // zero width
  EXPECT_EQ(printable("a\xe2\x80\xa8"
                      "b\xe2\x80\xa9"),
            "a\\u2028b\\u2029");                            // separators
  EXPECT_EQ(printable("\xf3\xa0\x81\x81"), "\\U000e0041");  // tag
}

TEST(Printable, EscapesBytesThatAreNotUtf8OneByOne) {
  EXPECT_EQ(printable("a\xff"
                      "b"),
            "a\\xffb");
  EXPECT_EQ(printable("\xc3"), "\\xc3");
  EXPECT_EQ(printable("\xe2\x82\n"), "\\xe2\\x82\\u000a");  // what follows is not swallowed
  EXPECT_EQ(printable("\xe2\x82\xc3\xa9"), "\\xe2\\x82\xc3\xa9");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(printable("\xc0\x8a"), "\\xc0\\x8a");           // an overlong newline
  EXPECT_EQ(printable("\x9b"), "\\x9b");
}

TEST(Printable, GivesOneLineOfUtf8ForAnyBytesAndTheSameWhenRepeated) {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    std::string text;
    for (std::size_t length = random() % 24; length > 0; --length)
      text +=
          static_cast<char>(random() % (round % 2 == 0 ? 256 : 48) + (round % 2 == 0 ? 0 : 176));
    const std::string out = printable(text);
    for (std::size_t at = 0; at < out.size();) {
      const std::uint32_t point = nextCodePoint(out, at);
      ASSERT_NE(point, kIllFormed);
      ASSERT_FALSE(isControl(point));
      ASSERT_FALSE(point >= 0x2028 && point <= 0x202e);
    }
    ASSERT_EQ(printable(out), out);
  }
}

}  // namespace
}  // namespace lumen::formats
