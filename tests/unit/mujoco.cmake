lumen_test(mujoco_export_test FOLDER mujoco
  LIBS lumen_export)

# Exports for MuJoCo and CathSim, in the official engine: `npm ci` in tests/mujoco; skipped, saying so, without it.
set(mujoco ${CMAKE_CURRENT_SOURCE_DIR}/mujoco/check_mujoco.py --lumen $<TARGET_FILE:lumen>)
python_test(MuJoCoExport.AGuidewireStaysInTheLumen foreign ${mujoco} --quick)
python_test(MuJoCoExport.GuidewiresStayInTheLumenAndNotInConvexHulls nightly ${mujoco})
foreach(name AGuidewireStaysInTheLumen GuidewiresStayInTheLumenAndNotInConvexHulls)
  if(TEST MuJoCoExport.${name})
    set_tests_properties(MuJoCoExport.${name} PROPERTIES ENVIRONMENT "PYTHONPATH=${LUMEN_PYTHON_PATH}")
  endif()
endforeach()
