// SPDX-License-Identifier: Apache-2.0
// Numbers as programs write them in JSON, for the tests of all that read JSON.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace lumen::test {

struct JsonSample {
  std::string text;
  double value;  ///< the double nearest to the text
};

/// Texts that Python and JavaScript write now, or wrote once where there is no Python.
inline std::string writtenNumbers() {
  const std::string folder = LUMEN_TEST_DATA "/json/";
  std::string text;
  const std::string command = "python3 " + folder + "write_numbers.py 7 200 2>/dev/null";
  if (FILE* const pipe = popen(command.c_str(), "r")) {
    std::array<char, 4096> part{};
    while (const std::size_t size = fread(part.data(), 1, part.size(), pipe))
      text.append(part.data(), size);
    if (pclose(pipe) == 0) return text;
  }
  std::ifstream stream(folder + "numbers.txt");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Those whose size is at most `most`; those of C++'s shortest form among them.
inline std::vector<JsonSample> jsonSamples(double most) {
  std::istringstream lines(writtenNumbers());
  std::vector<std::string> texts;
  for (std::string line; std::getline(lines, line);) texts.push_back(line);
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    const auto number = static_cast<float>(std::ldexp(random() >> 40, int(random() % 60) - 50));
    const double midpoint = (double{number} + double{std::nextafter(number, INFINITY)}) / 2;
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.begin(), text.end(), i % 2 == 0 ? midpoint : number).ptr;
    texts.emplace_back(text.begin(), end);
  }
  std::vector<JsonSample> samples;
  for (const std::string& text : texts)
    if (const double value = std::strtod(text.c_str(), nullptr); std::abs(value) <= most)
      samples.push_back({text, value});
  return samples;
}

}  // namespace lumen::test
