// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/surfaces.h"

#include <chrono>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include "converters/stages/surface/to_surface_mesh.h"
#include "viewer/session/packs/surface_pack.h"

namespace lumen::viewer {

namespace {

constexpr std::chrono::milliseconds kCancelCheckInterval{
    100};  // between two looks whether somebody still waits

constexpr std::size_t kMostJoints = 65536;  // that a vertex can name, the resting one included

/// Bones of the first surface of a case that moves; none where they are more than a vertex can name.
std::optional<convert::MeshSkin> skinOfFirst(const formats::Case& value,
                                             std::vector<convert::SurfaceMesh>& levels) {
  levels.resize(1);
  if (!value.motion || value.motion->node.size() >= kMostJoints) return std::nullopt;
  return convert::skinOf(value, levels);
}

bool hasSurface(const std::shared_ptr<const formats::Case>& value) {
  return value && value->models && value->tree.nodeCount() > 0;
}

}  // namespace

Surfaces::Surfaces(std::function<void()> ready) : m_ready(std::move(ready)) {
  m_thread = std::thread([this] { work(); });
}

Surfaces::~Surfaces() {
  end();
}

void Surfaces::end() {
  {
    const std::lock_guard lock(m_mutex);
    m_ended = true;
    if (m_progress) m_progress->cancel();
  }
  m_wake.notify_all();
  if (m_thread.joinable()) m_thread.join();
}

void Surfaces::show(std::shared_ptr<const formats::Case> value) {
  const std::lock_guard lock(m_mutex);
  if (value == m_case) return;
  m_case = std::move(value);
  m_quick.reset();
  m_levels = {};
  m_failed = {};
  m_isAsked = false;
  ++m_revision;
  if (m_progress) m_progress->cancel();
  m_wake.notify_all();
}

void Surfaces::allow(bool background) {
  const std::lock_guard lock(m_mutex);
  m_allowed = background;
  if (!background && m_progress) m_progress->cancel();
  m_wake.notify_all();
}

std::uint64_t Surfaces::revision() const {
  const std::lock_guard lock(m_mutex);
  return m_revision;
}

std::shared_ptr<const ReadySurface> Surfaces::get(int level) {
  {
    const std::lock_guard lock(m_mutex);
    for (std::size_t l = static_cast<std::size_t>(level); l < kLevels; ++l)
      if (m_levels[l]) return m_levels[l];
  }
  return quick();
}

void Surfaces::waitFor(int level, const Progress& progress) {
  const auto l = static_cast<std::size_t>(level);
  std::unique_lock lock(m_mutex);
  m_isAsked = true;
  m_wake.notify_all();
  while (!m_wake.wait_for(lock, kCancelCheckInterval, [&] {
    return !hasSurface(m_case) || !m_allowed || m_ended || m_levels[l] || m_failed[l];
  }))
    progress.check();
}

std::shared_ptr<const ReadySurface> Surfaces::quick() {
  {
    const std::lock_guard lock(m_mutex);
    m_isAsked = true;
  }
  m_wake.notify_all();
  return readyQuick();
}

std::shared_ptr<const ReadySurface> Surfaces::readyQuick() {
  const std::lock_guard one(m_quickMutex);
  std::shared_ptr<const formats::Case> value;
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(m_mutex);
    if (!hasSurface(m_case)) return nullptr;
    if (m_quick) return m_quick;
    value = m_case;
    number = ++m_number;
  }
  Progress silent;
  auto made = make(*value, kLevels, number, silent);
  const std::lock_guard lock(m_mutex);
  if (m_case == value) m_quick = made;
  return made;
}

std::shared_ptr<const ReadySurface> Surfaces::make(const formats::Case& value, int level,
                                                   std::uint64_t number, Progress& progress) {
  auto result = std::make_shared<ReadySurface>();
  result->tag = std::to_string(number);
  convert::ClosedSurface made;
  const bool isQuick = level >= kLevels;
  if (isQuick) {
    made.levels.push_back(convert::quickSurface(value, progress));
  } else {
    convert::ClosedSurfaceOptions options;
    options.edge.share *= 1 << level;
    made = convert::closedSurface(value, options, progress);
  }
  const std::optional<convert::MeshSkin> skin = skinOfFirst(value, made.levels);
  result->pack = surfacePack(made.levels.front(), {isQuick ? "quick" : "closed", level, kLevels},
                             made.report, skin ? &*skin : nullptr);
  result->mesh = std::make_shared<const convert::SurfaceMesh>(std::move(made.levels.front()));
  return result;
}

void Surfaces::work() {
  std::unique_lock lock(m_mutex);
  while (!m_ended) {
    if (hasSurface(m_case) && m_allowed && !m_quick && m_quickTried != m_case) {
      // a page begins with the quick surface
      m_quickTried = m_case;
      lock.unlock();
      try {
        readyQuick();
      } catch (const std::exception&) {
        // a request for it gets the error
      }
      lock.lock();
      continue;
    }
    int level = kLevels - 1;
    const auto isDone = [this](int l) {
      return m_levels[static_cast<std::size_t>(l)] || m_failed[static_cast<std::size_t>(l)];
    };
    while (level >= 0 && isDone(level)) --level;
    if (level < 0 || !m_allowed || !m_isAsked || !hasSurface(m_case)) {
      m_wake.wait(lock);
      continue;
    }
    const auto value = m_case;
    const auto progress = std::make_shared<Progress>();
    const std::uint64_t number = ++m_number;
    m_progress = progress;
    lock.unlock();
    std::shared_ptr<const ReadySurface> made;
    try {
      made = make(*value, level, number, *progress);
    } catch (const std::exception&) {
      // cancelled, or a case that has no such surface: the quick one stays
    }
    lock.lock();
    m_progress.reset();
    if (m_case != value || (!made && progress->cancelled())) continue;
    m_failed[static_cast<std::size_t>(level)] = !made;
    m_wake.notify_all();
    if (!made) continue;
    m_levels[static_cast<std::size_t>(level)] = std::move(made);
    ++m_revision;
    m_wake.notify_all();
    lock.unlock();
    m_ready();
    lock.lock();
  }
}

}  // namespace lumen::viewer
