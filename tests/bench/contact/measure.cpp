// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include <algorithm>
#include <chrono>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace lumen::bench {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Steps until a turn's time is over, at least one.
void takeTurn(Contest& contest, const Wires& wires, AnswerBuffer& answers) {
  constexpr double kTurn = 0.05;  // seconds
  Stepper stepper(*contest.method, wires, contest.environments, contest.threads, answers);
  const Clock::time_point begin = Clock::now();
  stepper.place();
  stepper.step();  // what a cold cache costs, and a first search
  std::size_t queries = 0;
  const Clock::time_point start = Clock::now();
  double time;
  do {
    stepper.step();
    queries += stepper.count();
    time = secondsSince(start);
  } while (time < kTurn);
  contest.queriesPerSecond =
      std::max(contest.queriesPerSecond, static_cast<double>(queries) / time);
  contest.seconds += secondsSince(begin);
}

}  // namespace

Stepper::Stepper(Method& method, const Wires& wires, std::size_t environments, int threads,
                 AnswerBuffer& answers)
    : m_method(method),
      m_wires(wires),
      m_count(environments * wires.points),
      m_threads(threads),
      m_answers(answers) {}

void Stepper::place() {
  m_frame = 0;
  m_forward = true;
  m_method.place({m_count, m_wires.position[0].data(), m_wires.station[0].data()});
}

void Stepper::step() {
  const std::size_t last = m_wires.frames() - 1;
  if (m_frame == (m_forward ? last : 0)) m_forward = !m_forward;
  if (last > 0) m_frame = m_forward ? m_frame + 1 : m_frame - 1;
  const double* points = m_wires.position[m_frame].data();
  if (m_threads == 1) return m_method.query(0, points, m_count, m_answers.from(0));
  // a share of whole wires for each thread
  const std::size_t wires = m_count / m_wires.points;
  const auto begin = [&](int t) {
    return wires * static_cast<std::size_t>(t) / static_cast<std::size_t>(m_threads) *
           m_wires.points;
  };
  tbb::task_arena arena(m_threads);
  arena.execute([&] {
    tbb::parallel_for(
        0, m_threads,
        [&](int t) {
          const std::size_t first = begin(t), count = begin(t + 1) - first;
          if (count > 0)
            m_method.query(first, points + 3 * first, count, m_answers.from(first));
        },
        tbb::static_partitioner());
  });
}

void measure(std::vector<Contest>& contests, const Wires& wires, int turns, double enough) {
  AnswerBuffer answers(wires.count());
  for (int turn = 0; turn < turns; ++turn)
    for (Contest& contest : contests)
      if (contest.seconds < enough) takeTurn(contest, wires, answers);
}

}  // namespace lumen::bench
