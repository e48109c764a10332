// SPDX-License-Identifier: Apache-2.0
// Where is the wall? libblob and its rivals on the same vessel and the same tool, in one process
// and one thread, warm.
//
//   query_bench [--json FILE] [--svg FILE] SURFACE...   SURFACE: capsule, spiral, or a case with
//   models
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "method.h"
#include "surfaces.h"

namespace lumen::bench {
namespace {

struct MethodFigures {
  std::string surface, method;
  double nanoseconds = 0;                 ///< per query
  double medianError = 0, highError = 0;  ///< of the distance, against EXACT; 99th percentile, mm
  double megabytes = 0;
};

double of(const std::vector<MethodFigures>& rows, const std::string& surface,
          const std::string& method) {
  for (const MethodFigures& row : rows)
    if (row.surface == surface && row.method == method) return row.nanoseconds;
  return 0;
}

std::string number(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

std::string orDash(double value, int digits) {
  return value > 0 ? number(value, digits) : "-";
}

const char* colourOf(const std::string& method) {
  if (method.rfind("libblob", 0) == 0) return "#1f6f8b";
  return method.rfind("floor", 0) == 0 ? "#999999" : "#c8553d";
}

std::string markdown(const std::vector<MethodFigures>& rows) {
  std::ostringstream out;
  out << "| surface | method | ns per query | times LOCAL | median error, mm | 99 % error, mm | MB "
         "|\n"
         "|---|---|---:|---:|---:|---:|---:|\n";
  for (const MethodFigures& row : rows) {
    const double local = of(rows, row.surface, "libblob LOCAL");
    out << "| " << row.surface << " | " << row.method << " | " << number(row.nanoseconds, 1)
        << " | " << number(row.nanoseconds / local, 2) << " | " << orDash(row.medianError, 5)
        << " | " << orDash(row.highError, 5) << " | " << orDash(row.megabytes, 2) << " |\n";
  }
  return out.str();
}

std::string json(const std::vector<MethodFigures>& rows) {
  std::ostringstream out;
  out << "[\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    out << "  {\"surface\": \"" << rows[i].surface << "\", \"method\": \"" << rows[i].method
        << "\", \"nanoseconds\": " << number(rows[i].nanoseconds, 2)
        << ", \"medianErrorMm\": " << number(rows[i].medianError, 7)
        << ", \"highErrorMm\": " << number(rows[i].highError, 7)
        << ", \"megabytes\": " << number(rows[i].megabytes, 3) << "}"
        << (i + 1 < rows.size() ? ",\n" : "\n");
  out << "]\n";
  return out.str();
}

// Bars on a logarithmic axis, from 1 ns to 1 ms.
std::string svg(const std::vector<MethodFigures>& rows) {
  constexpr int kLine = 20, kLeft = 300, kWidth = 600, kDecades = 6;
  const int height = 60 + kLine * static_cast<int>(rows.size());
  std::ostringstream out;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kLeft + kWidth + 90
      << "\" height=\"" << height
      << "\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"white\"/>\n<text x=\"10\" y=\"18\" font-size=\"14\">Time per query</text>\n";
  const char* ticks[] = {"1 ns", "10 ns", "100 ns", "1 us", "10 us", "100 us", "1 ms"};
  for (int d = 0; d <= kDecades; ++d) {
    const int x = kLeft + d * kWidth / kDecades;
    out << "<line x1=\"" << x << "\" x2=\"" << x << "\" y1=\"40\" y2=\"" << height - 10
        << "\" stroke=\"#dddddd\"/><text x=\"" << x << "\" y=\"34\" text-anchor=\"middle\">"
        << ticks[d] << "</text>\n";
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int y = 44 + kLine * static_cast<int>(i);
    const double decades = std::log10(std::max(rows[i].nanoseconds, 1.0));
    const double length = std::min(decades, double{kDecades}) * kWidth / kDecades;
    out << "<text x=\"" << kLeft - 8 << "\" y=\"" << y + 13 << "\" text-anchor=\"end\">"
        << rows[i].surface << ": " << rows[i].method << "</text><rect x=\"" << kLeft << "\" y=\""
        << y + 2 << "\" width=\"" << number(length, 1) << "\" height=\"" << kLine - 6
        << "\" fill=\"" << colourOf(rows[i].method) << "\"/><text x=\""
        << number(kLeft + length + 6, 1) << "\" y=\"" << y + 13 << "\">"
        << number(rows[i].nanoseconds, rows[i].nanoseconds < 100 ? 1 : 0) << " ns</text>\n";
  }
  out << "</svg>\n";
  return out.str();
}

using Clock = std::chrono::steady_clock;

double nanosecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
}

// The best of several passes over all frames, ns per query; distances of all frames.
double measure(Method& method, const Surface& surface, std::vector<double>& distances) {
  distances.resize(surface.points.size() / 3);
  double best = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass <= method.passes(); ++pass) {
    const Clock::time_point start = Clock::now();
    for (std::size_t frame = 0; frame < surface.frames(); ++frame)
      method.query(0, &surface.points[3 * frame * surface.toolPoints], surface.toolPoints,
                   Answers{&distances[frame * surface.toolPoints], {}});
    const double time = nanosecondsSince(start) / static_cast<double>(distances.size());
    if (pass > 0 || method.passes() == 1) best = std::min(best, time);
  }
  return best;
}

void compare(const std::vector<double>& truth, const std::vector<double>& found,
             MethodFigures& row) {
  std::vector<double> error;
  for (std::size_t i = 0; i < truth.size(); ++i)
    error.push_back(std::abs(std::abs(truth[i]) - std::abs(found[i])));
  std::sort(error.begin(), error.end());
  row.medianError = error[error.size() / 2];
  row.highError = error[error.size() * 99 / 100];
}

bool givesDistance(const std::string& method) {
  return method.find("inside") == std::string::npos && method.find("locate") == std::string::npos &&
         method.find("floor") == std::string::npos;
}

void runSurface(const std::string& what, bool atWall, Methods& methods,
                std::vector<MethodFigures>& rows) {
  const OwnedSurface owned = makeSurface(what, atWall);
  const Surface& surface = owned.surface;
  const Vessel& vessel = owned.owned.vessel;
  const blob_model_info info = blob_model_describe(vessel.model);
  std::cerr << vessel.name << ": " << info.node_count << " nodes, " << info.blob_count << " blobs, "
            << vessel.mesh.face.size() << " triangles\n";
  std::vector<double> truth, distances;
  for (const auto& method : methods) {
    method->prepare(vessel);
    method->place({surface.toolPoints, surface.points.data(), nullptr});
    MethodFigures row;
    row.surface = vessel.name;
    row.method = method->name();
    row.nanoseconds = measure(*method, surface, distances);
    row.megabytes = method->megabytes();
    if (truth.empty()) truth = distances;  // EXACT comes first
    if (givesDistance(row.method)) compare(truth, distances, row);
    rows.push_back(row);
    std::cerr << "  " << row.method << " " << row.nanoseconds << " ns\n";
  }
}

// Half of the tool in each of two threads, against all of it in one: the speed-up.
double twoThreads(const OwnedSurface& owned) {
  const Surface& surface = owned.surface;
  constexpr int kPasses = 2000;
  const auto work = [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> cursor(end - begin, BLOB_NOWHERE);
    std::vector<blob_sample> sample(end - begin);
    for (int pass = 0; pass < kPasses; ++pass)
      for (std::size_t frame = 0; frame < surface.frames(); ++frame)
        blob_query_many(owned.owned.vessel.model, 0, end - begin,
                        reinterpret_cast<const double(*)[3]>(
                            &surface.points[3 * (frame * surface.toolPoints + begin)]),
                        cursor.data(), sample.data());
  };
  Clock::time_point start = Clock::now();
  work(0, surface.toolPoints);
  const double one = nanosecondsSince(start);
  start = Clock::now();
  std::thread other(work, 0, surface.toolPoints / 2);
  work(surface.toolPoints / 2, surface.toolPoints);
  other.join();
  return one / nanosecondsSince(start);
}

// A walk of 10,000 nodes, 0.5 mm a step, and points near it.
double locateTenThousand() {
  constexpr std::size_t kNodes = 10000;
  std::mt19937 random(1);
  std::normal_distribution<float> turn(0, 0.1f), off(0, 1);
  std::vector<std::array<float, 3>> centre(1);
  float d[3] = {0.5f, 0, 0};
  while (centre.size() < kNodes) {
    std::array<float, 3> next = centre.back();
    float length = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      d[i] += turn(random) - 1e-4f * next[i];
      length += d[i] * d[i];
    }
    for (std::size_t i = 0; i < 3; ++i) next[i] += d[i] *= 0.5f / std::sqrt(length);
    centre.push_back(next);
  }
  const std::vector<float> radius(kNodes, 1.0f);
  const std::vector<std::uint32_t> offset(kNodes + 1, 0);
  blob_model_def def = blob_model_def_default();
  def.node_count = kNodes;
  def.centre = reinterpret_cast<const float(*)[3]>(centre.data());
  def.radius = radius.data();
  def.blobs.offset = offset.data();
  blob_model* model = nullptr;
  if (blob_model_create(&def, &model) != BLOB_OK) return 0;
  std::vector<std::array<double, 3>> point(20000);
  for (auto& p : point) {
    const auto& c = centre[random() % kNodes];
    for (std::size_t i = 0; i < 3; ++i) p[i] = static_cast<double>(c[i] + off(random));
  }
  double best = std::numeric_limits<double>::infinity();
  std::uint32_t sum = 0;
  for (int pass = 0; pass < 20; ++pass) {
    const Clock::time_point start = Clock::now();
    for (const auto& p : point) sum += blob_cursor_locate(model, p.data());
    best = std::min(best, nanosecondsSince(start) / static_cast<double>(point.size()));
  }
  blob_model_close(model);
  return sum == 0 ? 0 : best;
}

void write(const std::string& file, const std::string& text) {
  if (!file.empty()) std::ofstream(file) << text;
}

int run(int argc, char** argv) {
  std::string jsonFile, svgFile;
  std::vector<std::string> surfaces;
  bool atWall = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json" && i + 1 < argc)
      jsonFile = argv[++i];
    else if (argument == "--svg" && i + 1 < argc)
      svgFile = argv[++i];
    else if (argument == "--wall")
      atWall = true;
    else
      surfaces.push_back(argument);
  }
  if (surfaces.empty()) surfaces = {"capsule", "spiral"};
  Methods methods;
  addBlobMethods(methods);
  addFloor(methods);
  addGrid(methods);
#ifdef LUMEN_BENCH_OPENVDB
  addOpenVdb(methods);
#endif
#ifdef LUMEN_BENCH_EMBREE
  addEmbree(methods, false);
#endif
#ifdef LUMEN_BENCH_CGAL
  addCgal(methods);
#endif
#ifdef LUMEN_BENCH_FCL
  addFcl(methods, false);
#endif
  std::vector<MethodFigures> rows;
  for (const std::string& what : surfaces) runSurface(what, atWall, methods, rows);
  std::cout << markdown(rows) << "\nlocate among 10,000 nodes: " << locateTenThousand()
            << " ns\ntwo threads: " << twoThreads(makeSurface(surfaces.back(), atWall))
            << " times as fast as one\n";
  write(jsonFile, json(rows));
  write(svgFile, svg(rows));
  return 0;
}

}  // namespace
}  // namespace lumen::bench

int main(int argc, char** argv) {
  try {
    return lumen::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "query_bench: " << error.what() << "\n";
    return 1;
  }
}
