find_package(OpenMesh REQUIRED)
find_package(draco REQUIRED)
find_package(TinyGLTF REQUIRED)
lumen_test(mesh_test
  LABELS threads
  LIBS lumen_mesh lumen_surface OpenMeshCore draco::draco TinyGLTF::TinyGLTF
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/sofa_scene_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/write_mesh_test.cpp)

# CGAL, which is GPL, is only ever compared with. It is headers alone; its own CMake package would hide
# OpenMesh's from what follows.
lumen_test(self_intersections_test
  LABELS threads
  LIBS lumen_mesh gmp mpfr
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/self_intersections_test.cpp)
target_compile_options(self_intersections_test PRIVATE -frounding-math)

# The Khronos validator finds no error and no warning in our files. It needs `npm ci` in tests/gltf; without
# it the test fails.
add_executable(gltf_samples ${CMAKE_CURRENT_SOURCE_DIR}/unit/mesh/gltf_samples.cpp)
target_link_libraries(gltf_samples PRIVATE lumen_surface)
find_program(NODE_EXECUTABLE NAMES node nodejs)
set(gltf_folder ${CMAKE_CURRENT_BINARY_DIR}/gltf_validator_files)
add_test(NAME GltfValidator.SamplesAreWritten COMMAND gltf_samples ${gltf_folder})
set_tests_properties(GltfValidator.SamplesAreWritten PROPERTIES FIXTURES_SETUP gltf_samples)
add_test(NAME GltfValidator.FindsNoErrorAndNoWarning
  COMMAND ${NODE_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/gltf/validate.mjs
    ${gltf_folder}/tree.glb ${gltf_folder}/tree.gltf ${gltf_folder}/draco.glb ${gltf_folder}/draco.gltf
    ${gltf_folder}/fine.glb ${gltf_folder}/fine_draco.glb ${gltf_folder}/empty.glb)
set_tests_properties(GltfValidator.FindsNoErrorAndNoWarning PROPERTIES FIXTURES_REQUIRED gltf_samples)
