/* In place of libFuzzer: reads each file named on the command line once. */
#include <stdio.h>
#include <stdlib.h>

#include "tests/fuzz/fuzz.h"

int main(int count, char **name)
{
  for (int i = 1; i < count; i++) {
    FILE *file = fopen(name[i], "rb");
    uint8_t *data = malloc(1 << 20);
    if (!file || !data) {
      fprintf(stderr, "cannot read '%s'\n", name[i]);
      return 1;
    }
    size_t size = fread(data, 1, 1 << 20, file);
    fclose(file);
    fprintf(stderr, "replay: %s\n", name[i]);
    LLVMFuzzerTestOneInput(data, size);
    free(data);
  }
  fprintf(stderr, "replay: %d files\n", count - 1);
  return 0;
}
