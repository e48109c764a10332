// SPDX-License-Identifier: Apache-2.0
#include "fibers.h"

#include <cstdlib>
#include <vector>

#include <ucontext.h>

namespace lumen::blob::test {
namespace {

constexpr std::uint32_t kWarp = 32;
constexpr std::size_t kStack = 256 * 1024;

enum class Waits { No, ForBlock, ForWarp, Ended };

struct Fiber {
  ucontext_t context{};
  std::vector<char> stack = std::vector<char>(kStack);
  Waits waits = Waits::No;
  int offered = 0, received = 0;
};

struct Running {
  std::vector<Fiber> fibers;
  const std::function<void()>* kernel = nullptr;
  ucontext_t scheduler{};
  std::uint64_t block = 0;
  std::uint32_t thread = 0;
} g;

void enter() {
  (*g.kernel)();
  g.fibers[g.thread].waits = Waits::Ended;
  swapcontext(&g.fibers[g.thread].context, &g.scheduler);
}

void begin(Fiber& fiber) {
  getcontext(&fiber.context);
  fiber.context.uc_stack.ss_sp = fiber.stack.data();
  fiber.context.uc_stack.ss_size = fiber.stack.size();
  fiber.context.uc_link = nullptr;
  fiber.waits = Waits::No;
  makecontext(&fiber.context, enter, 0);
}

void wait(Waits waits) {
  g.fibers[g.thread].waits = waits;
  swapcontext(&g.fibers[g.thread].context, &g.scheduler);
}

// Lets threads go on that all wait alike; returns whether there were any.
bool letGo(std::size_t from, std::size_t to, Waits waits) {
  bool some = false;
  for (std::size_t i = from; i < to; ++i) {
    if (g.fibers[i].waits == Waits::Ended) continue;
    if (g.fibers[i].waits != waits) return false;
    some = true;
  }
  for (std::size_t i = from; i < to; ++i) {
    if (g.fibers[i].waits != waits) continue;
    g.fibers[i].received = g.fibers[from].offered;
    g.fibers[i].waits = Waits::No;
  }
  return some;
}

bool letSomeGo() {
  const std::size_t threads = g.fibers.size();
  if (letGo(0, threads, Waits::ForBlock)) return true;
  bool some = false;
  for (std::size_t first = 0; first < threads; first += kWarp)
    some = letGo(first, first + kWarp, Waits::ForWarp) || some;
  return some;
}

bool hasEnded() {
  for (const Fiber& fiber : g.fibers)
    if (fiber.waits != Waits::Ended) return false;
  return true;
}

void runBlock() {
  for (Fiber& fiber : g.fibers) begin(fiber);
  for (;;) {
    for (g.thread = 0; g.thread < g.fibers.size(); ++g.thread)
      if (g.fibers[g.thread].waits == Waits::No)
        swapcontext(&g.scheduler, &g.fibers[g.thread].context);
    if (hasEnded()) return;
    if (!letSomeGo()) std::abort();
  }
}

}  // namespace

void runBlocks(std::uint64_t blocks, std::uint32_t threads, const std::function<void()>& kernel) {
  if (threads % kWarp != 0) std::abort();
  g.fibers.resize(threads);
  g.kernel = &kernel;
  for (g.block = 0; g.block < blocks; ++g.block) runBlock();
}

std::uint64_t threadIndex() {
  return g.block * g.fibers.size() + g.thread;
}

void syncBlock() {
  wait(Waits::ForBlock);
}

int ofFirstThread(int value) {
  g.fibers[g.thread].offered = value;
  wait(Waits::ForWarp);
  return g.fibers[g.thread].received;
}

}  // namespace lumen::blob::test
