// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include <algorithm>
#include <ctime>
#include <thread>

namespace lumen::bench {
namespace {

double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Steps of one thread until its turn is over: queries and seconds.
struct Share {
  double queries = 0, seconds = 0;
};

Share takeShare(Stepper stepper) {
  constexpr double kTurn = 0.05;  // seconds
  constexpr std::size_t kBetween =
      12800;  // queries between looks at the clock, which costs some too
  const std::size_t steps = 1 + kBetween / std::max<std::size_t>(stepper.count(), 1);
  stepper.step();  // of cold caches, and of searches that have no step before
  Share share;
  const double start = threadSeconds();
  do {
    for (std::size_t i = 0; i < steps; ++i) stepper.step();
    share.queries += static_cast<double>(steps * stepper.count());
    share.seconds = threadSeconds() - start;
  } while (share.seconds < kTurn);
  return share;
}

// Each thread has a range of whole wires, and the same number of queries in a second as it would have in a
// step of all: the slowest says how long that takes.
void takeTurn(Contest& contest, const Wires& wires, AnswerBuffer& answers) {
  placeWires(*contest.method, wires, contest.environments);
  const auto threads = static_cast<std::size_t>(contest.threads);
  std::vector<Share> shares(threads);
  std::vector<std::thread> others;
  const auto run = [&](std::size_t t) {
    const std::size_t begin = contest.environments * t / threads;
    const std::size_t end = contest.environments * (t + 1) / threads;
    shares[t] = takeShare(Stepper(*contest.method, wires, begin, end - begin, answers));
  };
  for (std::size_t t = 1; t < threads; ++t) others.emplace_back(run, t);
  run(0);
  for (std::thread& other : others) other.join();
  double slowest = shares[0].queries / shares[0].seconds;
  for (const Share& share : shares) {
    slowest = std::min(slowest, share.queries / share.seconds);
    contest.seconds += share.seconds;
  }
  contest.queriesPerSecond =
      std::max(contest.queriesPerSecond, static_cast<double>(threads) * slowest);
}

}  // namespace

Stepper::Stepper(Method& method, const Wires& wires, std::size_t firstWire, std::size_t wireCount,
                 AnswerBuffer& answers)
    : m_method(method),
      m_wires(wires),
      m_first(firstWire * wires.points),
      m_count(wireCount * wires.points),
      m_answers(answers) {}

void Stepper::step() {
  const std::size_t last = m_wires.frames() - 1;
  if (!m_isNew && last > 0) {
    if (m_frame == (m_forward ? last : 0)) m_forward = !m_forward;
    m_frame = m_forward ? m_frame + 1 : m_frame - 1;
  }
  m_isNew = false;
  m_method.query(m_first, m_wires.position[m_frame].data() + 3 * m_first, m_count,
                 m_answers.from(m_first));
}

void placeWires(Method& method, const Wires& wires, std::size_t environments) {
  method.place({environments * wires.points, wires.position[0].data(), wires.station[0].data()});
}

void measure(std::vector<Contest>& contests, const Wires& wires, int turns, double enough) {
  AnswerBuffer answers(wires.count());
  for (int turn = 0; turn < turns; ++turn)
    for (Contest& contest : contests)
      if (contest.seconds < enough) takeTurn(contest, wires, answers);
}

}  // namespace lumen::bench
