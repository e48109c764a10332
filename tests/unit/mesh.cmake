find_package(OpenMesh REQUIRED)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(TinyGLTF REQUIRED)
lumen_test(mesh_test
  LABELS threads
  LIBS lumen_repair lumen_surface OpenMeshCore draco::draco meshoptimizer::meshoptimizer TinyGLTF::TinyGLTF
    nlohmann_json::nlohmann_json
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/dicom_surface_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/gltf_skin_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/sofa_scene_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/write_coded_gltf_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/write_gltf_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/write_plain_test.cpp)

# CGAL, which is GPL, is only ever compared with. It is headers alone; its own CMake package would hide
# OpenMesh's from what follows.
lumen_test(self_intersections_test
  LABELS foreign threads
  LIBS lumen_repair gmp mpfr
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/self_intersections_test.cpp)
target_compile_options(self_intersections_test PRIVATE -frounding-math)

# The Khronos validator finds no error and no warning in our files. It needs `npm ci` in tests/gltf; without
# it the test fails.
add_executable(mesh_samples ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/mesh_samples.cpp)
target_link_libraries(mesh_samples PRIVATE lumen_surface nlohmann_json::nlohmann_json)
set(mesh_folder ${CMAKE_CURRENT_BINARY_DIR}/mesh_samples_files)
add_test(NAME MeshSamples.AreWritten COMMAND mesh_samples ${mesh_folder})
set_tests_properties(MeshSamples.AreWritten PROPERTIES LABELS foreign FIXTURES_SETUP mesh_samples)
set(gltf_files)
foreach(sample tree moving fine empty closed confidence lod lod_per_branch)
  foreach(coding plain draco meshopt)
    list(APPEND gltf_files ${mesh_folder}/${sample}_${coding}.glb ${mesh_folder}/${sample}_${coding}.gltf)
  endforeach()
endforeach()
add_test(NAME GltfValidator.FindsNoErrorAndNoWarning
  COMMAND ${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/gltf/validate.mjs ${gltf_files})
set_tests_properties(GltfValidator.FindsNoErrorAndNoWarning PROPERTIES LABELS foreign FIXTURES_REQUIRED mesh_samples)

# three.js and Blender play a motion.
python_test(GltfMotion.VerticesStayOnThePosedWall foreign
  ${CMAKE_CURRENT_SOURCE_DIR}/gltf/check_motion.py $<TARGET_FILE:lumen> $<TARGET_FILE:case_reader> ${NODE}
  ${PROJECT_SOURCE_DIR}/viewer/page/node_modules)

# VTK reads what was written.
python_test(Vtk.ReadsMeshesAsTheyWere foreign
  ${CMAKE_CURRENT_SOURCE_DIR}/vtk/compare_meshes.py ${mesh_folder}/closed ${mesh_folder}/many ${mesh_folder}/empty)
if(TEST Vtk.ReadsMeshesAsTheyWere)
  set_tests_properties(Vtk.ReadsMeshesAsTheyWere PROPERTIES FIXTURES_REQUIRED mesh_samples)
endif()

lumen_test(read_mesh_test
  LABELS memory
  LIBS lumen_repair
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/box_tree_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/mesh_report_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/read_mesh_faults_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/read_mesh_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/triangle_tree_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/read_vtk_frame_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/repair_test.cpp)
