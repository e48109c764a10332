// SPDX-License-Identifier: Apache-2.0
// A value, or the issue that is the reason why there is none.
#pragma once

#include <optional>
#include <utility>
#include <variant>

#include "formats/container/issue.h"

namespace lumen::formats {

/// A value, or why there is none. Readers of untrusted bytes return it: nothing half-built, no
/// exception. Test it as a bool before reading `*result` or `result.error()`; reading the wrong one
/// throws std::bad_variant_access.
template <class T>
class [[nodiscard]] Expected {
public:
  Expected(T value) : m_state(std::in_place_index<0>, std::move(value)) {}
  Expected(Issue error) : m_state(std::in_place_index<1>, std::move(error)) {}
  [[nodiscard]] explicit operator bool() const { return m_state.index() == 0; }
  T& operator*() & { return std::get<0>(m_state); }
  const T& operator*() const& { return std::get<0>(m_state); }
  T&& operator*() && { return std::get<0>(std::move(m_state)); }
  T* operator->() { return &**this; }
  const T* operator->() const { return &**this; }
  [[nodiscard]] const Issue& error() const { return std::get<1>(m_state); }

private:
  std::variant<T, Issue> m_state;
};

/// Success, or the issue that is the reason why there was none. Test it as a bool before reading
/// `error()`, which throws std::bad_optional_access after success.
class [[nodiscard]] Status {
public:
  Status() = default;
  Status(Issue error) : m_error(std::move(error)) {}
  [[nodiscard]] explicit operator bool() const { return !m_error; }
  [[nodiscard]] const Issue& error() const { return m_error.value(); }

private:
  std::optional<Issue> m_error;
};

}  // namespace lumen::formats
