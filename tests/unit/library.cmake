lumen_test(library_test
  LABELS memory_slow
  LIBS lumen_library
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/build_list_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/build_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/change_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/derived_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/library_file_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/recipe_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/record_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/spdx_test.cpp)

# Whether a library is what it says, by its parts, and from outside with the programs that sign.
lumen_test(library_trust_test
  LABELS memory_slow
  LIBS lumen_library lumen_base
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/bag_check_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/plain_folder_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/remembered_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/signature_key_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/signature_test.cpp)
# gcc 12 sees overlaps in sums of texts that are not there (its bug 105651)
target_compile_options(library_trust_test PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
add_executable(copy_cases EXCLUDE_FROM_ALL ${CMAKE_CURRENT_SOURCE_DIR}/library/copy_cases.cpp)
target_link_libraries(copy_cases PRIVATE lumen_library)

# The pages of a library; in a browser they are tested beside the viewer's (viewer.cmake).
lumen_test(library_site_test
  LIBS lumen_library_site
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/site_test.cpp)

# Libraries made and changed by the program, read by others; `npm ci` in tests/library for the RO-Crate library.
python_test(Library.IsMadeChangedAndReadByOthers foreign ${CMAKE_CURRENT_SOURCE_DIR}/library/check_library.py $<TARGET_FILE:lumen>)
python_test(Library.SurvivesBeingKilledWhileItChanges slow ${CMAKE_CURRENT_SOURCE_DIR}/library/check_kills.py $<TARGET_FILE:lumen>)
python_test(Library.CasesThatNeedAPersonWait slow ${CMAKE_CURRENT_SOURCE_DIR}/library/check_quality.py $<TARGET_FILE:lumen>)
python_test(Library.IsBuiltFromAListWhateverHappens slow ${CMAKE_CURRENT_SOURCE_DIR}/library/check_build.py $<TARGET_FILE:lumen>)
python_test(Library.OfTenSyntheticPatientsIsMadeByOneCommand slow ${CMAKE_CURRENT_SOURCE_DIR}/library/check_sample.py $<TARGET_FILE:lumen>)
python_test(Library.ThatWasTamperedWithIsRefused foreign ${CMAKE_CURRENT_SOURCE_DIR}/library/tamper.py $<TARGET_FILE:lumen>)
python_test(Library.IsCheckedSignedAndVerified foreign ${CMAKE_CURRENT_SOURCE_DIR}/library/check_trust.py $<TARGET_FILE:lumen>)
foreach(name ThatWasTamperedWithIsRefused IsCheckedSignedAndVerified)
  if(TEST Library.${name})
    set_tests_properties(Library.${name} PROPERTIES TIMEOUT 900)
  endif()
endforeach()
