// SPDX-License-Identifier: Apache-2.0
// Lists of numbered faults: the issues of a case, the faults of a library.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "formats/container/error_code.h"

namespace lumen::formats {

/// The number of faults of each severity, kept or not.
struct FaultCounts {
  std::size_t errors = 0, warnings = 0, information = 0;
  [[nodiscard]] std::size_t total() const { return errors + warnings + information; }
  friend bool operator==(const FaultCounts&, const FaultCounts&) = default;
};

/// Counts all faults and keeps some. The verdict is that of the counts, so checks go on after the
/// list is full. A full list drops its last fault that is no error for an error. `Fault` has a
/// member `code`, for which severityOf(code) gives the severity.
template <class Fault>
class FaultList {
public:
  using Code = decltype(Fault::code);

  /// Errors: warnings are not asked for, and checks may stop once the list is full.
  enum class Keep : std::uint8_t { All, Errors };

  explicit FaultList(std::size_t maximum, Keep keep = Keep::All)
      : m_maximum(maximum), m_keep(keep) {}

  void add(Fault fault) {
    if (count(severityOf(fault.code))) insert(std::move(fault));
  }
  /// Adds the fault that `make` returns, which is called only for one that is kept: for hot checks.
  template <class Make>
  void add(Code code, Make make) {
    if (count(severityOf(code))) insert(make());
  }
  /// Adds the faults of `more` behind those of this list.
  void append(FaultList&& more) {
    m_counts.errors += more.m_counts.errors;
    m_counts.warnings += more.m_counts.warnings;
    m_counts.information += more.m_counts.information;
    for (Fault& fault : more.m_kept)
      if (hasRoom(severityOf(fault.code))) insert(std::move(fault));
  }

  /// True when no further fault could change the verdict or the list: a check may stop.
  [[nodiscard]] bool done() const { return m_keep == Keep::Errors && m_keptErrors >= m_maximum; }
  [[nodiscard]] bool keepsWarnings() const { return m_keep == Keep::All; }
  /// True after an error, kept or not.
  [[nodiscard]] bool failed() const { return m_counts.errors > 0; }
  [[nodiscard]] bool empty() const { return m_counts.total() == 0; }
  [[nodiscard]] const FaultCounts& counts() const { return m_counts; }
  [[nodiscard]] std::size_t maximum() const { return m_maximum; }

  /// The kept faults in the order in which they were found.
  [[nodiscard]] const std::vector<Fault>& kept() const { return m_kept; }
  /// The first error that was kept.
  [[nodiscard]] std::optional<Fault> firstError() const {
    const auto found = std::find_if(m_kept.begin(), m_kept.end(), isError);
    return found == m_kept.end() ? std::nullopt : std::optional<Fault>(*found);
  }
  /// The kept faults: errors in the order in which they were found, then the others. Empties the
  /// list; the counts stay.
  [[nodiscard]] std::vector<Fault> take() {
    std::stable_partition(m_kept.begin(), m_kept.end(), isError);
    m_keptErrors = 0;
    return std::exchange(m_kept, {});
  }
  /// Lets `change` complete every fault that is kept.
  template <class Change>
  void forEach(Change change) {
    for (Fault& fault : m_kept) change(fault);
  }

private:
  static bool isError(const Fault& fault) { return severityOf(fault.code) == Severity::Error; }

  [[nodiscard]] bool hasRoom(Severity severity) const {
    return (severity == Severity::Error ? m_keptErrors : m_kept.size()) < m_maximum;
  }
  // True for a fault that is to be kept.
  bool count(Severity severity) {
    if (severity != Severity::Error && m_keep == Keep::Errors) return false;
    ++(severity == Severity::Error     ? m_counts.errors
       : severity == Severity::Warning ? m_counts.warnings
                                       : m_counts.information);
    return hasRoom(severity);
  }
  void insert(Fault fault) {
    if (m_kept.size() == m_maximum)
      m_kept.erase(std::find_if_not(m_kept.rbegin(), m_kept.rend(), isError).base() - 1);
    m_keptErrors += isError(fault) ? 1 : 0;
    m_kept.push_back(std::move(fault));
  }

  std::size_t m_maximum;
  Keep m_keep;
  FaultCounts m_counts;
  std::vector<Fault> m_kept;
  std::size_t m_keptErrors = 0;
};

}  // namespace lumen::formats
