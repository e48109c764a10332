// SPDX-License-Identifier: Apache-2.0
// The organs among the phantoms. Sizes, courses and levels are typical of adults in computed tomography
// with contrast; they are of no patient.
#include <cmath>
#include <limits>
#include <utility>

#include "converters/stages/phantom/organ.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;
using formats::VesselSystem;

constexpr double kThrough = std::numeric_limits<double>::infinity(), kBox = 8;
constexpr double kFatLevel = -90, kMuscleLevel = 45, kCompactaLevel = 700,
                 kMarrowLevel = 180;  // HU

/// A trunk with fat under its skin, muscle, and a vertebral column.
std::vector<OrganShape> trunk() {
  return {{{56, 56, 56}, {52, 44, kThrough}, kFatLevel, kBox},
          {{56, 56, 56}, {48, 40, kThrough}, kMuscleLevel, kBox},
          {{56, 86, 56}, {11, 9, kThrough}, kCompactaLevel, kBox},
          {{56, 86, 56}, {9, 7, kThrough}, kMarrowLevel, kBox}};
}

Organ organOf(std::vector<OrganShape> ground, const std::vector<OrganShape>& shapes) {
  ground.insert(ground.end(), shapes.begin(), shapes.end());
  return {std::move(ground), {}, {}};
}

Courses joined(Courses courses, const Courses& more) {
  courses.insert(courses.end(), more.begin(), more.end());
  return courses;
}

Courses line(const std::vector<Vector3d>& places, double radius, double lastRadius) {
  return {courseThrough(places, radius, lastRadius)};
}

Courses line(const std::vector<Vector3d>& places, double radius) {
  return line(places, radius, radius);
}

/// A vessel that winds down the wall of the ventricle from its base, `apart` mm off.
struct Winding {
  double angle = 0, turn = 0, lowest = 0, radius = 0, apart = 0;
};

Courses onHeart(const Winding& winding) {
  constexpr double kBase = 0.9, kAcross = 33, kNarrowing = 0.6;
  std::vector<Vector3d> places;
  for (int i = 0; i <= 24; ++i) {
    const double t = i / 24.0;
    const double angle = winding.angle + winding.turn * t + 0.1 * std::sin(9 * t);
    const double height = kBase - (kBase - winding.lowest) * t;
    const double across = (kAcross + winding.apart) * std::sqrt(1 - 0.85 * 0.85 * height * height);
    places.emplace_back(56 + across * std::cos(angle), 52 + 0.85 * across * std::sin(angle),
                        56 + 38 * height);
  }
  return line(places, winding.radius, kNarrowing * winding.radius);
}

}  // namespace

// Three coronary arteries on a heart whose ventricle is as bright as they are, and a vein along one.
Design designHeart(const Frame& frame) {
  Organ heart =
      organOf(trunk(), {{{56, 52, 56}, {35, 30, 40}, 105}, {{56, 52, 56}, {24, 19, 28}, 370}});
  const Courses arteries =
      joined(joined(onHeart({-0.9, 1.6, -0.7, 2.2}), onHeart({-0.7, -1.8, -0.3, 2.0})),
             onHeart({1.6, 0.9, -0.5, 2.0}));
  heart.systems = {{VesselSystem::Artery, arteries, 375},
                   {VesselSystem::Vein, onHeart({-0.4, 1.6, -0.5, 1.8, 5}), 205}};
  return designOrgan(heart, frame);
}

// The portal tree, which comes from below and is called the artery, as blood leads into the organ by
// it, and the hepatic veins, which cross it from above.
Design designLiver(const Frame& frame) {
  Organ liver = organOf(trunk(), {{{52, 48, 58}, {40, 30, 38}, 110}});
  liver.systems = {
      {VesselSystem::Artery, forkingTree({58, 60, 22}, {-0.2, -0.3, 1}, {20, 3.4, 3}), 240},
      {VesselSystem::Vein, forkingTree({50, 54, 96}, {-0.1, -0.2, -1}, {20, 3.8, 3, 0.6, 4}), 210}};
  return designOrgan(liver, frame);
}

// Pulmonary arteries along bronchi, and pulmonary veins, on both sides.
Design designLungs(const Frame& frame) {
  Organ lungs = organOf(
      trunk(), {{{31, 54, 56}, {18, 30, 40}, -850, 4}, {{81, 54, 56}, {18, 30, 40}, -850, 4}});
  const Vector3d hilum(44, 48, 56), outwards(-1, 0.2, 0.3);
  lungs.airways = onBothSides(forkingTree({44, 53, 56}, outwards, {13, 3, 2}));
  lungs.systems = {{VesselSystem::Artery,
                    onBothSides(joined(line({{56, 46, 28}, {50, 46, 48}, hilum}, 4),
                                       forkingTree(hilum, outwards, {14, 3, 3}))),
                    365},
                   {VesselSystem::Vein,
                    onBothSides(forkingTree({46, 60, 38}, {-1, 0, 0.6}, {14, 3, 3, 0.6, 3})), 285}};
  return designOrgan(lungs, frame);
}

