// SPDX-License-Identifier: Apache-2.0
// write_man FILE: the manual page lumen(1), while lumen is built.
#include <fstream>

#include "converters/cli/man_page.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::ofstream file(argv[1], std::ios::binary);
  file << lumen::cli::manPage() << std::flush;
  return file.good() ? 0 : 1;
}
