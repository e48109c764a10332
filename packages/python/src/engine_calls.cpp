// SPDX-License-Identifier: Apache-2.0
#include "packages/python/src/engine_calls.h"

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "converters/engine/command.h"
#include "converters/engine/scope.h"
#include "converters/engine/tracking_input.h"
#include "packages/python/src/python_error.h"
#include "packages/python/src/watched_work.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

using Options = std::vector<std::pair<std::string, std::vector<std::string>>>;
using convert::Volume;

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

/// Answer of a command as (JSON or None, text, exit code, warnings, details).
py::tuple runCommand(const std::string& name, const std::vector<std::string>& arguments,
                     const Options& options, const py::object& report, int threads, bool strict) {
  const engine::Engine commands = engine::makeEngine();
  engine::Answer answer;
  std::string text;
  const Messages messages = runWatched({report, threads, strict}, [&](Progress& progress) {
    engine::RunContext context{commands, progress};
    context.threads = threads;
    context.strict = strict;
    context.answerEarly = [&text](const engine::Answer& early) { text += early.text; };
    answer = commands.run({name, arguments, options}, context);
  });
  using Json = engine::Json;
  py::object json = py::none();
  if (!answer.json.is_null())
    json = py::str(
        released([&] { return answer.json.dump(-1, ' ', false, Json::error_handler_t::replace); }));
  return py::make_tuple(json, text + answer.text, answer.code, messages.warnings, messages.details);
}

/// (3,) or (3, 3) numbers as nested tuples.
py::tuple tupleOf(const Eigen::Vector3d& v) {
  return py::make_tuple(v[0], v[1], v[2]);
}

/// The voxels as an array [k, j, i] that points into the volume.
py::array voxelsOf(const py::object& self) {
  const Volume& volume = self.cast<const Volume&>();
  const auto& size = volume.geometry.size;
  return std::visit(
      [&](const auto& voxels) -> py::array {
        using Number = typename std::decay_t<decltype(voxels)>::value_type;
        return py::array_t<Number>({size[2], size[1], size[0]}, voxels.data(), self);
      },
      volume.voxels);
}

std::pair<std::shared_ptr<Volume>, std::vector<std::string>> readVolume(const std::string& file,
                                                                        const Options& options,
                                                                        const py::object& report) {
  auto volume = std::make_shared<Volume>();
  const Messages messages = runWatched({report}, [&](Progress& progress) {
    OptionTable table;
    engine::VolumeArguments arguments;
    engine::addVolumeRows(table, arguments);
    engine::setRows(table, {"", {}, options});
    if (isAddress(file)) throw invalidInput(std::string("volume: ") + kAddressFault);
    const engine::FileFormat& format = engine::inputFormat(file, "");
    if (format.readVolume == nullptr) throw unsupported(file + ": this is not a volume");
    *volume = engine::readVolumeFile(file, format, arguments, progress);
  });
  return {volume, messages.warnings};
}

}  // namespace

void addEngine(py::module_& module) {
  module.attr("version") = LUMEN_VERSION;
  module.def("commands", &listCommands);
  module.def("run", &runCommand);
  module.def("read_volume", &readVolume);
  py::class_<Volume, std::shared_ptr<Volume>>(module, "Voxels")
      .def_property_readonly("array", &voxelsOf)
      .def_property_readonly("spacing",
                             [](const Volume& self) { return tupleOf(self.geometry.spacing); })
      .def_property_readonly("origin",
                             [](const Volume& self) { return tupleOf(self.geometry.origin); })
      .def_property_readonly("direction", [](const Volume& self) {
        const Eigen::Matrix3d rows = self.geometry.direction.transpose();
        return py::make_tuple(tupleOf(rows.col(0)), tupleOf(rows.col(1)), tupleOf(rows.col(2)));
      });
}

}  // namespace lumen::python
