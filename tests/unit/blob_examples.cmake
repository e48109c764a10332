# Tests of the outputs of libblob/examples and libblob/wasm; each part where it is built.
lumen_test(blob_examples_test
  LIBS lumen_options catheter_rod
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples/catheter_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples/soft_vessel_test.cpp)
target_include_directories(blob_examples_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples)

# Fitted phantoms for the programs.
set(models ${CMAKE_CURRENT_BINARY_DIR}/blob_examples)
foreach(name kissing bifurcation)
  add_test(NAME BlobExamples.Makes_${name}
    COMMAND ${CMAKE_COMMAND} -D LUMEN=$<TARGET_FILE:lumen> -D NAME=${name} -D FOLDER=${models}
      -P ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples/make_model.cmake)
  set_tests_properties(BlobExamples.Makes_${name} PROPERTIES LABELS slow FIXTURES_SETUP blob_${name})
endforeach()

# The whole rod's surface ends within 0.01 mm of the wall or farther inside.
add_test(NAME Catheter.StaysInABifurcation
  COMMAND catheter ${models}/bifurcation.lumen --steps 500 --young 1e4)
set_tests_properties(Catheter.StaysInABifurcation PROPERTIES LABELS slow
  FIXTURES_REQUIRED blob_bifurcation
  PASS_REGULAR_EXPRESSION "\"deepest_mm\": (-|0\\.00)[0-9.]*,\n.*\"contacts_most\": [1-9]")

# A vessel that gives way: it moves, and holds the rod.
add_test(NAME Catheter.StaysInABifurcationThatGivesWay
  COMMAND catheter ${models}/bifurcation.lumen --steps 500 --young 1e4 --soft 1)
set_tests_properties(Catheter.StaysInABifurcationThatGivesWay PROPERTIES LABELS slow
  FIXTURES_REQUIRED blob_bifurcation
  PASS_REGULAR_EXPRESSION "\"wall\": \"soft\".*\"vessel_moved_mm\": 0\\.(0[1-9]|[1-9]).*\"deepest_ever_mm\": (-|0\\.0)[0-9.]*,\n")

if(TARGET mujoco_vessel)
  lumen_test(mujoco_test
    LABELS foreign
    LIBS lumen_options mujoco_vessel
    SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples/mujoco_test.cpp)
  target_include_directories(mujoco_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples)
  foreach(name kissing bifurcation)
    add_test(NAME MuJoCo.ToolsStayIn_${name} COMMAND tools_in_vessel ${models}/${name}.lumen 1)
    set_tests_properties(MuJoCo.ToolsStayIn_${name} PROPERTIES LABELS foreign FIXTURES_REQUIRED blob_${name})
  endforeach()
endif()

if(TARGET blob_wasm AND NODE)
  get_target_property(wasm blob_wasm WASM)
  add_test(NAME Wasm.WritesNativeAnswers
    COMMAND query_samples ${models}/kissing.lumen 100000 ${models}/kissing.queries)
  set_tests_properties(Wasm.WritesNativeAnswers PROPERTIES LABELS slow
    FIXTURES_REQUIRED blob_kissing FIXTURES_SETUP blob_queries)
  add_test(NAME Wasm.GivesTheBitsOfTheNativeLibrary
    COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/libblob/wasm/compare.mjs ${wasm} ${models}/kissing.lumen
      ${models}/kissing.queries)
  set_tests_properties(Wasm.GivesTheBitsOfTheNativeLibrary PROPERTIES LABELS slow
    FIXTURES_REQUIRED "blob_kissing;blob_queries")
endif()

# query.wgsl in Chromium; a Gaussian case, because that kernel has code of its own.
if(TARGET blob_wasm AND TARGET blob_shader AND NODE AND NOT LUMEN_SANITIZE)
  get_target_property(shader blob_shader SHADER)
  add_test(NAME BlobExamples.Makes_kissing_gaussian
    COMMAND ${CMAKE_COMMAND} -D LUMEN=$<TARGET_FILE:lumen> -D NAME=kissing -D KERNEL=gaussian -D FOLDER=${models}
      -P ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob_examples/make_model.cmake)
  set_tests_properties(BlobExamples.Makes_kissing_gaussian PROPERTIES LABELS slow FIXTURES_SETUP blob_gaussian)
  add_test(NAME BlobDevice.AnswersOnWebGpuAreThoseOfTheLibrary
    COMMAND ${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/unit/blob/device_webgpu.mjs ${PROJECT_SOURCE_DIR}/libblob ${shader} ${wasm}
      ${models}/kissing.lumen ${models}/bifurcation.lumen ${models}/kissing_gaussian.lumen)
  set_tests_properties(BlobDevice.AnswersOnWebGpuAreThoseOfTheLibrary PROPERTIES LABELS foreign SKIP_RETURN_CODE 77 TIMEOUT 600
    FIXTURES_REQUIRED "blob_kissing;blob_bifurcation;blob_gaussian")
endif()
