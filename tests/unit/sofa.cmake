lumen_test(sofa_test FOLDER sofa
  LIBS lumen_export)

# Exports for simulators, checked from outside: by SOFA itself where it is, by lists of its components, by a reader of
# our own.
python_test(Sofa.ScenesHaveComponentsAndDataThatExist foreign
  ${CMAKE_CURRENT_SOURCE_DIR}/sofa/check_components.py $<TARGET_FILE:lumen>)
if(HAS_NUMPY)
  python_test(Sofa.RunsScenesAndInstrumentsStayInside foreign
    ${CMAKE_CURRENT_SOURCE_DIR}/sofa/run_exports.py --lumen $<TARGET_FILE:lumen>
    --steps 200 --case bifurcation --wall mesh grid --instrument guidewire coil)
  if(TARGET LumenSofa)
    python_test(Sofa.RunsAVesselThatGivesWay foreign
      ${CMAKE_CURRENT_SOURCE_DIR}/sofa/run_exports.py --lumen $<TARGET_FILE:lumen>
      --steps 200 --case bifurcation --wall soft --instrument guidewire
      --plugin $<TARGET_FILE:LumenSofa>)
    python_test(Sofa.RunsAVesselThatBeats foreign
      ${CMAKE_CURRENT_SOURCE_DIR}/sofa/run_exports.py --lumen $<TARGET_FILE:lumen>
      --steps 800 --case coronary-beating --wall implicit --instrument guidewire
      --plugin $<TARGET_FILE:LumenSofa>)
  endif()
  foreach(test RunsScenesAndInstrumentsStayInside RunsAVesselThatGivesWay RunsAVesselThatBeats)
    if(TEST Sofa.${test})
      set_tests_properties(Sofa.${test} PROPERTIES ENVIRONMENT "PYTHONPATH=${LUMEN_PYTHON_PATH}")
    endif()
  endforeach()
  python_test(Steve.ReadsPathsMeshAndBranches foreign
    ${CMAKE_CURRENT_SOURCE_DIR}/sofa/check_steve.py $<TARGET_FILE:lumen>)
endif()
