// SPDX-License-Identifier: Apache-2.0
// Runs targets: under libFuzzer the one that LUMEN_FUZZ_TARGET names, else each over the files of the
// folders that follow its name, so that the corpus is a test wherever there is no libFuzzer.
#include "fuzz/fuzz.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

namespace {

namespace fs = std::filesystem;
using lumen::fuzz::Target;

const Target* targetOf(std::string_view name) {
  using namespace lumen::fuzz;
  for (const auto targets :
       {caseTargets(), centerlineTargets(), meshTargets(), seedTargets(), volumeTargets()})
    for (const Target& target : targets)
      if (name == target.name) return &target;
  return nullptr;
}

}  // namespace

#ifdef LUMEN_FUZZ_TARGET

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Target* const target = targetOf(LUMEN_FUZZ_TARGET);
  target->run(std::as_bytes(std::span(data, size)));
  return 0;
}

#else

namespace {

void replay(const Target& target, const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  // an allocation of exactly this size, so that a sanitizer sees a read of one byte more
  const auto exact = std::make_unique<std::byte[]>(text.size());
  std::ranges::copy(std::as_bytes(std::span(text)), exact.get());
  target.run(std::span(exact.get(), text.size()));
}

std::size_t replayFolder(const Target& target, const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  for (const fs::path& file : files) replay(target, file);
  return files.size();
}

}  // namespace

int main(int argc, char** argv) {
  const Target* target = argc > 1 ? targetOf(argv[1]) : nullptr;
  if (!target) {
    std::fprintf(stderr, "Usage: fuzz TARGET FOLDER... [TARGET FOLDER...]...\n");
    return 2;
  }
  std::size_t inputs = 0;
  for (int i = 1; i < argc; ++i) {
    if (const Target* next = targetOf(argv[i])) {
      target = next;
      continue;
    }
    const std::size_t read = replayFolder(*target, argv[i]);
    std::printf("%s: %zu inputs of %s\n", target->name, read, argv[i]);
    std::fflush(stdout);
    if (read == 0) return 1;
    inputs += read;
  }
  return inputs > 0 ? 0 : 1;
}

#endif
