// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/library.h"

#include <chrono>
#include <exception>
#include <utility>

#include "converters/base/shown_text.h"
#include "converters/engine/file_format.h"
#include "converters/judge/measure/vessel_length.h"
#include "viewer/session/events.h"

namespace lumen::viewer {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kBetween{500};  // the page draws the list anew each time

}  // namespace

void Library::open(CaseList list, std::function<void()> more) {
  m_list = std::move(list);
  m_more = std::move(more);
  m_figures.resize(m_list.cases.size());
  m_isOpen = true;
  m_thread = std::thread([this] { read(); });
}

void Library::end() {
  m_ended = true;
  if (m_thread.joinable()) m_thread.join();
}

void Library::read() {
  using Clock = std::chrono::steady_clock;
  auto last = Clock::now();
  for (std::size_t i = 0; i < m_list.cases.size() && !m_ended; ++i) {
    Figures figures;
    try {
      const fs::path& file = m_list.cases[i].file;
      const formats::Case value = engine::inputFormat(file, "").readCase(file);
      figures.branches = value.tree.branches.size();
      figures.length = convert::vesselLengths(value.tree).total;
    } catch (const std::exception& error) {
      figures.error = messageText(error.what());
    }
    {
      const std::lock_guard lock(m_mutex);
      m_figures[i] = std::move(figures);
    }
    ++m_read;
    if (i + 1 < m_list.cases.size() && Clock::now() - last < kBetween) continue;
    last = Clock::now();
    m_more();
  }
}

Tagged Library::pack() const {
  if (!m_isOpen) return {};
  const std::size_t read = m_read;  // before the figures: never newer than they are
  Json list = Json::array();
  const std::lock_guard lock(m_mutex);
  for (std::size_t i = 0; i < m_list.cases.size(); ++i) {
    Json entry = {{"name", m_list.cases[i].name},
                  {"branches", nullptr},
                  {"length_mm", nullptr},
                  {"error", nullptr}};
    if (const auto& figures = m_figures[i]; figures && figures->error.empty()) {
      entry["branches"] = figures->branches;
      entry["length_mm"] = engine::jsonNumber(figures->length);
    } else if (figures) {
      entry["error"] = figures->error;
    }
    list.push_back(std::move(entry));
  }
  return tagged(std::to_string(read),
                jsonText({{"name", m_list.name}, {"cases", std::move(list)}}));
}

void Library::setOpenCase(std::size_t index) {
  const std::lock_guard lock(m_mutex);
  m_openCase = index;
}

std::optional<std::size_t> Library::openCase() const {
  const std::lock_guard lock(m_mutex);
  return m_openCase;
}

}  // namespace lumen::viewer
