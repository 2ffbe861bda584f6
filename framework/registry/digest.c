/* The digest that an installed shared object has beside it, as `sha256sum NAME.so > NAME.so.sha256`
 * writes it: a line of 64 hexadecimal digits, a blank, a blank or '*', and NAME.so. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <nettle/sha2.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "registry/registry_private.h"
#include "tree/load.h"

enum { DIGITS = 2 * SHA256_DIGEST_SIZE, DIGEST_FILE_MAX = 4096 };

/* The digits of a line for this file, in small letters; false where it is no such line. */
static bool stated_in(const char *text, size_t size, const char *name, char *stated)
{
  const size_t length = strlen(name), due = DIGITS + 2 + length;
  if (size < due || size > due + 1 || (size == due + 1 && text[due] != '\n'))
    return false;
  for (size_t i = 0; i < DIGITS; i++) {
    if (!isxdigit((unsigned char)text[i]))
      return false;
    stated[i] = (char)tolower((unsigned char)text[i]);
  }
  stated[DIGITS] = 0;
  return text[DIGITS] == ' ' && (text[DIGITS + 1] == ' ' || text[DIGITS + 1] == '*') &&
         memcmp(text + DIGITS + 2, name, length) == 0;
}

static void digest_of(const void *bytes, size_t size, char *found)
{
  struct sha256_ctx context;
  uint8_t digest[SHA256_DIGEST_SIZE];
  sha256_init(&context);
  sha256_update(&context, size, bytes);
  sha256_digest(&context, sizeof digest, digest);
  for (size_t i = 0; i < sizeof digest; i++)
    snprintf(found + 2 * i, 3, "%02x", digest[i]);
}

bool digest_holds(const char *file, const void *bytes, size_t size, char *why, size_t why_size)
{
  char path[2 * PATH_MAX + 16], fault[256] = "it is no line as sha256sum writes it for this file";
  char stated[DIGITS + 1], found[DIGITS + 1], *text = NULL;
  struct stat about;
  size_t length = 0;
  const char *name = strrchr(file, '/') + 1;
  snprintf(path, sizeof path, "%s.sha256", file);
  if (lstat(path, &about) != 0 && errno == ENOENT)
    return true;
  bool holds = text_load(path, DIGEST_FILE_MAX, &text, &length, fault, sizeof fault) &&
               stated_in(text, length, name, stated);
  free(text);
  if (!holds) {
    snprintf(why, why_size,
             "'%s' holds no digest: %s; install the plugin again, or remove the file where '%s' "
             "is your own",
             path, fault, name);
    return false;
  }
  digest_of(bytes, size, found);
  holds = strcmp(stated, found) == 0;
  if (!holds)
    snprintf(why, why_size,
             "'%s' is not the file that was installed: its SHA-256 is %s, and %s.sha256 beside it "
             "says %s; install it again, or, where it was changed on purpose, write the digest "
             "anew (sha256sum %s > %s.sha256 in its folder)",
             file, found, name, stated, name, name);
  return holds;
}
