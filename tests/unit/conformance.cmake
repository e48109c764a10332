# The conformance set of the format, run against our readers, libblob and the reference reader.
set(conformance ${PROJECT_SOURCE_DIR}/spec/conformance)
set(LUMEN_CONFORMANCE_SET ${PROJECT_BINARY_DIR}/spec/conformance)
if(NOT PYTHON)
  message(FATAL_ERROR "python3 not found: it makes the conformance set, which tests read")
endif()
file(GLOB recipes CONFIGURE_DEPENDS ${conformance}/*.py ${conformance}/*.json ${conformance}/*.txt)
add_custom_command(OUTPUT ${LUMEN_CONFORMANCE_SET}/made
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${LUMEN_CONFORMANCE_SET}
  COMMAND ${PYTHON} -B ${conformance}/make.py ${LUMEN_CONFORMANCE_SET}
  COMMAND ${CMAKE_COMMAND} -E touch ${LUMEN_CONFORMANCE_SET}/made
  DEPENDS ${recipes} VERBATIM)
add_custom_target(conformance_set ALL DEPENDS ${LUMEN_CONFORMANCE_SET}/made)

lumen_test(conformance_test
  LABELS memory
  LIBS lumen_case
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/set_test.cpp)
target_include_directories(conformance_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(conformance_test PRIVATE LUMEN_CONFORMANCE="${LUMEN_CONFORMANCE_SET}")
add_dependencies(conformance_test conformance_set)

add_executable(case_reader ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/case_reader.cpp)
target_link_libraries(case_reader PRIVATE lumen_case nlohmann_json::nlohmann_json)

add_executable(blob_reader ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/blob_reader.cpp)
target_link_libraries(blob_reader PRIVATE lumen_options lumen::blob nlohmann_json::nlohmann_json)

set(run_reader ${conformance}/run.py --lines --set ${LUMEN_CONFORMANCE_SET})
python_test(Conformance.OfOurReaderHoldsToTheByte quick ${run_reader} --exact --reader $<TARGET_FILE:case_reader>)
python_test(Conformance.OfTheReferenceReaderHolds quick ${run_reader} --lacks zstd --lacks draco
  --reader "{python} -S -E ${PROJECT_SOURCE_DIR}/spec/reference/lumen_reader.py")
# libblob answers queries, has neither decoder, and computes with floats
set(queries_only ${run_reader} --queries-only --tolerance 1e-5 --lacks zstd --lacks draco)
python_test(Conformance.OfLibblobHolds quick ${queries_only} --reader $<TARGET_FILE:blob_reader>)
python_test(Conformance.OfLibblobInDoublesHolds quick
  ${queries_only} --reader "$<TARGET_FILE:blob_reader> --doubles")
if(TARGET blob_wasm AND NODE)
  python_test(Conformance.OfLibblobInWebAssemblyHolds quick ${queries_only} --lacks motion --reader
    "${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/blob_reader.mjs $<TARGET_PROPERTY:blob_wasm,WASM>")
endif()
python_test(Conformance.FilesHaveTheirDigests quick ${conformance}/make.py --check ${LUMEN_CONFORMANCE_SET})
# that a reader of other people, which is started for each file, is run, too
python_test(Conformance.OfAReaderThatIsStartedForEachFileHolds quick ${conformance}/run.py --set ${LUMEN_CONFORMANCE_SET}
  --only golden --lacks zstd --lacks draco --reader "{python} -S -E ${PROJECT_SOURCE_DIR}/spec/reference/lumen_reader.py")
if(NOT LUMEN_SANITIZE)
  add_test(NAME Conformance.ArchiveOfAReleaseHoldsTheSet COMMAND bash -ec "rm -rf archive && mkdir archive && \
    '${PROJECT_SOURCE_DIR}/packages/conformance/build.sh' archive && cd archive && tar -xzf *.tar.gz && cd lumen-*/ && \
    '${PYTHON}' run.py --set . --lines --exact --reader '$<TARGET_FILE:case_reader>'")
  set_tests_properties(Conformance.ArchiveOfAReleaseHoldsTheSet PROPERTIES LABELS slow)
endif()
