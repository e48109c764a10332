// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/operation_process.h"

#include <system_error>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/relayed_progress.h"
#include "converters/base/run_program.h"
#include "converters/engine/file_access.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kLongestRun = 7 * 24 * 3600;  // s: an operation that runs for a week hangs

Json encoded(const Operation& operation, const ProcessOptions& options) {
  Json json{{"name", operation.name}, {"arguments", operation.arguments}};
  json["options"] = Json::array();
  for (const auto& [name, values] : operation.options) json["options"].push_back({name, values});
  json["threads"] = options.threads;
  json["strict"] = options.strict;
  return json;
}

std::vector<std::string> textsIn(const convert::JsonPlace& list) {
  std::vector<std::string> texts;
  for (const convert::JsonPlace& one : list.elements()) texts.push_back(one.text());
  return texts;
}

Operation decoded(const convert::JsonPlace& json) {
  Operation operation{json.at("name").text(), textsIn(json.at("arguments")), {}};
  for (const convert::JsonPlace& option : json.at("options").elements()) {
    const std::vector<convert::JsonPlace> pair = option.elements();
    operation.options.emplace_back(pair.at(0).text(), textsIn(pair.at(1)));
  }
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

convert::JsonFile operationJson(const fs::path& file) {
  return convert::JsonFile(readWholeFile(file, "operation"), file);
}

}  // namespace

fs::path thisProgram() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  if (program.filename().string().starts_with("ld-linux"))
    return (program.parent_path() / "../bin/lumen").lexically_normal();
  return program;
}

OperationEnd runInProcess(const Operation& operation, const ProcessOptions& options,
                          const fs::path& log, const Progress& progress) {
  const fs::path file = log.string() + ".operation.json";
  writeText(encoded(operation, options).dump(-1, ' ', false, Json::error_handler_t::replace), file);
  std::error_code ignored;
  fs::remove(endFile(file), ignored);
  convert::ProgramCall call;
  call.program = thisProgram();
  call.arguments = {kOperationWord, file.string()};
  call.folder = fs::current_path();
  call.seconds = kLongestRun;
  call.log = log;
  const convert::ProgramResult result = convert::runProgram(call, progress);
  OperationEnd end;
  end.isDone = result.end == convert::ProgramEnd::Done;
  end.code = result.code;
  if (!end.isDone) end.error = endText(result);
  if (fs::exists(endFile(file), ignored)) {
    convert::JsonFile left(readWholeFile(endFile(file), "end of an operation"), endFile(file));
    const convert::JsonPlace json(left);
    end.warnings = static_cast<std::size_t>(json.at("warnings").number());
    if (const std::string& error = json.at("error").text(); !error.empty()) end.error = error;
    end.answer = json.at("answer").text();
  }
  fs::remove(endFile(file), ignored);
  fs::remove(file, ignored);
  return end;
}

ProcessOptions operationOptions(const fs::path& file) {
  convert::JsonFile given = operationJson(file);
  const convert::JsonPlace json(given);
  return {static_cast<int>(json.at("threads").number()), json.at("strict").boolean()};
}

int runOperationFile(const fs::path& file, const Engine& engine, Surroundings& around) {
  convert::JsonFile given = operationJson(file);
  CountingProgress counting(around.progress);
  Surroundings own{engine, counting};
  own.threads = around.threads;
  own.strict = around.strict;
  own.mayFetch = false;  // a file states the operation, and no person
  const auto leaveEnd = [&](const std::string& error, const std::string& answer) {
    writeText(Json{{"error", error}, {"warnings", counting.warnings()}, {"answer", answer}}.dump(
                  -1, ' ', false, Json::error_handler_t::replace),
              endFile(file));
  };
  try {
    const Answer answer = engine.run(decoded(convert::JsonPlace(given)), own);
    leaveEnd("", answer.json.is_null()
                     ? ""
                     : answer.json.dump(-1, ' ', false, Json::error_handler_t::replace));
    return answer.code;
  } catch (const Error& error) {
    leaveEnd(error.what(), "");
    throw;
  }
}

}  // namespace lumen::engine
