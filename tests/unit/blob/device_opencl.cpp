// SPDX-License-Identifier: Apache-2.0
// The kernel of libblob/device/query.cl on an OpenCL device, against blob_query_columns().
//
//   device_opencl SOURCES [--points N] [--wide 0] [--exact] [CASE...]    SOURCES: the folder of libblob's sources
//
// Without a CASE: synthetic trees of each kernel, one of two vessels that touch. Prints what it
// compared, and both rates. --wide 0: as for graphics processors, without vectors. --exact: of a
// CASE, distances to the nearest point of the wall. Exit code 1:
// answers differ by more than blob_device.h allows; 77: there is no device.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CL/cl.h>

#include "blob.h"
#include "device_agreement.h"

namespace lumen::blob::test {
namespace {

constexpr int kSkipped = 77;

struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void require(cl_int code, const char* what) {
  if (code != CL_SUCCESS)
    throw std::runtime_error(std::string(what) + ": OpenCL error " + std::to_string(code));
}

// The first device of any platform, with the kernel. Handles are released with the process.
class OpenCl : public OtherProcessor {
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

  [[nodiscard]] std::string name() const override {
    char text[256] = "";
    clGetDeviceInfo(m_device, CL_DEVICE_NAME, sizeof text, text, nullptr);
    return std::string("OpenCL device: ") + text;
  }

  void begin(const std::vector<std::uint32_t>& words, std::uint32_t flags,
             const Points& points) override {
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
  double run() override {
    const double start = processorSeconds();
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
    return processorSeconds() - start;
  }
  Answers answers() override {
    std::vector<float> rows(4 * m_count), values(4 * m_count);
    const cl_mem value = upload(values);
    require(clSetKernelArg(m_kernel, kValueArgument, sizeof value, &value), "argument");
    run();
    Answers found{std::vector<std::uint32_t>(m_count), std::vector<std::uint32_t>(m_count), {}};
    download(m_cursor, found.cursor);
    download(m_state, found.state);
    download(m_answer, rows);
    download(value, values);
    found.setNumbers(rows, values);
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

int run(int argc, char** argv) {
  Comparison wanted;
  std::string options;
  for (int i = 2; i < argc; ++i) {
    if (std::strcmp(argv[i], "--points") == 0 && i + 1 < argc)
      wanted.points = std::strtoull(argv[++i], nullptr, 10);
    else if (std::strcmp(argv[i], "--wide") == 0 && i + 1 < argc)
      options = std::string(" -D BLOB_DEVICE_WIDE=") + argv[++i];
    else if (std::strcmp(argv[i], "--exact") == 0)
      wanted.exact = true;
    else
      wanted.cases.emplace_back(argv[i]);
  }
  OpenCl device(argc > 1 ? argv[1] : ".", options);
  return compareWithLibrary(wanted, device);
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
