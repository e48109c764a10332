// SPDX-License-Identifier: Apache-2.0
#include "converters/volume/nifti_geometry.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <string>

#include <nifti/nifti1_io.h>

#include "converters/common/error.h"

namespace lumen::convert {
namespace {

using Image = std::unique_ptr<nifti_image, void (*)(nifti_image*)>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Which transform counts, and how orthogonal an sform must be, is as in ITK's reader (5.2,
// itkNiftiImageIO.cxx), through which most tools of the field read. That reader differs in two
// things: it turns an orthogonal sform down where its inverse in floats is inaccurate, and leaves
// the origin of a file in metres as it is.
constexpr double kOrthogonal = 1e-4;

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

/// The transform that places the voxels; null if it has neither.
const mat44* chosenTransform(const nifti_image& image, const std::filesystem::path& path) {
  const bool hasS = image.sform_code != NIFTI_XFORM_UNKNOWN;
  const bool hasQ = image.qform_code != NIFTI_XFORM_UNKNOWN;
  if (!hasS && !hasQ) return nullptr;
  const bool prefersS = !hasQ || image.sform_code == NIFTI_XFORM_SCANNER_ANAT;
  if (hasS && prefersS && isOrthogonal(image.sto_xyz)) return &image.sto_xyz;
  if (hasQ) return &image.qto_xyz;
  throw invalidInput(path.string() +
                     ": its axes' directions (sform) are not orthogonal; resample the volume to an "
                     "orthogonal grid first");
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
  geometry.origin = scale * kLpsFromRas.cwiseProduct(offsetOf(*transform));
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
  nifti_1_header header{};
  header.sizeof_hdr = sizeof(header);
  header.regular = 'r';  // ANALYZE's mark, which some readers still look for
  std::memcpy(header.magic, "n+1", 4);
  header.vox_offset = 352;
  std::fill(std::begin(header.dim), std::end(header.dim), short{1});
  header.dim[0] = 3;
  int voxelBytes = 0, swapSize = 0;
  nifti_datatype_sizes(datatype, &voxelBytes, &swapSize);
  header.datatype = datatype;
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
  return header;
}

}  // namespace lumen::convert
