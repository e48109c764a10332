// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/findings.h"

#include <string>
#include <utility>

#include "viewer/session/document/arguments.h"
#include "viewer/session/events.h"

namespace lumen::viewer {

void Findings::setCheck(Json answer, std::vector<WorkItem> work,
                        std::shared_ptr<const formats::Case> of) {
  const std::lock_guard lock(m_mutex);
  m_check = std::move(answer);
  m_firstItem += m_items.size();
  m_items = std::move(work);
  m_work = nullptr;
  m_worked = nullptr;
  m_checked = std::move(of);
}

void Findings::setFigures(Json answer, std::shared_ptr<const formats::Case> of,
                          std::shared_ptr<const formats::Case> truth) {
  const std::lock_guard lock(m_mutex);
  m_figures = std::move(answer);
  m_compared = std::move(of);
  m_truth = std::move(truth);
}

void Findings::setMeasures(std::string name, std::vector<convert::MeasureTable> tables,
                           std::shared_ptr<const formats::Case> of) {
  std::string text = jsonText(convert::measuresJson(tables));
  const std::lock_guard lock(m_mutex);
  m_tables = {std::move(name), std::move(tables)};
  m_measures = tagged("measures-" + std::to_string(++m_measurings), std::move(text));
  m_measured = std::move(of);
}

void Findings::clear() {
  const std::lock_guard lock(m_mutex);
  m_check = m_figures = m_work = nullptr;
  m_firstItem += m_items.size();
  m_items.clear();
  m_measures = {};
  m_tables = {};
  m_checked = m_compared = m_truth = m_worked = m_measured = nullptr;
}

void Findings::addTo(Json& state, const Document& document) const {
  const std::lock_guard lock(m_mutex);
  const bool isChecked = m_check.is_object();
  if (m_worked != document.value) {
    m_work = isChecked && document.value ? workJson(m_items, m_firstItem, *document.value)
                                         : Json(nullptr);
    m_worked = document.value;
  }
  state["check"] = m_check;
  state["work"] = m_work;
  state["check_is_old"] = isChecked && m_checked != document.value;
  state["figures"] = lockedFigures(document);
}

WorkItem Findings::workItem(std::size_t number) const {
  const std::lock_guard lock(m_mutex);
  if (number < m_firstItem)
    throw Conflict("the case was checked again meanwhile; look, and try again");
  if (number - m_firstItem >= m_items.size()) refuse("the check has no place with that number");
  return m_items[number - m_firstItem];
}

Json Findings::lockedFigures(const Document& document) const {
  return m_compared == document.value && m_truth == document.truth ? m_figures : Json(nullptr);
}

Json Findings::figures(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  return lockedFigures(document);
}

Tagged Findings::measures() const {
  const std::lock_guard lock(m_mutex);
  return m_measures;
}

Tagged Findings::measures(const std::string& kind) const {
  const std::lock_guard lock(m_mutex);
  for (std::size_t k = 0; k < m_tables.tables.size(); ++k)
    if (m_tables.tables[k].kind == kind)
      return tagged(m_measures.tag + kind, convert::measuresCsv({&m_tables, 1}, k));
  return {};
}

std::uint64_t Findings::measuresRevision() const {
  const std::lock_guard lock(m_mutex);
  return m_measures.bytes ? m_measurings : 0;
}

bool Findings::areMeasuresOld(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  return m_measures.bytes && m_measured != document.value;
}

}  // namespace lumen::viewer
