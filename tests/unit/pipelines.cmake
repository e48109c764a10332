# Cohorts: rows of a list made by several processes, as a data set of BIDS, and by Snakemake on one machine and by Slurm. Scripts
# skip where Slurm cannot be started (slurm-wlm, munge, root), or the validator (npm ci in tests/pipelines) or Snakemake is missing.
set(pipelines ${CMAKE_CURRENT_SOURCE_DIR}/pipelines)
python_test(Pipelines.RowsAreMadeByManyProcesses slow ${pipelines}/check_rows.py $<TARGET_FILE:lumen>)
python_test(Pipelines.BidsDataSetOfOneVolume slow ${pipelines}/check_bids.py $<TARGET_FILE:lumen> --quick)
python_test(Pipelines.BidsDataSetsBecomeDerivativesAndALibrary foreign ${pipelines}/check_bids.py $<TARGET_FILE:lumen>)
python_test(Pipelines.SnakemakeMakesALibrary foreign ${pipelines}/check_snakemake.py $<TARGET_FILE:lumen>)
python_test(Pipelines.SnakemakeMakesALibraryBySlurm foreign ${pipelines}/check_snakemake.py $<TARGET_FILE:lumen> --slurm)
foreach(name BidsDataSetsBecomeDerivativesAndALibrary SnakemakeMakesALibrary SnakemakeMakesALibraryBySlurm)
  if(TEST Pipelines.${name})
    set_tests_properties(Pipelines.${name} PROPERTIES LABELS "foreign;nightly" TIMEOUT 1800)
  endif()
endforeach()
