# Cohorts: rows of a list made by several processes, by Slurm, as a data set of BIDS, and by Snakemake. Scripts skip where
# Slurm cannot be started (slurm-wlm, munge, root), or the validator (npm ci in tests/pipelines) or Snakemake is missing.
set(pipelines ${CMAKE_CURRENT_SOURCE_DIR}/pipelines)
python_test(Pipelines.RowsAreMadeByManyProcesses slow ${pipelines}/check_rows.py $<TARGET_FILE:lumen>)
set(LUMEN_COHORT_PATIENTS 6 CACHE STRING "Patients of the test of Slurm with killed tasks and a full disk; its proof has 40")
python_test(Pipelines.SlurmMakesEveryRowOnceWhateverHappens foreign ${pipelines}/check_slurm.py $<TARGET_FILE:lumen>
  --patients ${LUMEN_COHORT_PATIENTS})
python_test(Pipelines.BidsDataSetsBecomeDerivativesAndALibrary foreign ${pipelines}/check_bids.py $<TARGET_FILE:lumen>)
python_test(Pipelines.SnakemakeMakesALibraryOnOneMachineAndBySlurm foreign ${pipelines}/check_snakemake.py $<TARGET_FILE:lumen>)
foreach(name RowsAreMadeByManyProcesses SlurmMakesEveryRowOnceWhateverHappens BidsDataSetsBecomeDerivativesAndALibrary
    SnakemakeMakesALibraryOnOneMachineAndBySlurm)
  if(TEST Pipelines.${name})
    set_tests_properties(Pipelines.${name} PROPERTIES TIMEOUT 1800)
  endif()
endforeach()
