lumen_test(flow_test
  LIBS lumen_export lumen_base
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/flow_inlets_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/network_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/oned_network_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/openfoam_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/export/run_program_test.cpp)

# Folders for flow solvers, from outside: by the solvers where they are, else by readers of our own.
set(flow ${CMAKE_CURRENT_SOURCE_DIR}/flow)
python_test(Flow.SvZeroDModelsConserveFlow slow ${flow}/check_svzerod.py $<TARGET_FILE:lumen> --solve)
python_test(Flow.SvZeroDSolverConservesFlow nightly
  ${flow}/check_svzerod.py $<TARGET_FILE:lumen> ${PROJECT_SOURCE_DIR}/../shared/solvers ${CMAKE_CURRENT_BINARY_DIR}/svzerod)
python_test(Flow.OpenFoamMeshesAndRuns foreign ${flow}/check_openfoam.py $<TARGET_FILE:lumen>)
python_test(Flow.OneDimensionalInputsAreBalanced slow ${flow}/check_oned.py $<TARGET_FILE:lumen>)
python_test(Flow.SimVascularProjectsOpenInVtk foreign ${flow}/check_simvascular.py $<TARGET_FILE:lumen>)
python_test(Flow.VolumeMeshesPassCheckMesh foreign ${flow}/check_volume_mesh.py $<TARGET_FILE:lumen>)
python_test(Flow.TubeOfPrismsFollowsPoiseuille nightly ${flow}/check_volume_mesh.py $<TARGET_FILE:lumen> --flow)
