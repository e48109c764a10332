// SPDX-License-Identifier: Apache-2.0
#include "converters/engine/next_step.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "converters/base/shown_lines.h"
#include "converters/base/shown_text.h"

namespace lumen::engine {

namespace {

/// Options of `lumen info` that `lumen convert` has with the same meaning.
constexpr std::array<std::string_view, 9> kShared = {
    "from", "spacing", "unit",           "series",      "volume-index",
    "crop", "frame",   "allow-detached", "label-table",
};

}  // namespace

std::string convertCommand(const OptionTable& table, const std::string& file,
                           const std::string& stem) {
  std::string command =
      "lumen convert " + convert::shellWord(file) + " " + convert::shellWord(stem + ".lumen");
  for (const OptionRow& row : table.rows()) {
    if (!row.isOn() || row.isPreference ||
        std::find(kShared.begin(), kShared.end(), row.name) == kShared.end())
      continue;
    for (const std::string& value : row.givenValues)
      command += " " + convert::shellWord(row.shownName() + "=" + value);
  }
  return command;
}

Answer withNext(Answer answer, const NextStep& next, std::size_t column) {
  answer.json["next"] = {{"assumed", next.assumed}, {"does", next.does}, {"command", next.command}};
  Lines lines(column);
  lines.add("next", next.does).add("type", next.command);
  answer.text += lines.text();
  return answer;
}

}  // namespace lumen::engine