// The true lumen of an aorta, with a branch, and the wider, dimmer false one, a third of a millimetre
// apart, beside a plaque of calcium.
Design designDissection(const Frame& frame) {
  Organ aorta = organOf(trunk(), {{{64, 70, 56}, {1.4, 1.4, 3}, 900}});
  aorta.systems = {{VesselSystem::TrueLumen,
                    joined(line({{55, 62, 0}, {57, 60, 56}, {54, 62, kOrganEdge}}, 5),
                           line({{57, 60.5, 56}, {70, 54, 58}, {84, 56, 62}}, 2.5, 2)),
                    375},
                   {VesselSystem::FalseLumen,
                    line({{67.2, 66, 0}, {69, 64.5, 56}, {66, 66, kOrganEdge}}, 7.5), 255}};
  return designOrgan(aorta, frame);
}

// Kidneys whose cortex is bright, between the aorta and the lower caval vein.
Design designKidneys(const Frame& frame) {
  Organ kidneys = organOf(trunk(), {});
  for (const double x : {30.0, 82.0}) {
    kidneys.shapes.push_back({{x, 66, 56}, {13, 12, 24}, 175});
    kidneys.shapes.push_back({{x, 66, 56}, {8, 7, 15}, 60});
  }
  const Courses renal =
      onBothSides(joined(line({{56, 66, 58}, {64, 65, 56}, {70, 66, 56}}, 2.6),
                         forkingTree({70, 66, 56}, {1, 0, 0.1}, {9, 2.2, 2, 0.8})));
  kidneys.systems = {
      {VesselSystem::Artery, joined(line({{56, 66, 0}, {56, 66, kOrganEdge}}, 6), renal), 375},
      {VesselSystem::Vein,
       joined(line({{44, 60, 0}, {44, 60, kOrganEdge}}, 7),
              line({{44, 60, 52}, {56, 56, 51}, {72, 63, 50}}, 3.2)),
       185}};
  return designOrgan(kidneys, frame);
}

// Thighs: thick cortical bone, a femoral artery with two branches, and a wider vein along it.
Design designLegs(const Frame& frame) {
  Organ legs;
  for (const double x : {31.0, 81.0})
    for (const OrganShape& shape : {OrganShape{{x, 56, 56}, {24, 30, kThrough}, kFatLevel, kBox},
                                    OrganShape{{x, 56, 56}, {21, 27, kThrough}, kMuscleLevel, kBox},
                                    OrganShape{{x, 56, 56}, {9, 9, kThrough}, 1200},
                                    OrganShape{{x, 56, 56}, {5, 5, kThrough}, 60}})
      legs.shapes.push_back(shape);
  const Courses branches = joined(line({{41, 45, 38}, {30, 42, 60}, {24, 44, 88}}, 2, 1.4),
                                  line({{41, 46, 68}, {50, 52, 80}}, 1.4));
  legs.systems = {
      {VesselSystem::Artery,
       onBothSides(
           joined(line({{40, 44, 0}, {42, 46, 56}, {36, 50, kOrganEdge}}, 3.2, 2.6), branches)),
       365},
      {VesselSystem::Vein,
       onBothSides(line({{44, 50.5, 0}, {46, 52.5, 56}, {41, 55.5, kOrganEdge}}, 3.6)), 165}};
  return designOrgan(legs, frame);
}

// Two systems that spread side by side in one plane, as in a retina, in even tissue.
Design designRetina(const Frame& frame) {
  Organ retina;
  retina.shapes = {{{56, 64, 56}, {48, 22, 42}, 40, kBox}};
  const auto spread = [](const Vector3d& from, double tilt, double radius, std::uint64_t seed) {
    return joined(forkingTree(from, {1, 0, tilt}, {16, radius, 3, 0.6, seed}),
                  forkingTree(from, {-1, 0, tilt}, {16, radius, 3, 0.6, seed + 1}));
  };
  retina.systems = {{VesselSystem::Artery, spread({56, 55, 56}, 0.3, 2, 1), 340},
                    {VesselSystem::Vein, spread({56, 61, 53}, -0.2, 2.4, 5), 240}};
  return designOrgan(retina, frame);
}

}  // namespace lumen::convert
