// SPDX-License-Identifier: Apache-2.0
#include "converters/base/options/option_table.h"

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen {

namespace {

enum class Shape { Round, Flat };
const std::map<std::string, Shape> kShapes = {{"flat", Shape::Flat}, {"round", Shape::Round}};

struct Values {
  bool dark = false;
  int rays = 162;
  std::uint64_t seed = 1;
  double rate = 0.7;
  std::optional<double> blur;
  std::vector<int> crop;
  std::vector<std::string> files;
  Shape shape = Shape::Round;
};

class OptionTableTest : public ::testing::Test {
protected:
  void SetUp() override {
    m_table.flag("dark", m_values.dark, "Dark").recorded();
    m_table.add("rays", &m_values.rays, "N", "Rays").among({12, 42, 162}).recorded();
    m_table.add("seed", &m_values.seed, "K", "Seed")
        .in(WholeRange{0, 1000})
        .recorded("random-seed");
    m_table.add("rate", &m_values.rate, "SHARE", "Rate").in(NumberRange{0, 1, true}).recorded();
    m_table.scaled("blur", m_values.blur, "Blur", "measured").recorded();
    OptionRow& crop = m_table.add("crop", &m_values.crop, "I,J", "Box");
    crop.count = 2;
    crop.delimiter = ',';
    m_table.add("file", &m_values.files, "FILE", "File").checkedBy(fileName()).many();
    m_table.choice("shape", m_values.shape, kShapes, "Shape").alsoCalled("form").recorded();
  }

  std::string refusal(const std::string& name, const std::string& text) {
    try {
      m_table.set(name, {text});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Usage);
      return error.what();
    }
    return "";
  }

  Values m_values;
  OptionTable m_table;
};

}  // namespace

TEST(FileNameTest, AnAddressIsNone) {
  for (const char* text : {"https://example.org/a.nrrd", "s3://bucket/a.nrrd", "HTTP://a/b"})
    EXPECT_TRUE(fileName()(text).starts_with("found an address, expected the name of a file"))
        << text;
  for (const char* text : {"a.nrrd", "/a/b.nrrd", "./https://a/b", "a:/b", "://a"})
    EXPECT_EQ(fileName()(text), "") << text;
}

TEST_F(OptionTableTest, ARowStoresAValueOfItsType) {
  m_table.set("dark", {"true"});
  m_table.set("rays", {"42"});
  m_table.set("seed", {"+12"});
  m_table.set("rate", {"0.25"});
  m_table.set("blur", {"1.5"});
  m_table.set("crop", {"3,4"});
  m_table.set("file", {"a", "b"});
  m_table.set("shape", {"flat"});
  EXPECT_TRUE(m_values.dark);
  EXPECT_EQ(m_values.rays, 42);
  EXPECT_EQ(m_values.seed, 12U);
  EXPECT_EQ(m_values.rate, 0.25);
  EXPECT_EQ(m_values.blur, 1.5);
  EXPECT_EQ(m_values.crop, (std::vector<int>{3, 4}));
  EXPECT_EQ(m_values.files, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(m_values.shape, Shape::Flat);
}

TEST_F(OptionTableTest, ARefusalSaysWhatWasFoundAndWhatIsExpected) {
  EXPECT_EQ(refusal("rays", "13"), "--rays: found 13, expected 12, 42 or 162");
  EXPECT_EQ(refusal("rate", "0"), "--rate: found 0, expected a number above 0 and at most 1");
  EXPECT_EQ(refusal("rate", "nan"), "--rate: found nan, expected a number above 0 and at most 1");
  EXPECT_EQ(refusal("seed", "1001"), "--seed: found 1001, expected a whole number from 0 to 1000");
  EXPECT_EQ(refusal("seed", ""), "--seed: found nothing, expected a whole number from 0 to 1000");
  EXPECT_EQ(refusal("crop", "3"), "--crop: found 1 value, expected I,J");
  EXPECT_EQ(refusal("shape", "falt"),
            "--shape: found falt, expected flat or round; did you mean flat?");
  EXPECT_EQ(refusal("dark", "perhaps"), "--dark: found perhaps, expected true or false");
  EXPECT_EQ(refusal("rates", "1"), "--rates: there is no such option; did you mean --rate?");
}

TEST_F(OptionTableTest, AnAliasFindsItsRowAndAnArgumentIsNoOption) {
  std::string file;
  m_table.argument("CASE", &file, "Case");
  EXPECT_EQ(m_table.find("form"), m_table.find("shape"));
  EXPECT_EQ(m_table.find("CASE"), nullptr);
}

TEST_F(OptionTableTest, TheDefaultIsTheValueOfTheVariable) {
  EXPECT_EQ(m_table.find("rays")->defaultText, "162");
  EXPECT_EQ(m_table.find("rate")->defaultText, "0.7");
  EXPECT_EQ(m_table.find("shape")->defaultText, "round");
  EXPECT_EQ(m_table.find("blur")->defaultText, "");
}

TEST_F(OptionTableTest, RecordedValuesAreThoseThatAreSet) {
  using formats::ParameterValue;
  m_values.shape = Shape::Flat;
  const std::map<std::string, ParameterValue> expected = {{"dark", false},
                                                          {"rays", std::int64_t{162}},
                                                          {"random-seed", std::int64_t{1}},
                                                          {"rate", 0.7},
                                                          {"shape", std::string("flat")}};
  EXPECT_EQ(m_table.recordedValues(), expected);
}

TEST_F(OptionTableTest, RecordedValuesAreTakenBackAndOthersPassedOver) {
  formats::Step step;
  step.parameters = {{"rays", std::int64_t{12}},
                     {"rate", std::int64_t{1}},
                     {"blur", 2.5},
                     {"random-seed", std::string("one")},
                     {"shape", std::string("flat")},
                     {"dark", std::int64_t{1}}};
  m_table.takeRecorded(step);
  EXPECT_EQ(m_values.rays, 12);
  EXPECT_EQ(m_values.rate, 1.0);
  EXPECT_EQ(m_values.blur, 2.5);
  EXPECT_EQ(m_values.seed, 1U);
  EXPECT_EQ(m_values.shape, Shape::Flat);
  EXPECT_FALSE(m_values.dark);
}

TEST_F(OptionTableTest, VariablesOutOfRangeAreReportedByName) {
  m_values.rays = 13;
  try {
    m_table.requireValues("tracking: ");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_STREQ(error.what(), "tracking: rays: found 13, expected 12, 42 or 162");
  }
}

}  // namespace lumen
