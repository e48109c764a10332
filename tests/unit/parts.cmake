# Parts whose tests are one program, or a few, and need nothing else.
lumen_test(base_test FOLDER base WITHOUT vtk_xml_test.cpp
  LABELS memory
  LIBS lumen_base)
lumen_test(vtk_xml_test
  LABELS memory
  LIBS lumen_vtk_xml
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/base/vtk_xml_test.cpp)
lumen_test(field_test FOLDER field
  LIBS lumen_options lumen_case lumen_field lumen::blob_static
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/tree.cpp)
target_include_directories(field_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob)
lumen_test(voxels_test FOLDER voxels
  LABELS memory
  LIBS lumen_voxels)
lumen_test(labels_test FOLDER labels
  LABELS memory
  LIBS lumen_labels)
lumen_test(seeds_test FOLDER seeds
  LABELS memory
  LIBS lumen_seeds)
target_include_directories(seeds_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/volume)
# gcc 12 sees overlaps in sums of texts that are not there (its bug 105651)
target_compile_options(seeds_test PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
lumen_test(centerline_test FOLDER centerline
  LABELS memory
  LIBS lumen_centerline lumen_vtk_xml)
lumen_test(finding_test FOLDER finding WITHOUT track_courses_test.cpp beside_bone_test.cpp
  LABELS threads
  LIBS lumen_finding)
if(LUMEN_REGISTERS)
  # the thread sanitizer does not see how ITK's library, which is not built with it, hands work to its threads
  lumen_test(native_test FOLDER native
    LABELS slow
    LIBS lumen_native)
endif()
# Finding and tracking together.
lumen_test(whole_tree_test
  LIBS lumen_compare lumen_editing lumen_finding lumen_phantom lumen_tracking
  SLOW WholePatient.HasTheVesselThatAnotherHidesAsOne
       WholePatient.HasAVesselThatIsEnteredWhereItTouchesAsOne
       WholeCircleOfWillis.HasThreeInletsAndThreeCommunicatingArteries
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/finding/track_courses_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/finding/beside_bone_test.cpp)
lumen_test(tracking_test FOLDER tracking
  LABELS threads
  LIBS lumen_fitting lumen_phantom lumen_tracking)
lumen_test(fitting_test FOLDER fitting
  LABELS threads
  LIBS lumen_fitting lumen_reproduce)
lumen_test(image_fitting_test FOLDER image_fitting
  LABELS threads
  LIBS lumen_image_fitting lumen_fitting lumen_tracking lumen_phantom)
lumen_test(motion_stage_test FOLDER motion
  LABELS threads
  LIBS lumen_motion lumen_phantom lumen_tracking lumen_geometry)
lumen_test(editing_test FOLDER editing WITHOUT one_click_test.cpp
  LABELS memory_slow
  LIBS lumen_editing lumen_base lumen_geometry lumen_centerline lumen_fitting lumen_phantom
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/formats/sample_case.cpp)
target_include_directories(editing_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
lumen_test(one_click_test
  LIBS lumen_check lumen_editing lumen_fitting lumen_phantom lumen_tracking
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/editing/one_click_test.cpp)
lumen_test(trees_from_surfaces_test FOLDER trees_from_surfaces
  LABELS memory_slow threads slow
  LIBS lumen_fitting lumen_trees_from_surfaces lumen_surface)
lumen_test(operations_test FOLDER operations
  LABELS threads
  LIBS lumen_operations lumen_phantom)
lumen_test(anatomy_test FOLDER anatomy
  LIBS lumen_anatomy lumen_phantom)
lumen_test(phantom_test FOLDER phantom
  LABELS threads
  LIBS lumen_phantom lumen_geometry)
python_test(Finding.VesselsInDrawnOrgansStayFound nightly
  ${CMAKE_CURRENT_SOURCE_DIR}/evaluation/reproduce/organs.py hold $<TARGET_FILE:lumen>)
python_test(Finding.CirclesOfWillisAreNetworksWithTheirInlets nightly
  ${CMAKE_CURRENT_SOURCE_DIR}/evaluation/reproduce/circles.py hold $<TARGET_FILE:lumen>)
# .ci/nightly makes the environment, where there is a Python that VMTK's wheel runs with.
set(peers ${PROJECT_SOURCE_DIR}/build/peers/bin/python)
if(EXISTS ${peers} AND EXISTS ${PROJECT_SOURCE_DIR}/../shared/data/prior AND NOT LUMEN_SANITIZE)
  add_test(NAME Finding.BesideOtherPrograms COMMAND ${peers} -B
    ${CMAKE_CURRENT_SOURCE_DIR}/evaluation/reproduce/peers.py hold ${PROJECT_SOURCE_DIR}/../shared/data $<TARGET_FILE:lumen>)
  set_tests_properties(Finding.BesideOtherPrograms PROPERTIES LABELS nightly)
endif()
lumen_test(compare_test FOLDER compare
  LABELS threads
  LIBS lumen_compare lumen_geometry
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/evaluation/reproduce/vessel_score.cpp)
target_include_directories(compare_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare)
lumen_test(check_test FOLDER check
  LABELS threads
  LIBS lumen_check lumen_facts lumen_overlay lumen_fitting lumen_phantom lumen_geometry lumen_tracking lumen_geometry)
target_include_directories(check_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
lumen_test(gate_test FOLDER gate
  LIBS lumen_gate)
lumen_test(measure_test FOLDER measure
  LABELS threads
  LIBS lumen_measure lumen_facts lumen_fitting lumen_phantom lumen_geometry)
lumen_test(xray_test FOLDER xray
  LABELS threads
  LIBS lumen_xray lumen_measure lumen_fitting lumen_phantom
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/measure/shapes.cpp)
lumen_test(picture_test FOLDER picture
  LABELS threads
  LIBS lumen_picture lumen::blob_static TBB::tbb)
target_include_directories(picture_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/check)
# Operations within commands, and apart from them.
lumen_test(engine_test FOLDER engine
  LIBS lumen_commands)
# Counts of the programs of tests/evaluation.
if(LUMEN_BUILD_NIGHTLY)
  lumen_test(contact_test FOLDER evaluation
    LIBS lumen_options lumen_contact_count)
endif()
