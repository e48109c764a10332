// SPDX-License-Identifier: Apache-2.0
// Shared by the functions of lumen/engine.h: what lies behind the pointers, and the way from
// exceptions to a status.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "converters/base/progress.h"
#include "converters/engine/convert_options.h"
#include "converters/operations/case_of.h"
#include "converters/operations/source.h"
#include "converters/operations/surface_of.h"
#include "formats/case/case.h"
#include "lumen/engine.h"

struct lumen_engine_options {
  lumen::engine::ConvertOptions values;
  lumen::OptionTable table;
  lumen_engine_options() { values.addRows(table); }
};

struct lumen_engine_source {
  std::optional<lumen::operations::Source> source;  ///< empty once it is used up
  std::vector<lumen::convert::SeedBranch> seeds;
  std::string seedsName, regionsName;               ///< empty without them
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

/// Fills *fault, if there is one, and returns `status`.
lumen_engine_status refuse(lumen_engine_fault* fault, lumen_engine_status status,
                           std::string_view sentence);

/// USAGE: `function` was handed a null pointer.
lumen_engine_status refuseNull(lumen_engine_fault* fault, const char* function);

/// The status of `work`, which may throw: no exception leaves the library.
lumen_engine_status guarded(lumen_engine_fault* fault, const std::function<void()>& work);

/// Does long work on as many threads as the listener says, which hears of it and may end it.
void listenTo(const lumen_engine_listener* listener, const std::function<void(Progress&)>& work);

/// A copy of the caller's options, or those that stand without any. Files that are among the inputs
/// count as given.
class Options {
public:
  explicit Options(const lumen_engine_options* given);
  void give(const char* name, const std::string& file) {
    if (!file.empty()) m_held.table.set(name, {file});
  }
  [[nodiscard]] const ConvertOptions& values() const { return m_held.values; }
  [[nodiscard]] const OptionTable& table() const { return m_held.table; }

private:
  lumen_engine_options m_held;
};

}  // namespace lumen::engine::api
