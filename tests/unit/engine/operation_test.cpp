// SPDX-License-Identifier: Apache-2.0
// Settings of a command hold for the operations within it; operations apart from it leave their end.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "converters/base/error.h"
#include "converters/engine/file_access.h"
#include "converters/engine/operation_process.h"
#include "converters/engine/prepare_case.h"
#include "converters/operations/case_of.h"

namespace lumen::engine {

namespace {

namespace fs = std::filesystem;

/// Findings of the last run of NotingCommand.
struct Notes {
  std::optional<RunSettings> settings;
};

/// A command in place of lumen view: writes its output, warns, and notes its settings.
class NotingCommand : public Command {
public:
  explicit NotingCommand(Notes& notes) : m_notes(notes) {}
  [[nodiscard]] std::string name() const override { return "view"; }
  [[nodiscard]] std::string summary() const override { return ""; }
  [[nodiscard]] std::string example() const override { return ""; }
  void addRows(OptionTable& table) override {
    table.argument("FILE", &m_case, "");
    table.file("html", m_page, "");
  }
  Answer run(const RunContext& context) override {
    m_notes.settings = context;
    context.progress.warn("a vessel ends");
    std::ofstream(m_page) << m_case;
    return {Json{{"page", m_page}}, "", 0};
  }

private:
  Notes& m_notes;
  std::string m_case, m_page;
};

class OperationTest : public testing::Test {
protected:
  OperationTest() {
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
    m_engine.add([this] { return std::make_unique<NotingCommand>(m_notes); });
    std::ofstream(m_case) << "a case";
  }

  [[nodiscard]] Operation view() const {
    return Operation{"view", {m_case.string()}, {}}.with("html", m_page.string());
  }
  static std::string read(const fs::path& name) {
    std::ifstream file(name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::string log() const { return read(m_log); }
  /// Writes a case of a straight vessel with models.
  void writeVessel() {
    operations::Source source;
    source.centerline.emplace();
    for (int z = 0; z <= 10; ++z)
      source.centerline->file.points.push_back({{0, 0, double(z)}, 1, z - 1});
    source.centerline->file.unit = 1;
    source.centerline->file.axes = convert::CenterlineAxes::Lps;
    operations::CaseOptions options;
    options.models.emplace();
    const operations::MadeCase made =
        operations::caseOf(std::move(source), options, operationContext(m_progress));
    writeCase(made.value, m_case, formats::CaseEncoding::Binary, {});
  }

  fs::path m_folder = fs::path(testing::TempDir()) / "operation_test";
  fs::path m_case = m_folder / "a.lumen", m_log = m_folder / "log.txt";
  fs::path m_page = m_folder / "page.html";
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
  writeVessel();
  CaseWishes wishes;
  wishes.id = "siphon-01";
  wishes.replace = true;
  wishes.surface = false;
  wishes.viewer = true;
  convert::CaseAbout about;
  about.licence = "CC-BY-4.0";
  about.synthetic = true;
  const convert::IncomingCase incoming =
      prepareCase(m_case, about, wishes, m_folder / "library", m_context);
  EXPECT_TRUE(read(incoming.folder() / "view.html").ends_with("/siphon-01.lumen"));
  ASSERT_TRUE(m_notes.settings);
  EXPECT_EQ(m_notes.settings->threads, 3);
  EXPECT_TRUE(m_notes.settings->strict);
  EXPECT_EQ(m_notes.settings->program, "/bin/false");
  m_notes.settings->answerEarly({{}, "early"});
  EXPECT_EQ(answered, "early");
}

TEST_F(OperationTest, AReportPageIsThatOfLumenReportAndNeedsNoCommand) {
  writeVessel();
  convert::IncomingCase incoming(m_folder / "library");
  incoming.record.id = "siphon-01";
  incoming.record.about.title = "A siphon";
  addReportPage(m_case, incoming, m_context);
  ASSERT_EQ(incoming.record.files.size(), 1U);
  EXPECT_EQ(incoming.record.files[0].role, "report");
  const fs::path named = m_folder / "siphon-01.lumen";
  fs::rename(m_case, named);
  const Engine engine = makeEngine();
  (void)engine.run(
      Operation{"report", {named.string(), m_page.string()}, {}}.with("title", "A siphon"),
      RunContext(engine, m_progress));
  EXPECT_NE(read(m_page).find("A siphon"), std::string::npos);
  EXPECT_TRUE(read(incoming.folder() / "report.html") == read(m_page));
}

TEST_F(OperationTest, WithoutAProgramItRunsInThisProcess) {
  m_context.threads = 1;
  const OperationEnd end = runApart(view(), m_context, m_log);
  EXPECT_TRUE(end.isDone) << end.error;
  EXPECT_EQ(end.warnings, 1U);
  EXPECT_EQ(Json::parse(end.answer)["page"], m_page.string());
  EXPECT_EQ(log(), "warning: a vessel ends\n");
}

TEST_F(OperationTest, AFailureInThisProcessIsItsEnd) {
  const OperationEnd end = runApart(view().with("colour", "red"), m_context, m_log);
  EXPECT_FALSE(end.isDone);
  EXPECT_EQ(end.code, 2);
  EXPECT_NE(end.error.find("colour"), std::string::npos) << end.error;
  EXPECT_EQ(log(), "error: " + end.error + "\n");
}

TEST_F(OperationTest, AWarningInThisProcessIsAnErrorIfStrict) {
  m_context.strict = true;
  EXPECT_EQ(runApart(view(), m_context, m_log).code, 3);
}

TEST_F(OperationTest, ItStopsInThisProcessWithTheCommandAroundIt) {
  m_progress.cancel();
  try {
    (void)runApart(view(), m_context, m_log);
    FAIL() << "it went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Cancelled);
  }
}

TEST_F(OperationTest, TheFileOfAnOperationLeavesItsEndBesideIt) {
  const fs::path file = m_folder / "a.json";
  std::ofstream(file) << R"({"name": "view", "arguments": [")" + m_case.string() +
                             R"("], "options": [["html", [")" + m_page.string() +
                             R"("]]], "threads": 2, "strict": true})";
  EXPECT_EQ(operationSettings(file).threads, 2);
  EXPECT_TRUE(operationSettings(file).strict);
  EXPECT_EQ(runOperationFile(file, m_context), 0);
  std::ifstream left(file.string() + ".end");
  EXPECT_EQ(Json::parse(left)["warnings"], 1);
}

TEST_F(OperationTest, AnOptionWithoutValuesInTheFileOfAnOperationIsRefused) {
  const fs::path file = m_folder / "b.json";
  std::ofstream(file) << R"({"name": "view", "arguments": [], "options": [["html"]]})";
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
