// SPDX-License-Identifier: Apache-2.0
#include "open_case.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "build_model.h"
#include "formats/container/printable.h"
#include "formats/view/case_view.h"
#include "posed_model.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#elif !defined(__wasm__)
#include <fstream>
#endif

namespace lumen::blob {
namespace {

using formats::ErrorCode;

/// A file mapped into memory where the system can, read into memory elsewhere.
class MappedFile {
public:
  /// Maps or reads a file; false as a bool, with its fault, if it cannot be opened, is no regular
  /// file, or is empty.
  explicit MappedFile(const char* path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  explicit operator bool() const { return m_data != nullptr; }
  [[nodiscard]] const void* data() const { return m_data; }
  [[nodiscard]] std::size_t size() const { return m_size; }
  /// The cause of a file that cannot be used, such as "No such file or directory".
  [[nodiscard]] const std::string& fault() const { return m_fault; }

private:
  std::string m_fault;
  const void* m_data = nullptr;
  std::size_t m_size = 0;
  std::vector<double> m_copy;  ///< bytes where files cannot be mapped; doubles for alignment
};

#if defined(__unix__) || defined(__APPLE__)
std::string systemFault() {
  return std::generic_category().message(errno);
}

// Why a file of this status is no case; empty if it may be one.
std::string faultOf(const struct stat& status) {
  if (S_ISDIR(status.st_mode)) return "found a folder, expected a file";
  if (!S_ISREG(status.st_mode)) return "found a device or a pipe, expected a file";
  return status.st_size > 0 ? "" : "the file is empty";
}

MappedFile::MappedFile(const char* path) {
  const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    m_fault = systemFault();
    return;
  }
  struct stat status {};
  m_fault = fstat(file, &status) == 0 ? faultOf(status) : systemFault();
  if (m_fault.empty()) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* data = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
    if (data != MAP_FAILED) {
      m_data = data;
      m_size = size;
    } else {
      m_fault = systemFault();
    }
  }
  close(file);
}

MappedFile::~MappedFile() {
  if (m_data != nullptr) munmap(const_cast<void*>(m_data), m_size);
}
#elif defined(__wasm__)
// no files exist here, and streams would be most of the library
MappedFile::MappedFile(const char*) : m_fault("there are no files here") {}
MappedFile::~MappedFile() = default;
#else
MappedFile::MappedFile(const char* path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  if (size <= 0) {
    m_fault = file         ? "the file is empty"
              : errno != 0 ? std::generic_category().message(errno)
                           : "the file cannot be opened";
    return;
  }
  m_copy.resize((static_cast<std::size_t>(size) + sizeof(double) - 1) / sizeof(double));
  file.seekg(0);
  if (!file.read(reinterpret_cast<char*>(m_copy.data()), size)) {
    m_fault = "the file cannot be read";
    return;
  }
  m_data = m_copy.data();
  m_size = static_cast<std::size_t>(size);
}

MappedFile::~MappedFile() = default;
#endif

blob_status fail(const blob_open_def& def, blob_status status, std::string_view sentence) {
  if (def.message != nullptr && def.message_size > 0) {
    const std::size_t size = std::min(sentence.size(), def.message_size - 1);
    std::memcpy(def.message, sentence.data(), size);
    def.message[size] = '\0';
  }
  return status;
}

blob_status statusOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::HeaderChecksum:
    case ErrorCode::TableChecksum:
    case ErrorCode::ChunkChecksum:
      return BLOB_ERROR_CHECKSUM;
    case ErrorCode::ChunkEncoding:
      return BLOB_ERROR_ENCODING;
    case ErrorCode::Limit:
      return BLOB_ERROR_LIMIT;
    default:
      return BLOB_ERROR_FORMAT;
  }
}

// Fills `blobs`; false if offsets point beyond the arrays, as those of an unverified file may.
bool fillBlobs(const formats::ModelView& view, blob_blobs& blobs) {
  if (view.offset.empty() || view.offset.back() != view.centre.size() ||
      view.centre.size() != view.width.size())
    return false;
  blobs.kernel = static_cast<blob_kernel>(view.kernel);
  blobs.kernel_parameter = view.kernelParameter;
  blobs.iso_level = view.isoLevel;
  blobs.offset = view.offset.data();
  blobs.centre = reinterpret_cast<const float(*)[3]>(view.centre.data());
  blobs.width = view.width.data();
  return true;
}

