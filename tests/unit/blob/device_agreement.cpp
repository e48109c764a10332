// SPDX-License-Identifier: Apache-2.0
#include "device_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

#include "tree.h"

namespace lumen::blob::test {
namespace {

constexpr double kDistance = 1e-5;  // mm, at points within a radius of the wall
constexpr double kSameNode = 0.99999;
constexpr double kSameFoot = 0.999;  // exact distances: elsewhere another place is as near about it
constexpr int kTurns = 5;

// A batch that is asked for again and again.
class OnThisProcessor {
public:
  OnThisProcessor(const blob_model* model, std::uint32_t flags, const Points& points)
      : m_model(model),
        m_flags(flags),
        m_xyz(points.xyz.begin(), points.xyz.end()),
        m_state(points.count()),
        m_answers{points.cursor, {}, std::vector<double>(kNumbers * points.count())} {
    double* const numbers = m_answers.numbers.data();
    m_columns.count = points.count();
    m_columns.point_stride = 3 * sizeof(double);
    m_columns.answer_stride = kNumbers * sizeof(double);
    m_columns.cursor = m_answers.cursor.data();
    m_columns.distance = numbers;
    m_columns.state = m_state.data();
    for (std::size_t k = 0; k < 3; ++k) {
      m_columns.point[k] = &m_xyz[k];
      m_columns.normal[k] = numbers + 1 + k;
    }
    run();  // moves the cursors
  }
  double run() {
    const double start = processorSeconds();
    blob_query_columns(m_model, m_flags, &m_columns);
    return processorSeconds() - start;
  }
  Answers answers() {
    m_columns.value = m_answers.numbers.data() + 4;
    for (std::size_t k = 0; k < 3; ++k) m_columns.gradient[k] = m_columns.value + 1 + k;
    run();
    m_answers.state.assign(m_state.begin(), m_state.end());
    return m_answers;
  }

private:
  const blob_model* m_model;
  std::uint32_t m_flags;
  std::vector<double> m_xyz;
  std::vector<std::uint8_t> m_state;
  Answers m_answers;
  blob_columns m_columns = blob_columns_default();
};

// How far two numbers are apart: none if both are NaN, or equal.
double apart(double a, double b) {
  if (std::isnan(a) && std::isnan(b)) return 0;
  const double difference = a == b ? 0 : std::abs(a - b);
  return std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference;
}

// How answers agree. A leak is a point that one side has in the lumen and the other outside.
struct Agreement {
  std::size_t same = 0, leaks = 0, near = 0, farther = 0;
  double distance = 0;  // mm; in radii where they are more than a radius R outside
  double others = 0;    // normals; f in mm, and its gradient

