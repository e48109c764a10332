// SPDX-License-Identifier: Apache-2.0
// The kernel of libblob/device/query.cl on an OpenCL device, against blob_query_columns().
//
//   device_opencl SOURCES [--points N] [CASE...]    SOURCES: the folder of libblob's sources
//
// Without a CASE: synthetic trees, one of two vessels that touch. Prints what it compared, and both
// rates. Exit code 1: answers differ by more than blob_device.h allows; 77: there is no device.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
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
  }
  [[nodiscard]] std::size_t count() const { return cursor.size(); }
};

struct Answers {
  std::vector<std::uint32_t> cursor, state;
  std::vector<double> distance;
  double seconds = 0;
};

Answers onThisProcessor(const blob_model* model, const Points& points) {
  const std::size_t count = points.count();
  const std::vector<double> xyz(points.xyz.begin(), points.xyz.end());
  Answers answers{points.cursor, std::vector<std::uint32_t>(count), std::vector<double>(count)};
  std::vector<double> normal(3 * count);
  std::vector<std::uint8_t> state(count);
  blob_columns columns = blob_columns_default();
  columns.count = count;
  columns.point_stride = 3 * sizeof(double);
  columns.cursor = answers.cursor.data();
  columns.distance = answers.distance.data();
  columns.state = state.data();
  for (std::size_t k = 0; k < 3; ++k) {
    columns.point[k] = &xyz[k];
    columns.normal[k] = &normal[k * count];
  }
  blob_query_columns(model, BLOB_BLENDED, &columns);  // moves the cursors
  const double start = processorSeconds();
  blob_query_columns(model, BLOB_BLENDED, &columns);
  answers.seconds = processorSeconds() - start;
  std::copy(state.begin(), state.end(), answers.state.begin());
  return answers;
}

// The first device of any platform, with the kernel. Handles are released with the process.
class OpenCl {
public:
  explicit OpenCl(const std::string& sources) {
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
    build(sources);
  }

  [[nodiscard]] std::string name() const {
    char text[256] = "";
    clGetDeviceInfo(m_device, CL_DEVICE_NAME, sizeof text, text, nullptr);
    return text;
  }

