// SPDX-License-Identifier: Apache-2.0
#include "viewer/session/surfaces.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "converters/engine/answers/answer_text.h"
#include "converters/operations/surface_of.h"
#include "converters/stages/surface/to_surface_mesh.h"
#include "viewer/session/free_memory.h"
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

/// Reports the stages of a level to those who wait for it; warnings are not theirs.
class Surfaces::HeardProgress : public Progress {
public:
  /// With one thread `isStopped` is asked, but nobody for a surface that somebody waits for.
  HeardProgress(Surfaces& surfaces, int level, std::function<bool()> isStopped)
      : m_surfaces(surfaces), m_level(level), m_stop(std::move(isStopped)) {}
  void begin(std::string_view stage, std::size_t total) override {
    m_stop.ask(*this);
    tell([&](Progress& waiting) { waiting.begin(stage, total); });
  }
  void advance(std::size_t units) override {
    m_stop.ask(*this);
    tell([&](Progress& waiting) { waiting.advance(units); });
  }
  void end() override {
    tell([](Progress& waiting) { waiting.end(); });
  }

private:
  void tell(const std::function<void(Progress&)>& call) { m_surfaces.tellWaiting(m_level, call); }

  Surfaces& m_surfaces;
  const int m_level;
  StopQuestion m_stop;
};

Surfaces::Surfaces(std::function<void()> ready, const std::optional<OneThread>& oneThread)
    : m_ready(std::move(ready)), m_oneThread(oneThread) {
  if (!m_oneThread) m_thread = std::thread([this] { work(); });
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
  m_levels = {};
  m_hasFailed = {};
  m_asked = kLevels;
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
    m_asked = std::min(m_asked, level);
    m_wake.notify_all();
    for (int l = level; l < kLevels; ++l)
      if (m_levels[place(l)]) return m_levels[place(l)];
  }
  return quick();
}

void Surfaces::prefer(int level) {
  if (m_progress && m_making != level) m_progress->cancel();
}

void Surfaces::waitFor(int level, Progress& progress) {
  std::unique_lock lock(m_mutex);
  const std::pair<int, Progress*> mine{level, &progress};
  m_waiting.push_back(mine);
  if (!isTried(level)) prefer(level);
  m_wake.notify_all();
  const auto isOver = [&] {
    return !hasSurface(m_case) || !m_allowed || m_ended || isTried(level) || progress.cancelled();
  };
  if (m_oneThread)
    while (!isOver()) makeLevel(level, lock);
  else
    while (!m_wake.wait_for(lock, kCancelCheckInterval, isOver)) continue;
  m_waiting.erase(std::find(m_waiting.begin(), m_waiting.end(), mine));
  progress.check();
}

void Surfaces::tellWaiting(int level, const std::function<void(Progress&)>& tell) {
  const std::lock_guard lock(m_mutex);
  for (const auto& [wanted, progress] : m_waiting)
    if (wanted == level) tell(*progress);
}

bool Surfaces::isFinerReady(int level) const {
  return std::any_of(m_levels.begin(), m_levels.begin() + level,
                     [](const auto& surface) { return surface != nullptr; });
}

std::shared_ptr<const ReadySurface> Surfaces::coarsest() const {
  for (int level = kLevels - 1; level >= 0; --level)
    if (m_levels[place(level)]) return m_levels[place(level)];
  return nullptr;
}

std::shared_ptr<const ReadySurface> Surfaces::quick() {
  Progress silent;
  return readyQuick(silent);
}

std::shared_ptr<const ReadySurface> Surfaces::readyQuick(Progress& progress) {
  const std::lock_guard one(m_quickMutex);
  std::shared_ptr<const formats::Case> value;
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(m_mutex);
    if (!hasSurface(m_case)) return nullptr;
    if (auto level = coarsest()) return level;
    if (m_levels[kQuick]) return m_levels[kQuick];
    value = m_case;
    number = ++m_number;
  }
  auto made = make(*value, kQuick, number, progress);
  const std::lock_guard lock(m_mutex);
  if (m_case == value) m_levels[kQuick] = made;
  return made;
}

std::shared_ptr<const ReadySurface> Surfaces::make(const formats::Case& value, int level,
                                                   std::uint64_t number, Progress& progress) {
  auto result = std::make_shared<ReadySurface>();
  result->tag = std::to_string(number);
  operations::Surface made;
  const bool isQuick = level == kQuick;
  if (isQuick) {
    made.levels.push_back(convert::quickSurface(value, progress));
  } else {
    operations::SurfaceOptions options;
    constexpr convert::SurfaceError kFinest = convert::kUsualSurfaceError;
    options.closed.maxError = {.radii = (1 << level) * kFinest.radii,
                               .voxels = (1 << level) * kFinest.voxels};
    made = operations::surfaceOf(value, options, "", engine::operationContext(progress));
  }
  const std::optional<convert::MeshSkin> skin = skinOfFirst(value, made.levels);
  result->pack =
      surfacePack(made.levels.front(), {isQuick ? "quick" : "closed", level, kLevels},
                  made.report.value_or(convert::SurfaceReport{}), skin ? &*skin : nullptr);
  result->position = std::move(made.levels.front().position);
  return result;
}

int Surfaces::nextLevel() const {
  if (!m_allowed || !hasSurface(m_case)) return -1;
  for (const auto& [level, progress] : m_waiting)
    if (!isTried(level)) return level;
  const bool isAnyReady = coarsest() != nullptr;
  if (!isTried(kQuick) && !isAnyReady) return kQuick;  // a page begins with it
  return m_asked < kLevels && !isTried(m_asked) && !isFinerReady(m_asked) ? m_asked : -1;
}

void Surfaces::work() {
  std::unique_lock lock(m_mutex);
  while (!m_ended) {
    const int level = nextLevel();
    if (level < 0)
      m_wake.wait(lock);
    else
      makeLevel(level, lock);
  }
}

bool Surfaces::makeNext() {
  std::unique_lock lock(m_mutex);
  const int level = nextLevel();
  if (level >= 0) makeLevel(level, lock);
  return level >= 0;
}

void Surfaces::makeLevel(int level, std::unique_lock<std::mutex>& lock) {
  const auto value = m_case;
  const bool asks = m_oneThread && m_waiting.empty();
  const auto progress =
      std::make_shared<HeardProgress>(*this, level, asks ? m_oneThread->isSurfaceStopped : nullptr);
  const std::uint64_t number = level == kQuick ? 0 : ++m_number;
  m_progress = progress;
  m_making = level;
  lock.unlock();
  std::shared_ptr<const ReadySurface> made;
  try {
    made = level == kQuick ? readyQuick(*progress) : make(*value, level, number, *progress);
  } catch (const std::exception&) {
    // cancelled, or a case that has no such surface: a request for the quick one gets the error
  }
  returnFreeMemory();
  lock.lock();
  m_progress.reset();
  if (m_case != value || (!made && progress->cancelled())) return;
  m_hasFailed[place(level)] = !made;
  m_wake.notify_all();
  if (!made || level == kQuick) return;
  m_levels[place(level)] = std::move(made);
  m_levels[kQuick].reset();
  ++m_revision;
  m_wake.notify_all();
  lock.unlock();
  m_ready();
  lock.lock();
}

}  // namespace lumen::viewer
