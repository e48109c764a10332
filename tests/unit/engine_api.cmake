# lumen/engine.h: the library from outside, an example in C99, and the names that it exports.
add_executable(nifti_to_glb ${PROJECT_SOURCE_DIR}/packages/examples/nifti_to_glb.c)
target_link_libraries(nifti_to_glb PRIVATE lumen_engine_shared)
set_target_properties(nifti_to_glb PROPERTIES C_STANDARD 99 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF)
lumen_test(engine_api_test FOLDER api
  LIBS lumen_engine_shared lumen_base lumen_editing lumen_phantom lumen_seeds lumen_volume_io)
add_dependencies(engine_api_test nifti_to_glb)
target_compile_definitions(engine_api_test PRIVATE NIFTI_TO_GLB="$<TARGET_FILE:nifti_to_glb>")
if(LUMEN_IO STREQUAL "minimal")
  add_test(NAME EngineApi.MinimalNeedsNoneOfTheRim
    COMMAND sh -ec "needed=$(readelf -d '$<TARGET_FILE:lumen_engine_shared>' | grep NEEDED); test -n \"$needed\"; ! echo \"$needed\" | grep -iE 'itk|gdcm|vdb|curl|httplib|ssl|crypto'")
endif()
add_test(NAME EngineApi.ExportsItsOwnNamesAlone
  COMMAND sh -ec "names=$(nm -D --defined-only '$<TARGET_FILE:lumen_engine_shared>' | awk '{print $NF}'); test -n \"$names\"; ! echo \"$names\" | grep -v '^lumen_engine_'")
