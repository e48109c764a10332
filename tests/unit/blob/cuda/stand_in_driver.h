// SPDX-License-Identifier: Apache-2.0
// A stand-in for NVIDIA's driver: a library of the same soname whose device is host memory, and which
// runs the kernels of query.cu as this processor's compiler makes them, in fibers. A launch waits in its stream
// until run() or cuStreamSynchronize() is called. It proves nothing about graphics processors.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <vector>

/// A stream; its launches wait.
struct CUstream_st {
  std::deque<std::function<void()>> launches;
};

namespace lumen::blob::test::stand_in {

/// Forgets contexts, memory, calls and faults.
void reset(int devices = 1);
/// Makes a function of this name fail with a result from now on.
void failAt(const std::string& function, int result);
/// Names of the functions that were called, in order.
std::vector<std::string> takeCalls();
/// Runs a stream's launches in their order; null: the default stream.
void run(CUstream_st* stream);
/// Launches that wait in a stream.
std::size_t waiting(CUstream_st* stream);
/// Blocks of memory, modules and retained contexts that are held.
std::size_t held();
/// Contexts that are current on the calling thread.
std::size_t entered();
/// Makes a context of its own current on the calling thread.
void enterOwnContext();
/// A kernel that has run.
struct Launch {
  std::string kernel;
  std::size_t threads;
};
/// Launches that have run since the last call.
std::vector<Launch> takeLaunches();

}  // namespace lumen::blob::test::stand_in
