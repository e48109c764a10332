// SPDX-License-Identifier: Apache-2.0
// write_man FILE: the manual page lumen(1), while lumen is built.
#include "converters/base/files.h"
#include "converters/cli/help_text.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  lumen::writeNewFile(lumen::cli::manPage(), argv[1]);
}
