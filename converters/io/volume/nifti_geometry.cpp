// SPDX-License-Identifier: Apache-2.0
// Declared in image_header.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include <Eigen/LU>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/io/volume/image_header.h"
#include "converters/io/volume/nifti_rotation.h"
#include "converters/io/volume/volume_checks.h"

namespace lumen::convert {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The sform counts where its code is at least as high as the qform's: nibabel, NiiVue, FreeSurfer and
// SPM take the sform whenever it is stated, ITK (5.2, itkNiftiImageIO.cxx) only if its code is 1 or
// there is no qform. The required orthogonality of an sform is ITK's, which differs in two points: it
// rejects an orthogonal sform whose inverse in floats is inaccurate, and leaves the origin of a file in
// metres unconverted.
constexpr double kOrthogonal = 1e-4;
constexpr double kLeastUpright = 0.7;  // volume of unit axes, below which they are none of an image
constexpr const char* kSheared = "its axes' directions (sform) are not orthogonal";
// Limit of the norm of a quaternion's b, c and d, which belong to a unit vector: a greater one is
// no rounding of floats.
constexpr double kLongQuaternion = 1 + 1e-3;
// Share of the spacing within which two transforms must place every voxel in order to agree.
constexpr double kAgree = 0.5;
// Relative tolerance between the lengths of an sform's axes and pixdim.
constexpr double kSameSpacing = 1e-3;

const Vector3d kLpsFromRas(-1, -1, 1);

// NIfTI-1's codes of units and of a scanner's transform.
constexpr int kMetres = 1, kMillimetres = 2, kMicrometres = 3;
constexpr std::int16_t kScannerTransform = 1, kAlignedTransform = 2;

/// A transform of the header in RAS and the file's unit; a fault, if it is invalid.
struct Transform {
  bool stated = false;
  bool isSheared = false;  ///< axes lean
  std::string fault;
  const char* remedy =
      "expected a place in space; write its transform again, by the tool it is from";
  Matrix3d axes = Matrix3d::Identity();  ///< columns, with any length
  Vector3d offset = Vector3d::Zero();
  [[nodiscard]] bool usable() const { return stated && fault.empty(); }
};

Transform sformOf(const NiftiHeader& header) {
  Transform sform;
  sform.stated = header.sformCode > 0;
  for (std::size_t r = 0; r < 3; ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    for (std::size_t c = 0; c < 3; ++c)
      sform.axes(row, static_cast<Eigen::Index>(c)) = static_cast<double>(header.sform[r][c]);
    sform.offset[row] = static_cast<double>(header.sform[r][3]);
  }
  Matrix3d axes = sform.axes;
  axes.colwise().normalize();
  const double skew = (axes * axes.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!sform.axes.allFinite() || !sform.offset.allFinite()) {
    sform.fault = "its sform has numbers that are not finite";
  } else if (!(sform.axes.colwise().norm().minCoeff() > 0)) {
    sform.fault = "its sform has an axis without a length";
  } else if (!(std::abs(axes.determinant()) >= kLeastUpright)) {
    sform.fault = kSheared;
    sform.remedy = "resample the volume to an orthogonal grid first";
  } else {
    sform.isSheared = !(skew <= kOrthogonal);
  }
  return sform;
}

Transform qformOf(const NiftiHeader& header) {
  Transform qform;
  qform.stated = header.qformCode > 0;
  const Vector3d quaternion = toEigen(header.quaternion);
  qform.offset = toEigen(header.qOffset);
  if (!quaternion.allFinite() || quaternion.norm() > kLongQuaternion)
    qform.fault = "its qform has the quaternion (b, c, d) " +
                  vectorText(quaternion, kHeaderDigits) + ", which is no rotation";
  else if (!qform.offset.allFinite())
    qform.fault = "its qform has the offset " + vectorText(qform.offset, kHeaderDigits);
  else if (!std::isfinite(header.handedness))
    qform.fault = "its qform has the handedness (pixdim[0]) " +
                  longNumber(static_cast<double>(header.handedness));
  if (!qform.fault.empty()) return qform;
  const auto step = [&](std::size_t a) {
    return std::isfinite(header.pixdim[a]) && header.pixdim[a] > 0 ? header.pixdim[a] : 1.0F;
  };
  qform.axes =
      niftiAxes({header.quaternion, header.handedness}, {step(0), step(1), step(2)}).cast<double>();
  return qform;
}

/// The greatest distance between a corner of the volume in one transform and in another, with the
/// spacing of pixdim.
double distanceOf(const Transform& one, const Transform& other, const NiftiHeader& header) {
  Matrix3d difference = one.axes.colwise().normalized() - other.axes.colwise().normalized();
  difference *= toEigen(header.pixdim).asDiagonal();
  double furthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vector3d index;
    for (int a = 0; a < 3; ++a)
      index[a] = (corner >> a & 1) * (header.size[static_cast<std::size_t>(a)] - 1);
    const Vector3d apart = one.offset - other.offset + difference * index;
    furthest = std::max(furthest, apart.norm());
  }
  return furthest;
}

