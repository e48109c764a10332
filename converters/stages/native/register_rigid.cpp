// SPDX-License-Identifier: Apache-2.0
// The only source that includes ITK, whose headers take long to compile.
#include "converters/stages/native/register_rigid.h"

#include <cstddef>
#include <variant>
#include <vector>

#include <itkCommand.h>
#include <itkEuler3DTransform.h>
#include <itkImage.h>
#include <itkImageRegistrationMethodv4.h>
#include <itkMeanSquaresImageToImageMetricv4.h>
#include <itkRegistrationParameterScalesFromPhysicalShift.h>
#include <itkRegularStepGradientDescentOptimizerv4.h>

namespace lumen::convert {
namespace {

constexpr double kFirstStep = 0.5;    // voxels of `fixed`, of the point that moves most
constexpr double kLeastStep = 0.002;  // the same: an end
constexpr unsigned kMostSteps = 200;
constexpr double kShorter = 0.8;  // of a step that turned back: less stops in narrow valleys

using Image = itk::Image<float, 3>;
using Transform = itk::Euler3DTransform<double>;
using Metric = itk::MeanSquaresImageToImageMetricv4<Image, Image>;
using Scales = itk::RegistrationParameterScalesFromPhysicalShift<Metric>;
using Optimizer = itk::RegularStepGradientDescentOptimizerv4<double>;
using Registration = itk::ImageRegistrationMethodv4<Image, Image, Transform>;

/// The voxels as an image of ITK, which does not own them.
Image::Pointer imageOf(const Volume& volume) {
  const VolumeGeometry& from = volume.geometry;
  auto image = Image::New();
  Image::SizeType size;
  Image::DirectionType direction;
  for (unsigned a = 0; a < 3; ++a) {
    size[a] = static_cast<itk::SizeValueType>(from.size[a]);
    for (unsigned b = 0; b < 3; ++b)
      direction(a, b) = from.direction(static_cast<int>(a), static_cast<int>(b));
  }
  image->SetRegions(Image::RegionType(size));
  image->SetSpacing(from.spacing.data());
  image->SetOrigin(from.origin.data());
  image->SetDirection(direction);
  const auto& voxels = std::get<std::vector<float>>(volume.voxels);
  // ITK reads them only
  image->GetPixelContainer()->SetImportPointer(const_cast<float*>(voxels.data()), voxels.size(),
                                               false);
  return image;
}

Transform::Pointer transformOf(const Eigen::Isometry3d& motion, const Eigen::Vector3d& centre) {
  auto transform = Transform::New();
  Transform::MatrixType matrix;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      matrix(static_cast<unsigned>(a), static_cast<unsigned>(b)) = motion.linear()(a, b);
  transform->SetCenter(Transform::InputPointType(centre.data()));
  transform->SetMatrix(matrix, 1e-6);
  const Eigen::Vector3d shift = motion * centre - centre;
  transform->SetTranslation(Transform::OutputVectorType(shift.data()));
  return transform;
}

Eigen::Isometry3d motionOf(const Transform& transform) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (unsigned a = 0; a < 3; ++a) {
    motion.translation()[static_cast<int>(a)] = transform.GetOffset()[a];
    for (unsigned b = 0; b < 3; ++b)
      motion.linear()(static_cast<int>(a), static_cast<int>(b)) = transform.GetMatrix()(a, b);
  }
  return motion;
}

/// The mean square at the points, without random samples, copies of gradients, and threads.
Metric::Pointer metricAt(std::span<const Eigen::Vector3d> points) {
  auto set = Metric::FixedSampledPointSetType::New();
  set->Initialize();
  for (std::size_t i = 0; i < points.size(); ++i)
    set->SetPoint(i, Metric::FixedSampledPointSetType::PointType(points[i].data()));
  auto metric = Metric::New();
  metric->SetFixedSampledPointSet(set);
  metric->SetUseSampledPointSet(true);
  metric->SetUseFixedImageGradientFilter(false);
  metric->SetUseMovingImageGradientFilter(false);
  metric->SetMaximumNumberOfWorkUnits(1);
  return metric;
}

Optimizer::Pointer optimizerOf(const Metric::Pointer& metric, double voxel,
                               const Progress& progress) {
  auto scales = Scales::New();
  scales->SetMetric(metric);
  auto optimizer = Optimizer::New();
  optimizer->SetScalesEstimator(scales);
  optimizer->SetDoEstimateLearningRateOnce(false);
  optimizer->SetDoEstimateLearningRateAtEachIteration(false);
  optimizer->SetLearningRate(kFirstStep * voxel);
  optimizer->SetMinimumStepLength(kLeastStep * voxel);
  optimizer->SetNumberOfIterations(kMostSteps);
  optimizer->SetRelaxationFactor(kShorter);
  optimizer->SetNumberOfWorkUnits(1);
  auto step = itk::FunctionCommand::New();
  step->SetCallback([&progress](const itk::EventObject&) { progress.check(); });
  optimizer->AddObserver(itk::IterationEvent(), step);
  return optimizer;
}

}  // namespace

bool canRegister() {
  return true;
}

Eigen::Isometry3d registerRigid(const Volume& fixed, const Volume& moving,
                                std::span<const Eigen::Vector3d> points,
                                const Eigen::Isometry3d& start, const Progress& progress) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) centre += point / static_cast<double>(points.size());
  const Metric::Pointer metric = metricAt(points);
  auto registration = Registration::New();
  registration->SetFixedImage(imageOf(fixed));
  registration->SetMovingImage(imageOf(moving));
  registration->SetMetric(metric);
  registration->SetOptimizer(optimizerOf(metric, fixed.geometry.voxelSize(), progress));
  registration->SetInitialTransform(transformOf(start, centre));
  registration->InPlaceOn();
  registration->SetNumberOfLevels(1);
  registration->SetShrinkFactorsPerLevel(Registration::ShrinkFactorsArrayType(1, 1));
  registration->SetSmoothingSigmasPerLevel(Registration::SmoothingSigmasArrayType(1, 0.0));
  registration->SetNumberOfWorkUnits(1);
  const bool isLoud = itk::Object::GetGlobalWarningDisplay();
  itk::Object::SetGlobalWarningDisplay(false);
  Eigen::Isometry3d motion = start;
  try {
    registration->Update();
    motion = motionOf(*registration->GetTransform());
  } catch (const itk::ExceptionObject&) {  // hardly a point lies in both images
  }
  itk::Object::SetGlobalWarningDisplay(isLoud);
  return motion;
}

}  // namespace lumen::convert
