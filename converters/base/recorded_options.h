// SPDX-License-Identifier: Apache-2.0
// Reads a stage's options back from the step of a case that records them.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "formats/case/case.h"

namespace lumen {

/// Options under their names; what is missing, or of another type than is wanted, stays as it is. A file
/// may say anything: the stage checks the values.
class RecordedOptions {
public:
  explicit RecordedOptions(const formats::Step& step) : m_step(step) {}

  void read(const std::string& name, double& out) const {
    if (const auto* found = get<double>(name))
      out = *found;
    else if (const auto* whole = get<std::int64_t>(name))
      out = static_cast<double>(*whole);
  }
  void read(const std::string& name, std::optional<double>& out) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    read(name, value);
    if (value == value) out = value;
  }
  void read(const std::string& name, int& out) const {
    const auto* found = get<std::int64_t>(name);
    if (found && *found >= 0 && *found <= INT32_MAX) out = static_cast<int>(*found);
  }
  template <class Type>
  void read(const std::string& name, Type& out) const {
    if (const auto* found = get<Type>(name)) out = *found;
  }

private:
  template <class Type>
  [[nodiscard]] const Type* get(const std::string& name) const {
    const auto found = m_step.parameters.find(name);
    return found == m_step.parameters.end() ? nullptr : std::get_if<Type>(&found->second);
  }

  const formats::Step& m_step;
};

}  // namespace lumen
