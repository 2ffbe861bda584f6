#define _GNU_SOURCE /* O_CLOEXEC */
#include "tree/load.h"
#include "base/array.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What stands there instead of a file; null for a file. */
static const char *other_kind(mode_t mode)
{
  static const struct {
    mode_t kind;
    const char *words;
  } kinds[] = {{S_IFDIR, "a folder"},
               {S_IFIFO, "a named pipe"},
               {S_IFCHR, "a device"},
               {S_IFBLK, "a device"},
               {S_IFSOCK, "a socket"}};
  for (size_t k = 0; k < ARRAY_SIZE(kinds); k++)
    if ((mode & S_IFMT) == kinds[k].kind)
      return kinds[k].words;
  return S_ISREG(mode) ? NULL : "something else";
}

/* A file may grow, and those of /proc have no size: what counts is what can be read. */
static bool read_all(int descriptor, size_t most, char **text, size_t *size, char *why,
                     size_t why_size)
{
  size_t room = 0;
  *size = 0;
  for (;;) {
    if (*size + 1 >= room) {
      room = room == 0 ? 1 << 16 : 2 * room;
      char *grown = realloc(*text, room);
      if (grown == NULL) {
        snprintf(why, why_size, "no memory left to read it");
        return false;
      }
      *text = grown;
    }
    ssize_t count = read(descriptor, *text + *size, room - *size - 1);
    if (count < 0 && errno == EINTR)
      continue;
    if (count < 0) {
      snprintf(why, why_size, "cannot read the file: %s", strerror(errno));
      return false;
    }
    *size += (size_t)count;
    (*text)[*size] = '\0';
    if (*size > most) {
      snprintf(why, why_size, "the file has more than the %zu bytes that are read", most);
      return false;
    }
    if (count == 0)
      return true;
  }
}

/* Without O_NONBLOCK the opening of a pipe waits for somebody who writes. */
static int open_regular(const char *file, struct stat *about, char *why, size_t why_size)
{
  int descriptor = open(file, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0 || fstat(descriptor, about) != 0) {
    snprintf(why, why_size, "cannot open the file: %s", strerror(errno));
  } else if (other_kind(about->st_mode) != NULL) {
    snprintf(why, why_size, "this is %s, not a file", other_kind(about->st_mode));
    errno = EINVAL;
  } else {
    return descriptor;
  }
  const int fault = errno;
  if (descriptor >= 0)
    close(descriptor);
  errno = fault;
  return -1;
}

bool text_load(const char *file, size_t most, char **text, size_t *size, char *why, size_t why_size)
{
  struct stat about;
  *text = NULL;
  int descriptor = open_regular(file, &about, why, why_size);
  if (descriptor < 0)
    return false;
  bool fine = (unsigned long long)about.st_size <= most;
  if (fine)
    fine = read_all(descriptor, most, text, size, why, why_size);
  else
    snprintf(why, why_size, "the file has %lld bytes; at most %zu are read",
             (long long)about.st_size, most);
  close(descriptor);
  if (!fine) {
    free(*text);
    *text = NULL;
  }
  return fine;
}

FILE *text_open(const char *file)
{
  struct stat about;
  char why[128];
  int descriptor = open_regular(file, &about, why, sizeof why);
  return descriptor < 0 ? NULL : fdopen(descriptor, "r");
}