void reportDisagreement(const Transform& used, const char* name, const Transform& other,
                        const char* otherName, const NiftiHeader& header,
                        std::vector<std::string>& assumptions) {
  const double apart = distanceOf(used, other, header);
  const double voxel = toEigen(header.pixdim).minCoeff();
  if (!(apart > kAgree * voxel)) return;
  assumptions.push_back("its qform (code " + std::to_string(header.qformCode) +
                        ") and its sform (code " + std::to_string(header.sformCode) +
                        ") place voxels up to " + numberText(apart / voxel, 3) +
                        " voxels apart; the " + name + " is used; if the " + otherName +
                        " is right, remove the " + name + " (set its code to 0)");
}

/// Whether an sform that leans, as by a gantry tilt, is the grid of the scan, which no qform can state:
/// it is the scanner's or that of another scan, and the qform is elsewhere, or there is no qform. One of
/// an atlas leans by a registration that changes shapes.
bool isTilted(const Transform& sform, const Transform& qform, const NiftiHeader& header) {
  if (!sform.isSheared || !sform.usable()) return false;
  if (!qform.usable()) return true;
  const double apart = distanceOf(qform, sform, header);
  const double voxel = toEigen(header.pixdim).minCoeff();
  return header.sformCode <= kAlignedTransform && apart > kAgree * voxel;
}

/// The transform that places the voxels, or null if none is stated.
const Transform* chosenTransform(Transform& sform, const Transform& qform,
                                 const NiftiHeader& header, const std::filesystem::path& path,
                                 std::vector<std::string>& assumptions) {
  if (!sform.stated && !qform.stated) return nullptr;
  if (isTilted(sform, qform, header)) return &sform;
  if (sform.isSheared) sform.fault = kSheared;
  const bool prefersS = sform.stated && (!qform.stated || header.sformCode >= header.qformCode);
  const Transform& first = prefersS ? sform : qform;
  const Transform& second = prefersS ? qform : sform;
  const char* const firstName = prefersS ? "sform" : "qform";
  const char* const secondName = prefersS ? "qform" : "sform";
  if (first.usable()) {
    if (second.usable())
      reportDisagreement(first, firstName, second, secondName, header, assumptions);
    return &first;
  }
  if (second.usable()) {
    assumptions.push_back(first.fault + "; its " + secondName + " is used instead");
    return &second;
  }
  std::string faults = first.fault;
  if (second.stated) faults.append(", and ").append(second.fault);
  throw invalidInput(path.string() + ": " + faults + "; " + first.remedy);
}

/// Adds an assumption if the lengths of the sform's axes contradict pixdim, which counts.
void reportOtherSpacing(const Transform& sform, const Vector3d& spacing, const FieldWord& word,
                        std::vector<std::string>& assumptions) {
  if (!sform.usable()) return;
  const Vector3d lengths = sform.axes.colwise().norm();
  const auto off = (lengths - spacing).cwiseQuotient(spacing).cwiseAbs();
  if (!(off.maxCoeff() > kSameSpacing)) return;
  assumptions.push_back("its sform has voxels " + vectorText(lengths, kHeaderDigits) +
                        " apart, its pixdim " + vectorText(spacing, kHeaderDigits) +
                        "; pixdim is used; state another with " + word("spacing"));
}

std::optional<double> millimetres(int unitCode) {
  if (unitCode == kMetres) return 1e3;
  if (unitCode == kMillimetres) return 1;
  if (unitCode == kMicrometres) return 1e-3;
  return std::nullopt;
}

/// Writes a field of a header in this machine's byte order, which its first number shows.
template <class T>
void put(std::string& header, std::size_t at, T value) {
  std::memcpy(header.data() + at, &value, sizeof(value));
}

}  // namespace

