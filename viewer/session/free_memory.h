// SPDX-License-Identifier: Apache-2.0
// Memory that a long-running server gives back to the system.
#pragma once

namespace lumen::viewer {

/// From now on large blocks go back to the system when they are freed, not only those of the size
/// that the first of them had. Does nothing without the GNU C library.
void returnLargeBlocks();

/// Gives free memory of all threads back to the system: after a surface or a job, which take many
/// times what they leave. Takes milliseconds. Does nothing without the GNU C library.
void returnFreeMemory();

}  // namespace lumen::viewer
