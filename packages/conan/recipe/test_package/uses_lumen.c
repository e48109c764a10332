/* SPDX-License-Identifier: Apache-2.0 */
#include <stdio.h>

#include "blob.h"
#include "lumen/case.h"

int main(void) {
  printf("%s, %s\n", lumen_case_version(), blob_status_text(BLOB_OK));
  return 0;
}
