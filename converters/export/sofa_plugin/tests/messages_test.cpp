// SPDX-License-Identifier: Apache-2.0
// Messages of SOFA about scenes that cannot run; such scenes stop.
#include <LumenSofa/BlobMotion.h>
#include <LumenSofa/BlobPose.h>
#include <gtest/gtest.h>
#include <sofa/helper/logging/MessageDispatcher.h>
#include <sofa/helper/logging/MessageHandler.h>

#include "scenes.h"

namespace lumensofa::test {
namespace {

using sofa::helper::logging::Message;
using sofa::helper::logging::MessageDispatcher;

struct Errors : sofa::helper::logging::MessageHandler {
  void process(Message& message) override {
    if (message.type() == Message::Error) text += message.messageAsString() + "\n";
  }
  std::string text;
};

struct Messages : sofa::testing::BaseSimulationTest {
  /// Loads a scene and runs some steps, in which the component of a node is invalid. Returns the
  /// errors that were reported.
  template <class Component = BeamBlobContact>
  std::string run(const std::string& content, const std::string& node = "instrument") {
    EXPECT_MSG_EMIT(Error);
    Errors errors;
    MessageDispatcher::addHandler(&errors);
    SceneInstance s("xml", scene(content));
    s.initScene();
    EXPECT_FALSE(s.root->getAnimate());
    for (int i = 0; i < 5; ++i) s.simulate(0.01);
    MessageDispatcher::rmHandler(&errors);
    EXPECT_FALSE(find<Component>(s.root, node)->isComponentStateValid());
    const auto* state = s.root->getChild("instrument")->getMechanicalState();
    for (sofa::Size i = 0; i < state->getSize(); ++i)
      EXPECT_NEAR(state->getPX(i), 5, 1.1) << "nothing has moved";
    return errors.text;
  }
  static std::string withField(const std::string& file, const std::string& attributes = {}) {
    return field(file, attributes) + wire("0 0 0 1", kContact);
  }
};

void expectMessage(const std::string& messages, const std::string& sentence) {
  EXPECT_NE(messages.find(sentence), std::string::npos)
      << "expected: " << sentence << "\ntold: " << messages;
}

TEST_F(Messages, StateWhichCaseIsMissing) {
  expectMessage(run(withField("absent.lumen")), "absent.lumen': there is no such file");
}

TEST_F(Messages, StateThatAFileIsNoCase) {
  expectMessage(run(withField("broken.lumen")), "broken.lumen' is not a case that can be used: ");
}

TEST_F(Messages, StateThatACaseHasNoModels) {
  expectMessage(run(withField("unfitted.lumen")),
                "unfitted.lumen' has no models: 'lumen fit' makes them");
}

TEST_F(Messages, StateWhichBranchesThereAre) {
  expectMessage(run(withField("touching.lumen", "branch='carotid'")),
                "touching.lumen' has no branch 'carotid'; it has b000, b001");
}

TEST_F(Messages, StateWhichDomainsThereAre) {
  expectMessage(run(withField("tube.lumen", "domain='global'")),
                "domain is 'global'; expected blended or local");
}

TEST_F(Messages, StateThatAContactHasNoField) {
  expectMessage(run(wire("0 0 0 1", "<BeamBlobContact radius='0.2'/>")), "no field: ");
}

TEST_F(Messages, StateWhichNumbersAreAllowed) {
  const auto with = [](const std::string& attribute) {
    return field("tube.lumen") +
           wire("0 0 0 1", "<BeamBlobContact field='@/vessel/wall' " + attribute + "/>");
  };
  expectMessage(run(with("samples='0'")), "samples is 0; expected 1 to 64");
  expectMessage(run(with("friction='-1'")), "friction is -1; expected a number from 0");
  expectMessage(run(with("alarmDistance='-0.5'")),
                "alarmDistance is -0.5; expected a number from 0");
  expectMessage(run(with("radius='-0.5'")), "radius is -0.5; expected a number from 0");
}

std::string withPose(const std::string& frames, const std::string& attributes) {
  return "<Node name='vessel'>" + frames + "<BlobField name='wall' filename='" +
         caseFile("tube.lumen") + "'/><BlobPose name='pose' " + attributes + "/></Node>" +
         wire("0 0 0 1", kContact);
}

const char* const kTwoFrames =
    "<MechanicalObject template='Rigid3d' position='0 0 0 0 0 0 1  60 0 0 0 0 0 1'/>";

TEST_F(Messages, StateWhichMotionAVesselHas) {
  const auto runMotion = [this](const std::string& file, const std::string& more) {
    return run<lumensofa::BlobMotion>("<Node name='vessel'>" + std::string(kTwoFrames) +
                                          "<BlobField name='wall' filename='" + caseFile(file) +
                                          "'/>" + more + "</Node>" + wire("0 0 0 1", kContact),
                                      "vessel");
  };
  expectMessage(runMotion("tube.lumen", "<BlobMotion field='@wall'/>"),
                "tube.lumen' has no motion: 'lumen motion' makes one from images");
  expectMessage(runMotion("shifted.lumen", "<BlobMotion/>"), "no field: link a BlobField");
  expectMessage(runMotion("absent.lumen", "<BlobMotion field='@wall'/>"),
                "the field '/vessel/wall' is invalid, see its message");
  expectMessage(runMotion("shifted.lumen",
                          "<BlobPose field='@wall' nodes='0 30'/><BlobMotion field='@wall'/>"),
                "the field '/vessel/wall' is moved by another component; expected one");
}

TEST_F(Messages, StateWhichFramesCarryAVessel) {
  const auto runPose = [this](const std::string& content) {
    return run<lumensofa::BlobPose>(content, "vessel");
  };
  expectMessage(runPose(withPose(kTwoFrames, "field='@wall'")),
                "there are 2 frames; expected one for each of the 31 nodes of the case");
  expectMessage(runPose(withPose(kTwoFrames, "field='@wall' nodes='0 5 30'")),
                "there are 2 frames; expected one for each of the 3 listed nodes");
  expectMessage(runPose(withPose(kTwoFrames, "field='@wall' nodes='0 31'")),
                "nodes has 31; expected different numbers from 0 to 30");
  expectMessage(runPose(withPose(kTwoFrames, "field='@wall' nodes='7 7'")),
                "nodes has 7 twice; expected different numbers from 0 to 30");
  expectMessage(runPose(withPose(kTwoFrames, "field='@wall' nodes='0 30' tolerance='-1'")),
                "tolerance is -1; expected a number from 0");
  expectMessage(runPose(withPose(kTwoFrames, "nodes='0 30'")), "no field: link a BlobField");
  expectMessage(runPose(withPose("", "field='@wall' nodes='0 30'")),
                "no frames: link a MechanicalObject");
}

}  // namespace
}  // namespace lumensofa::test
