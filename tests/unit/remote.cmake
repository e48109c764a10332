lumen_test(remote_test
  LABELS memory
  SLOW RemoteFileTest.ASilentServerIsGivenUp RemoteFileTest.AServerThatFallsSilentIsAskedAgain RemoteFileTest.NobodyListens
  LIBS lumen_remote
  SOURCES
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/remote/remote_address_test.cpp
    ${CMAKE_CURRENT_SOURCE_DIR}/unit/remote/remote_file_test.cpp)
