# Counts of the programs of tests/evaluation.
if(LUMEN_BUILD_NIGHTLY)
  lumen_test(contact_test
    LIBS lumen_options lumen_contact_count
    SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/evaluation/contact_test.cpp)
endif()
