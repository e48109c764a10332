// SPDX-License-Identifier: Apache-2.0
// The kernel of libblob/device/query.cl on an OpenCL device, against blob_query_columns().
//
//   device_opencl SOURCES [--points N] [--wide 0] [--exact] [CASE...]    SOURCES: the folder of libblob's sources
//
// Without a CASE: synthetic trees of each kernel, one of two vessels that touch. Prints what it
// compared, and both rates. --wide 0: as for graphics processors, without vectors. --exact: of a
// CASE, distances to the nearest point of the wall. Exit code 1:
// answers differ by more than blob_device.h allows; 77: there is no device.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CL/cl.h>

#include "blob.h"
#include "tree.h"

namespace lumen::blob::test {
namespace {

constexpr int kSkipped = 77;
constexpr double kDistance = 1e-5;  // mm, at points within a radius of the wall
constexpr double kSameNode = 0.99999;
constexpr double kSameFoot = 0.999;  // exact distances: elsewhere another place is as near about it

struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void require(cl_int code, const char* what) {
  if (code != CL_SUCCESS)
    throw std::runtime_error(std::string(what) + ": OpenCL error " + std::to_string(code));
}

// Processor time of all threads, s: other work on the machine does not count.
double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

constexpr int kTurns = 5;

// The least processor time of one batch counts, as other work on the machine makes it longer.
template <class Batch>
double secondsOf(Batch& batch) {
  const double start = processorSeconds();
  batch.run();
  return processorSeconds() - start;
}

// Points about the nodes of a model, as floats, with cursors that know their vessel.
struct Points {
  std::vector<float> xyz;
  std::vector<std::uint32_t> cursor;

  Points(const blob_model* model, std::size_t count) {
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
  [[nodiscard]] std::size_t count() const { return cursor.size(); }
};

constexpr std::size_t kNumbers = 8;  // distance, normal, f, grad f

struct Answers {
  std::vector<std::uint32_t> cursor, state;
  std::vector<double> numbers;  // kNumbers of each point
};

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
  void run() { blob_query_columns(m_model, m_flags, &m_columns); }
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

// The first device of any platform, with the kernel. Handles are released with the process.
class OpenCl {
public:
  OpenCl(const std::string& sources, const std::string& options) {
    cl_platform_id platform[8];
    cl_uint platforms = 0;
    if (clGetPlatformIDs(8, platform, &platforms) != CL_SUCCESS) platforms = 0;
    for (cl_uint i = 0; i < platforms && m_device == nullptr; ++i)
      if (clGetDeviceIDs(platform[i], CL_DEVICE_TYPE_ALL, 1, &m_device, nullptr) != CL_SUCCESS)
        m_device = nullptr;
    if (m_device == nullptr) throw NoDevice("no OpenCL device");
    cl_int code = 0;
    m_context = clCreateContext(nullptr, 1, &m_device, nullptr, nullptr, &code);
    require(code, "context");
    m_queue = clCreateCommandQueue(m_context, m_device, 0, &code);
    require(code, "queue");
    build(sources, options);
  }

  [[nodiscard]] std::string name() const {
    char text[256] = "";
    clGetDeviceInfo(m_device, CL_DEVICE_NAME, sizeof text, text, nullptr);
    return text;
  }

  // Uploads a batch, and moves its cursors.
  void begin(const std::vector<std::uint32_t>& words, std::uint32_t flags, const Points& points) {
    m_count = points.count();
    m_kernel = (flags & BLOB_DISTANCE_EXACT) != 0 ? m_exact : m_blended;
    const cl_mem packed = upload(words), xyz = upload(points.xyz);
    m_cursor = upload(points.cursor);
    m_answer = upload(std::vector<float>(4 * m_count));
    m_state = upload(points.cursor);
    const cl_uint vessel = 0, number = static_cast<cl_uint>(m_count);
    cl_uint index = 0;
    const auto pass = [&](std::size_t size, const void* value) {
      require(clSetKernelArg(m_kernel, index++, size, value), "argument");
    };
    pass(sizeof packed, &packed);
    pass(sizeof vessel, &vessel);
    pass(sizeof flags, &flags);
    pass(sizeof number, &number);
    for (const cl_mem buffer : {xyz, m_cursor, m_answer}) pass(sizeof buffer, &buffer);
    pass(sizeof(cl_mem), nullptr);
    pass(sizeof m_state, &m_state);
    run();
  }
  void run() {
    cl_device_type type = 0;
    clGetDeviceInfo(m_device, CL_DEVICE_TYPE, sizeof type, &type, nullptr);
    constexpr std::size_t kItemsOfProcessor = 64;
    const bool isGraphics = (type & CL_DEVICE_TYPE_CPU) == 0;
    const std::size_t group = isGraphics ? 64 : 1;
    const std::size_t size = isGraphics ? (m_count + group - 1) / group * group : kItemsOfProcessor;
    require(
        clEnqueueNDRangeKernel(m_queue, m_kernel, 1, nullptr, &size, &group, 0, nullptr, nullptr),
        "run");
    require(clFinish(m_queue), "finish");
  }
  Answers answers() {
    std::vector<float> rows(4 * m_count), values(4 * m_count);
    const cl_mem value = upload(values);
    require(clSetKernelArg(m_kernel, kValueArgument, sizeof value, &value), "argument");
    run();
    Answers found{std::vector<std::uint32_t>(m_count), std::vector<std::uint32_t>(m_count), {}};
    download(m_cursor, found.cursor);
    download(m_state, found.state);
    download(m_answer, rows);
    download(value, values);
    for (std::size_t i = 0; i < m_count; ++i)
      for (const std::vector<float>* from : {&rows, &values})
        found.numbers.insert(found.numbers.end(), &(*from)[4 * i], &(*from)[4 * i] + 4);
    return found;
  }

private:
  static constexpr cl_uint kValueArgument = 7;

