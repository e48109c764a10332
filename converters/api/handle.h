// SPDX-License-Identifier: Apache-2.0
// Shared by the functions of lumen/engine.h: what lies behind the pointers, and the way from
// exceptions to a status.
#pragma once

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/operations/case_of.h"
#include "converters/operations/source.h"
#include "converters/operations/surface_of.h"
#include "formats/case/case.h"
#include "lumen/engine.h"

struct lumen_engine_source {
  std::optional<lumen::operations::Source> source;  ///< empty once it is used up
  std::vector<lumen::convert::SeedBranch> seeds;
  std::optional<lumen::operations::CorrectedCase> corrected;
  /// Options that name files, and the names of those that were among the inputs.
  std::vector<std::pair<const char*, std::string>> files;
  lumen::ContentMask content = lumen::kAnyContent;  ///< bits of engine/scope.h
};

struct lumen_engine_case {
  lumen::formats::Case value;
};

struct lumen_engine_bytes {
  std::string bytes;
};

struct lumen_engine_surface {
  lumen::convert::SurfaceMesh mesh;
};

namespace lumen::engine::api {

/// An argument of a function, as its declaration calls it.
struct Argument {
  const char* name;
  const void* value;
};

/// Throws Error(Usage) that names the function and its first argument that is null.
void requireGiven(const char* function, std::initializer_list<Argument> arguments);

/// The status of `work`, which may throw: no exception leaves the library. Fills *fault, if there is
/// one.
lumen_engine_status guarded(lumen_engine_fault* fault, const std::function<void()>& work);

/// Does long work on as many threads as the listener says, which hears of it and may end it.
void listenTo(const lumen_engine_listener* listener, const std::function<void(Progress&)>& work);

}  // namespace lumen::engine::api