  Answers query(const std::vector<std::uint32_t>& words, const Points& points) {
    const std::size_t count = points.count();
    Answers answers{points.cursor, std::vector<std::uint32_t>(count), std::vector<double>(count)};
    const cl_mem packed = upload(words), xyz = upload(points.xyz), cursor = upload(points.cursor);
    std::vector<float> found(4 * count);
    const cl_mem answer = upload(found), state = upload(answers.state);
    const cl_uint vessel = 0, flags = BLOB_BLENDED, number = static_cast<cl_uint>(count);
    cl_uint index = 0;
    const auto pass = [&](std::size_t size, const void* value) {
      require(clSetKernelArg(m_kernel, index++, size, value), "argument");
    };
    pass(sizeof packed, &packed);
    pass(sizeof vessel, &vessel);
    pass(sizeof flags, &flags);
    pass(sizeof number, &number);
    for (const cl_mem* buffer : {&xyz, &cursor, &answer}) pass(sizeof *buffer, buffer);
    pass(sizeof(cl_mem), nullptr);
    pass(sizeof state, &state);
    run(count);  // compiles, and moves the cursors
    const double start = processorSeconds();
    run(count);
    answers.seconds = processorSeconds() - start;
    download(cursor, answers.cursor);
    download(state, answers.state);
    download(answer, found);
    for (std::size_t i = 0; i < count; ++i) answers.distance[i] = double{found[4 * i]};
    for (const cl_mem buffer : {packed, xyz, cursor, answer, state}) clReleaseMemObject(buffer);
    return answers;
  }

private:
  void build(const std::string& sources) {
    std::ostringstream text;
    text << std::ifstream(sources + "/device/query.cl").rdbuf();
    const std::string source = text.str();
    const char* start = source.c_str();
    cl_int code = 0;
    const cl_program program = clCreateProgramWithSource(m_context, 1, &start, nullptr, &code);
    require(code, "program");
    const std::string options = "-cl-std=CL1.2 -I " + sources + "/include";
    if (clBuildProgram(program, 1, &m_device, options.c_str(), nullptr, nullptr) != CL_SUCCESS) {
      std::vector<char> log(1 << 16);
      clGetProgramBuildInfo(program, m_device, CL_PROGRAM_BUILD_LOG, log.size() - 1, log.data(),
                            nullptr);
      throw std::runtime_error(log.data());
    }
    m_kernel = clCreateKernel(program, "blob_query_points", &code);
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

  void run(std::size_t count) {
    cl_device_type type = 0;
    clGetDeviceInfo(m_device, CL_DEVICE_TYPE, sizeof type, &type, nullptr);
    constexpr std::size_t kItemsOfProcessor = 64;
    const bool isGraphics = (type & CL_DEVICE_TYPE_CPU) == 0;
    const std::size_t group = isGraphics ? 64 : 1;
    const std::size_t size = isGraphics ? (count + group - 1) / group * group : kItemsOfProcessor;
    require(
        clEnqueueNDRangeKernel(m_queue, m_kernel, 1, nullptr, &size, &group, 0, nullptr, nullptr),
        "run");
    require(clFinish(m_queue), "finish");
  }

  cl_device_id m_device = nullptr;
  cl_context m_context = nullptr;
  cl_command_queue m_queue = nullptr;
  cl_kernel m_kernel = nullptr;
};

// Prints how the answers agree, distances in mm, or in radii where they are more than a radius R
// outside; whether they do so as closely as promised. A leak is a point that one side has in the
// lumen and the other outside.
bool compare(const std::string& name, const blob_model* model, std::size_t count, OpenCl& device) {
  const blob_model* models[1] = {model};
  std::vector<std::uint32_t> words(blob_device_pack(models, 1, nullptr, 0) / 4);
  blob_device_pack(models, 1, words.data(), 4 * words.size());
  if (blob_device_check(words.data(), 4 * words.size()) != BLOB_OK) return false;
  const Points points(model, count);
  const Answers here = onThisProcessor(model, points), there = device.query(words, points);
  std::size_t same = 0, leaks = 0;
  double greatest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    same += here.cursor[i] == there.cursor[i] ? 1 : 0;
    leaks += here.state[i] != there.state[i] ? 1 : 0;
    if (here.cursor[i] != there.cursor[i]) continue;
    const double radius = blob_model_node(model, here.cursor[i]).radius;
    const double scale = std::max(1.0, here.distance[i] / radius);
    greatest = std::max(greatest, std::abs(here.distance[i] - there.distance[i]) / scale);
  }
  const auto number = static_cast<double>(count);
  std::printf(
      "%s: %zu points, same node %.6f %%, distance within %.2g mm, %zu leaks; "
      "processor time of %.1f ns a point there, %.1f by the library; %zu bytes\n",
      name.c_str(), count, 100 * static_cast<double>(same) / number, greatest, leaks,
      1e9 * there.seconds / number, 1e9 * here.seconds / number, 4 * words.size());
  return static_cast<double>(same) >= kSameNode * number && leaks == 0 && greatest <= kDistance;
}

int run(int argc, char** argv) {
  std::size_t count = 1'000'000;
  std::vector<std::string> cases;
  for (int i = 2; i < argc; ++i) {
    if (std::strcmp(argv[i], "--points") == 0 && i + 1 < argc)
      count = std::strtoull(argv[++i], nullptr, 10);
    else
      cases.emplace_back(argv[i]);
  }
  OpenCl device(argc > 1 ? argv[1] : ".");
  std::printf("OpenCL device: %s\n", device.name().c_str());
  bool agree = true;
  for (const std::string& file : cases) {
    blob_model* model = nullptr;
    const blob_status status = blob_model_open(file.c_str(), nullptr, &model);
    if (status != BLOB_OK) throw std::runtime_error(file + ": " + blob_status_text(status));
    agree = compare(file, model, count, device) && agree;
    blob_model_close(model);
  }
  if (cases.empty())
    for (const auto& [name, tree] :
         {std::pair{"helix", helix(120, 0.02)}, {"fork", fork(0.7, 0.02)}, {"kissing", kissing(0)}})
      agree = compare(name, tree.build().get(), count / 3, device) && agree;
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