  void build(const std::string& sources, const std::string& more) {
    std::ostringstream text;
    text << std::ifstream(sources + "/device/query.cl").rdbuf();
    const std::string source = text.str();
    const char* start = source.c_str();
    cl_int code = 0;
    const cl_program program = clCreateProgramWithSource(m_context, 1, &start, nullptr, &code);
    require(code, "program");
    const std::string options = "-cl-std=CL1.2 -I " + sources + "/include" + more;
    if (clBuildProgram(program, 1, &m_device, options.c_str(), nullptr, nullptr) != CL_SUCCESS) {
      std::vector<char> log(1 << 16);
      clGetProgramBuildInfo(program, m_device, CL_PROGRAM_BUILD_LOG, log.size() - 1, log.data(),
                            nullptr);
      throw std::runtime_error(log.data());
    }
    m_blended = clCreateKernel(program, "blob_query_points", &code);
    require(code, "kernel");
    m_exact = clCreateKernel(program, "blob_query_exact_points", &code);
    require(code, "kernel");
  }

  template <class T>
  cl_mem upload(const std::vector<T>& values) {
    cl_int code = 0;
    const cl_mem buffer =
        clCreateBuffer(m_context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                       values.size() * sizeof(T), const_cast<T*>(values.data()), &code);
    require(code, "buffer");
    return buffer;
  }

  template <class T>
  void download(cl_mem buffer, std::vector<T>& values) {
    require(clEnqueueReadBuffer(m_queue, buffer, CL_TRUE, 0, values.size() * sizeof(T),
                                values.data(), 0, nullptr, nullptr),
            "download");
  }

  cl_device_id m_device = nullptr;
  cl_context m_context = nullptr;
  cl_command_queue m_queue = nullptr;
  cl_kernel m_blended = nullptr, m_exact = nullptr, m_kernel = nullptr;
  cl_mem m_cursor = nullptr, m_answer = nullptr, m_state = nullptr;
  std::size_t m_count = 0;
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
             std::size_t count, OpenCl& device) {
  const std::vector<std::uint32_t> words = pack(model);
  const Points points(model, count);
  OnThisProcessor library(model, flags, points);
  device.begin(words, flags, points);
  double ofLibrary = 1e9, ofDevice = 1e9;  // s
  for (int turn = 0; turn < kTurns; ++turn) {
    ofLibrary = std::min(ofLibrary, secondsOf(library));
    ofDevice = std::min(ofDevice, secondsOf(device));
  }
  const Agreement found(model, library.answers(), device.answers());
  const auto number = static_cast<double>(count);
  std::printf(
      "%s, flags %u: %zu points, same node %zu, distance within %.2g mm (%.3f %% within 1e-5, "
      "farther at %zu), others %.2g, %zu leaks; processor time of %.1f ns a point there, %.1f by "
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

bool compareTrees(std::size_t count, OpenCl& device) {
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

int run(int argc, char** argv) {
  std::size_t count = 1'000'000;
  std::uint32_t flags = BLOB_BLENDED;
  std::string options;
  std::vector<std::string> cases;
  for (int i = 2; i < argc; ++i) {
    if (std::strcmp(argv[i], "--points") == 0 && i + 1 < argc)
      count = std::strtoull(argv[++i], nullptr, 10);
    else if (std::strcmp(argv[i], "--wide") == 0 && i + 1 < argc)
      options = std::string(" -D BLOB_DEVICE_WIDE=") + argv[++i];
    else if (std::strcmp(argv[i], "--exact") == 0)
      flags = BLOB_DISTANCE_EXACT;
    else
      cases.emplace_back(argv[i]);
  }
  OpenCl device(argc > 1 ? argv[1] : ".", options);
  std::printf("OpenCL device: %s\n", device.name().c_str());
  if (cases.empty()) return compareTrees(count, device) ? 0 : 1;
  bool agree = true;
  for (const std::string& file : cases) {
    blob_model* model = nullptr;
    const blob_status status = blob_model_open(file.c_str(), nullptr, &model);
    if (status != BLOB_OK) throw std::runtime_error(file + ": " + blob_status_text(status));
    agree = compare(file, model, flags, count, device) && agree;
    blob_model_close(model);
  }
  return agree ? 0 : 1;
}

}  // namespace
}  // namespace lumen::blob::test

int main(int argc, char** argv) {
  try {
    return lumen::blob::test::run(argc, argv);
  } catch (const lumen::blob::test::NoDevice& none) {
    std::printf("skipped: %s\n", none.what());
    return lumen::blob::test::kSkipped;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "device_opencl: %s\n", error.what());
    return 1;
  }
}
