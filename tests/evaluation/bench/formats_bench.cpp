// SPDX-License-Identifier: Apache-2.0
// Reading and writing a case of 10 000 nodes with a million points and 64 000 blobs.
#include <benchmark/benchmark.h>

#include "formats/container/crc32c.h"
#include "unit/formats/sample_case.h"

namespace lumen::formats {
namespace {

Case large() {
  Case value = test::longCase(10000, 100, 6);
  return value;
}

void reportBytes(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void openContainer(benchmark::State& state) {
  const auto file = encodeBinary(large());
  for (auto _ : state) benchmark::DoNotOptimize(readContainer(file));
}
BENCHMARK(openContainer)->Unit(benchmark::kMicrosecond);

void checksum(benchmark::State& state) {
  const auto file = encodeBinary(large());
  for (auto _ : state) benchmark::DoNotOptimize(crc32c(file));
  reportBytes(state, file.size());
}
BENCHMARK(checksum)->Unit(benchmark::kMillisecond);

void decodeBinaryCase(benchmark::State& state) {
  const auto file = encodeBinary(large());
  for (auto _ : state) benchmark::DoNotOptimize(decodeBinary(file));
  reportBytes(state, file.size());
}
BENCHMARK(decodeBinaryCase)->Unit(benchmark::kMillisecond);

void encodeBinaryCase(benchmark::State& state) {
  const Case value = large();
  for (auto _ : state) benchmark::DoNotOptimize(encodeBinary(value));
}
BENCHMARK(encodeBinaryCase)->Unit(benchmark::kMillisecond);

void decodeJsonCase(benchmark::State& state) {
  const std::string text = encodeJson(large());
  for (auto _ : state) benchmark::DoNotOptimize(decodeJson(text));
  reportBytes(state, text.size());
}
BENCHMARK(decodeJsonCase)->Unit(benchmark::kMillisecond);

void encodeJsonCase(benchmark::State& state) {
  const Case value = large();
  for (auto _ : state) benchmark::DoNotOptimize(encodeJson(value));
}
BENCHMARK(encodeJsonCase)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lumen::formats
