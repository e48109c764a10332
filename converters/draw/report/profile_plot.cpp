// SPDX-License-Identifier: Apache-2.0
#include "converters/draw/report/profile_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "converters/base/number_text.h"
#include "converters/draw/overlay/overlay.h"

namespace lumen::convert {

Axis axisTo(double end, int most) {
  Axis axis;
  axis.end = std::isfinite(end) && end > 0 ? end : 1;
  const double least = axis.end / std::max(1, most);
  int power = static_cast<int>(std::floor(std::log10(least)));
  double step = 0;
  // the next power of ten is at least `least`, so one of these is found
  for (const double times : {1.0, 2.0, 5.0, 10.0}) {
    step = times * std::pow(10.0, power);
    if (step * (1 + 1e-12) >= least) {
      if (times == 10) ++power;
      break;
    }
  }
  axis.digits = std::max(0, -power);
  for (int i = 0; i * step <= axis.end * (1 + 1e-12); ++i) axis.marks.push_back(i * step);
  return axis;
}

namespace {

// Tenths of a millimetre on paper: whole numbers are fine enough.
constexpr int kWidth = 580, kHeight = 360;
constexpr int kLeft = 92, kRight = 520, kTop = 14, kBottom = 262;
constexpr int kStrip = 12;       // height of the strip below
constexpr int kMarksBelow = 40;  // height from the axis down to the feet of its numbers
constexpr std::size_t kSteps = 440;
constexpr int kMarksAcross = 5, kMarksUp = 4;
constexpr double kHeadroom = 1.08;  // above the greatest radius
constexpr std::array<const char*, 4> kAgreementClasses = {"not-judged", "good", "fair", "poor"};
static_assert(static_cast<int>(Agreement::Poor) == 3);

std::string number(int value) {
  return std::to_string(value);
}

int between(int from, int to, double share) {
  return from + static_cast<int>(std::lround((to - from) * std::clamp(share, 0.0, 1.0)));
}

std::string line(const char* type, int x0, int y0, int x1, int y1) {
  return std::string("<path class=\"") + type + "\" d=\"M" + number(x0) + " " + number(y0) + "L" +
         number(x1) + " " + number(y1) + "\"/>";
}

std::string label(const char* type, int x, int y, const std::string& ours) {
  return std::string("<text class=\"") + type + "\" x=\"" + number(x) + "\" y=\"" + number(y) +
         "\">" + ours + "</text>";
}

/// A title that is read from below upwards.
std::string upright(int x, int y, const std::string& ours) {
  return "<text class=\"middle\" transform=\"translate(" + number(x) + " " + number(y) +
         ") rotate(-90)\">" + ours + "</text>";
}

class Plot {
public:
  Plot(const TreeProfile& profile, std::span<const Agreement> agreement)
      : m_profile(profile),
        m_agreement(agreement),
        m_across(axisTo(profile.along.empty() ? 0 : profile.along.back(), kMarksAcross)),
        m_up(axisTo(greatest(profile.radius) * kHeadroom, kMarksUp)) {}

  [[nodiscard]] std::string draw() const {
    return area() + grid() + forks() + strip() + curve() + titles();
  }

private:
  static double greatest(const std::vector<float>& values) {
    return values.empty() ? 0
                          : static_cast<double>(*std::max_element(values.begin(), values.end()));
  }
  [[nodiscard]] int x(double along) const { return between(kLeft, kRight, along / m_across.end); }
  [[nodiscard]] int y(double radius) const { return between(kBottom, kTop, radius / m_up.end); }
  static int ofConfidence(float rate) { return between(kBottom, kTop, static_cast<double>(rate)); }

  /// "10 20L30 40...", the drawn ones of `values`.
  template <class Height>
  [[nodiscard]] std::string places(const std::vector<float>& values, Height&& height) const {
    std::string text;
    for (const std::size_t i : drawnValues(m_profile.along, values, kSteps)) {
      if (!text.empty()) text += 'L';
      text += number(x(m_profile.along[i])) + ' ' + number(height(values[i]));
    }
    return text;
  }

  [[nodiscard]] std::string area() const {
    const std::vector<float>& rates = m_profile.confidence;
    if (rates.empty()) return {};
    const std::string first = number(x(m_profile.along.front())),
                      last = number(x(m_profile.along.back()));
    return "<path class=\"confidence\" d=\"M" + first + " " + number(kBottom) + "L" +
           places(rates, ofConfidence) + "L" + last + " " + number(kBottom) + "Z\"/>" +
           label("end-right", kRight + 8, kTop + 9, "1") +
           label("end-right", kRight + 8, kBottom + 9, "0") +
           upright(kWidth - 8, (kTop + kBottom) / 2, "confidence");
  }

  [[nodiscard]] std::string grid() const {
    std::string text;
    for (const double mark : m_up.marks) {
      if (mark > 0) text += line("grid", kLeft, y(mark), kRight, y(mark));
      text += label("end-left", kLeft - 8, y(mark) + 9, fixedText(mark, m_up.digits));
    }
    for (const double mark : m_across.marks) {
      text += line("axis", x(mark), kBottom, x(mark), kBottom + 8);
      text += label("middle", x(mark), kBottom + kMarksBelow, fixedText(mark, m_across.digits));
    }
    return text + line("axis", kLeft, kBottom, kRight, kBottom) +
           line("axis", kLeft, kTop, kLeft, kBottom);
  }

