# The npm packages, built and installed, in Node and in Chromium.
if(NODE AND NOT LUMEN_SANITIZE)
  foreach(package blob viewer)
    add_test(NAME Packages.Npm.${package} COMMAND ${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/npm/run.mjs ${package})
    set_tests_properties(Packages.Npm.${package} PROPERTIES LABELS foreign SKIP_RETURN_CODE 77 RUN_SERIAL ON TIMEOUT 600
      ENVIRONMENT "LUMEN=$<TARGET_FILE:lumen>;LUMEN_BUILD=${PROJECT_BINARY_DIR};LUMEN_PICTURES=${CMAKE_BINARY_DIR}/people")
  endforeach()
endif()
