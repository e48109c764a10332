// SPDX-License-Identifier: Apache-2.0
// The options of lumen/engine.h: those of `lumen convert`, but that files are bytes among the inputs.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "converters/base/input_file.h"
#include "converters/base/options/option_table.h"
#include "converters/base/progress.h"
#include "converters/engine/convert_options.h"
#include "converters/operations/context.h"
#include "lumen/engine.h"

struct lumen_engine_options {
  lumen::engine::ConvertOptions values;
  lumen::OptionTable table;
  lumen_engine_options() { values.addRows(table); }
};

namespace lumen::engine::api {

/// An option that names a file, and the bytes in its place.
struct InputPart {
  const char* option;
  const char* name;  ///< in messages
  lumen_engine_file lumen_engine_inputs::*file;
};
inline constexpr std::array<InputPart, 5> kInputParts = {{
    {"seeds", "inputs.seeds", &lumen_engine_inputs::seeds},
    {"corrections", "inputs.corrected", &lumen_engine_inputs::corrected},
    {"label-map", "inputs.label_map", &lumen_engine_inputs::label_map},
    {"label-table", "inputs.label_table", &lumen_engine_inputs::label_table},
    {"centerline", "inputs.centerline", &lumen_engine_inputs::centerline},
}};

/// A sentence with options spelled as this interface has them: "--inlier-rate" becomes
/// "inlier-rate" in quotation marks, and "--seeds" becomes inputs.seeds.
std::string inWordsOfC(std::string_view sentence);

/// A copy of the caller's options, or those that stand without any.
class Options {
public:
  explicit Options(const lumen_engine_options* given);
  /// The option that names a file is given: this one.
  void give(const char* option, const InputFile& file);
  [[nodiscard]] const ConvertOptions& values() const { return m_held.values; }
  [[nodiscard]] const OptionTable& table() const { return m_held.table; }
  /// The context of an operation by these options, which outlive it.
  [[nodiscard]] operations::Context context(Progress& progress) const;

private:
  lumen_engine_options m_held;
};

}  // namespace lumen::engine::api
