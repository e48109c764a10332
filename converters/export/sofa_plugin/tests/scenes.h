// SPDX-License-Identifier: Apache-2.0
// Scenes of the tests, as text. Lengths in mm; a tube of radius 2 runs along x from 0 to 60.
#pragma once

#include <string>

#include <LumenSofa/BeamBlobContact.h>
#include <LumenSofa/BlobField.h>
#include <sofa/simulation/Node.h>
#include <sofa/testing/BaseSimulationTest.h>

namespace lumensofa::test {

inline std::string caseFile(const std::string& name) {
  return std::string(LUMENSOFA_CASES) + "/" + name;
}

inline const char* const kPlugins = R"(
  <RequiredPlugin name="BeamAdapter"/>
  <RequiredPlugin name="LumenSofa"/>
  <RequiredPlugin name="Sofa.Component.AnimationLoop"/>
  <RequiredPlugin name="Sofa.Component.Constraint.Lagrangian.Correction"/>
  <RequiredPlugin name="Sofa.Component.Constraint.Lagrangian.Solver"/>
  <RequiredPlugin name="Sofa.Component.Constraint.Projective"/>
  <RequiredPlugin name="Sofa.Component.LinearSolver.Direct"/>
  <RequiredPlugin name="Sofa.Component.ODESolver.Backward"/>
  <RequiredPlugin name="Sofa.Component.SolidMechanics.Spring"/>
  <RequiredPlugin name="Sofa.Component.StateContainer"/>
  <RequiredPlugin name="Sofa.Component.Topology.Container.Constant"/>
  <RequiredPlugin name="Sofa.Component.Topology.Container.Dynamic"/>
  <RequiredPlugin name="Sofa.Component.Topology.Container.Grid"/>
  <FreeMotionAnimationLoop/>
  <GenericConstraintSolver tolerance="1e-7" maxIterations="1000"/>
)";

inline std::string field(const std::string& file, const std::string& attributes = {}) {
  return "<Node name='vessel'><BlobField name='wall' filename='" + caseFile(file) + "' " +
         attributes + "/></Node>";
}

/// A wire of radius 0.2 whose tip wants to bend, pushed in at 20 mm/s at (5, 0, 0) in the direction
/// of the quaternion.
inline std::string wire(const std::string& quaternion, const std::string& contact) {
  return R"(
  <Node name="rest">
    <RodStraightSection name="body" length="60" nbBeams="30" nbEdgesCollis="30" nbEdgesVisu="30" youngModulus="1e6"
        poissonRatio="0.3" radius="0.2" massDensity="6e-6"/>
    <RodSpireSection name="tip" length="10" nbBeams="8" nbEdgesCollis="8" nbEdgesVisu="8" youngModulus="5e5"
        poissonRatio="0.3" radius="0.2" massDensity="6e-6" spireDiameter="20" spireHeight="0"/>
    <WireRestShape template="Rigid3d" name="shape" wireMaterials="@body @tip"/>
    <EdgeSetTopologyContainer name="lines"/>
    <EdgeSetTopologyModifier/>
    <EdgeSetGeometryAlgorithms template="Rigid3d"/>
    <MechanicalObject template="Rigid3d"/>
  </Node>
  <Node name="instrument">
    <EulerImplicitSolver rayleighStiffness="0.2" rayleighMass="0.1"/>
    <BTDLinearSolver/>
    <RegularGridTopology name="grid" nx="39" ny="1" nz="1" xmin="0" xmax="0" ymin="0" ymax="0" zmin="0" zmax="0"/>
    <MechanicalObject name="dofs" template="Rigid3d"/>
    <WireBeamInterpolation name="interpolation" WireRestShape="@../rest/shape"/>
    <AdaptiveBeamForceFieldAndMass interpolation="@interpolation"/>
    <InterventionalRadiologyController name="controller" template="Rigid3d" instruments="interpolation" topology="@grid"
        startingPos="5 0 0 )" +
         quaternion +
         R"(" xtip="1" step="0.1" speed="20" rotationInstrument="0" controlledInstrument="0"
        threshold="0.001"/>
    <GenericConstraintCorrection/>
    <FixedProjectiveConstraint indices="0"/>
    <RestShapeSpringsForceField points="@controller.indexFirstNode" external_rest_shape="@dofs" external_points="0"
        stiffness="1e8" angularStiffness="1e8"/>)" +
         contact + "</Node>";
}

inline const char* const kContact =
    "<BeamBlobContact name='contact' field='@/vessel/wall' interpolation='@interpolation' "
    "radius='0.2' friction='0.1' "
    "samples='3' alarmDistance='0.5'/>";

inline std::string scene(const std::string& content, const std::string& gravity = "0 0 0") {
  return "<?xml version='1.0'?><Node name='root' dt='0.01' gravity='" + gravity + "'>" + kPlugins +
         content + "</Node>";
}

/// The component of a type at a path below the root, such as "vessel".
template <class Component>
Component* find(const sofa::simulation::Node::SPtr& root, const std::string& node) {
  return root->getChild(node)->get<Component>(sofa::core::objectmodel::BaseContext::Local);
}

}  // namespace lumensofa::test
