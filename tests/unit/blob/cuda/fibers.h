// SPDX-License-Identifier: Apache-2.0
// Threads of a graphics processor as fibers of this one, so that kernels whose threads wait for one
// another run here.
#pragma once

#include <cstdint>
#include <functional>

namespace lumen::blob::test {

/// Runs a kernel in blocks of threads, one block after another; in a block each thread runs until it
/// waits or ends. Threads that end no longer count. Aborts where some wait for what cannot come.
void runBlocks(std::uint64_t blocks, std::uint32_t threads, const std::function<void()>& kernel);

/// The index in the launch of the thread that runs.
std::uint64_t threadIndex();
/// Waits for all threads of the block.
void syncBlock();
/// The value of the first thread of a warp of 32, for which all of them wait.
int ofFirstThread(int value);

}  // namespace lumen::blob::test
