lumen_test(library_test
  LABELS memory_slow
  LIBS lumen_batch lumen_library
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/library/batch_test.cpp
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
set(library ${CMAKE_CURRENT_SOURCE_DIR}/library)
python_test(Library.IsMadeChangedAndReadByOthers foreign ${library}/check_library.py $<TARGET_FILE:lumen> $<TARGET_FILE:batch_lumen>)
python_test(Library.SurvivesAKillWhileItChanges slow ${library}/check_kills.py $<TARGET_FILE:lumen> --kills 5)
python_test(Library.SurvivesBeingKilledWhileItChanges nightly ${library}/check_kills.py $<TARGET_FILE:lumen>)
python_test(Library.ACaseThatNeedsAPersonOpensAtItsWorstPlace slow ${library}/check_quality.py $<TARGET_FILE:lumen> --quick)
python_test(Library.CasesThatNeedAPersonWait nightly ${library}/check_quality.py $<TARGET_FILE:lumen>)
python_test(Library.IsBuiltFromAList slow ${library}/check_build.py $<TARGET_FILE:lumen> --kills 0)
python_test(Library.IsBuiltFromAListWhateverHappens nightly ${library}/check_build.py $<TARGET_FILE:lumen>)
python_test(Library.OfTenSyntheticPatientsIsMadeByOneCommand nightly ${library}/check_sample.py $<TARGET_FILE:lumen>)
python_test(Library.ThatWasTamperedWithIsRefused foreign ${library}/tamper.py $<TARGET_FILE:batch_lumen> --every 7)
python_test(Library.ThatWasTamperedWithInAnyWayIsRefused nightly ${library}/tamper.py $<TARGET_FILE:batch_lumen>)
python_test(Library.IsCheckedSignedAndVerified foreign ${library}/check_trust.py $<TARGET_FILE:lumen> $<TARGET_FILE:batch_lumen>)
python_test(Library.IsSignedWithAPasswordAtATerminal nightly
  ${library}/check_trust.py $<TARGET_FILE:lumen> $<TARGET_FILE:batch_lumen> --passwords)
