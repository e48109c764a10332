// SPDX-License-Identifier: Apache-2.0
// Declared in image_header.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <optional>

#include <nifti/nifti1_io.h>

#include "converters/base/error.h"
#include "converters/base/number_text.h"
#include "converters/base/shown_text.h"
#include "converters/base/vectors.h"
#include "converters/io/volume/image_header.h"
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
// Limit of the norm of a quaternion's b, c and d, which belong to a unit vector: a greater one is
// no rounding of floats.
constexpr double kLongQuaternion = 1 + 1e-3;
// Share of the spacing within which two transforms must place every voxel in order to agree.
constexpr double kAgree = 0.5;
// Relative tolerance between the lengths of an sform's axes and pixdim.
constexpr double kSameSpacing = 1e-3;

const Vector3d kLpsFromRas(-1, -1, 1);

/// A transform of the header in RAS and the file's unit; a fault, if it is invalid.
struct Transform {
  bool stated = false;
  std::string fault;
  const char* remedy =
      "expected a place in space; write its transform again, by the tool it is from";
  Matrix3d axes = Matrix3d::Identity();  ///< columns, with any length
  Vector3d offset = Vector3d::Zero();
  [[nodiscard]] bool usable() const { return stated && fault.empty(); }
};

Transform sformOf(const NiftiHeader& header) {
  Transform sform;
  sform.stated = header.sformCode > NIFTI_XFORM_UNKNOWN;
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
  } else if (!(skew <= kOrthogonal)) {
    sform.fault = "its axes' directions (sform) are not orthogonal";
    sform.remedy = "resample the volume to an orthogonal grid first";
  }
  return sform;
}

Transform qformOf(const NiftiHeader& header) {
  Transform qform;
  qform.stated = header.qformCode > NIFTI_XFORM_UNKNOWN;
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
  const mat44 m = nifti_quatern_to_mat44(
      header.quaternion[0], header.quaternion[1], header.quaternion[2], header.qOffset[0],
      header.qOffset[1], header.qOffset[2], step(0), step(1), step(2), header.handedness);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) qform.axes(r, c) = static_cast<double>(m.m[r][c]);
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

/// The transform that places the voxels, or null if none is stated.
const Transform* chosenTransform(const Transform& sform, const Transform& qform,
                                 const NiftiHeader& header, const std::filesystem::path& path,
                                 std::vector<std::string>& assumptions) {
  if (!sform.stated && !qform.stated) return nullptr;
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

/// The nearest orthogonal axes in RAS and floats; no offset.
mat44 rasAxes(const Matrix3d& direction) {
  const Eigen::Matrix3f d = (kLpsFromRas.asDiagonal() * direction).cast<float>();
  const mat44 columns = nifti_make_orthog_mat44(d(0, 0), d(1, 0), d(2, 0), d(0, 1), d(1, 1),
                                                d(2, 1), d(0, 2), d(1, 2), d(2, 2));
  mat44 axes{};
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) axes.m[r][c] = columns.m[c][r];
  return axes;
}

std::optional<double> millimetres(int unitCode) {
  if (unitCode == NIFTI_UNITS_METER) return 1e3;
  if (unitCode == NIFTI_UNITS_MM) return 1;
  if (unitCode == NIFTI_UNITS_MICRON) return 1e-3;
  return std::nullopt;
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
  const Transform sform = sformOf(header), qform = qformOf(header);
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
  if (!options.spacing) reportOtherSpacing(sform, geometry.spacing, options.word, assumptions);
  geometry.origin = kLpsFromRas.cwiseProduct(transform->offset);
  geometry.direction = kLpsFromRas.asDiagonal() * transform->axes;
  geometry.direction.colwise().normalize();
  return stated;
}

std::string niftiHeader(const Volume& volume, const std::filesystem::path& path) {
  constexpr std::array<short, 4> kTypes = {DT_UINT8, DT_INT16, DT_UINT16, DT_FLOAT32};
  const VolumeGeometry& geometry = volume.geometry;
  for (const int size : geometry.size)
    if (size > std::numeric_limits<short>::max())
      throw unsupported(path.string() + ": has " + std::to_string(size) +
                        " voxels along an axis; NIfTI-1 holds at most 32767");
  nifti_1_header header{};
  header.sizeof_hdr = sizeof(header);
  header.regular = 'r';  // ANALYZE's mark, which some readers still look for
  std::memcpy(header.magic, "n+1", 4);
  header.vox_offset = kNiftiFirstVoxel;
  std::fill(std::begin(header.dim), std::end(header.dim), short{1});
  header.dim[0] = 3;
  int voxelBytes = 0, swapSize = 0;
  header.datatype = kTypes[volume.voxels.index()];
  nifti_datatype_sizes(header.datatype, &voxelBytes, &swapSize);
  header.bitpix = static_cast<short>(8 * voxelBytes);
  const mat44 axes = rasAxes(geometry.direction);
  mat44 matrix = axes;
  const Eigen::Vector3f offset = kLpsFromRas.cwiseProduct(geometry.origin).cast<float>();
  float* const rows[] = {header.srow_x, header.srow_y, header.srow_z};
  for (int r = 0; r < 3; ++r) {
    header.dim[r + 1] = static_cast<short>(geometry.size[static_cast<std::size_t>(r)]);
    header.pixdim[r + 1] = static_cast<float>(geometry.spacing[r]);
    for (int c = 0; c < 3; ++c) rows[r][c] = static_cast<float>(geometry.spacing[c]) * axes.m[r][c];
    rows[r][3] = matrix.m[r][3] = offset[r];
  }
  nifti_mat44_to_quatern(matrix, &header.quatern_b, &header.quatern_c, &header.quatern_d,
                         &header.qoffset_x, &header.qoffset_y, &header.qoffset_z, nullptr, nullptr,
                         nullptr, &header.pixdim[0]);
  header.qform_code = header.sform_code = NIFTI_XFORM_SCANNER_ANAT;
  header.xyzt_units = NIFTI_UNITS_MM;
  header.scl_slope = 1;
  std::string bytes(kNiftiFirstVoxel, '\0');  // zeros behind the header: no extensions
  std::memcpy(bytes.data(), &header, sizeof(header));
  return bytes;
}

}  // namespace lumen::convert