  [[nodiscard]] std::string forks() const {
    std::string text;
    for (const double fork : m_profile.forks)
      text += line("fork", x(fork), kBottom, x(fork), kBottom - 14);
    return text;
  }

  /// One piece for neighbours that agree alike; a node's piece lies between it and the one before.
  [[nodiscard]] std::string strip() const {
    std::string text;
    const std::size_t count = std::min(m_agreement.size(), m_profile.along.size());
    int from = kLeft;
    for (std::size_t first = 0, next = 0; first < count; first = next) {
      for (next = first; next < count && m_agreement[next] == m_agreement[first];) ++next;
      const int to = next == count ? x(m_across.end) : x(m_profile.along[next - 1]);
      if (to > from)
        text += std::string("<rect class=\"") +
                kAgreementClasses[static_cast<std::size_t>(m_agreement[first])] + "\" x=\"" +
                number(from) + "\" y=\"" + number(kBottom + 1) + "\" width=\"" + number(to - from) +
                "\" height=\"" + number(kStrip) + "\"/>";
      from = std::max(from, to);
    }
    return text;
  }

  [[nodiscard]] std::string curve() const {
    if (m_profile.radius.size() == 1)
      return "<circle class=\"radius-dot\" cx=\"" + number(x(m_profile.along[0])) + "\" cy=\"" +
             number(y(static_cast<double>(m_profile.radius[0]))) + "\" r=\"8\"/>";
    return "<path class=\"radius\" d=\"M" +
           places(m_profile.radius, [&](float r) { return y(static_cast<double>(r)); }) + "\"/>";
  }

  [[nodiscard]] std::string titles() const {
    return upright(28, (kTop + kBottom) / 2, "radius, mm") +
           label("middle", (kLeft + kRight) / 2, kHeight - 16, "along the vessel, mm");
  }

  const TreeProfile& m_profile;
  std::span<const Agreement> m_agreement;
  Axis m_across, m_up;
};

Markup drawing(int width, int height, const std::string& alt, const std::string& inside) {
  return {"<svg role=\"img\" aria-label=\"" + alt + "\" viewBox=\"0 0 " + number(width) + " " +
          number(height) + "\">" + inside + "</svg>"};
}

}  // namespace

Markup profilePlot(const TreeProfile& profile, std::span<const Agreement> agreement) {
  return drawing(kWidth, kHeight, "radius along the vessel",
                 profile.along.empty() ? "" : Plot(profile, agreement).draw());
}

Markup confidenceBars(const ConfidenceShares& shares) {
  constexpr int kBarsWidth = 880, kBarsHeight = 520, kFoot = 420, kHead = 40, kFrom = 60;
  const auto classes = static_cast<int>(shares.length.size());
  const double most = shares.length.empty() || shares.total <= 0
                          ? 1
                          : *std::max_element(shares.length.begin(), shares.length.end());
  const int pitch = (kBarsWidth - kFrom - 30) / std::max(1, classes);
  std::string inside = line("axis", kFrom, kFoot, kFrom + pitch * classes, kFoot);
  for (int i = 0; i < classes; ++i) {
    const double length = shares.length[static_cast<std::size_t>(i)];
    const int left = kFrom + pitch * i, top = between(kFoot, kHead, length / most);
    inside += "<rect class=\"bar\" x=\"" + number(left + 5) + "\" y=\"" + number(top) +
              "\" width=\"" + number(pitch - 10) + "\" height=\"" + number(kFoot - top) + "\"/>" +
              label("middle", left + pitch / 2, top - 8,
                    fixedText(100 * length / std::max(shares.total, 1e-30), 1) + " %") +
              label("middle", left, kFoot + 36, fixedText(0.1 * i, 1));
  }
  inside += label("middle", kFrom + pitch * classes, kFoot + 36, "1.0") +
            label("middle", kFrom + pitch * classes / 2, kFoot + 76, "confidence (inlier rate)") +
            upright(30, (kFoot + kHead) / 2, "share of the length, %");
  return drawing(kBarsWidth, kBarsHeight, "how much of the length has which confidence", inside);
}

std::string plotStyle() {
  std::string style = R"(svg { display: block; width: 100%; font-size: 25px; }
svg text { fill: #222; }
.middle { text-anchor: middle; } .end-left { text-anchor: end; } .end-right { text-anchor: start; fill: #456; }
.axis { stroke: #222; stroke-width: 2.5; fill: none; } .grid { stroke: #ccc; stroke-width: 1.5; fill: none; }
.fork { stroke: #222; stroke-width: 4; fill: none; }
.radius { stroke: #a01818; stroke-width: 4; fill: none; stroke-linejoin: round; } .radius-dot { fill: #a01818; }
.confidence { fill: #cfdfef; } .bar { fill: #8fb0d0; }
)";
  const auto add = [&](const std::string& type, const Rgb& c) {
    const std::string colour =
        "rgb(" + number(c[0]) + ", " + number(c[1]) + ", " + number(c[2]) + ")";
    style += "." + type + " { fill: " + colour + "; } .key." + type + " { background: " + colour +
             "; }\n";
  };
  for (std::size_t i = 0; i < kAgreementClasses.size(); ++i)
    add(kAgreementClasses[i], colourOf(static_cast<Agreement>(i)));
  add("missing", kMissingColour);
  return style;
}

}  // namespace lumen::convert
