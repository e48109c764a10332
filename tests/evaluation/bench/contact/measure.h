// SPDX-License-Identifier: Apache-2.0
// How many contact queries a method answers in a second.
#pragma once

#include <cstddef>
#include <vector>

#include "method.h"
#include "wires.h"

namespace lumen::bench {

/// Buffers of answers for all points of a step.
class AnswerBuffer {
public:
  explicit AnswerBuffer(std::size_t count) : m_distance(count), m_normal(3 * count) {}
  /// From point `first` on.
  [[nodiscard]] Answers from(std::size_t first) {
    const std::size_t n = m_distance.size();
    double* normal = m_normal.data() + first;
    return {m_distance.data() + first, {normal, normal + n, normal + 2 * n}};
  }
  [[nodiscard]] const double* distance() const { return m_distance.data(); }

private:
  std::vector<double> m_distance, m_normal;
};

/// A range of wires that one thread steps. The wires and the method stay.
class Stepper {
public:
  /// Answers of all wires go to `answers`, each to its place.
  Stepper(Method& method, const Wires& wires, std::size_t firstWire, std::size_t wireCount,
          AnswerBuffer& answers);
  /// Queries all points of the next frame: forth and back through all frames, so that no point jumps. The
  /// first step is frame 0.
  void step();
  [[nodiscard]] std::size_t frame() const { return m_frame; }
  [[nodiscard]] std::size_t count() const { return m_count; }

private:
  Method& m_method;
  const Wires& m_wires;
  std::size_t m_first, m_count;  ///< points
  AnswerBuffer& m_answers;
  std::size_t m_frame = 0;
  bool m_isNew = true, m_forward = true;
};

/// Starts the first so many wires anew.
void placeWires(Method& method, const Wires& wires, std::size_t environments);

/// One thing to measure, and the best that was seen of it.
struct Contest {
  Method* method = nullptr;
  std::size_t environments = 0;
  int threads = 1;
  double queriesPerSecond = 0;  ///< of the fastest of all turns
  double seconds = 0;           ///< spent on it
};

/// Takes turns, so that whatever else the machine does hits all alike; who has spent `enough` seconds is
/// left out from then on. Seconds are those of the threads' own clocks, which stand while others have the
/// processor; of several threads those of the one that needs most.
void measure(std::vector<Contest>& contests, const Wires& wires, int turns, double enough);

}  // namespace lumen::bench
