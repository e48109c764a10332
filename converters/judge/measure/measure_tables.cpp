// SPDX-License-Identifier: Apache-2.0
#include "converters/judge/measure/measure_tables.h"

#include <limits>
#include <utility>

#include "formats/case/vessel_system.h"

namespace lumen::convert {

namespace {

template <class Row>
struct ValueColumn {
  std::string_view name;  ///< with its unit
  Measured Row::*value;
};

template <class Row>
struct PlaceColumn {
  std::string_view name;
  Place Row::*place;
};

// clang-format off
constexpr ValueColumn<StationMeasures> kStationValues[] = {
    {"along_mm", &StationMeasures::along},
    {"curvature_per_mm", &StationMeasures::curvature},
    {"torsion_per_mm", &StationMeasures::torsion},
    {"inscribed_radius_mm", &StationMeasures::radius},
    {"area_mm2", &StationMeasures::area},
    {"perimeter_mm", &StationMeasures::perimeter},
    {"smallest_diameter_mm", &StationMeasures::leastDiameter},
    {"largest_diameter_mm", &StationMeasures::greatestDiameter},
    {"circularity", &StationMeasures::circularity},
    {"taper_mm_per_mm", &StationMeasures::taper},
};

// of vessels and of paths
constexpr ValueColumn<CourseMeasures> kCourseValues[] = {
    {"length_mm", &CourseMeasures::length},
    {"chord_mm", &CourseMeasures::chord},
    {"tortuosity", &CourseMeasures::tortuosity},
    {"sum_of_angles_rad_per_cm", &CourseMeasures::sumOfAngles},
    {"inflection_count_metric", &CourseMeasures::inflectionCount},
    {"mean_curvature_per_mm", &CourseMeasures::meanCurvature},
    {"greatest_curvature_per_mm", &CourseMeasures::greatestCurvature},
    {"turns_over_90_deg", &CourseMeasures::turns},
    {"turning_deg_per_cm", &CourseMeasures::turning},
    {"smallest_radius_mm", &CourseMeasures::smallestRadius},
    {"mean_radius_mm", &CourseMeasures::meanRadius},
    {"volume_mm3", &CourseMeasures::volume},
    {"wall_area_mm2", &CourseMeasures::wallArea},
};
constexpr PlaceColumn<CourseMeasures> kCoursePlaces[] = {
    {"place", &CourseMeasures::place},
    {"greatest_curvature", &CourseMeasures::greatestCurvaturePlace},
    {"smallest_radius", &CourseMeasures::smallestRadiusPlace},
};

constexpr ValueColumn<VesselMeasures> kVesselValues[] = {
    {"taper_mm_per_mm", &VesselMeasures::taper},
};

constexpr ValueColumn<PathMeasures> kPathValues[] = {
    {"forks", &PathMeasures::forks},
    {"greatest_take_off_deg", &PathMeasures::takeOff},
    {"least_calibre_step", &PathMeasures::calibreStep},
    {"largest_catheter_fr", &PathMeasures::catheter},
};
constexpr PlaceColumn<PathMeasures> kPathPlaces[] = {
    {"greatest_take_off", &PathMeasures::takeOffPlace},
    {"least_calibre_step", &PathMeasures::calibreStepPlace},
};

constexpr ValueColumn<ForkMeasures> kForkValues[] = {
    {"angle_deg", &ForkMeasures::angle},
    {"larger_take_off_deg", &ForkMeasures::takeOffLarger},
    {"smaller_take_off_deg", &ForkMeasures::takeOffSmaller},
    {"larger_in_plane_deg", &ForkMeasures::inPlaneLarger},
    {"smaller_in_plane_deg", &ForkMeasures::inPlaneSmaller},
    {"parent_out_of_plane_deg", &ForkMeasures::outOfPlaneParent},
    {"larger_out_of_plane_deg", &ForkMeasures::outOfPlaneLarger},
    {"smaller_out_of_plane_deg", &ForkMeasures::outOfPlaneSmaller},
    {"larger_calibre_step", &ForkMeasures::calibreLarger},
    {"smaller_calibre_step", &ForkMeasures::calibreSmaller},
    {"area_ratio", &ForkMeasures::areaRatio},
    {"murray_exponent", &ForkMeasures::murrayExponent},
    {"asymmetry", &ForkMeasures::asymmetry},
};

constexpr ValueColumn<NarrowingMeasures> kNarrowingValues[] = {
    {"along_mm", &NarrowingMeasures::along},
    {"length_mm", &NarrowingMeasures::length},
    {"diameter_mm", &NarrowingMeasures::diameter},
    {"healthy_diameter_mm", &NarrowingMeasures::healthyDiameter},
    {"nascet_percent", &NarrowingMeasures::diameterDegree},
    {"area_percent", &NarrowingMeasures::areaDegree},
};

constexpr ValueColumn<SacMeasures> kSacValues[] = {
    {"neck_diameter_mm", &SacMeasures::neckDiameter},
    {"neck_area_mm2", &SacMeasures::neckArea},
    {"height_mm", &SacMeasures::height},
    {"reach_mm", &SacMeasures::reach},
    {"width_mm", &SacMeasures::width},
    {"dome_volume_mm3", &SacMeasures::volume},
    {"dome_area_mm2", &SacMeasures::area},
    {"aspect_ratio", &SacMeasures::aspectRatio},
    {"size_ratio", &SacMeasures::sizeRatio},
    {"bottleneck_factor", &SacMeasures::bottleneckFactor},
    {"undulation_index", &SacMeasures::undulation},
    {"ellipticity_index", &SacMeasures::ellipticity},
    {"non_sphericity_index", &SacMeasures::nonSphericity},
    {"inflow_angle_deg", &SacMeasures::inflowAngle},
};
// clang-format on

template <class Column, std::size_t count>
void addNames(const Column (&columns)[count], std::vector<std::string_view>& names) {
  for (const Column& column : columns) names.push_back(column.name);
}

template <class Row, class Column, std::size_t count>
void addValues(const Row& row, const Column (&columns)[count], MeasureRow& out) {
  for (const Column& column : columns) out.values.push_back(row.*column.value);
}

/// A place that no measure set is none.
template <class Row, class Column, std::size_t count>
void addPlaces(const Row& row, const Column (&columns)[count], MeasureRow& out) {
  for (const Column& column : columns) {
    const Place place = row.*column.place;
    out.places.push_back(place.isZero(0) ? Place::Constant(std::numeric_limits<double>::quiet_NaN())
                                         : place);
  }
}

class Labels {
public:
  explicit Labels(const formats::CenterlineTree& tree) : m_tree(tree) {}
  const std::string& operator[](std::uint32_t branch) const {
    return m_tree.branches[branch].label;
  }

private:
  const formats::CenterlineTree& m_tree;
};

MeasureTable stationTable(const Labels& labels, const CaseMeasures& measures) {
  MeasureTable table{"stations", {"vessel"}, {"place", "tangent"}, {}, {}};
  addNames(kStationValues, table.values);
  for (const StationMeasures& m : measures.stations) {
    MeasureRow& row = table.rows.emplace_back();
    row.labels = {labels[m.branch]};
    row.places = {m.place, m.tangent};
    addValues(m, kStationValues, row);
  }
  return table;
}

MeasureTable vesselTable(const formats::Case& source, const Labels& labels,
                         const CaseMeasures& measures) {
  const std::vector<formats::VesselSystem> systems = formats::knownBranchSystems(source);
  MeasureTable table{"vessels", {"vessel"}, {}, {}, {}};
  addNames(kCoursePlaces, table.places);
  addNames(kCourseValues, table.values);
  addNames(kVesselValues, table.values);
  for (const VesselMeasures& m : measures.vessels) {
    MeasureRow& row = table.rows.emplace_back();
    row.labels = {labels[m.branch]};
    if (!systems.empty())
      row.system = formats::kVesselSystemNames[static_cast<std::size_t>(systems[m.branch])];
    addPlaces(m, kCoursePlaces, row);
    addValues(m, kCourseValues, row);
    addValues(m, kVesselValues, row);
  }
  return table;
}

MeasureTable pathTable(const Labels& labels, const CaseMeasures& measures) {
  MeasureTable table{"paths", {"inlet", "end", "vessels"}, {}, {}, {}};
  addNames(kCoursePlaces, table.places);
  addNames(kPathPlaces, table.places);
  addNames(kCourseValues, table.values);
  addNames(kPathValues, table.values);
  for (const PathMeasures& m : measures.paths) {
    MeasureRow& row = table.rows.emplace_back();
    std::string path;
    for (const std::uint32_t branch : m.branches)
      path += (path.empty() ? "" : " > ") + labels[branch];
    row.labels = {labels[m.inlet], labels[m.end], path};
    addPlaces(m, kCoursePlaces, row);
    addPlaces(m, kPathPlaces, row);
    addValues(m, kCourseValues, row);
    addValues(m, kPathValues, row);
  }
  return table;
}

MeasureTable forkTable(const Labels& labels, const CaseMeasures& measures) {
  MeasureTable table{"forks",
                     {"parent", "larger", "smaller"},
                     {"place", "normal", "parent_vector", "larger_vector", "smaller_vector"},
                     {},
                     {}};
  addNames(kForkValues, table.values);
  for (const ForkMeasures& m : measures.forks) {
    MeasureRow& row = table.rows.emplace_back();
    row.labels = {labels[m.parent], labels[m.larger], labels[m.smaller]};
    row.places = {m.place};
    constexpr PlaceColumn<ForkMeasures> kVectors[] = {
        {"normal", &ForkMeasures::normal},
        {"parent_vector", &ForkMeasures::into},
        {"larger_vector", &ForkMeasures::outLarger},
        {"smaller_vector", &ForkMeasures::outSmaller}};
    addPlaces(m, kVectors, row);
    addValues(m, kForkValues, row);
  }
  return table;
}

MeasureTable narrowingTable(const Labels& labels, const CaseMeasures& measures) {
  MeasureTable table{"narrowings", {"vessel", "finding"}, {"place"}, {}, {}};
  addNames(kNarrowingValues, table.values);
  for (const NarrowingMeasures& m : measures.narrowings) {
    MeasureRow& row = table.rows.emplace_back();
    row.labels = {labels[m.branch], m.isDilation ? "dilation" : "narrowing"};
    row.places = {m.place};
    addValues(m, kNarrowingValues, row);
  }
  return table;
}

MeasureTable sacTable(const Labels& labels, const CaseMeasures& measures) {
  MeasureTable table{"sacs", {"aneurysm", "position"}, {"place", "normal", "tip"}, {}, {}};
  addNames(kSacValues, table.values);
  for (const SacMeasures& m : measures.sacs) {
    MeasureRow& row = table.rows.emplace_back();
    row.labels = {labels[m.branch], std::string(m.position)};
    row.places = {m.place};
    constexpr PlaceColumn<SacMeasures> kPlaces[] = {{"normal", &SacMeasures::neckNormal},
                                                    {"tip", &SacMeasures::tip}};
    addPlaces(m, kPlaces, row);
    addValues(m, kSacValues, row);
  }
  return table;
}

}  // namespace

std::vector<MeasureTable> measureTables(const formats::Case& source, const CaseMeasures& measures) {
  const Labels labels(source.tree);
  std::vector<MeasureTable> tables;
  tables.push_back(stationTable(labels, measures));
  tables.push_back(vesselTable(source, labels, measures));
  tables.push_back(pathTable(labels, measures));
  tables.push_back(forkTable(labels, measures));
  tables.push_back(narrowingTable(labels, measures));
  tables.push_back(sacTable(labels, measures));
  return tables;
}

}  // namespace lumen::convert
