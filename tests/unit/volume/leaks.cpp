// SPDX-License-Identifier: Apache-2.0
// Leaks inside ITK's libraries, small and on their error paths, that LeakSanitizer need not report.

extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libITKNrrdIO\n";
}
