# The conformance set of the format, run against our readers and against the reference reader.
set(conformance ${PROJECT_SOURCE_DIR}/spec/conformance)

lumen_test(conformance_test
  LABELS memory
  LIBS lumen_case
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/damage_test.cpp)
target_compile_definitions(conformance_test PRIVATE LUMEN_CONFORMANCE="${conformance}")

add_executable(case_reader ${CMAKE_CURRENT_SOURCE_DIR}/unit/conformance/case_reader.cpp)
target_link_libraries(case_reader PRIVATE lumen_case nlohmann_json::nlohmann_json)

find_package(Python3 3.9 COMPONENTS Interpreter)
if(Python3_FOUND)
  add_test(NAME Conformance.OfOurReaderHoldsToTheByte
    COMMAND Python3::Interpreter ${conformance}/run.py --exact --reader $<TARGET_FILE:case_reader>)
  add_test(NAME Conformance.OfTheReferenceReaderHolds
    COMMAND Python3::Interpreter ${conformance}/run.py --lacks zstd --lacks draco
      --reader "{python} -S -E ${PROJECT_SOURCE_DIR}/spec/reference/lumen_reader.py")
  add_test(NAME Conformance.FilesAreThoseOfTheirRecipes
    COMMAND Python3::Interpreter ${conformance}/make.py --check)
endif()
