// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/interrupt.h"

#include <cstdio>
#include <ctime>

#include <signal.h>
#include <unistd.h>

#include "formats/case/atomic_file.h"

namespace lumen {

namespace {

constexpr timespec kGrace{0, 800'000'000};

bool isIgnored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// The signals that interrupt, and SIGUSR1, by which the guard ends its waiting thread. A program
/// that was started by nohup ignores SIGHUP and goes on.
sigset_t awaitedSignals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1}) sigaddset(&set, signal);
  if (!isIgnored(SIGHUP)) sigaddset(&set, SIGHUP);
  return set;
}

}  // namespace

void reportFileSizeLimit() {
  signal(SIGXFSZ, SIG_IGN);
}

InterruptGuard::InterruptGuard(Progress& progress) : m_progress(progress) {
  // a shell starts background jobs with SIGINT ignored, and an ignored signal never becomes pending
  signal(SIGINT, SIG_DFL);
  const sigset_t blocked = awaitedSignals();
  pthread_sigmask(SIG_BLOCK, &blocked, nullptr);
  m_thread = std::thread([this] { wait(); });
}

InterruptGuard::~InterruptGuard() {
  pthread_kill(m_thread.native_handle(), SIGUSR1);
  m_thread.join();
}

void InterruptGuard::wait() {
  const sigset_t awaited = awaitedSignals();
  int received = 0;
  while (sigwait(&awaited, &received) != 0) {
  }
  if (received == SIGUSR1) return;
  m_progress.cancel();
  received = sigtimedwait(&awaited, nullptr, &kGrace);
  if (received != SIGUSR1) exitNow();
}

void InterruptGuard::exitNow() {
  formats::removeOwnTemporaries();
  std::fputs("\nlumen: interrupted\n", stderr);
  _exit(static_cast<int>(ErrorKind::Cancelled));
}

}  // namespace lumen
