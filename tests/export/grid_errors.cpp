// SPDX-License-Identifier: Apache-2.0
// How far grids of a case are from its field, and what they say where vessels touch: the tables of docs/grids.md.
// grid_errors CASE SPACING...
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionShapes/btSdfCollisionShape.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include "converters/base/error.h"
#include "converters/base/vectors.h"
#include "converters/export/shared/grid_files.h"
#include "converters/stages/surface/closing/closed_surface.h"
#include "formats/case/case_file.h"
#include "tests/unit/export/kissing.h"

namespace {

using namespace lumen;
using namespace lumen::convert;

constexpr double kMostFromWall = 0.5;  // mm: points are as far from a wall, at most
constexpr double kTouching = 1;        // mm: another vessel's wall is as near
constexpr double kClearly = 0.1;       // mm: a sign that is wrong deeper than this is no rounding
constexpr double kBand = 1;            // mm
constexpr int kPoints = 100000;

/// A place of a tool in a branch, near that branch's wall.
struct Probe {
  Eigen::Vector3d place;
  std::uint32_t branch;
  double own, all;  ///< mm, of the branch, and of all vessels
  bool touching;    ///< another vessel, not near along the tree, has its wall near by
};

struct Case {
  formats::Case source;
  VesselDistance vessels;
  std::vector<TreeRegion> regions;
  SurfaceMesh wall;
  explicit Case(formats::Case value) : source(std::move(value)), vessels(source) {
    Progress silent;
    for (std::uint32_t b = 0; b < source.tree.branches.size(); ++b)
      regions.push_back(regionOfBranch(source.tree, b));
    wall = quickSurface(source, silent);
  }
};

double distanceOf(const Case& c, std::uint32_t branch, const Eigen::Vector3d& p) {
  return static_cast<double>(test::askBranch(c.vessels, c.regions[branch], p).distance);
}

/// Whether a branch that has no node in the region of `branch` has a wall near `p`.
bool isTouched(const Case& c, std::uint32_t branch, const Eigen::Vector3d& p) {
  const auto& tree = c.source.tree;
  std::vector<bool> known(tree.branches.size());
  for (const std::uint32_t n : c.regions[branch]) known[tree.branch[n]] = true;
  for (std::uint32_t n = 0; n < tree.nodeCount(); ++n) {
    if (known[tree.branch[n]]) continue;
    const double x = p[0] - static_cast<double>(tree.centre[n].x),
                 y = p[1] - static_cast<double>(tree.centre[n].y),
                 z = p[2] - static_cast<double>(tree.centre[n].z);
    const double reach = 2 * static_cast<double>(tree.radius[n]) + kTouching;
    if (x * x + y * y + z * z > reach * reach) continue;
    known[tree.branch[n]] = true;
    if (std::abs(distanceOf(c, tree.branch[n], p)) < kTouching) return true;
  }
  return false;
}

std::vector<Probe> probesOf(const Case& c) {
  std::vector<Probe> probes;
  std::mt19937_64 random(1);
  const auto share = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  while (probes.size() < kPoints) {
    const std::size_t v = random() % c.wall.position.size();
    const double along = kMostFromWall * (2 * share() - 1);
    const Eigen::Vector3d p = toEigen(c.wall.position[v]) + along * toEigen(c.wall.normal[v]);
    const std::uint32_t branch = c.source.tree.branch[c.wall.node[v]];
    const double own = distanceOf(c, branch, p);
    if (std::abs(own) > kMostFromWall) continue;
    probes.push_back({p, branch, own, static_cast<double>(test::askAll(c.vessels, p).distance),
                      isTouched(c, branch, p)});
  }
  return probes;
}

Box3d boundingBox(const Case& c, const TreeRegion* region) {
  Box3d box;
  for (std::size_t v = 0; v < c.wall.position.size(); ++v)
    if (!region || std::binary_search(region->begin(), region->end(), c.wall.node[v]))
      box.add(toEigen(c.wall.position[v]));
  return box;
}

/// Answers of a grid at every probe; NaN: none.
using Answers = std::vector<double>;

void report(const char* name, double spacing, double megabytes, double seconds,
            const std::vector<Probe>& probes, const Answers& answers, bool isOwn) {
  std::vector<double> errors;
  std::size_t touching = 0, wrong = 0, leaks = 0, walls = 0;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (std::isnan(answers[i])) continue;
    errors.push_back(std::abs(answers[i] - (isOwn ? probes[i].own : probes[i].all)));
    if (!probes[i].touching) continue;
    ++touching;
    if ((answers[i] < 0) == (probes[i].own < 0)) continue;
    ++wrong;
    if (std::abs(probes[i].own) > kClearly) ++(probes[i].own > 0 ? leaks : walls);
  }
  std::sort(errors.begin(), errors.end());
  double sum = 0;
  for (const double e : errors) sum += e;
  const double n = static_cast<double>(errors.size());
  std::printf("| %s | %.3g | %.0f | %.1f | %.4f | %.4f | %.3f | %zu | %zu | %zu | %zu |\n", name,
              spacing, megabytes, seconds, sum / n,
              errors[static_cast<std::size_t>(0.99 * (n - 1))], errors.back(), touching, wrong,
              leaks, walls);
  std::fflush(stdout);
}