  Agreement(const blob_model* model, const Answers& here, const Answers& there) {
    for (std::size_t i = 0; i < here.cursor.size(); ++i) {
      same += here.cursor[i] == there.cursor[i] ? 1 : 0;
      leaks += ((here.state[i] ^ there.state[i]) & BLOB_INSIDE) != 0 ? 1 : 0;
      if (here.cursor[i] != there.cursor[i]) continue;
      const double radius = blob_model_node(model, here.cursor[i]).radius;
      const double *a = &here.numbers[kNumbers * i], *b = &there.numbers[kNumbers * i];
      const double error = apart(a[0], b[0]) / std::max(1.0, a[0] / radius);
      near += error <= kDistance ? 1 : 0;
      farther += error > kDistance && std::abs(b[0]) > std::abs(a[0]) ? 1 : 0;
      distance = std::max(distance, error);
      for (std::size_t k = 1; k < kNumbers; ++k) others = std::max(others, apart(a[k], b[k]));
    }
  }
  // Whether answers for flags agree as closely as promised.
  [[nodiscard]] bool isGood(std::uint32_t flags, std::size_t count) const {
    const auto number = static_cast<double>(count);
    if (static_cast<double>(same) < kSameNode * number || leaks > 0) return false;
    if ((flags & BLOB_DISTANCE_EXACT) != 0) return static_cast<double>(near) >= kSameFoot * number;
    return distance <= kDistance && others <= kDistance;
  }
};

std::vector<std::uint32_t> pack(const blob_model* model) {
  std::vector<std::uint32_t> words(blob_device_pack(&model, 1, nullptr, 0) / 4);
  blob_device_pack(&model, 1, words.data(), 4 * words.size());
  if (blob_device_check(words.data(), 4 * words.size()) != BLOB_OK)
    throw std::runtime_error("a packed buffer is refused");
  return words;
}

// Prints how the answers agree; returns whether they do so as closely as promised.
bool compare(const std::string& name, const blob_model* model, std::uint32_t flags,
             std::size_t count, OtherProcessor& device) {
  const std::vector<std::uint32_t> words = pack(model);
  const Points points(model, count);
  OnThisProcessor library(model, flags, points);
  device.begin(words, flags, points);
  double ofLibrary = 1e9, ofDevice = 1e9;  // s: the least, as other work makes it longer
  for (int turn = 0; turn < kTurns; ++turn) {
    ofLibrary = std::min(ofLibrary, library.run());
    ofDevice = std::min(ofDevice, device.run());
  }
  const Agreement found(model, library.answers(), device.answers());
  const auto number = static_cast<double>(count);
  std::printf(
      "%s, flags %u: %zu points, same node %zu, distance within %.2g mm (%.3f %% within 1e-5, "
      "farther at %zu), others %.2g, %zu leaks; %.3f ns a point there, %.1f of one processor by "
      "the "
      "library; %zu bytes\n",
      name.c_str(), flags, count, found.same, found.distance,
      100 * static_cast<double>(found.near) / number, found.farther, found.others, found.leaks,
      1e9 * ofDevice / number, 1e9 * ofLibrary / number, 4 * words.size());
  return found.isGood(flags, count);
}

// A tree whose blobs are of another kernel.
Tree ofKernel(blob_kernel kernel, double parameter) {
  Tree tree = helix(60, 0.02);
  tree.kernel = kernel;
  tree.parameter = parameter;
  for (float& width : tree.blobWidth) width *= 2.5f;
  return tree;
}

bool compareTrees(std::size_t count, OtherProcessor& device) {
  bool agree = true;
  for (const auto& [name, tree] :
       {std::pair{"helix", helix(120, 0.02)}, {"fork", fork(0.7, 0.02)}, {"kissing", kissing(0)}})
    agree = compare(name, tree.build().get(), BLOB_BLENDED, count / 3, device) && agree;
  for (const Tree& tree : {helix(120, 0.02), kissing(0)})
    agree = compare("exact", tree.build().get(), BLOB_DISTANCE_EXACT, count / 20, device) && agree;
  const Model bent = bend(0.03).build();
  for (const std::uint32_t flags : {BLOB_LOCAL, BLOB_LOCAL | BLOB_HOLD})
    agree = compare("bend", bent.get(), flags, count / 50, device) && agree;
  for (const auto& [name, tree] : {std::pair{"Gaussian", ofKernel(BLOB_GAUSSIAN, 0.5)},
                                   {"quartic", ofKernel(BLOB_QUARTIC, 0)},
                                   {"soft object", ofKernel(BLOB_SOFT_OBJECT, 0)}})
    agree = compare(name, tree.build().get(), BLOB_BLENDED, count / 50, device) && agree;
  return agree;
}

}  // namespace

Points::Points(const blob_model* model, std::size_t count) {
  constexpr float kReachRadii = 1.5f;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> share(-kReachRadii, kReachRadii);
  const std::size_t nodes = blob_model_describe(model).node_count;
  for (std::size_t i = 0; i < count; ++i) {
    const auto node = static_cast<std::uint32_t>(i * nodes / count);
    const blob_node at = blob_model_node(model, node);
    for (const double centre : at.centre)
      xyz.push_back(static_cast<float>(centre + at.radius * double{share(random)}));
    cursor.push_back(node);
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  xyz[3 * (count / 5)] = nan;
  xyz[3 * (count / 3) + 1] = std::numeric_limits<float>::infinity();
  xyz[3 * (count / 2) + 2] = -1e15f;
  cursor[count / 7] = BLOB_NOWHERE;
}

void Answers::setNumbers(const std::vector<float>& rows, const std::vector<float>& values) {
  for (std::size_t i = 0; i < rows.size(); i += 4)
    for (const std::vector<float>* from : {&rows, &values})
      numbers.insert(numbers.end(), &(*from)[i], &(*from)[i] + 4);
}

double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

int compareWithLibrary(const Comparison& wanted, OtherProcessor& device) {
  std::printf("%s\n", device.name().c_str());
  if (wanted.cases.empty()) return compareTrees(wanted.points, device) ? 0 : 1;
  bool agree = true;
  for (const std::string& file : wanted.cases) {
    blob_model* model = nullptr;
    const blob_status status = blob_model_open(file.c_str(), nullptr, &model);
    if (status != BLOB_OK) throw std::runtime_error(file + ": " + blob_status_text(status));
    const std::uint32_t flags = wanted.exact ? BLOB_DISTANCE_EXACT : BLOB_BLENDED;
    agree = compare(file, model, flags, wanted.points, device) && agree;
    blob_model_close(model);
  }
  return agree ? 0 : 1;
}

}  // namespace lumen::blob::test
