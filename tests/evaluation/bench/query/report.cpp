// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace lumen::bench {
namespace {

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

}  // namespace

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

}  // namespace lumen::bench
