// SPDX-License-Identifier: Apache-2.0
// lumen_circles FOLDER: circles from pixelated discs by nine combinations of interpolation and
// gradient (Yureidini's thesis, 3.8.2, table 3.2). Writes circles.md, circles.json and
// circles.plot.json.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "circle_search.h"
#include "plot.h"
#include "report.h"

namespace {

using namespace lumen;
using namespace lumen::reproduce;

constexpr std::size_t kFewestAcross = 2, kMostAcross = 10, kMostAcrossLow = 4, kPlaces = 6;
constexpr std::size_t kImages = (kMostAcross - kFewestAcross + 1) * kPlaces * kPlaces;
constexpr int kGrid = 10;  // foci to a radius

/// Table 3.2: RMS of the centre (all, low), of the radius (all, low), then mean and standard
/// deviation (all, low) of the distances from the found circle, from the true one, and of the rate.
using Published = std::array<double, 16>;
constexpr std::array<Published, kConfigurations> kPublished = {
    {{.309, .528, .180, .307, .190, .182, .368, .222, .156, .100, .267, .100, .681, .142, .538,
      .084},
     {.269, .459, .170, .291, .179, .171, .347, .209, .150, .100, .262, .099, .697, .152, .538,
      .087},
     {.108, .180, .080, .135, .083, .074, .149, .097, .080, .053, .136, .056, .894, .121, .759,
      .101},
     {.107, .179, .075, .128, .082, .073, .149, .096, .079, .052, .135, .054, .894, .120, .760,
      .100},
     {.064, .098, .042, .064, .053, .039, .085, .053, .058, .038, .097, .040, .949, .102, .860,
      .135},
     {.062, .095, .040, .061, .052, .038, .084, .051, .055, .041, .095, .045, .952, .099, .865,
      .133},
     {.168, .282, .082, .134, .114, .101, .211, .124, .114, .081, .205, .081, .808, .168, .616,
      .096},
     {.070, .110, .069, .114, .057, .043, .097, .052, .068, .061, .132, .066, .932, .117, .815,
      .134},
     {.062, .093, .091, .153, .053, .038, .086, .045, .075, .076, .149, .090, .940, .107, .847,
      .131}}};

/// Sums over instances.
struct Sums {
  double count = 0, none = 0, centre = 0, radius = 0;
  std::array<double, 3> first{}, second{};  ///< found circle, true circle, rate

