// SPDX-License-Identifier: Apache-2.0
// Answers of checks, comparisons and measurings, each with the parts that it is about.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "converters/judge/measure/measure_case.h"
#include "viewer/session/document/arguments.h"
#include "viewer/session/document/document.h"
#include "viewer/session/packs/pack.h"
#include "viewer/session/work_list.h"

namespace lumen::viewer {

/// All calls are thread-safe.
class Findings {
public:
  void setCheck(Json answer, std::vector<WorkItem> work, std::shared_ptr<const formats::Case> of);
  void setFigures(Json answer, std::shared_ptr<const formats::Case> of,
                  std::shared_ptr<const formats::Case> truth);
  /// `name`: of the case, for tables of comma-separated values.
  void setMeasures(std::string name, std::vector<convert::MeasureTable> tables,
                   std::shared_ptr<const formats::Case> of);
  void clear();

  /// Adds the members of the state that are about `document`: "check", null if there was none, with
  /// "check_is_old" if it was about another case; "work", the places that it leaves to a person
  /// (workJson()); and "figures".
  void addTo(Json& state, const Document& document) const;
  /// The item of the last check with that number, which no item of another check has. Throws Error(Usage)
  /// if there is none, and Conflict for one of an earlier check.
  [[nodiscard]] WorkItem workItem(std::size_t number) const;
  /// Null if there was no comparison of the case and the truth of `document`.
  [[nodiscard]] Json figures(const Document& document) const;
  /// The tables of measures as measuresJson() has them; null if there are none. They may be about an
  /// earlier case.
  [[nodiscard]] Tagged measures() const;
  /// One of them as comma-separated values; null if there is none of that kind.
  [[nodiscard]] Tagged measures(const std::string& kind) const;
  /// Counts up with each measuring; 0 if there are no measures.
  [[nodiscard]] std::uint64_t measuresRevision() const;
  [[nodiscard]] bool areMeasuresOld(const Document& document) const;

private:
  /// Call it with the mutex held.
  [[nodiscard]] Json lockedFigures(const Document& document) const;

  mutable std::mutex m_mutex;  ///< guards all that follow
  Json m_check, m_figures;
  std::vector<WorkItem> m_items;
  std::size_t m_firstItem = 0;  ///< its number
  Tagged m_measures;
  convert::MeasuredCase m_tables;
  std::uint64_t m_measurings = 0;
  std::shared_ptr<const formats::Case> m_checked, m_compared, m_truth, m_measured;
  mutable std::shared_ptr<const formats::Case> m_worked;  ///< the case that m_work is of, or null
  mutable Json m_work;
};

}  // namespace lumen::viewer
