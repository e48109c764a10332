# The pieces of a report, and texts of cases in pages. The case stands before libblob, which brings copies of the numbers of errors.
lumen_test(report_test FOLDER report
  LIBS lumen_report lumen_case lumen::blob_static)

# The page in Chromium, from disk and on paper. Its packages are those of the viewer's page.
if(NODE)
  add_test(NAME ReportPage.FitsOnPaperAndRunsNothing COMMAND ${NODE} ${CMAKE_CURRENT_SOURCE_DIR}/report/run.mjs)
  set_tests_properties(ReportPage.FitsOnPaperAndRunsNothing PROPERTIES
    LABELS foreign SKIP_RETURN_CODE 77 RUN_SERIAL ON TIMEOUT 1800
    ENVIRONMENT "LUMEN=$<TARGET_FILE:lumen>;LUMEN_PICTURES=${CMAKE_BINARY_DIR}/people")
endif()