class Clock {
public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_begin).count();
  }

private:
  std::chrono::steady_clock::time_point m_begin = std::chrono::steady_clock::now();
};

void measureDense(const Case& c, const std::vector<Probe>& probes, double h) {
  Progress silent;
  const Clock clock;
  const DistanceGrid grid =
      sampleGrid({c.vessels}, latticeOver(boundingBox(c, nullptr), 2, h), silent);
  const double seconds = clock.seconds();
  Answers answers;
  for (const Probe& probe : probes) answers.push_back(test::trilinear(grid, probe.place));
  report("one grid, floats", h, 4e-6 * static_cast<double>(grid.values.size()), seconds, probes,
         answers, false);
}

void measureBranches(const Case& c, const std::vector<Probe>& probes, double h) {
  Progress silent;
  const Lattice whole = latticeOver(boundingBox(c, nullptr), 2, h);
  Answers answers(probes.size(), std::nan(""));
  double samples = 0, seconds = 0;
  for (std::uint32_t b = 0; b < c.regions.size(); ++b) {
    const Clock clock;
    const DistanceGrid grid =
        sampleGrid({c.vessels, &c.regions[b], kBand + 2 * h},
                   cropLattice(whole, boundingBox(c, &c.regions[b]), 2), silent);
    seconds += clock.seconds();
    samples += static_cast<double>(grid.values.size());
    for (std::size_t i = 0; i < probes.size(); ++i)
      if (probes[i].branch == b) answers[i] = test::trilinear(grid, probes[i].place);
  }
  report("a grid for each branch, floats", h, 4e-6 * samples, seconds, probes, answers, true);
}

void measureVdb(const Case& c, const std::vector<Probe>& probes, double h, bool half) {
  Progress silent;
  const Clock clock;
  const std::string bytes =
      encodeVdb({c.vessels, nullptr, std::max(kBand, 3 * h)},
                latticeOver(boundingBox(c, nullptr), 2, h), {.half = half}, silent);
  const double seconds = clock.seconds();
  std::istringstream in(bytes, std::ios::binary);
  openvdb::io::Stream stream(in, false);
  openvdb::FloatGrid::Ptr set;
  for (const auto& grid : *stream.getGrids())
    if (grid->getName() == "distance") set = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sample(*set);
  Answers answers;
  for (const Probe& probe : probes)
    answers.push_back(
        static_cast<double>(sample.wsSample({probe.place[0], probe.place[1], probe.place[2]})));
  report(half ? "OpenVDB, half floats" : "OpenVDB", h, 1e-6 * static_cast<double>(bytes.size()),
         seconds, probes, answers, false);
}

void measureCdf(const Case& c, const std::vector<Probe>& probes, double h) {
  Progress silent;
  const Clock clock;
  const std::string bytes =
      encodeCdf({c.vessels, nullptr, kBand}, latticeOver(boundingBox(c, nullptr), 2, h), 1, silent);
  const double seconds = clock.seconds();
  btSdfCollisionShape shape;
  if (!shape.initializeSDF(bytes.data(), static_cast<int>(bytes.size()))) std::abort();
  Answers answers;
  for (const Probe& probe : probes) {
    btScalar distance = 0;
    btVector3 normal;
    const auto at = [&](Eigen::Index a) { return static_cast<btScalar>(probe.place[a]); };
    const bool isKnown = shape.queryPoint({at(0), at(1), at(2)}, distance, normal);
    answers.push_back(isKnown ? -static_cast<double>(distance) : std::nan(""));
  }
  report(".cdf in Bullet", h, 1e-6 * static_cast<double>(bytes.size()), seconds, probes, answers,
         false);
}

/// A grid that would be too large is left out, which is said.
template <class Measure>
void attempt(Measure measure) {
  try {
    measure();
  } catch (const Error& error) {
    std::printf("%s\n", error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return std::fputs("usage: grid_errors CASE SPACING...\n", stderr), 2;
  auto read = formats::readCaseFile(argv[1]);
  if (!read) return std::fputs("cannot read the case\n", stderr), 3;
  openvdb::initialize();
  const Case c(std::move(*read));
  const std::vector<Probe> probes = probesOf(c);
  const auto touched = std::count_if(probes.begin(), probes.end(),
                                     [](const Probe& probe) { return probe.touching; });
  std::printf(
      "%zu points within %g mm of a wall, %td of them where another vessel's wall is within "
      "%g mm\n\n",
      probes.size(), kMostFromWall, touched, kTouching);
  std::puts(
      "| grid | h, mm | MB | s | mean error | 99 % | greatest | touching | wrong sign | leaks > "
      "0.1 mm | walls > 0.1 mm |\n|---|---|---|---|---|---|---|---|---|---|---|");
  for (int i = 2; i < argc; ++i) {
    const double h = std::atof(argv[i]);
    attempt([&] { measureDense(c, probes, h); });
    attempt([&] { measureBranches(c, probes, h); });
    attempt([&] { measureVdb(c, probes, h, false); });
    attempt([&] { measureVdb(c, probes, h, true); });
    attempt([&] { measureCdf(c, probes, h); });
  }
  return 0;
}
