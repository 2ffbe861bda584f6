/* gamut-header FILE.yaml: prints NAME.gamut.h. The build runs it before there is a `gamut`. */
#include <stdio.h>

#include "base/error.h"
#include "descriptor/descriptor.h"
#include "unit/unit.h"

int main(int count, char **argument)
{
  static const int exit_code[] = {
#define EXIT_CODE(name, code, text) [name] = code,
      GAMUT_STATUS_LIST(EXIT_CODE)
#undef EXIT_CODE
  };
  if (count != 2) {
    fprintf(stderr, "usage: %s NAME.yaml\n", argument[0]);
    return exit_code[GAMUT_USAGE];
  }
  char why[256] = "";
  gamut_status status = GAMUT_OK;
  struct descriptor *descriptor = NULL;
  struct trace *trace = trace_new();
  struct units *units = units_new(why, sizeof why);
  if (!trace || !units) {
    fprintf(stderr, "%s: %s\n", argument[0], why);
    status = GAMUT_INTERNAL;
    goto done;
  }
  TRY(descriptor_read(argument[1], units, trace, &descriptor));
  descriptor_header(descriptor, stdout);
  if (fflush(stdout) != 0)
    status = trace_fail(trace, GAMUT_OUTPUT, "cannot write the header of '%s'", argument[1]);

done:
  if (trace)
    trace_print(trace, stderr);
  descriptor_free(descriptor);
  units_free(units);
  trace_free(trace);
  return exit_code[status];
}
