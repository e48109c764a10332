// SPDX-License-Identifier: Apache-2.0
// A vessel as a geom of MuJoCo. See libblob/examples/mujoco.
#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tube.h"
#include "vessel.h"

namespace {

using lumen::test::makeTubes;
using lumen::test::Model;

struct DeleteMujoco {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
  void operator()(mjData* d) const { mj_deleteData(d); }
};

/// A ball of 0.3 mm at the middle of the first of two tubes that touch, their axes 2.75 mm apart
/// along y. Lengths are `unit` for a millimetre.
struct TwoTubesScene {
  Model tubes = makeTubes({0, 2.75F});
  double unit;
  std::unique_ptr<mjModel, DeleteMujoco> m;
  std::unique_ptr<mjData, DeleteMujoco> d;

  explicit TwoTubesScene(double unitOfMillimetre,
                         const std::string& shape = "type='sphere' size='0.3'")
      : unit(unitOfMillimetre) {
    const std::string text =
        "<mujoco><option timestep='0.0005' gravity='0 0 0'/><default><geom solref='0.001 "
        "1'/></default>"
        "<worldbody><geom name='vessel' type='box' size='50 50 50'/>"
        "<body pos='10 0 0'><freejoint/><geom " +
        shape + "/></body></worldbody></mujoco>";
    static mjVFS files;
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "scene.xml", static_cast<int>(text.size()));
    std::memcpy(files.filedata[0], text.data(), text.size());
    char error[300] = "";
    m.reset(mj_loadXML("scene.xml", &files, error, sizeof error));
    mj_deleteVFS(&files);
    EXPECT_NE(m, nullptr) << error;
    d.reset(mj_makeData(m.get()));
    EXPECT_TRUE(vessel_attach(m.get(), "vessel", tubes.get(), unit));
  }
  ~TwoTubesScene() { vessel_detach(); }
  TwoTubesScene(const TwoTubesScene&) = delete;
  TwoTubesScene& operator=(const TwoTubesScene&) = delete;

  void run(double seconds) {
    while (d->time < seconds) mj_step(m.get(), d.get());
  }
};

TEST(MujocoVessel, ABallThatOvershootsIntoATouchingVesselComesBack) {
  TwoTubesScene scene(1);
  mj_forward(scene.m.get(), scene.d.get());
  scene.d->qvel[1] = 3000;  // 1.5 mm a step: over the wall and into the other lumen
  double farthest = 0;
  for (int i = 0; i < 2000; ++i) {
    mj_step(scene.m.get(), scene.d.get());
    farthest = std::max(farthest, scene.d->qpos[1]);
  }
  EXPECT_GT(farthest, 1.4);
  EXPECT_LT(scene.d->qpos[1], 1.4 - 0.3 + 0.02);
  EXPECT_LT(vessel_node(1), 41U);
}

TEST(MujocoVessel, TheContactIsOnTheWallWithTheNormalOutwards) {
  TwoTubesScene scene(1);
  scene.d->qpos[1] = -1.2;
  mj_forward(scene.m.get(), scene.d.get());
  ASSERT_EQ(scene.d->ncon, 1);
  const mjContact& contact = scene.d->contact[0];
  EXPECT_NEAR(contact.frame[1], -1, 1e-3);
  // the wall is at about -1.38: 0.12 of the ball's radius of 0.3 lie beyond
  EXPECT_NEAR(contact.dist, -0.12, 0.03);
  EXPECT_NEAR(contact.pos[1], -1.44, 0.02);
}

TEST(MujocoVessel, AMillimetreMayBeTwoUnits) {
  TwoTubesScene scene(2);  // the wall is at 2.8: nothing touches
  scene.d->qpos[0] = 20;
  scene.d->qpos[1] = -1.2;
  mj_forward(scene.m.get(), scene.d.get());
  EXPECT_EQ(scene.d->ncon, 0);
  scene.d->qpos[1] = -2.7;
  mj_forward(scene.m.get(), scene.d.get());
  EXPECT_EQ(scene.d->ncon, 1);
}

TEST(MujocoVessel, ACapsuleAcrossTheTubeTouchesWithBothEnds) {
  TwoTubesScene scene(1, "type='capsule' size='0.3 1.2' euler='90 0 0'");
  mj_forward(scene.m.get(), scene.d.get());
  EXPECT_EQ(scene.d->ncon, 2);
}

TEST(MujocoVessel, AVesselMustBeABoxOfTheModel) {
  TwoTubesScene scene(1);
  EXPECT_FALSE(vessel_attach(scene.m.get(), "absent", scene.tubes.get(), 1));
}

}  // namespace
