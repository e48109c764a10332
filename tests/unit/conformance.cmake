# The conformance set of the format, run against our readers, libblob and the reference reader.
set(conformance ${PROJECT_SOURCE_DIR}/spec/conformance)

lumen_test(conformance_test
  LABELS memory
  LIBS lumen_case
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/damage_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/verdict_test.cpp)
target_include_directories(conformance_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(conformance_test PRIVATE LUMEN_CONFORMANCE="${conformance}")

add_executable(case_reader ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/case_reader.cpp)
target_link_libraries(case_reader PRIVATE lumen_case nlohmann_json::nlohmann_json)

add_executable(blob_reader ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/blob_reader.cpp)
target_link_libraries(blob_reader PRIVATE lumen_options lumen::blob nlohmann_json::nlohmann_json)

python_test(Conformance.OfOurReaderHoldsToTheByte quick
  ${conformance}/run.py --exact --reader $<TARGET_FILE:case_reader>)
python_test(Conformance.OfTheReferenceReaderHolds slow
  ${conformance}/run.py --lacks zstd --lacks draco
  --reader "{python} -S -E ${PROJECT_SOURCE_DIR}/spec/reference/lumen_reader.py")
# libblob answers queries, has neither decoder, and computes with floats
set(queries_only ${conformance}/run.py --queries-only --tolerance 1e-5 --lacks zstd --lacks draco)
python_test(Conformance.OfLibblobHolds quick ${queries_only} --reader $<TARGET_FILE:blob_reader>)
python_test(Conformance.OfLibblobInDoublesHolds quick
  ${queries_only} --reader "$<TARGET_FILE:blob_reader> --doubles")
if(TARGET blob_wasm AND NODE)
  python_test(Conformance.OfLibblobInWebAssemblyHolds slow ${queries_only} --lacks motion --reader
    "${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/blob_reader.mjs $<TARGET_PROPERTY:blob_wasm,WASM>")
endif()
python_test(Conformance.FilesAreThoseOfTheirRecipes slow ${conformance}/make.py --check)
