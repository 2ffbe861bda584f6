/* What a shared object says of itself before it is opened: whether the file is whole, what it calls
 * and which variables of its own it could keep state in. */
#ifndef GAMUT_ELF_H
#define GAMUT_ELF_H

#include <stdbool.h>
#include <stddef.h>

struct elf_file {
  unsigned char *bytes; /* null where it is none, with the reason in `why` */
  size_t size;
  unsigned owner, mode; /* of the file that was opened */
  const char *why;
};

/* Reads the file as it is. */
bool elf_load(struct elf_file *, const char *path);
/* Whether everything that its headers name lies within it; frees it where not. A truncated file
 * would end the program with SIGBUS once it is opened. */
bool elf_check(struct elf_file *);
/* Both. */
bool elf_read(struct elf_file *, const char *path);
void elf_free(struct elf_file *);
/* Calls `each` with the name of every function or variable that others must give. */
void elf_imports(const struct elf_file *, void (*each)(void *, const char *name), void *self);
/* Calls `each` with the name of every writable variable but the compiler's own; in a stripped file
 * with the name of the section that holds some. */
void elf_variables(const struct elf_file *, void (*each)(void *, const char *name), void *self);

#endif
