/* SPDX-License-Identifier: Apache-2.0 */
/* Seconds of libblob's queries from C, beside which measure.py puts those from Python.
 *
 *   blob_calls CASE POINTS COUNT ROUNDS REPEATS
 *
 * POINTS is a file of COUNT packed points, three doubles each, mm. Prints the seconds of one call of
 * COUNT points, one line for each round, which repeats the call REPEATS times. */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "blob.h"

/* Seconds of processor time: other programs count less than they do in time. */
static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void print_rounds(const blob_model* model, size_t count, const double (*points)[3],
                         blob_sample* samples, uint32_t* cursors, int rounds, int repeats) {
  for (size_t i = 0; i < count; ++i) cursors[i] = blob_cursor_locate(model, points[i]);
  blob_query_many(model, BLOB_BLENDED, count, points, cursors, samples); /* memory is touched */
  for (int round = 0; round < rounds; ++round) {
    const double begin = now();
    for (int i = 0; i < repeats; ++i)
      blob_query_many(model, BLOB_BLENDED, count, points, cursors, samples);
    printf("%.9g\n", (now() - begin) / repeats);
  }
}

int main(int argc, char** argv) {
  blob_model* model = NULL;
  if (argc != 6 || blob_model_open(argv[1], NULL, &model) != BLOB_OK) {
    fprintf(stderr, "usage: blob_calls CASE POINTS COUNT ROUNDS REPEATS\n");
    return 2;
  }
  const size_t count = strtoul(argv[3], NULL, 10);
  double(*points)[3] = calloc(count, sizeof *points);
  blob_sample* samples = calloc(count, sizeof *samples);
  uint32_t* cursors = calloc(count, sizeof *cursors);
  FILE* file = fopen(argv[2], "rb");
  const int is_read =
      points && samples && cursors && file && fread(points, sizeof *points, count, file) == count;
  if (is_read)
    print_rounds(model, count, (const double(*)[3])points, samples, cursors, atoi(argv[4]),
                 atoi(argv[5]));
  if (file) fclose(file);
  free(cursors);
  free(samples);
  free(points);
  blob_model_close(model);
  return is_read ? 0 : 1;
}
