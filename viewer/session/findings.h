// SPDX-License-Identifier: Apache-2.0
// Answers of checks and comparisons, each with the parts that it is about.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "viewer/session/arguments.h"
#include "viewer/session/document.h"
#include "viewer/session/work_list.h"

namespace lumen::viewer {

/// All calls are thread-safe.
class Findings {
public:
  void setCheck(Json answer, std::vector<WorkItem> work, std::shared_ptr<const formats::Case> of);
  void setFigures(Json answer, std::shared_ptr<const formats::Case> of,
                  std::shared_ptr<const formats::Case> truth);
  void clear();

  /// Null if there was no check; it may be about an earlier case.
  [[nodiscard]] Json check() const;
  /// The places that the last check leaves to a person in the case of `document` (workJson()). Null
  /// without a check or a case.
  [[nodiscard]] Json work(const Document& document) const;
  /// The item of the last check with that number. Throws Error(Usage) if there is none.
  [[nodiscard]] WorkItem workItem(std::size_t number) const;
  /// Whether the check was about another case than that of `document`.
  [[nodiscard]] bool isCheckOld(const Document& document) const;
  /// Null if there was no comparison of the case and the truth of `document`.
  [[nodiscard]] Json figures(const Document& document) const;

private:
  mutable std::mutex m_mutex;  ///< guards all that follow
  Json m_check, m_figures;
  std::vector<WorkItem> m_work;
  std::shared_ptr<const formats::Case> m_checked, m_compared, m_truth;
  mutable std::shared_ptr<const formats::Case> m_worked;  ///< case that m_workJson is of, or null
  mutable Json m_workJson;
};

}  // namespace lumen::viewer
