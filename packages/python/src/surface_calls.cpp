// SPDX-License-Identifier: Apache-2.0
// The surface of a case as arrays, with the options of `lumen convert`.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <pybind11/stl.h>

#include "converters/engine/command.h"
#include "converters/engine/convert_options.h"
#include "converters/engine/scope.h"
#include "converters/io/mesh/mesh_parts.h"
#include "converters/judge/facts/reachable.h"
#include "converters/operations/case_of.h"
#include "converters/operations/surface_of.h"
#include "packages/python/src/array_views.h"
#include "packages/python/src/case_object.h"
#include "packages/python/src/engine_calls.h"
#include "packages/python/src/python_error.h"
#include "packages/python/src/watched_work.h"

namespace py = pybind11;

namespace lumen::python {

namespace {

using convert::SurfaceMesh;

constexpr const char* kMeshName = "mesh.ply";  // in messages

/// The rows of `lumen convert` that count between a case and a mesh, among others.
struct SurfaceRows {
  engine::ConvertOptions convert;
  std::optional<double> time;
  OptionTable table;

  explicit SurfaceRows(const Options& options) {
    convert.addRows(table);
    engine::addTimeRow(table, time).forInputs(engine::kCases).inGroup("");
    engine::setRows(table, {"convert", {}, options});
  }
};

/// The surface of the case called `name` at the time of the rows. A case without models gets some
/// for it.
SurfaceMesh surfaceOf(const formats::Case& value, const std::string& name, const SurfaceRows& rows,
                      Progress& progress) {
  const operations::Context context = engine::operationContext(progress, &rows.table);
  operations::Source source;
  source.name = name;
  source.value = engine::atTime(value, rows.time, name, rows.table, progress);
  const bool isFitted = source.value->models.has_value();
  if (!isFitted && !source.value->points)
    throw invalidInput(name +
                       ": this case has neither models nor wall points to fit them to, so there is "
                       "no surface to make a mesh of");
  engine::requireInScope(
      rows.table,
      {isFitted ? engine::kFittedCase : engine::kUnfittedCase, engine::kOtherMesh, name, kMeshName},
      progress);
  operations::CaseOptions options = rows.convert.caseOptions(engine::FormatKind::Case);
  if (!isFitted) options.models = rows.convert.modelOptions(source, rows.table, progress);
  const formats::Case made = operations::caseOf(std::move(source), options, context).value;
  progress.check();
  convert::warnOfClosed(convert::measureReach(made, progress), progress);
  operations::SurfaceOptions surface = rows.convert.output.surface;
  surface.closed.levels = 1;
  return std::move(operations::surfaceOf(made, surface, kMeshName, context).levels.front());
}

/// Vertices, triangles, numbers of groups from 1 on, names of groups and arrays of the vertices:
/// views of the surface's memory; and warnings and details.
py::tuple meshOf(const CaseObject& self, const std::string& name, const Options& options,
                 const py::object& report, int threads, bool strict) {
  requireValid(self);
  auto made = std::make_unique<SurfaceMesh>();
  const Messages messages = runWatched({report, threads, strict}, [&](Progress& progress) {
    const SurfaceRows rows(options);
    *made = surfaceOf(self.value, name, rows, progress);
    for (std::uint32_t& group : made->group) ++group;
  });
  SurfaceMesh& mesh = *made;
  const py::capsule owner(made.get(), [](void* at) { delete static_cast<SurfaceMesh*>(at); });
  made.release();
  py::dict attributes;
  attributes["normal"] = viewAs<float>(owner, mesh.normal);
  attributes["radius"] = viewAs<float>(owner, mesh.radius);
  if (!mesh.confidence.empty()) attributes["confidence"] = viewAs<float>(owner, mesh.confidence);
  attributes["branch"] = viewAs<std::int32_t>(owner, mesh.branch);
  return py::make_tuple(viewAs<float>(owner, mesh.position),
                        viewAs<std::int32_t>(owner, mesh.triangle),
                        viewAs<std::int32_t>(owner, mesh.group),
                        convert::distinct(convert::plainGroupNames(mesh.groups), convert::oneWord),
                        attributes, messages.warnings, messages.details);
}

}  // namespace

void addSurfaces(py::module_& module) {
  module.def("mesh_of", &meshOf);
}

}  // namespace lumen::python
