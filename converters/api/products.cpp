// SPDX-License-Identifier: Apache-2.0
// The functions of lumen/engine.h that make cases and products.
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "converters/api/handle.h"
#include "converters/api/options.h"
#include "converters/base/error.h"
#include "converters/engine/file_access.h"
#include "converters/engine/scope.h"

namespace lumen::engine::api {
namespace {

constexpr const char* kCaseName = "case";  // in messages

formats::Case caseOf(lumen_engine_source& from, Options options, Progress& progress) {
  if (!from.source)
    throw Error(ErrorKind::Usage, "the source is used up; expected one that no case was made of");
  operations::Source source = *std::exchange(from.source, std::nullopt);
  for (const auto& [option, name] : from.files) options.give(option, name);
  requireCompatible(options.table());
  requireInScope(options.table(), {from.content, kAnyContent, source.name, {}, true}, progress);
  const FormatKind kind = source.grey || source.labels ? FormatKind::Volume : FormatKind::Mesh;
  operations::CaseOptions made = options.values().caseOptions(kind);
  made.vessels.seeds = from.seeds;
  made.corrected = std::move(from.corrected);
  made.models = options.values().modelOptions(source, options.table(), progress);
  return operations::caseOf(std::move(source), made, options.context(progress)).value;
}

const FileFormat& formatNamed(const std::string& name) {
  for (const FileFormat& format : fileFormats())
    if (format.name == name && canWrite(format)) return format;
  throw unsupported("the format is \"" + name + "\"; expected one of " + formatNames(canWrite));
}

std::string encoded(const formats::Case& value, const std::string& format, const Options& options,
                    Progress& progress) {
  const FileFormat& writer = formatNamed(format);
  requireCompatible(options.table());
  return writer.encodeCase(value, kCaseName, options.values().output, progress).bytes;
}

/// The texts of a float's array as the C struct has it.
const float (*triples(const std::vector<convert::Float3>& values))[3] {
  static_assert(sizeof(convert::Float3) == 3 * sizeof(float));
  return reinterpret_cast<const float(*)[3]>(values.data());
}

}  // namespace
}  // namespace lumen::engine::api

using namespace lumen;
using namespace lumen::engine;
using namespace lumen::engine::api;

extern "C" {

lumen_engine_status lumen_engine_case_of(lumen_engine_source* source,
                                         const lumen_engine_options* options,
                                         const lumen_engine_listener* listener,
                                         lumen_engine_case** out,
                                         lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    requireGiven("lumen_engine_case_of", {{"source", source}, {"out", out}});
    listenTo(listener, [&](Progress& progress) {
      *out = new lumen_engine_case{api::caseOf(*source, Options(options), progress)};
    });
  });
}

lumen_engine_status lumen_engine_open_case(const lumen_engine_file* file, lumen_engine_case** out,
                                           lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    requireGiven("lumen_engine_open_case", {{"file", file}, {"out", out}});
    requireGiven("lumen_engine_open_case",
                 {{"file->name", file->name}, {"file->bytes", file->bytes}});
    const std::string_view bytes(static_cast<const char*>(file->bytes), file->size);
    *out = new lumen_engine_case{readCase({file->name, bytes})};
  });
}

void lumen_engine_free_case(lumen_engine_case* value) noexcept {
  delete value;
}

size_t lumen_engine_branch_count(const lumen_engine_case* value) noexcept {
  return value ? value->value.tree.branches.size() : 0;
}

const char* lumen_engine_branch_name(const lumen_engine_case* value, size_t branch) noexcept {
  if (branch >= lumen_engine_branch_count(value)) return nullptr;
  return value->value.tree.branches[branch].label.c_str();
}

size_t lumen_engine_branch_parent(const lumen_engine_case* value, size_t branch) noexcept {
  if (branch >= lumen_engine_branch_count(value)) return SIZE_MAX;
  const formats::CenterlineTree& tree = value->value.tree;
  const std::int32_t node = tree.branches[branch].parentNode;
  return node == formats::kNoParent ? SIZE_MAX : tree.branch[static_cast<std::size_t>(node)];
}

const void* lumen_engine_bytes_data(const lumen_engine_bytes* bytes) noexcept {
  return bytes ? bytes->bytes.data() : nullptr;
}

size_t lumen_engine_bytes_size(const lumen_engine_bytes* bytes) noexcept {
  return bytes ? bytes->bytes.size() : 0;
}

void lumen_engine_free_bytes(lumen_engine_bytes* bytes) noexcept {
  delete bytes;
}

lumen_engine_status lumen_engine_encode(const lumen_engine_case* value, const char* format,
                                        const lumen_engine_options* options,
                                        const lumen_engine_listener* listener,
                                        lumen_engine_bytes** out,
                                        lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    requireGiven("lumen_engine_encode", {{"value", value}, {"format", format}, {"out", out}});
    listenTo(listener, [&](Progress& progress) {
      *out = new lumen_engine_bytes{encoded(value->value, format, Options(options), progress)};
    });
  });
}

lumen_engine_status lumen_engine_surface_of(const lumen_engine_case* value,
                                            const lumen_engine_options* options,
                                            const lumen_engine_listener* listener,
                                            lumen_engine_surface** out,
                                            lumen_engine_fault* fault) noexcept {
  if (out) *out = nullptr;
  return guarded(fault, [&] {
    requireGiven("lumen_engine_surface_of", {{"value", value}, {"out", out}});
    listenTo(listener, [&](Progress& progress) {
      const Options given(options);
      requireCompatible(given.table());
      operations::SurfaceOptions surface = given.values().output.surface;
      surface.closed.levels = 1;
      operations::Surface made =
          operations::surfaceOf(value->value, surface, kCaseName, given.context(progress));
      *out = new lumen_engine_surface{std::move(made.levels.front())};
    });
  });
}

lumen_engine_mesh lumen_engine_get_mesh(const lumen_engine_surface* surface) noexcept {
  if (!surface) return {};
  const convert::SurfaceMesh& mesh = surface->mesh;
  static_assert(sizeof(convert::Triangle) == 3 * sizeof(std::uint32_t));
  return {mesh.position.size(),
          triples(mesh.position),
          triples(mesh.normal),
          mesh.radius.data(),
          mesh.branch.data(),
          mesh.triangle.size(),
          reinterpret_cast<const std::uint32_t(*)[3]>(mesh.triangle.data()),
          mesh.group.data(),
          mesh.groups.size()};
}

const char* lumen_engine_group_name(const lumen_engine_surface* surface, size_t group) noexcept {
  if (!surface || group >= surface->mesh.groups.size()) return nullptr;
  return surface->mesh.groups[group].name.c_str();
}

void lumen_engine_free_surface(lumen_engine_surface* surface) noexcept {
  delete surface;
}

}  // extern "C"
