// SPDX-License-Identifier: Apache-2.0
#include "converters/io/mesh/sofa_scene.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "converters/base/error.h"

namespace lumen::convert {
namespace {

using Eigen::Vector3d;

SofaLoader loader(const std::string& text, const std::string& wanted = "") {
  return vesselLoader(sofaLoaders(text, "s.scn"), wanted, "s.scn");
}

/// Error that is thrown: the exit code and the message.
std::string refusal(const std::string& text, const std::string& wanted = "") {
  try {
    loader(text, wanted);
  } catch (const Error& error) {
    return std::to_string(static_cast<int>(error.kind())) + ": " + error.what();
  }
  return {};
}

const std::string kTwo = R"(<?xml version="1.0"?>
<Node name="root">
  <Node name="Tool"><MeshOBJLoader name="tip" filename="tip.obj"/></Node>
  <Node name="Carotids">
    <MeshSTLLoader name="l" filename="c.stl"/>
    <Node name="Collision"><TriangleCollisionModel moving="0"/></Node>
  </Node>
</Node>)";

TEST(SofaScene, PlacesAsSofaDoes) {
  const SofaLoader one = loader(R"(<Node><MeshObjLoader filename="a.obj" translation="10 20 30"
      rotation="90 90 0" scale="2" scale3d="1 3 1"/></Node>)");
  EXPECT_EQ(one.filename, "a.obj");
  // (1, 1, 1) is scaled to (2, 6, 2), turned about x to (2, -2, 6), then about y to (6, -2, -2)
  EXPECT_LT((one.toScene * Vector3d(1, 1, 1) - Vector3d(16, 18, 28)).norm(), 1e-9);
}

TEST(SofaScene, TurnsByAllThreeAnglesInSofasOrder) {
  const SofaLoader one =
      loader(R"(<Node><MeshOBJLoader filename="a.obj" rotation="10 20 30"/></Node>)");
  // the quaternion of Quat::createQuaterFromEuler() for these angles
  const double a = std::numbers::pi / 36, b = std::numbers::pi / 18, c = std::numbers::pi / 12;
  const Eigen::Quaterniond sofa(cos(a) * cos(b) * cos(c) + sin(a) * sin(b) * sin(c),
                                sin(a) * cos(b) * cos(c) - cos(a) * sin(b) * sin(c),
                                cos(a) * sin(b) * cos(c) + sin(a) * cos(b) * sin(c),
                                cos(a) * cos(b) * sin(c) - sin(a) * sin(b) * cos(c));
  EXPECT_LT((one.toScene.linear() - sofa.toRotationMatrix()).norm(), 1e-12);
}

TEST(SofaScene, AppliesTheMechanicalObjectBesideIt) {
  const SofaLoader one = loader(R"(<Node name="v"><MeshSTLLoader filename="a.stl" scale="2"/>
      <MechanicalObject position="0 0 400" scale="3" ry="90" dx="1"/></Node>)");
  EXPECT_TRUE(one.isMovedTwice);
  EXPECT_LT((one.toScene * Vector3d(0, 0, 1) - Vector3d(7, 0, 0)).norm(), 1e-9);
}

TEST(SofaScene, TakesTheStillMesh) {
  EXPECT_EQ(loader(kTwo).filename, "c.stl");
}

TEST(SofaScene, TakesTheNodeThatSaysVessel) {
  EXPECT_EQ(loader(R"(<Node name="root"><Node name="a"><MeshOBJLoader filename="a.obj"/></Node>
      <Node name="vesselTree"><MeshOBJLoader filename="b.obj"/></Node></Node>)")
                .filename,
            "b.obj");
}

TEST(SofaScene, TakesTheOneThatIsNamed) {
  EXPECT_EQ(loader(kTwo, "tip").filename, "tip.obj");
  EXPECT_EQ(loader(kTwo, "Tool").filename, "tip.obj");
  EXPECT_EQ(loader(kTwo, "root/Tool").filename, "tip.obj");
  EXPECT_EQ(refusal(kTwo, "x"),
            "3: s.scn: loads no mesh called \"x\"; it loads tip in root/Tool (tip.obj), l in "
            "root/Carotids (c.stl)");
}

TEST(SofaScene, RefusesToGuess) {
  EXPECT_EQ(refusal(R"(<Node name="r"><MeshOBJLoader name="a" filename="a.obj"/>
      <MeshOBJLoader name="b" filename="b.obj"/></Node>)"),
            "3: s.scn: it is not clear which of its meshes are the vessels: a in r (a.obj), b in r "
            "(b.obj); expected mesh to name one, by its loader or its node");
}

TEST(SofaScene, RefusesWhatItCannotRead) {
  EXPECT_EQ(refusal(R"(<Node><MeshGmshLoader filename="a.msh"/></Node>)"),
            "4: s.scn: line 1: the vessels are loaded by MeshGmshLoader; lumen reads MeshOBJLoader "
            "and MeshSTLLoader");
  EXPECT_EQ(refusal("<Node/>"),
            "3: s.scn: loads no mesh; expected a MeshOBJLoader or a MeshSTLLoader");
  EXPECT_EQ(refusal("<html/>"),
            "3: s.scn: line 1: begins with \"html\"; expected <Node>, with which a scene of SOFA "
            "begins");
  EXPECT_NE(refusal("import Sofa").find("is no XML"), std::string::npos);
  EXPECT_NE(refusal("<!DOCTYPE a [<!ENTITY b \"c\">]><Node/>").find("document type"),
            std::string::npos);
  EXPECT_EQ(refusal(R"(<Node><MeshOBJLoader filename="a.obj" rotation="1 2"/></Node>)"),
            "3: s.scn: line 1: has the rotation \"1 2\"; expected 3 numbers");
  std::string deep;
  for (int i = 0; i < 1000; ++i) deep += "<Node>";
  EXPECT_NE(refusal(deep).find("more than 64 deep"), std::string::npos);
}

}  // namespace
}  // namespace lumen::convert
