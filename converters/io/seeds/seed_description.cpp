// SPDX-License-Identifier: Apache-2.0
#include "converters/io/seeds/seed_description.h"

#include <algorithm>

#include "converters/base/parsed_number.h"
#include "converters/base/text.h"
#include "converters/io/seeds/seeds_parse.h"

namespace lumen::convert {
void applyDescription(const std::string& text, SeedBranch& branch,
                      const std::function<void(const std::string&)>& refuse) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    const auto equals = part.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = trimmed(part.substr(0, equals));
    const std::string value = trimmed(part.substr(equals + 1));
    if (key == "parent") {
      branch.parent = value;
    } else if (key == "kind" && setKind(value, branch)) {
      continue;
    } else if (key == "radius") {
      const auto radius = parsedNumber(value);
      if (!radius) return refuse("a number after \"radius=\"");
      for (auto& point : branch.points)
        if (!point.radius) point.radius = branch.frame.unit * *radius;
    } else {
      return refuse(
          "\"parent=LABEL\", \"kind=vessel\", \"kind=aneurysm\", \"kind=root\" or "
          "\"radius=NUMBER\" "
          "around each \"=\"");
    }
  }
}

}  // namespace lumen::convert
