# SPDX-License-Identifier: Apache-2.0
# The Debian packages and the release as far as this build shows them; packages/debian/build.sh builds and judges them.
python_test(DebianPackages.HoldEveryInstalledFileOnceAndTheStoredSymbols foreign
  ${CMAKE_CURRENT_SOURCE_DIR}/check_debian.py ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR})
python_test(Release.ListsSignsAndNamesWhatIsMissing foreign ${CMAKE_CURRENT_SOURCE_DIR}/check_release.py)
