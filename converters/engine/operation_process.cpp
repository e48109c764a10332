// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/operation_process.h"

#include <fstream>
#include <mutex>
#include <system_error>

#include <tbb/task_arena.h>

#include "converters/base/error.h"
#include "converters/base/files.h"
#include "converters/base/json_place.h"
#include "converters/base/relayed_progress.h"
#include "converters/base/run_program.h"
#include "converters/base/shown_text.h"
#include "converters/engine/file_access.h"

namespace lumen::engine {

namespace fs = std::filesystem;

namespace {

constexpr unsigned kLongestRun = 7 * 24 * 3600;  // s: an operation that runs for a week hangs

/// As the file of an operation states it; bytes that are no UTF-8 are replaced.
std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json encoded(const Operation& operation, const RunSettings& settings) {
  Json json{{"name", operation.name}, {"arguments", operation.arguments}};
  json["options"] = Json::array();
  for (const auto& [name, values] : operation.options) json["options"].push_back({name, values});
  json["threads"] = settings.threads;
  json["strict"] = settings.strict;
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
    if (pair.size() != 2) option.refuse("a name and the list of its values");
    operation.options.emplace_back(pair[0].text(), textsIn(pair[1]));
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

/// Messages of an operation in this process, appended to its log.
class LogProgress : public QuietProgress {
public:
  LogProgress(const Progress& asked, const fs::path& log, bool strict)
      : QuietProgress(asked), m_log(log, std::ios::app), m_strict(strict) {
    if (!m_log) throw failed(log.string() + ": cannot be written");
  }
  void warn(std::string_view message) override {
    if (m_strict)
      throw invalidInput(std::string(message) + " (a warning, which strict makes an error)");
    write("warning: " + std::string(message));
  }
  void write(const std::string& line) {
    const std::lock_guard lock(m_mutex);
    m_log << messageText(line) << std::endl;
  }

private:
  std::mutex m_mutex;
  std::ofstream m_log;
  bool m_strict;
};

/// Runs the operation in this process. An Error is an end, too.
OperationEnd runHere(const Operation& operation, const RunContext& context) {
  CountingProgress counting(context.progress);
  OperationEnd end;
  try {
    const Answer answer = context.engine.run(operation, context.within(counting));
    end.code = answer.code;
    if (!answer.json.is_null()) end.answer = dumped(answer.json);
  } catch (const Error& error) {
    end.code = static_cast<int>(error.kind());
    end.error = error.what();
  }
  end.warnings = counting.warnings();
  return end;
}

OperationEnd runLogged(const Operation& operation, const RunContext& context, const fs::path& log) {
  LogProgress logged(context.progress, log, context.strict);
  OperationEnd end;
  const int most = context.threads > 0 ? context.threads : tbb::this_task_arena::max_concurrency();
  tbb::task_arena(most).execute([&] { end = runHere(operation, context.within(logged)); });
  context.progress.check();
  end.isDone = end.code == 0;
  if (!end.error.empty()) logged.write("error: " + end.error);
  if (!end.isDone && end.error.empty())
    end.error = endText({convert::ProgramEnd::Refused, end.code, {}, {}});
  return end;
}

/// Takes what the process left beside the file of its operation.
void takeLeft(const fs::path& file, OperationEnd& end) {
  std::error_code ignored;
  if (!fs::exists(endFile(file), ignored)) return;
  convert::JsonFile left(readWholeFile(endFile(file), "end of an operation"), endFile(file));
  const convert::JsonPlace json(left);
  end.warnings = static_cast<std::size_t>(json.at("warnings").number());
  if (const std::string& error = json.at("error").text(); !error.empty()) end.error = error;
  end.answer = json.at("answer").text();
}

}  // namespace

OperationEnd runApart(const Operation& operation, const RunContext& context, const fs::path& log) {
  if (context.program.empty()) return runLogged(operation, context, log);
  const fs::path file = log.string() + ".operation.json";
  writeText(dumped(encoded(operation, context)), file);
  std::error_code ignored;
  fs::remove(endFile(file), ignored);
  convert::ProgramCall call;
  call.program = context.program;
  call.arguments = {kOperationWord, file.string()};
  call.folder = fs::current_path();
  call.seconds = kLongestRun;
  call.log = log;
  const convert::ProgramResult result = convert::runProgram(call, context.progress);
  OperationEnd end;
  end.isDone = result.end == convert::ProgramEnd::Done;
  end.code = result.code;
  if (!end.isDone) end.error = endText(result);
  takeLeft(file, end);
  fs::remove(endFile(file), ignored);
  fs::remove(file, ignored);
  return end;
}

RunSettings operationSettings(const fs::path& file) {
  convert::JsonFile given = operationJson(file);
  const convert::JsonPlace json(given);
  RunSettings settings;
  settings.threads = static_cast<int>(json.at("threads").number());
  settings.strict = json.at("strict").boolean();
  return settings;
}

int runOperationFile(const fs::path& file, const RunContext& context) {
  convert::JsonFile given = operationJson(file);
  const OperationEnd end = runHere(decoded(convert::JsonPlace(given)), context);
  writeText(dumped({{"error", end.error}, {"warnings", end.warnings}, {"answer", end.answer}}),
            endFile(file));
  if (!end.error.empty()) throw Error(static_cast<ErrorKind>(end.code), end.error);
  return end.code;
}

}  // namespace lumen::engine