blob_status build(const formats::CaseView& view, const blob_open_def& def, blob_model** model) {
  blob_model_def tree = blob_model_def_default();
  tree.node_count = view.nodeCount();
  tree.centre = reinterpret_cast<const float(*)[3]>(view.nodeCentre.data());
  tree.radius = view.nodeRadius.data();
  tree.parent = view.nodeParent.data();
  tree.link_count = view.links.size();
  tree.link = reinterpret_cast<const std::uint32_t(*)[2]>(view.links.data());
  tree.simd = def.simd;
  if (!view.models)
    return fail(def, BLOB_ERROR_NO_MODELS, "the case has no models; lumen fit makes them");
  if (!fillBlobs(*view.models, tree.blobs))
    return fail(def, BLOB_ERROR_TOPOLOGY, "offsets do not match the number of blobs");
  const blob_status status = checkDefinition(tree);
  if (status != BLOB_OK) return fail(def, status, blob_status_text(status));
  *model = buildModel(tree).release();
  return BLOB_OK;
}

// Copies the motion of a view.
blob_status readMotion(const formats::CaseView& view, const blob_open_def& def,
                       blob_motion** motion) {
  if (!view.motion)
    return fail(def, BLOB_ERROR_NO_MOTION, "the case has no motion; lumen motion makes one");
  const formats::MotionView& from = *view.motion;
  auto made = std::make_unique<blob_motion>();
  made->caseNodes = view.nodeCount();
  made->period = from.period;
  made->time.assign(from.time.begin(), from.time.end());
  made->node.assign(from.node.begin(), from.node.end());
  for (const formats::PoseRecord& p : from.pose) {
    const blob_transform transform{{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}, p[7]};
    if (!isTransform(transform))
      return fail(def, BLOB_ERROR_RANGE,
                  "a pose of the motion is out of the range of blob_transform");
    made->pose.push_back(poseOf(transform));
  }
  const bool areNodes = std::all_of(made->node.begin(), made->node.end(),
                                    [&view](std::uint32_t i) { return i < view.nodeCount(); });
  // of an unverified file, counts and order may be anything
  if (!areNodes || made->time.empty() ||
      made->pose.size() != made->time.size() * made->node.size() ||
      !std::is_sorted(made->time.begin(), made->time.end()))
    return fail(def, BLOB_ERROR_TOPOLOGY, "the motion names nodes or times that the case lacks");
  *motion = made.release();
  return BLOB_OK;
}

// Views the bytes of a file, and uses the view.
template <class Use>
blob_status withView(const void* bytes, std::size_t size, const blob_open_def& def, Use use) {
  std::span<const std::byte> view(static_cast<const std::byte*>(bytes), size);
  // numbers are used in place, so unaligned bytes are copied
  std::vector<std::byte> aligned;
  if (reinterpret_cast<std::uintptr_t>(bytes) % alignof(double) != 0) {
    aligned.assign(view.begin(), view.end());
    view = aligned;
  }
  const auto opened =
      formats::viewCase(view, def.verify != 0 ? formats::Verify::All : formats::Verify::Structure);
  if (!opened)
    return fail(def, statusOf(opened.error().code), formats::printable(opened.error().message));
  return use(*opened);
}

// Maps a file, and uses its bytes.
template <class Use>
blob_status withFile(const char* path, const blob_open_def& def, Use use) {
  const MappedFile file(path);
  if (!file) return fail(def, BLOB_ERROR_FILE, file.fault());
  return use(file.data(), file.size());
}

}  // namespace

blob_status openBytes(const void* bytes, std::size_t size, const blob_open_def& def,
                      blob_model** model) {
  return withView(bytes, size, def,
                  [&](const formats::CaseView& view) { return build(view, def, model); });
}

blob_status openFile(const char* path, const blob_open_def& def, blob_model** model) {
  return withFile(path, def, [&](const void* bytes, std::size_t size) {
    return openBytes(bytes, size, def, model);
  });
}

blob_status openMotionBytes(const void* bytes, std::size_t size, const blob_open_def& def,
                            blob_motion** motion) {
  return withView(bytes, size, def,
                  [&](const formats::CaseView& view) { return readMotion(view, def, motion); });
}

blob_status openMotionFile(const char* path, const blob_open_def& def, blob_motion** motion) {
  return withFile(path, def, [&](const void* bytes, std::size_t size) {
    return openMotionBytes(bytes, size, def, motion);
  });
}

}  // namespace lumen::blob
