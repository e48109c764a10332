// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/operation_process.h"

#include <system_error>

#include "converters/base/error.h"
#include "converters/base/run_program.h"
#include "converters/engine/file_access.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kLongest = 7 * 24 * 3600;  // s: an operation that runs for a week hangs

Json encoded(const Operation& operation, const ProcessOptions& options) {
  Json json{{"name", operation.name}, {"arguments", operation.arguments}};
  json["options"] = Json::array();
  for (const auto& [name, values] : operation.options) json["options"].push_back({name, values});
  json["threads"] = options.threads;
  json["strict"] = options.strict;
  return json;
}

Operation decoded(const Json& json) {
  Operation operation{json.at("name"), json.at("arguments"), {}};
  for (const Json& option : json.at("options"))
    operation.options.emplace_back(option.at(0), option.at(1));
  return operation;
}

fs::path endFile(const fs::path& operationFile) {
  return operationFile.string() + ".end";
}

std::string endText(const convert::ProgramResult& result) {
  switch (result.end) {
    case convert::ProgramEnd::Crashed:
      return "crashed, or was ended for want of memory";
    case convert::ProgramEnd::TookTooLong:
      return "did not end within a week";
    default:
      return "ended with exit code " + std::to_string(result.code);
  }
}

Json operationJson(const fs::path& file) {
  Json json = Json::parse(readText(file, "operation"), nullptr, false);
  if (!json.is_object() || !json.contains("options"))
    throw invalidInput(file.string() + ": this is no operation of lumen library build");
  return json;
}

/// Passes all on, and counts warnings.
class CountingProgress : public Progress {
public:
  explicit CountingProgress(Progress& shown) : m_shown(shown) {}
  void begin(std::string_view stage, std::size_t total) override { m_shown.begin(stage, total); }
  void advance(std::size_t units) override { m_shown.advance(units); }
  void end() override { m_shown.end(); }
  void detail(std::string_view message) override { m_shown.detail(message); }
  void warn(std::string_view message) override {
    ++m_warnings;
    m_shown.warn(message);
  }
  [[nodiscard]] std::size_t warnings() const { return m_warnings; }

private:
  Progress& m_shown;
  std::size_t m_warnings = 0;
};

}  // namespace

OperationEnd runInProcess(const Operation& operation, const ProcessOptions& options,
                          const fs::path& log, const Progress& progress) {
  const fs::path file = log.string() + ".operation.json";
  writeText(encoded(operation, options).dump(), file);
  std::error_code ignored;
  fs::remove(endFile(file), ignored);
  convert::ProgramCall call;
  call.program = fs::read_symlink("/proc/self/exe");
  call.arguments = {kOperationWord, file.string()};
  call.folder = fs::current_path();
  call.seconds = kLongest;
  call.log = log;
  const convert::ProgramResult result = convert::runProgram(call, progress);
  OperationEnd end;
  end.isDone = result.end == convert::ProgramEnd::Done;
  end.code = result.code;
  if (!end.isDone) end.error = endText(result);
  if (fs::exists(endFile(file), ignored)) {
    const Json json = Json::parse(readText(endFile(file), "end of an operation"));
    end.warnings = json.at("warnings");
    if (const std::string error = json.at("error"); !error.empty()) end.error = error;
  }
  fs::remove(endFile(file), ignored);
  fs::remove(file, ignored);
  return end;
}

ProcessOptions operationOptions(const fs::path& file) {
  const Json json = operationJson(file);
  return {json.at("threads"), json.at("strict")};
}

int runOperationFile(const fs::path& file, const Engine& engine, Surroundings& around) {
  const Json json = operationJson(file);
  CountingProgress counting(around.progress);
  Surroundings own{engine, counting};
  own.threads = around.threads;
  own.strict = around.strict;
  own.willWrite = around.willWrite;
  const auto leaveEnd = [&](const std::string& error) {
    writeText(Json{{"error", error}, {"warnings", counting.warnings()}}.dump(), endFile(file));
  };
  try {
    const Answer answer = engine.run(decoded(json), own);
    leaveEnd("");
    return answer.code;
  } catch (const Error& error) {
    leaveEnd(error.what());
    throw;
  }
}

}  // namespace lumen::engine
