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
  m_firstWork += m_work.size();
  m_work = std::move(work);
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
  m_check = m_figures = nullptr;
  m_firstWork += m_work.size();
  m_work.clear();
  m_measures = {};
  m_tables = {};
  m_checked = m_compared = m_truth = m_worked = m_measured = nullptr;
}

Json Findings::check() const {
  const std::lock_guard lock(m_mutex);
  return m_check;
}

Json Findings::work(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  if (!m_check.is_object() || !document.value) return nullptr;
  if (m_worked != document.value) {
    m_workJson = workJson(m_work, m_firstWork, *document.value);
    m_worked = document.value;
  }
  return m_workJson;
}

WorkItem Findings::workItem(std::size_t number) const {
  const std::lock_guard lock(m_mutex);
  if (number < m_firstWork)
    throw Conflict("the case was checked again meanwhile; look, and try again");
  if (number - m_firstWork >= m_work.size()) refuse("the check has no place with that number");
  return m_work[number - m_firstWork];
}

bool Findings::isCheckOld(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  return m_check.is_object() && m_checked != document.value;
}

Json Findings::figures(const Document& document) const {
  const std::lock_guard lock(m_mutex);
  return m_compared == document.value && m_truth == document.truth ? m_figures : Json(nullptr);
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