  void add(const Sums& o) {
    count += o.count, none += o.none, centre += o.centre, radius += o.radius;
    for (std::size_t k = 0; k < 3; ++k) first[k] += o.first[k], second[k] += o.second[k];
  }
  /// In the order of Published, every other value.
  [[nodiscard]] std::array<double, 8> figures() const {
    std::array<double, 8> out = {std::sqrt(centre / count), std::sqrt(radius / count)};
    for (std::size_t k = 0; k < 3; ++k) {
      const double mean = first[k] / count;
      out[2 + 2 * k] = mean;
      out[3 + 2 * k] = std::sqrt(std::max(0.0, second[k] / count - mean * mean));
    }
    return out;
  }
};

double rmsDistance(const WallPoints& points, const Circle& circle) {
  double squares = 0;
  for (std::size_t i = 0; i < points.u.size(); ++i) {
    const double d = std::hypot(static_cast<double>(points.u[i]) - circle.u,
                                static_cast<double>(points.v[i]) - circle.v) -
                     circle.radius;
    squares += d * d;
  }
  return std::sqrt(squares / static_cast<double>(points.u.size()));
}

double inlierRate(const WallPoints& points, const Circle& truth) {
  double inside = 0;
  for (std::size_t i = 0; i < points.u.size(); ++i)
    inside += std::abs(std::hypot(static_cast<double>(points.u[i]) - truth.u,
                                  static_cast<double>(points.v[i]) - truth.v) -
                       1) <= 0.1
                  ? 1
                  : 0;
  return inside / static_cast<double>(points.u.size());
}

void judge(const WallPoints& points, const Circle& found, const Circle& truth, Sums& sums) {
  if (!(found.radius > 0)) {
    sums.none += 1;
    return;
  }
  const double du = found.u - truth.u, dv = found.v - truth.v;
  sums.count += 1;
  sums.centre += du * du + dv * dv;
  sums.radius += (found.radius - 1) * (found.radius - 1);
  const std::array<double, 3> values = {rmsDistance(points, found), rmsDistance(points, truth),
                                        inlierRate(points, truth)};
  for (std::size_t k = 0; k < 3; ++k) {
    sums.first[k] += values[k];
    sums.second[k] += values[k] * values[k];
  }
}

/// Sums of every search, with all points and with trimmed ones.
using ImageSums = std::array<std::array<Sums, kSearches>, 2>;

void judgeFocus(const std::array<WallPoints, kSearches>& points, const Circle& truth,
                std::uint64_t stream, ImageSums& sums) {
  for (std::size_t c = 0; c < kSearches; ++c)
    for (const std::size_t variant : {0U, 1U}) {
      const WallPoints kept = variant == 1 ? trimmed(points[c]) : points[c];
      Random random(1, stream);
      Circle found = detectCircle(kept, random);
      if (c == kConfigurations) found = refineCircle(kept, found);
      judge(kept, found, truth, sums[variant][c]);
    }
}

ImageSums runImage(std::size_t index) {
  const std::size_t across = kFewestAcross + index / (kPlaces * kPlaces);
  const double step = 0.1 * 2.0 / static_cast<double>(across);  // a tenth of a pixel
  const double u = step * static_cast<double>(index % kPlaces);
  const double v = step * static_cast<double>(index / kPlaces % kPlaces);
  DiscSampler sampler(discImage(static_cast<int>(across), u, v));
  std::array<WallPoints, kSearches> points;
  ImageSums sums;
  for (int i = -kGrid; i <= kGrid; ++i)
    for (int j = -kGrid; j <= kGrid; ++j) {
      if (i * i + j * j >= kGrid * kGrid) continue;
      const Circle truth{-i / static_cast<double>(kGrid), -j / static_cast<double>(kGrid), 1};
      sampler.cast(u - truth.u, v - truth.v, points);
      const auto focus = static_cast<std::size_t>(21 * (i + kGrid) + j + kGrid);
      judgeFocus(points, truth, index * 1000 + focus, sums);
    }
  return sums;
}

struct Outcome {
  std::array<Sums, kSearches> all, low;
  std::array<std::array<Sums, kSearches>, kMostAcross + 1> byAcross;
};

/// With all points, and with trimmed ones.
std::array<Outcome, 2> runImages(Progress& progress) {
  std::vector<ImageSums> each(kImages);
  progress.begin("circles", kImages);
  tbb::parallel_for(std::size_t{0}, kImages, [&](std::size_t i) {
    progress.check();
    each[i] = runImage(i);
    progress.advance();
  });
  progress.end();
  std::array<Outcome, 2> out;
  for (std::size_t i = 0; i < kImages; ++i) {
    const std::size_t across = kFewestAcross + i / (kPlaces * kPlaces);
    for (std::size_t variant = 0; variant < 2; ++variant)
      for (std::size_t c = 0; c < kSearches; ++c) {
        const Sums& sums = each[i][variant][c];
        out[variant].all[c].add(sums);
        if (across <= kMostAcrossLow) out[variant].low[c].add(sums);
        out[variant].byAcross[across][c].add(sums);
      }
  }
  return out;
}

/// The published value with index k of the table, or NaN for the search that has none.
double published(std::size_t configuration, std::size_t k) {
  return configuration < kConfigurations ? kPublished[configuration][k]
                                         : std::numeric_limits<double>::quiet_NaN();
}

Table circleTable(const std::string& title, const Outcome& outcome) {
  Table table{title,
              {"configuration", "RMS centre all", "thesis", "low", "thesis low", "RMS radius all",
               "thesis radius", "radius low", "thesis radius low", "no circle"},
              {}};
  for (std::size_t c = 0; c < kSearches; ++c) {
    const auto all = outcome.all[c].figures(), low = outcome.low[c].figures();
    table.rows.push_back({kSearchNames[c], all[0], published(c, 0), low[0], published(c, 1), all[1],
                          published(c, 2), low[1], published(c, 3), outcome.all[c].none});
  }
  return table;
}

/// One of the three quantities that have a mean and a standard deviation.
Table spreadTable(const std::string& title, const Outcome& outcome, std::size_t quantity) {
  Table table{title,
              {"configuration", "all mean", "thesis", "all deviation", "thesis deviation",
               "low mean", "thesis low", "low deviation", "thesis low deviation"},
              {}};
  for (std::size_t c = 0; c < kSearches; ++c) {
    const auto all = outcome.all[c].figures(), low = outcome.low[c].figures();
    const std::size_t f = 2 + 2 * quantity, p = 4 + 4 * quantity;
    table.rows.push_back({kSearchNames[c], all[f], published(c, p), all[f + 1], published(c, p + 1),
                          low[f], published(c, p + 2), low[f + 1], published(c, p + 3)});
  }
  return table;
}

Plot plotByAcross(const Outcome& outcome) {
  Plot plot{"RMS error of the centre", "pixels across the disc", "radii", false, {}};
  for (const std::size_t c : {1U, 3U, 5U, 6U, 8U, 9U}) {
    Curve curve{kSearchNames[c], {}, c == kConfigurations};
    for (std::size_t across = kFewestAcross; across <= kMostAcross; ++across)
      curve.points.emplace_back(static_cast<double>(across),
                                outcome.byAcross[across][c].figures()[0]);
    plot.curves.push_back(curve);
  }
  return plot;
}

void run(const std::filesystem::path& folder, Progress& progress) {
  const auto [outcome, trimmedOutcome] = runImages(progress);
  Report report("Circles in pixelated discs");
  report.paragraph(
      "Radius 1; " + std::to_string(kImages) +
      " images, 305 foci each (the grid of a tenth that "
      "lies strictly within the disc; the thesis counts 315, of which its text gives no account), "
      "128 rays of 128 samples, no noise. Distances are geometric; equation 3.7 prints the "
      "difference of squares, whose sum can be negative. \"As tracked\" is not in the thesis.");
  report.table(circleTable("Circle, every point of a ray kept (table 3.2)", outcome));
  report.table(spreadTable("RMS distance of the points from the found circle", outcome, 0));
  report.table(spreadTable("RMS distance of the points from the true circle", outcome, 1));
  report.table(spreadTable("Share of the points within a tenth of the true circle", outcome, 2));
  report.picture("circles.svg", "RMS error of the centre, every point kept");
  report.table(circleTable("Circle, points trimmed as in tracking (thesis 3.3)", trimmedOutcome));
  report.table(spreadTable("Distance from the found circle, trimmed", trimmedOutcome, 0));
  report.table(spreadTable("Distance from the true circle, trimmed", trimmedOutcome, 1));
  report.table(spreadTable("Share within a tenth, trimmed", trimmedOutcome, 2));
  std::filesystem::create_directories(folder);
  writePlot(folder, "circles", plotByAcross(outcome));
  report.write(folder, "circles");
  std::fputs(report.markdown().c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  return runReport(argc, argv, "lumen_circles", run);
}
