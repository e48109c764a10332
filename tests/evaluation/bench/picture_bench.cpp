// SPDX-License-Identifier: Apache-2.0
// Where the time of lumen picture goes: opening the models, tracing, all of a picture, and the PNG.
//
//   build/release/tests/evaluation/bench/picture_bench CASE.lumen [THREADS]
//
// 1000 by 800 pixels from in front; the least of five runs, of the clock and of the processor.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <functional>
#include <limits>
#include <string>

#include <tbb/global_control.h>

#include "converters/draw/picture/draw_case.h"
#include "converters/engine/file_access.h"

namespace lumen::bench {
namespace {

double secondsOf(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void measure(const char* name, const std::function<void()>& work) {
  constexpr int kRuns = 5;
  double wall = std::numeric_limits<double>::infinity(), processor = wall;
  for (int run = 0; run < kRuns; ++run) {
    const double w = secondsOf(CLOCK_MONOTONIC), p = secondsOf(CLOCK_PROCESS_CPUTIME_ID);
    work();
    wall = std::min(wall, secondsOf(CLOCK_MONOTONIC) - w);
    processor = std::min(processor, secondsOf(CLOCK_PROCESS_CPUTIME_ID) - p);
  }
  std::printf("%-8s %6.3f s, processor %6.3f s\n", name, wall, processor);
}

void run(const std::string& file) {
  const formats::Case value = engine::readCase(file);
  Progress progress;
  convert::PictureOptions options;
  options.view = convert::View::Anterior;
  const convert::Camera camera = convert::cameraFor(
      value.tree, {options.view, 0, false, 2 * options.width, 2 * options.height, 0});
  const convert::SurfaceTracer tracer(value);
  const convert::CasePainter painter(value);
  const convert::Picture picture = painter.draw(options, progress);
  measure("open", [&] { const convert::SurfaceTracer again(value); });
  measure("trace", [&] { (void)tracer.trace(camera, progress); });
  measure("draw", [&] { (void)painter.draw(options, progress); });
  measure("PNG", [&] { (void)convert::encodePng(picture); });
}

}  // namespace
}  // namespace lumen::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: picture_bench CASE.lumen [THREADS]\n");
    return 2;
  }
  const int threads = argc > 2 ? std::max(1, std::atoi(argv[2])) : 2;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  try {
    lumen::bench::run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "picture_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
