// SPDX-License-Identifier: Apache-2.0
#include "convert_itk.h"

#include <algorithm>
#include <chrono>
#include <variant>

#include <itkHessianToObjectnessMeasureImageFilter.h>
#include <itkImage.h>
#include <itkMultiScaleHessianBasedMeasureImageFilter.h>
#include <itkMultiThreaderBase.h>
#include <itkSymmetricSecondRankTensor.h>

namespace lumen::bench {
namespace {

using Image = itk::Image<float, 3>;
using Hessian = itk::Image<itk::SymmetricSecondRankTensor<double, 3>, 3>;

Image::Pointer imageOf(const convert::Volume& volume) {
  auto image = Image::New();
  Image::SizeType size;
  Image::SpacingType spacing;
  for (unsigned a = 0; a < 3; ++a) {
    size[a] = static_cast<itk::SizeValueType>(volume.geometry.size[a]);
    spacing[a] = volume.geometry.spacing[a];
  }
  image->SetRegions(size);
  image->SetSpacing(spacing);
  image->Allocate();
  std::visit(
      [&](const auto& voxels) {
        std::transform(voxels.begin(), voxels.end(), image->GetBufferPointer(),
                       [](auto x) { return static_cast<float>(x); });
      },
      volume.voxels);
  return image;
}

}  // namespace

Vesselness multiScaleVesselness(const convert::Volume& volume, double least, double greatest,
                                int threads) {
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(static_cast<itk::ThreadIdType>(threads));
  const auto image = imageOf(volume);
  const auto start = std::chrono::steady_clock::now();
  auto measure = itk::HessianToObjectnessMeasureImageFilter<Hessian, Image>::New();
  measure->SetObjectDimension(1);
  measure->SetBrightObject(true);
  auto filter = itk::MultiScaleHessianBasedMeasureImageFilter<Image, Hessian, Image>::New();
  filter->SetInput(image);
  filter->SetHessianToMeasureFilter(measure);
  filter->SetSigmaStepMethodToLogarithmic();
  filter->SetSigmaMinimum(least);
  filter->SetSigmaMaximum(greatest);
  filter->SetNumberOfSigmaSteps(5);
  filter->Update();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const float* first = filter->GetOutput()->GetBufferPointer();
  double sum = 0;
  for (std::size_t i = 0; i < volume.geometry.voxelCount(); ++i)
    sum += static_cast<double>(first[i]);
  return {taken.count(), sum / static_cast<double>(volume.geometry.voxelCount())};
}

}  // namespace lumen::bench
