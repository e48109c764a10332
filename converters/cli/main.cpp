// SPDX-License-Identifier: Apache-2.0
#include "converters/cli/command_line.h"

int main(int argc, char** argv) {
  return lumen::cli::runCommandLine(argc, argv);
}
