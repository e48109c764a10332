lumen_test(flow_test
  LIBS lumen_export lumen_base
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/network_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/oned_network_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/run_program_test.cpp)

# Folders for flow solvers, from outside: by the solvers where they are, else by readers of our own.
find_program(PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(PYTHON NAMES python3)
if(PYTHON AND NOT LUMEN_SANITIZE)
  set(flow ${CMAKE_CURRENT_SOURCE_DIR}/flow)
  add_test(NAME Flow.SvZeroDSolverConservesFlow
    COMMAND ${PYTHON} -B ${flow}/check_svzerod.py $<TARGET_FILE:lumen> ${PROJECT_SOURCE_DIR}/../shared/solvers
      ${CMAKE_CURRENT_BINARY_DIR}/svzerod)
  add_test(NAME Flow.OpenFoamMeshesAndRuns
    COMMAND ${PYTHON} -B ${flow}/check_openfoam.py $<TARGET_FILE:lumen>)
  add_test(NAME Flow.OneDimensionalInputsAreBalanced
    COMMAND ${PYTHON} -B ${flow}/check_oned.py $<TARGET_FILE:lumen>)
  add_test(NAME Flow.SimVascularProjectsOpenInVtk
    COMMAND ${PYTHON} -B ${flow}/check_simvascular.py $<TARGET_FILE:lumen>)
  set_tests_properties(Flow.SvZeroDSolverConservesFlow Flow.OpenFoamMeshesAndRuns Flow.OneDimensionalInputsAreBalanced
    Flow.SimVascularProjectsOpenInVtk
    PROPERTIES SKIP_RETURN_CODE 77)
endif()
