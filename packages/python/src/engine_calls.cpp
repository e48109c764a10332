// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/engine_calls.h"

#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/stl.h>

#include "converters/engine/command.h"
#include "converters/engine/scope.h"
#include "formats/case/case_encoding.h"
#include "packages/python/src/case_object.h"
#include "packages/python/src/volume_object.h"
#include "packages/python/src/watched_work.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

/// Type of an option's value: flag, int, float, text.
const char* valueType(const OptionRow& row) {
  return std::visit(
      [](const auto& target) {
        using Target = std::decay_t<decltype(target)>;
        if constexpr (std::is_same_v<Target, bool*>)
          return "flag";
        else if constexpr (std::is_same_v<Target, double*> ||
                           std::is_same_v<Target, std::optional<double>*>)
          return "float";
        else if constexpr (std::is_same_v<Target, int*> || std::is_same_v<Target, std::int64_t*> ||
                           std::is_same_v<Target, std::uint64_t*> ||
                           std::is_same_v<Target, std::optional<std::int64_t>*> ||
                           std::is_same_v<Target, std::vector<int>*>)
          return "int";
        else
          return "text";
      },
      row.target);
}

/// `for_mesh`: it counts where a mesh without a format's own options is made of a case.
py::dict rowFacts(const OptionRow& row) {
  using namespace py::literals;
  return py::dict(
      "name"_a = row.name, "type"_a = row.isFlag() ? "flag" : valueType(row),
      "placeholder"_a = row.type, "help"_a = row.help, "default"_a = row.defaultText,
      "group"_a = row.group, "argument"_a = row.isArgument, "required"_a = row.isRequired,
      "repeats"_a = row.repeats, "count"_a = row.count, "delimited"_a = row.delimiter != 0,
      "words"_a = row.words,
      "range"_a = row.range   ? row.range->text()
                  : row.whole ? row.whole->text()
                              : std::string(),
      "for_mesh"_a = (row.inputs & engine::kCases) != 0 && (row.outputs & engine::kOtherMesh) != 0);
}

/// All commands with their rows, in the order of the help.
py::dict listCommands() {
  py::dict all;
  for (const auto& [command, table] : engine::makeEngine().commands()) {
    py::list rows;
    for (const OptionRow& row : table->rows()) rows.append(rowFacts(row));
    py::dict facts;
    facts["summary"] = command->summary();
    facts["example"] = command->example();
    facts["rows"] = rows;
    all[command->name().c_str()] = facts;
  }
  return all;
}

using Cases = std::vector<std::pair<std::string, const CaseObject*>>;

/// Gives the memory bytes and volumes, which the caller keeps, by their names. Returns the cases,
/// which are valid.
Cases giveValues(const py::dict& given, MemoryFiles& memory) {
  Cases cases;
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    if (py::isinstance<CaseObject>(value)) {
      cases.emplace_back(name, value.cast<const CaseObject*>());
      requireValid(*cases.back().second);
    } else if (py::isinstance<py::tuple>(value)) {
      const GivenVolume volume(value.cast<py::tuple>());
      memory.give(name, convert::nrrdHeader(volume.voxels, "raw"), volume.bytes);
    } else {
      memory.give(name, value.cast<std::string>());
    }
  }
  return cases;
}

/// A case of lumen for the bytes of one, else the bytes.
py::object keptValue(const std::string& name, const std::string& bytes) {
  if (!name.ends_with(".lumen")) return py::bytes(bytes);
  return py::cast(decodedCase(std::as_bytes(std::span(bytes.data(), bytes.size())), name));
}

/// Runs a command whose arguments and options name files and values in memory: `given` are cases,
/// parts of volumes and texts, `kept` outputs. Returns (JSON or None, text, exit code, warnings,
/// details, outputs by name).
py::tuple runCommand(const Operation& operation, const py::dict& given,
                     const std::vector<std::string>& kept, const Watch& watch) {
  const engine::Engine commands = engine::makeEngine();
  MemoryFiles memory;
  const Cases cases = giveValues(given, memory);
  for (const std::string& name : kept) memory.keep(name);
  std::vector<std::vector<std::byte>> encoded;
  engine::Answer answer;
  std::string text, json;
  const Messages messages = runWatched(watch, [&](Progress& progress) {
    for (const auto& [name, object] : cases) {
      encoded.push_back(formats::encodeBinary(object->value));
      const auto* const bytes = reinterpret_cast<const char*>(encoded.back().data());
      memory.give(name, "", {bytes, encoded.back().size()});
    }
    engine::RunContext context{commands, progress};
    context.threads = watch.threads;
    context.strict = watch.strict;
    context.memory = &memory;
    context.answerEarly = [&text](const engine::Answer& early) { text += early.text; };
    answer = commands.run(operation, context);
    using Json = engine::Json;
    if (!answer.json.is_null())
      json = answer.json.dump(-1, ' ', false, Json::error_handler_t::replace);
  });
  py::dict outputs;
  for (const std::string& name : kept) outputs[name.c_str()] = keptValue(name, memory.keep(name));
  return py::make_tuple(json.empty() ? py::object(py::none()) : py::str(json), text + answer.text,
                        answer.code, messages.warnings, messages.details, outputs);
}

}  // namespace

void addEngine(py::module_& module) {
  module.attr("version") = LUMEN_VERSION;
  module.def("commands", &listCommands);
  module.def(
      "run", [](const std::string& name, const std::vector<std::string>& arguments,
                const Options& options, const py::dict& given, const std::vector<std::string>& kept,
                const py::object& report, int threads, bool strict) {
        return runCommand({name, arguments, options}, given, kept, {report, threads, strict});
      });
}

}  // namespace lumen::python
