# One version in all places, and cases of older versions.
python_test(Versions.AreOne quick ${PROJECT_SOURCE_DIR}/packages/version.py --check)
python_test(Versions.CasesOfOlderOnesGiveTheirAnswers quick
  ${CMAKE_CURRENT_SOURCE_DIR}/check_old_cases.py $<TARGET_FILE:lumen> $<TARGET_FILE:blob>)
