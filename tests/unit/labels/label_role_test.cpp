// SPDX-License-Identifier: Apache-2.0
// Roles of labels: of every name in the tables that come with the program, and of other names by
// their words.
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "converters/io/labels/known_tables.h"
#include "converters/io/labels/label_meaning.h"

namespace lumen::convert {
namespace {

/// The names of all tables by their roles, as a person gives these.
constexpr const char* kRoles = R"(
vessel: liver_vessels
artery: aorta, brachiocephalic_trunk, subclavian_artery_right, subclavian_artery_left,
  common_carotid_artery_right, common_carotid_artery_left, iliac_artery_left,
  iliac_artery_right, pulmonary_artery, lung_arteries, internal_carotid_artery_right,
  internal_carotid_artery_left, coronary_arteries, celiac_trunk, superior_mesenteric_artery,
  renal_arteries, BA, R-PCA, L-PCA, R-ICA, R-MCA, L-ICA, L-MCA, R-Pcom, L-Pcom, Acom, R-ACA,
  L-ACA, 3rd-A2, R-P1P2, L-P1P2, R-M1, L-M1, R-A1A2, L-A1A2, R-A3, L-A3, 3rd-A3, R-M2, R-M3,
  L-M2, L-M3, R-P3P4, L-P3P4, R-VA, L-VA, R-SCA, L-SCA, R-AICA, L-AICA, R-PICA, L-PICA, R-AChA,
  L-AChA, R-OA, L-OA, R-ECA, L-ECA, R-STA, L-STA, R-MaxA, L-MaxA, R-MMA, L-MMA, Zone 0,
  Innominate, Zone 1, Left Common Carotid, Zone 2, Left Subclavian Artery, Zone 3, Zone 4, Zone
  5, Zone 6, Celiac Artery, Zone 7, SMA, Zone 8, Right Renal Artery, Left Renal Artery, Zone 9,
  Zone 10 R (Right Common Iliac Artery), Zone 10 L (Left Common Iliac Artery), Right Internal
  Iliac Artery, Left Internal Iliac Artery, Zone 11 R (Right External Iliac Artery), Zone 11 L
  (Left External Iliac Artery), aortic vessel tree
vein: pulmonary_vein, brachiocephalic_vein_left, brachiocephalic_vein_right, superior_vena_cava,
  inferior_vena_cava, portal_vein_and_splenic_vein, iliac_vena_left, iliac_vena_right,
  lung_veins, internal_jugular_vein_right, internal_jugular_vein_left, VoG, StS, ICVs, R-BVR,
  L-BVR, SSS
chamber: atrial_appendage_left, heart_atrium_left, heart_ventricle_left, heart_atrium_right,
  heart_ventricle_right
aneurysm: brain_aneurysm
true-lumen: aorta_true_lumen
false-lumen: aorta_false_lumen
bone: sacrum, vertebrae_S1, vertebrae_L5, vertebrae_L4, vertebrae_L3, vertebrae_L2,
  vertebrae_L1, vertebrae_T12, vertebrae_T11, vertebrae_T10, vertebrae_T9, vertebrae_T8,
  vertebrae_T7, vertebrae_T6, vertebrae_T5, vertebrae_T4, vertebrae_T3, vertebrae_T2,
  vertebrae_T1, vertebrae_C7, vertebrae_C6, vertebrae_C5, vertebrae_C4, vertebrae_C3,
  vertebrae_C2, vertebrae_C1, humerus_left, humerus_right, scapula_left, scapula_right,
  clavicula_left, clavicula_right, femur_left, femur_right, hip_left, hip_right, skull,
  rib_left_1, rib_left_2, rib_left_3, rib_left_4, rib_left_5, rib_left_6, rib_left_7,
  rib_left_8, rib_left_9, rib_left_10, rib_left_11, rib_left_12, rib_right_1, rib_right_2,
  rib_right_3, rib_right_4, rib_right_5, rib_right_6, rib_right_7, rib_right_8, rib_right_9,
  rib_right_10, rib_right_11, rib_right_12, sternum, vertebrae, hyoid, zygomatic_arch_right,
  zygomatic_arch_left, styloid_process_right, styloid_process_left
metal: hip_implant
organ: spleen, kidney_right, kidney_left, gallbladder, liver, stomach, pancreas,
  adrenal_gland_right, adrenal_gland_left, lung_upper_lobe_left, lung_lower_lobe_left,
  lung_upper_lobe_right, lung_middle_lobe_right, lung_lower_lobe_right, esophagus, trachea,
  thyroid_gland, small_bowel, duodenum, colon, urinary_bladder, prostate, kidney_cyst_left,
  kidney_cyst_right, heart, spinal_cord, gluteus_maximus_left, gluteus_maximus_right,
  gluteus_medius_left, gluteus_medius_right, gluteus_minimus_left, gluteus_minimus_right,
  autochthon_left, autochthon_right, iliopsoas_left, iliopsoas_right, brain, costal_cartilages,
  heart_myocardium, face, lung_left, lung_right, intervertebral_discs, lung_airways,
  lung_airways_wall, liver_tumor, larynx_air, thyroid_cartilage, cricoid_cartilage, airway
)";

/// Names by roles of a text as above; a line that begins with a space goes on with the one before.
std::map<std::string, std::set<std::string>> namesByRole(std::string text) {
  std::map<std::string, std::set<std::string>> names;
  for (std::size_t at; (at = text.find("\n  ")) != text.npos;) text.replace(at, 3, " ");
  for (std::size_t at = 1; at < text.size();) {
    const std::size_t end = text.find('\n', at), colon = text.find(": ", at);
    std::set<std::string>& ofRole = names[text.substr(at, colon - at)];
    for (std::size_t from = colon + 2; from < end;) {
      const std::size_t to = std::min(text.find(", ", from), end);
      ofRole.insert(text.substr(from, to - from));
      from = to + 2;
    }
    at = end + 1;
  }
  return names;
}

TEST(KnownTables, EveryNameHasTheRoleThatAPersonGivesIt) {
  std::map<std::string, std::set<std::string>> found;
  std::set<std::string> plain;
  for (const KnownTable& table : knownTables())
    for (const auto& [value, label] : table.labels)
      if (plain.insert(plainName(label.name)).second)
        found[roleWord(label.role)].insert(label.name);
  EXPECT_EQ(found, namesByRole(kRoles));
}

TEST(KnownTables, ANameHasOneRoleInAllTables) {
  for (const KnownTable& table : knownTables())
    for (const auto& [value, label] : table.labels)
      EXPECT_EQ(findKnownName(label.name)->role, label.role) << table.title << ": " << label.name;
}

TEST(KnownTables, HaveAllLabelsOfTheirSources) {
  const std::map<std::string, std::size_t> counts = {{"totalsegmentator", 117},
                                                     {"totalsegmentator-v1", 104},
                                                     {"totalsegmentator-mr", 50},
                                                     {"topcow", 13},
                                                     {"topbrain-ct", 40},
                                                     {"topbrain-mr", 42},
                                                     {"aortaseg24", 23},
                                                     {"sega", 1},
                                                     {"imagecas", 1},
                                                     {"parse", 1},
                                                     {"atm22", 1}};
  for (const auto& [word, count] : counts) {
    ASSERT_NE(findKnownTable(word), nullptr) << word;
    EXPECT_EQ(findKnownTable(word)->labels.size(), count) << word;
  }
  EXPECT_EQ(findKnownTable("totalsegmentator")->labels.at(52).name, "aorta");
  EXPECT_EQ(findKnownTable("totalsegmentator-v1")->labels.at(7).name, "aorta");
  EXPECT_EQ(findKnownTable("totalsegmentator")->title, "TotalSegmentator total");
  EXPECT_EQ(findKnownTable("nothing"), nullptr);
}

TEST(LabelRoles, WordsOfANameShowItsRole) {
  const std::map<std::string, LabelRole> roles = {{"Left Renal Artery", LabelRole::Artery},
                                                  {"leftVertebralArtery", LabelRole::Artery},
                                                  {"R_ICA", LabelRole::Artery},
                                                  {"pulmonary trunk", LabelRole::Artery},
                                                  {"body_trunc", LabelRole::Organ},
                                                  {"middle cerebral vein", LabelRole::Vein},
                                                  {"arteries and veins", LabelRole::Vessel},
                                                  {"Left-vessel", LabelRole::Vessel},
                                                  {"lateral ventricle", LabelRole::Organ},
                                                  {"left ventricle", LabelRole::Chamber},
                                                  {"Aneurysm of the ICA", LabelRole::Aneurysm},
                                                  {"aneurysm clip", LabelRole::Metal},
                                                  {"central venous catheter", LabelRole::Metal},
                                                  {"Pacing lead, right atrium", LabelRole::Metal},
                                                  {"ECG electrodes", LabelRole::Metal},
                                                  {"EndotrachealTube", LabelRole::Metal},
                                                  {"carotid calcification", LabelRole::Calcium},
                                                  {"aortic wall", LabelRole::Organ},
                                                  {"vertebral body L1", LabelRole::Bone},
                                                  {"vertebrae_L6", LabelRole::Bone},
                                                  {"true lumen", LabelRole::TrueLumen},
                                                  {"false_lumen_2", LabelRole::FalseLumen},
                                                  {"ROI", LabelRole::Region},
                                                  {"Segment_1", LabelRole::Unknown},
                                                  {"ribbon", LabelRole::Unknown},
                                                  {"", LabelRole::Unknown}};
  for (const auto& [name, role] : roles)
    EXPECT_EQ(roleWord(roleOfName(name)), roleWord(role)) << name;
}

TEST(LabelRoles, AreWords) {
  for (const std::string& word : roleWords()) EXPECT_EQ(roleWord(*roleOfWord(word)), word);
  EXPECT_EQ(roleWords().size(), 13U);
  EXPECT_FALSE(roleOfWord("Artery"));
  EXPECT_EQ(plainName("Left Renal-Artery"), "left_renal_artery");
  EXPECT_EQ(plainName("(leftRenal)"), "left_renal");
}

TEST(LabelMeanings, StateTheirSources) {
  LabelTable table{{{1, "R-P1P2"}, {2, "hepatic vein 7"}, {3, "thing"}, {4, "thing too"}},
                   {{4, LabelRole::Metal}},
                   "dseg.tsv",
                   {}};
  std::vector<LabelMeaning> meanings = meaningsOf(table);
  const auto shown = [&](std::size_t i) {
    return roleWord(meanings[i].role) + " from " + sourcesOf(meanings[i]) +
           (meanings[i].isStated ? "" : "?");
  };
  ASSERT_EQ(meanings.size(), 4U);
  EXPECT_EQ(shown(0), "artery from dseg.tsv, TopBrain CT");
  EXPECT_EQ(shown(1), "vein from dseg.tsv, its name?");
  EXPECT_EQ(shown(2), "unknown from dseg.tsv?");
  EXPECT_EQ(shown(3), "metal from dseg.tsv");
  EXPECT_TRUE(stateRole({"Hepatic-vein 7", LabelRole::Bone}, "the option", meanings));
  EXPECT_TRUE(stateRole({"3", LabelRole::Vessel}, "the option", meanings));
  EXPECT_FALSE(stateRole({"5", LabelRole::Vessel}, "the option", meanings));
  EXPECT_EQ(shown(1), "bone from dseg.tsv, the option");
  EXPECT_EQ(shown(2), "vessel from dseg.tsv, the option");
}

TEST(LabelMeanings, NamesWinOverNumbers) {
  // 7 is the aorta of the first version, and the pancreas of the second
  const std::vector<LabelMeaning> meanings = meaningsOf({{{7, "aorta"}}, {}, "map", {}});
  EXPECT_EQ(meanings.front().role, LabelRole::Artery);
  EXPECT_EQ(sourcesOf(meanings.front()), "map, TotalSegmentator total");
}

TEST(LabelMeanings, LabelsWithoutANameAreAddedAndCounted) {
  Volume volume;
  volume.geometry.size = {2, 2, 2};
  volume.voxels = std::vector<std::uint8_t>{0, 3, 3, 1, 0, 3, 1, 0};
  const std::map<std::int64_t, std::size_t> counts = {{1, 2}, {3, 3}};
  EXPECT_EQ(countLabels(volume), counts);
  std::vector<LabelMeaning> meanings = meaningsOf({{{3, "aorta"}}, {}, "map", {}});
  addUnnamed(counts, meanings);
  ASSERT_EQ(meanings.size(), 2U);
  EXPECT_EQ(meanings[0].value, 1);
  EXPECT_TRUE(meanings[0].name.empty());
  EXPECT_EQ(namesOf(meanings), (LabelNames{{3, "aorta"}}));
  volume.voxels = std::vector<float>{0, 0.5F, 0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(countLabels(volume).empty());
}

}  // namespace
}  // namespace lumen::convert
