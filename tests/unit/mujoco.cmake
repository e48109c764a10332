lumen_test(mujoco_export_test
  LIBS lumen_export
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mujoco/wall_bodies_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mujoco/wall_pieces_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/mujoco/wire_reach_test.cpp)

# Exports for MuJoCo and CathSim, in the official engine: `npm ci` in tests/mujoco; skipped, saying so, without it.
set(mujoco ${CMAKE_CURRENT_SOURCE_DIR}/mujoco/check_mujoco.py --lumen $<TARGET_FILE:lumen>)
python_test(MuJoCoExport.AGuidewireStaysInTheLumen foreign ${mujoco} --quick)
python_test(MuJoCoExport.GuidewiresStayInTheLumenAndNotInConvexHulls nightly ${mujoco})
foreach(name AGuidewireStaysInTheLumen GuidewiresStayInTheLumenAndNotInConvexHulls)
  if(TEST MuJoCoExport.${name})
    set_tests_properties(MuJoCoExport.${name} PROPERTIES ENVIRONMENT "PYTHONPATH=${LUMEN_PYTHON_PATH}")
  endif()
endforeach()
