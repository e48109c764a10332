// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/nifti_geometry.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>

#include <Eigen/LU>
#include <nifti/nifti1_io.h>

#include "converters/common/error.h"

namespace lumen::convert {
namespace {

using Image = std::unique_ptr<nifti_image, void (*)(nifti_image*)>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// An sform whose axes are farther from orthogonal, or from the qform's, is not used: ITK's readers
// go by the same figures (itkNiftiImageIO.cxx, ITK 5), and both must put a volume in one place.
constexpr double kOrthogonal = 1e-4;
constexpr double kSame = 1e-4;

const Vector3d kLpsFromRas(-1, -1, 1);

Matrix3d axesOf(const mat44& matrix) {
  Matrix3d axes;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) axes(r, c) = static_cast<double>(matrix.m[r][c]);
  return axes;
}

Vector3d offsetOf(const mat44& matrix) {
  return {static_cast<double>(matrix.m[0][3]), static_cast<double>(matrix.m[1][3]),
          static_cast<double>(matrix.m[2][3])};
}

bool isOrthogonal(const mat44& matrix) {
  Matrix3d axes = axesOf(matrix);
  axes.colwise().normalize();
  return (axes * axes.transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kOrthogonal;
}

bool areSame(const mat44& a, const mat44& b) {
  const Matrix3d axes = axesOf(a);
  const double scale = axes.colwise().norm().minCoeff();
  return (axes - axesOf(b)).cwiseAbs().maxCoeff() <= kSame * scale &&
         (offsetOf(a) - offsetOf(b)).cwiseAbs().maxCoeff() <= kSame;
}

/// The transform that places the voxels; null if it has neither.
const mat44* chosenTransform(const nifti_image& image, const std::filesystem::path& path) {
  const bool hasS = image.sform_code != NIFTI_XFORM_UNKNOWN;
  const bool hasQ = image.qform_code != NIFTI_XFORM_UNKNOWN;
  if (!hasS && !hasQ) return nullptr;
  if (hasS && isOrthogonal(image.sto_xyz) &&
      (!hasQ || image.sform_code == NIFTI_XFORM_SCANNER_ANAT ||
       areSame(image.sto_xyz, image.qto_xyz)))
    return &image.sto_xyz;
  if (hasQ) return &image.qto_xyz;
  throw invalidInput(path.string() +
                     ": its axes' directions (sform) are not orthogonal; resample the volume to an "
                     "orthogonal grid first");
}

double millimetres(int units) {
  if (units == NIFTI_UNITS_METER) return 1e3;
  if (units == NIFTI_UNITS_MICRON) return 1e-3;
  return 1;
}

}  // namespace

VolumeGeometry niftiGeometry(const nifti_1_header& header, const std::filesystem::path& path) {
  const Image image(nifti_convert_nhdr2nim(header, nullptr), nifti_image_free);
  if (!image) throw invalidInput(path.string() + ": its NIfTI header is not sound");
  VolumeGeometry geometry;
  geometry.size = {image->nx, image->ny, image->nz};
  const double scale = millimetres(image->xyz_units);
  geometry.spacing =
      scale * Vector3d(static_cast<double>(image->dx), static_cast<double>(image->dy),
                       static_cast<double>(image->dz));
  const mat44* transform = chosenTransform(*image, path);
  if (transform == nullptr) return geometry;
  geometry.origin = kLpsFromRas.cwiseProduct(offsetOf(*transform));
  geometry.direction = kLpsFromRas.asDiagonal() * axesOf(*transform);
  geometry.direction.colwise().normalize();
  return geometry;
}

nifti_1_header niftiHeader(const VolumeGeometry& geometry, short datatype,
                           const std::filesystem::path& path) {
  for (const int size : geometry.size)
    if (size > std::numeric_limits<short>::max())
      throw unsupported(path.string() + ": has " + std::to_string(size) +
                        " voxels along an axis; NIfTI-1 holds at most 32767");
  const std::array<int, 8> dim = {3, geometry.size[0], geometry.size[1], geometry.size[2], 1, 1, 1,
                                  1};
  const std::unique_ptr<nifti_1_header, void (*)(void*)> made(
      nifti_make_new_header(dim.data(), datatype), std::free);
  if (!made) throw failed(path.string() + ": no NIfTI header can be made");
  nifti_1_header header = *made;
  const Eigen::Matrix3f axes = (kLpsFromRas.asDiagonal() * geometry.direction).cast<float>();
  const Eigen::Vector3f offset = kLpsFromRas.cwiseProduct(geometry.origin).cast<float>();
  const Eigen::Vector3f spacing = geometry.spacing.cast<float>();
  mat44 matrix{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) matrix.m[r][c] = axes(r, c);
    matrix.m[r][3] = offset[r];
    header.pixdim[r + 1] = spacing[r];
  }
  matrix.m[3][3] = 1;
  nifti_mat44_to_quatern(matrix, &header.quatern_b, &header.quatern_c, &header.quatern_d,
                         &header.qoffset_x, &header.qoffset_y, &header.qoffset_z, nullptr, nullptr,
                         nullptr, &header.pixdim[0]);
  float* const rows[] = {header.srow_x, header.srow_y, header.srow_z};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) rows[r][c] = c < 3 ? spacing[c] * matrix.m[r][c] : offset[r];
  header.qform_code = header.sform_code = NIFTI_XFORM_SCANNER_ANAT;
  header.xyzt_units = NIFTI_UNITS_MM;
  header.scl_slope = 1;
  return header;
}

}  // namespace lumen::convert
