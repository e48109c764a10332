// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/findings.h"

#include <utility>

namespace lumen::viewer {

void Findings::setCheck(Json answer, std::shared_ptr<const formats::Case> of) {
  const std::lock_guard lock(m_mutex);
  m_check = std::move(answer);
  m_checked = std::move(of);
}

void Findings::setFigures(Json answer, std::shared_ptr<const formats::Case> of,
                          std::shared_ptr<const formats::Case> truth) {
  const std::lock_guard lock(m_mutex);
  m_figures = std::move(answer);
  m_compared = std::move(of);
  m_truth = std::move(truth);
}

void Findings::clear() {
  const std::lock_guard lock(m_mutex);
  m_check = m_figures = nullptr;
  m_checked = m_compared = m_truth = nullptr;
}

Json Findings::check() const {
  const std::lock_guard lock(m_mutex);
  return m_check;
}

bool Findings::isCheckOld(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  return m_check.is_object() && m_checked != document.value;
}

Json Findings::figures(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  return m_compared == document.value && m_truth == document.truth ? m_figures : Json(nullptr);
}

}  // namespace lumen::viewer
