/* SPDX-License-Identifier: Apache-2.0
 * make_case FILE: makes a case of two vessels by lumen/case_edit.h, and reads it again.
 * cc make_case.c $(pkg-config --cflags --libs lumen-case) */
/* First, as it must need nothing before it. */
/* clang-format off */
#include "lumen/case_edit.h"
/* clang-format on */

#include <stdio.h>

static int fail(lumen_case_status status, const lumen_case_fault* fault) {
  printf("%s: %s\n", lumen_case_status_text(status), fault->message);
  return 1;
}

int main(int count, char** arguments) {
  const float trunk[4][3] = {{0, 0, 0}, {0, 0, 2}, {0, 0, 4}, {0, 0, 6}};
  const float twig[2][3] = {{1.5f, 0, 5}, {3, 0, 6}};
  const float wide[4] = {2, 2, 1.8f, 1.6f}, thin[2] = {1, 0.8f};
  lumen_case* value = NULL;
  lumen_case_fault fault = {0};
  lumen_case_nodes nodes;
  lumen_case_status status = lumen_case_create(&value);
  if (count != 2 || status != LUMEN_CASE_OK) return 2;
  status = lumen_case_append_branch(value, "trunk", LUMEN_CASE_VESSEL, -1, 4, trunk, wide, &fault);
  if (status == LUMEN_CASE_OK) /* it leaves the third node of the trunk */
    status = lumen_case_append_branch(value, "twig", LUMEN_CASE_VESSEL, 2, 2, twig, thin, &fault);
  if (status == LUMEN_CASE_OK) status = lumen_case_save(value, arguments[1], NULL, &fault);
  lumen_case_close(value);
  if (status == LUMEN_CASE_OK) status = lumen_case_open(arguments[1], &value, &fault);
  if (status != LUMEN_CASE_OK) return fail(status, &fault);
  nodes = lumen_case_get_nodes(value);
  printf("%u branches, %u nodes, the last at x = %g mm\n", (unsigned)lumen_case_branch_count(value),
         (unsigned)nodes.count, nodes.centre[nodes.count - 1][0]);
  lumen_case_close(value);
  return 0;
}
