// SPDX-License-Identifier: Apache-2.0
// Settings of a command hold for the operations within it; operations apart from it leave their end.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/engine/operation_process.h"
#include "converters/engine/prepare_case.h"

namespace lumen::engine {

namespace {

namespace fs = std::filesystem;

/// Findings of the last run of NotingCommand.
struct Notes {
  std::optional<RunSettings> settings;
};

/// A command in place of lumen report: writes its output, warns, and notes its settings.
class NotingCommand : public Command {
public:
  explicit NotingCommand(Notes& notes) : m_notes(notes) {}
  [[nodiscard]] std::string name() const override { return "report"; }
  [[nodiscard]] std::string summary() const override { return ""; }
  [[nodiscard]] std::string example() const override { return ""; }
  void addRows(OptionTable& table) override {
    table.argument("CASE", &m_case, "");
    table.argument("HTML", &m_page, "");
    table.add("title", &m_title, "TEXT", "");
  }
  Answer run(const RunContext& context) override {
    m_notes.settings = context;
    context.progress.warn("a vessel ends");
    std::ofstream(m_page) << m_title;
    return {Json{{"page", m_page}}, "", 0};
  }

private:
  Notes& m_notes;
  std::string m_case, m_page, m_title;
};

class OperationTest : public testing::Test {
protected:
  OperationTest() {
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
    m_engine.add([this] { return std::make_unique<NotingCommand>(m_notes); });
    std::ofstream(m_case) << "a case";
  }

  [[nodiscard]] Operation report() const {
    return Operation{"report", {m_case.string(), (m_folder / "page.html").string()}, {}};
  }
  [[nodiscard]] std::string log() const {
    std::ifstream file(m_log);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path m_folder = fs::path(testing::TempDir()) / "operation_test";
  fs::path m_case = m_folder / "a.lumen", m_log = m_folder / "log.txt";
  Notes m_notes;
  Engine m_engine;
  Progress m_progress;
  RunContext m_context{m_engine, m_progress};
};

TEST_F(OperationTest, APageWithinACommandIsMadeWithItsSettings) {
  std::string answered;
  m_context.threads = 3;
  m_context.strict = true;
  m_context.program = "/bin/false";
  m_context.answerEarly = [&](const Answer& answer) { answered = answer.text; };
  convert::IncomingCase incoming(m_folder / "library");
  incoming.record.id = "a";
  addReportPage(m_case, incoming, m_context);
  ASSERT_TRUE(m_notes.settings);
  EXPECT_EQ(m_notes.settings->threads, 3);
  EXPECT_TRUE(m_notes.settings->strict);
  EXPECT_EQ(m_notes.settings->program, "/bin/false");
  m_notes.settings->answerEarly({{}, "early"});
  EXPECT_EQ(answered, "early");
}

TEST_F(OperationTest, WithoutAProgramItRunsInThisProcess) {
  m_context.threads = 1;
  const OperationEnd end = runApart(report().with("title", "A"), m_context, m_log);
  EXPECT_TRUE(end.isDone) << end.error;
  EXPECT_EQ(end.warnings, 1U);
  EXPECT_EQ(Json::parse(end.answer)["page"], (m_folder / "page.html").string());
  EXPECT_EQ(log(), "warning: a vessel ends\n");
}

TEST_F(OperationTest, AFailureInThisProcessIsItsEnd) {
  const OperationEnd end = runApart(report().with("colour", "red"), m_context, m_log);
  EXPECT_FALSE(end.isDone);
  EXPECT_EQ(end.code, 2);
  EXPECT_NE(end.error.find("colour"), std::string::npos) << end.error;
  EXPECT_EQ(log(), "error: " + end.error + "\n");
}

TEST_F(OperationTest, AWarningInThisProcessIsAnErrorIfStrict) {
  m_context.strict = true;
  EXPECT_EQ(runApart(report(), m_context, m_log).code, 3);
}

TEST_F(OperationTest, ItStopsInThisProcessWithTheCommandAroundIt) {
  m_progress.cancel();
  try {
    (void)runApart(report(), m_context, m_log);
    FAIL() << "it went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Cancelled);
  }
}

TEST_F(OperationTest, TheFileOfAnOperationLeavesItsEndBesideIt) {
  const fs::path file = m_folder / "a.json";
  std::ofstream(file) << R"({"name": "report", "arguments": [")" + m_case.string() + "\", \"" +
                             (m_folder / "page.html").string() +
                             R"("], "options": [["title", ["A"]]], "threads": 2, "strict": true})";
  EXPECT_EQ(operationSettings(file).threads, 2);
  EXPECT_TRUE(operationSettings(file).strict);
  EXPECT_EQ(runOperationFile(file, m_context), 0);
  std::ifstream left(file.string() + ".end");
  EXPECT_EQ(Json::parse(left)["warnings"], 1);
}

TEST_F(OperationTest, AnOptionWithoutValuesInTheFileOfAnOperationIsRefused) {
  const fs::path file = m_folder / "b.json";
  std::ofstream(file) << R"({"name": "report", "arguments": [], "options": [["title"]]})";
  try {
    (void)runOperationFile(file, m_context);
    FAIL() << "it was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InvalidInput);
    EXPECT_NE(std::string(error.what()).find("expected a name and the list of its values"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace

}  // namespace lumen::engine
