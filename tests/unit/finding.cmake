lumen_test(finding_test
  LABELS threads
  LIBS lumen_finding
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/finding/background_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/finding/find_vessels_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/finding/ridges_test.cpp)

# Finding and tracking together.
lumen_test(whole_tree_test
  LIBS lumen_compare lumen_editing lumen_finding lumen_phantom lumen_tracking
  SLOW WholePatient.HasTheVesselThatAnotherHidesAsOne
       WholePatient.HasAVesselThatIsEnteredWhereItTouchesAsOne
       WholeCircleOfWillis.HasThreeInletsAndThreeCommunicatingArteries
  SOURCES ${CMAKE_CURRENT_SOURCE_DIR}/unit/finding/track_courses_test.cpp)