StatedGeometry niftiGeometry(const NiftiHeader& header, const ReadVolumeOptions& options,
                             const std::filesystem::path& path,
                             std::vector<std::string>& assumptions) {
  StatedGeometry stated;
  VolumeGeometry& geometry = stated.geometry;
  stated.unit = millimetres(header.unitCode);
  stated.unitNote = "its header states no unit of length that NIfTI has (xyzt_units is " +
                    std::to_string(header.unitCode) +
                    "), so lengths are taken as mm; state the unit with " + options.word("unit");
  geometry.size = header.size;
  geometry.spacing = toEigen(header.pixdim);
  Transform sform = sformOf(header);
  const Transform qform = qformOf(header);
  const Transform* transform = chosenTransform(sform, qform, header, path, assumptions);
  if (transform == nullptr) {
    assumptions.emplace_back(
        "its header places it nowhere (qform_code and sform_code are 0), so its axes are taken as "
        "left, posterior and superior, from an origin at its first voxel");
    stated.placedBy = "no transform";
    return stated;
  }
  stated.placedBy = transform == &sform ? "sform (code " + std::to_string(header.sformCode) + ")"
                                        : "qform (code " + std::to_string(header.qformCode) + ")";
  // lengths along axes that lean are no distances of slices, which pixdim may state
  const bool leans = transform == &sform && sform.isSheared;
  if (leans) geometry.spacing = sform.axes.colwise().norm();
  if (!options.spacing && !leans)
    reportOtherSpacing(sform, geometry.spacing, options.word, assumptions);
  geometry.origin = kLpsFromRas.cwiseProduct(transform->offset);
  geometry.direction = kLpsFromRas.asDiagonal() * transform->axes;
  geometry.direction.colwise().normalize();
  return stated;
}

std::string niftiHeader(const Volume& volume, const std::filesystem::path& path) {
  struct StoredType {
    std::int16_t code, bits;
  };
  constexpr std::array<StoredType, 4> kTypes = {{{2, 8}, {4, 16}, {512, 16}, {16, 32}}};
  const VolumeGeometry& geometry = volume.geometry;
  for (const int size : geometry.size)
    if (size > std::numeric_limits<std::int16_t>::max())
      throw unsupported(path.string() + ": has " + std::to_string(size) +
                        " voxels along an axis; NIfTI-1 holds at most 32767");
  std::string header(kNiftiFirstVoxel, '\0');  // zeros behind it: no extensions
  put(header, 0, std::int32_t{kNiftiHeaderSize});
  header[38] = 'r';  // ANALYZE's mark, which some readers still look for
  for (std::size_t axis = 0; axis < 8; ++axis)
    put(header, 40 + 2 * axis, axis == 0 ? std::int16_t{3} : std::int16_t{1});
  const StoredType type = kTypes.at(volume.voxels.index());
  put(header, 70, type.code);
  put(header, 72, type.bits);
  put(header, 108, static_cast<float>(kNiftiFirstVoxel));
  put(header, 112, 1.0F);  // scl_slope
  header[123] = kMillimetres;
  put(header, 252, kScannerTransform);
  put(header, 254, kScannerTransform);
  std::memcpy(&header[344], "n+1", 4);
  const Eigen::Matrix3f axes =
      orthogonalAxes((kLpsFromRas.asDiagonal() * geometry.direction).cast<float>());
  const Eigen::Vector3f offset = kLpsFromRas.cwiseProduct(geometry.origin).cast<float>();
  const Eigen::Vector3f spacing = geometry.spacing.cast<float>();
  const NiftiRotation rotation = niftiRotation(axes);
  put(header, 76, rotation.handedness);
  for (std::size_t r = 0; r < 3; ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    put(header, 42 + 2 * r, static_cast<std::int16_t>(geometry.size[r]));
    put(header, 80 + 4 * r, spacing[row]);
    put(header, 256 + 4 * r, rotation.quaternion[r]);
    put(header, 268 + 4 * r, offset[row]);
    const std::size_t sform = 280 + 16 * r;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto column = static_cast<Eigen::Index>(c);
      put(header, sform + 4 * c, spacing[column] * axes(row, column));
    }
    put(header, sform + 12, offset[row]);
  }
  return header;
}

}  // namespace lumen::convert
