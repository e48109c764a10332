// SPDX-License-Identifier: Apache-2.0
// The surfaces of the open case: a coarse one at once, finer ones from the background.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "converters/base/progress.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "formats/case/case.h"
#include "viewer/session/document/one_thread.h"

namespace lumen::viewer {

/// A surface that is ready.
struct ReadySurface {
  std::string tag;                        ///< names it: another surface has another one
  std::string pack;                       ///< viewer/README.md
  std::vector<convert::Float3> position;  ///< of the vertices, mm, LPS
};

/// All calls are thread-safe.
class Surfaces {
public:
  /// Levels of detail: 0 is the finest, the edges of 1 are twice as long.
  static constexpr int kLevels = 2;

  /// `ready` is called, without any lock, when another surface can be had.
  /// With `oneThread` the background works in makeNext().
  explicit Surfaces(std::function<void()> ready, const std::optional<OneThread>& oneThread = {});
  ~Surfaces();
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;

  /// Ends the background for good; `ready` is not called after that.
  void end();

  /// The case whose surfaces are wanted; may be null or have no models.
  void show(std::shared_ptr<const formats::Case> value);
  /// Allows the background to work, or stops it while a person waits for other work.
  void allow(bool background);

  /// The finest that is ready and no finer than `level`, 0 for the finest of all, or what quick()
  /// gives. The background makes the finest level that was asked for. Null if the case has no surface.
  std::shared_ptr<const ReadySurface> get(int level);
  /// Waits until that level is ready, which is then made before all others, or cannot be made, or no
  /// work is allowed. `progress` hears of its stages. Throws Error(Cancelled).
  void waitFor(int level, Progress& progress);
  /// A surface at once: the coarsest level that is ready, or else a preview, which is made now.
  std::shared_ptr<const ReadySurface> quick();
  /// With one thread: makes a surface that is wanted. False if none is.
  bool makeNext();
  /// Counts surfaces that have become ready, and cases.
  [[nodiscard]] std::uint64_t revision() const;

private:
  static constexpr int kQuick = kLevels;  ///< behind the levels
  static std::size_t place(int level) { return static_cast<std::size_t>(level); }

  class HeardProgress;

  void work();
  /// Makes that level, without the lock, and takes it.
  void makeLevel(int level, std::unique_lock<std::mutex>& lock);
  /// Calls `tell` with the progress of each who waits for that level.
  void tellWaiting(int level, const std::function<void(Progress&)>& tell);
  // Call these with the mutex held.
  [[nodiscard]] bool isTried(int level) const {
    return m_levels[place(level)] || m_hasFailed[place(level)];
  }
  [[nodiscard]] bool isFinerReady(int level) const;
  /// The coarsest level that is ready, which is no preview; or null.
  [[nodiscard]] std::shared_ptr<const ReadySurface> coarsest() const;
  /// The level that the background is to make; -1: nothing.
  [[nodiscard]] int nextLevel() const;
  /// Stops what the background makes, unless it is that level.
  void prefer(int level);

  std::shared_ptr<const ReadySurface> readyQuick(Progress& progress);
  std::shared_ptr<const ReadySurface> make(const formats::Case& value, int level,
                                           std::uint64_t number, Progress& progress);

  const std::function<void()> m_ready;
  const std::optional<OneThread> m_oneThread;
  std::mutex m_quickMutex;     ///< held while the quick surface is made; taken before the other
  mutable std::mutex m_mutex;  ///< guards all that follow
  std::condition_variable m_wake;
  std::shared_ptr<const formats::Case> m_case;
  std::array<std::shared_ptr<const ReadySurface>, kLevels + 1> m_levels;
  std::array<bool, kLevels + 1> m_hasFailed{};
  std::shared_ptr<Progress> m_progress;  ///< progress of the surface that the background makes
  int m_making = 0;                      ///< its level
  /// Those who wait, each with the level that it waits for and what hears of it.
  std::vector<std::pair<int, Progress*>> m_waiting;
  std::uint64_t m_revision = 1, m_number = 0;
  bool m_allowed = true, m_ended = false;
  int m_asked = kLevels;  ///< the finest level that pages have asked for; none is made before
  std::thread m_thread;
};

}  // namespace lumen::viewer
