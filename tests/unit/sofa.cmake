lumen_test(sofa_test
  LIBS lumen_export
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/insertion_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/sofa/scene_test.cpp)

# What it exports for simulators, from outside: by SOFA itself where it is, by lists of its components, by a reader of
# our own.
find_program(PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(PYTHON NAMES python3)
if(PYTHON AND NOT LUMEN_SANITIZE)
  add_test(NAME Sofa.ScenesHaveComponentsAndDataThatExist
    COMMAND ${PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/sofa/check_components.py $<TARGET_FILE:lumen>)
  set_tests_properties(Sofa.ScenesHaveComponentsAndDataThatExist PROPERTIES SKIP_RETURN_CODE 77)
  execute_process(COMMAND ${PYTHON} -c "import numpy" RESULT_VARIABLE no_numpy OUTPUT_QUIET ERROR_QUIET)
  if(no_numpy)
    message(STATUS "NumPy (python3-numpy) not found: scenes of SOFA are not run, and stEVE's files not read")
  else()
    add_test(NAME Sofa.RunsScenesAndInstrumentsStayInside
      COMMAND ${PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/sofa/run_exports.py --lumen $<TARGET_FILE:lumen>
        --blob $<TARGET_FILE:blob> --steps 200 --case bifurcation --wall mesh grid --instrument guidewire coil)
    set_tests_properties(Sofa.RunsScenesAndInstrumentsStayInside PROPERTIES SKIP_RETURN_CODE 77)
    add_test(NAME Steve.ReadsPathsMeshAndBranches
      COMMAND ${PYTHON} -B ${CMAKE_CURRENT_SOURCE_DIR}/sofa/check_steve.py $<TARGET_FILE:lumen>)
  endif()
endif()
