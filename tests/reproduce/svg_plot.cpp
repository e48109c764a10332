// SPDX-License-Identifier: Apache-2.0
#include "svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "report.h"

namespace lumen::reproduce {
namespace {

constexpr double kWidth = 720, kHeight = 440, kLeft = 80, kRight = 170, kTop = 40, kBottom = 60;
constexpr std::array kColours = {"#1b6ca8", "#c44536", "#2a9d4a", "#8a5ab5", "#b8860b", "#444444"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

/// Text as XML has it.
std::string escaped(const std::string& words) {
  std::string out;
  for (const char c : words) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const std::string& more = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" +
         more + ">" + escaped(words) + "</text>\n";
}

std::string segment(double x0, double y0, double x1, double y1, const std::string& stroke,
                    const std::string& more = "") {
  return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) +
         "\" y2=\"" + number(y1) + "\" stroke=\"" + stroke + "\"" + more + "/>\n";
}

/// How a curve is drawn, in the plot and in its legend.
std::string styleOf(const Curve& curve) {
  return std::string(" stroke-width=\"1.8\"") + (curve.dashed ? " stroke-dasharray=\"5 4\"" : "");
}

/// One axis: its range in data, its ticks, and its range in the picture.
struct Axis {
  double low = 0, high = 1, from = 0, to = 1;
  bool logarithmic = false;

  [[nodiscard]] double place(double value) const {
    const double share =
        logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return from + share * (to - from);
  }
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> values;
    if (logarithmic) {
      for (double decade = low; decade <= 1.001 * high; decade *= 10) values.push_back(decade);
      return values;
    }
    const double rough = (high - low) / 6, decade = std::pow(10, std::floor(std::log10(rough)));
    const double lead = rough / decade;
    const double step = decade * (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10);
    for (double v = std::ceil(low / step) * step; v <= high + 1e-9 * step; v += step) {
      values.push_back(std::abs(v) < 1e-9 * step ? 0 : v);
    }
    return values;
  }
};

/// x and y axes around all points.
std::pair<Axis, Axis> axesOf(const Plot& plot) {
  Axis x{1e300, -1e300, kLeft, kWidth - kRight, false};
  Axis y{1e300, plot.logarithmic ? 0.0 : -1e300, kHeight - kBottom, kTop, plot.logarithmic};
  for (const Curve& curve : plot.curves) {
    for (const auto& [px, py] : curve.points) {
      if (!std::isfinite(py) || (plot.logarithmic && !(py > 0))) continue;
      x.low = std::min(x.low, px);
      x.high = std::max(x.high, px);
      y.low = std::min(y.low, py);
      y.high = std::max(y.high, py);
    }
  }
  if (plot.logarithmic) {
    y.low = std::pow(10, std::floor(std::log10(y.low)));
    y.high = std::pow(10, std::ceil(std::log10(y.high)));
  } else {
    y.low = std::min(0.0, y.low);
    y.high *= 1.05;
  }
  if (!(x.high > x.low)) x.high = x.low + 1;
  if (!(y.high > y.low)) y.high = y.low + 1;
  return {x, y};
}

std::string path(const Curve& curve, const Axis& x, const Axis& y, const std::string& colour) {
  std::string points;
  for (const auto& [px, py] : curve.points) {
    if (!std::isfinite(py) || (y.logarithmic && !(py > 0))) continue;
    points += number(x.place(px)) + "," + number(y.place(py)) + " ";
  }
  return "<polyline fill=\"none\" stroke=\"" + colour + "\"" + styleOf(curve) + " points=\"" +
         points + "\"/>\n";
}

}  // namespace

std::string svg(const Plot& plot) {
  const auto [x, y] = axesOf(plot);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) +
                    " " + number(kHeight) +
                    "\" font-family=\"sans-serif\" font-size=\"13\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  out += text(0.5 * (kLeft + kWidth - kRight), 24, "middle", plot.title, " font-weight=\"bold\"");
  for (const double tick : x.ticks()) {
    out += segment(x.place(tick), y.from, x.place(tick), y.to, "#e4e4e4");
    out += text(x.place(tick), y.from + 18, "middle", formatNumber(tick));
  }
  for (const double tick : y.ticks()) {
    out += segment(x.from, y.place(tick), x.to, y.place(tick), "#e4e4e4");
    out += text(x.from - 8, y.place(tick) + 4, "end", formatNumber(tick));
  }
  out += segment(x.from, y.from, x.to, y.from, "black") +
         segment(x.from, y.from, x.from, y.to, "black");
  out += text(0.5 * (x.from + x.to), kHeight - 14, "middle", plot.xLabel);
  out += text(0, 0, "middle", plot.yLabel,
              " transform=\"translate(20," + number(0.5 * (y.from + y.to)) + ") rotate(-90)\"");
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const std::string colour = kColours[i % kColours.size()];
    const double at = kTop + 10 + 20 * static_cast<double>(i);
    out += path(plot.curves[i], x, y, colour);
    out += segment(x.to + 12, at, x.to + 36, at, colour, styleOf(plot.curves[i]));
    out += text(x.to + 42, at + 4, "start", plot.curves[i].name);
  }
  return out + "</svg>\n";
}

}  // namespace lumen::reproduce
