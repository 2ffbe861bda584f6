#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include "registry/elf.h"
#include "base/array.h"

#include <elf.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { OBJECT_MAX = 256 << 20 };

typedef ElfW(Ehdr) header;
typedef ElfW(Phdr) segment;
typedef ElfW(Shdr) section;
typedef ElfW(Sym) symbol;

static bool within(const struct elf_file *elf, size_t from, size_t count, size_t size)
{
  return from <= elf->size && (size == 0 || count <= (elf->size - from) / size);
}

static const header *header_of(const struct elf_file *elf)
{
  return (const header *)(const void *)elf->bytes;
}

static const section *section_at(const struct elf_file *elf, size_t index)
{
  const header *h = header_of(elf);
  return index < h->e_shnum
             ? (const section *)(const void *)(elf->bytes + h->e_shoff + index * sizeof(section))
             : NULL;
}

static const char *check_parts(const struct elf_file *elf)
{
  const header *h = header_of(elf);
  const unsigned char class = sizeof(void *) == 8 ? ELFCLASS64 : ELFCLASS32;
  if (elf->size < sizeof *h || memcmp(h->e_ident, ELFMAG, SELFMAG) != 0)
    return "it is no ELF file";
  if (h->e_ident[EI_CLASS] != class || h->e_type != ET_DYN)
    return "it is no shared object of this machine";
  if (h->e_phentsize != sizeof(segment) || !within(elf, h->e_phoff, h->e_phnum, sizeof(segment)) ||
      h->e_phoff % sizeof(void *) != 0)
    return "it is cut off: its segments are not all there";
  const segment *part = (const segment *)(const void *)(elf->bytes + h->e_phoff);
  for (size_t i = 0; i < h->e_phnum; i++)
    if (!within(elf, part[i].p_offset, part[i].p_filesz, 1))
      return "it is cut off: a segment is not all there";
  if (h->e_shnum == 0)
    return NULL;
  if (h->e_shentsize != sizeof(section) || !within(elf, h->e_shoff, h->e_shnum, sizeof(section)) ||
      h->e_shoff % sizeof(void *) != 0)
    return "it is cut off: its table of sections is not all there";
  for (size_t i = 0; i < h->e_shnum; i++) {
    const section *s = section_at(elf, i);
    if (s->sh_type != SHT_NOBITS && !within(elf, s->sh_offset, s->sh_size, 1))
      return "it is cut off: a section is not all there";
  }
  return NULL;
}

bool elf_load(struct elf_file *elf, const char *path)
{
  *elf = (struct elf_file){.why = "it cannot be read"};
  FILE *file = fopen(path, "rbe");
  long size = -1;
  struct stat info;
  if (file && fstat(fileno(file), &info) == 0) {
    elf->owner = info.st_uid;
    elf->mode = info.st_mode;
  }
  if (file && fseek(file, 0, SEEK_END) == 0)
    size = ftell(file);
  if (size >= 0 && size <= OBJECT_MAX && fseek(file, 0, SEEK_SET) == 0) {
    elf->bytes = malloc((size_t)size + sizeof(header));
    elf->size = elf->bytes ? fread(elf->bytes, 1, (size_t)size, file) : 0;
  }
  if (file)
    fclose(file);
  if (elf->bytes && elf->size == (size_t)size)
    elf->why = NULL;
  else
    elf_free(elf);
  return elf->why == NULL;
}

bool elf_check(struct elf_file *elf)
{
  elf->why = check_parts(elf);
  if (elf->why)
    elf_free(elf);
  return elf->why == NULL;
}

bool elf_read(struct elf_file *elf, const char *path)
{
  return elf_load(elf, path) && elf_check(elf);
}

void elf_free(struct elf_file *elf)
{
  free(elf->bytes);
  elf->bytes = NULL;
}

static const char *name_in(const struct elf_file *elf, const section *strings, size_t at)
{
  const char *text = (const char *)elf->bytes + (strings ? strings->sh_offset : 0);
  if (!strings || strings->sh_type != SHT_STRTAB || at >= strings->sh_size ||
      !memchr(text + at, 0, strings->sh_size - at))
    return "";
  return text + at;
}

static const section *section_of_type(const struct elf_file *elf, unsigned type)
{
  for (size_t i = 0; i < header_of(elf)->e_shnum; i++)
    if (section_at(elf, i)->sh_type == type)
      return section_at(elf, i);
  return NULL;
}

static size_t symbols_in(const struct elf_file *elf, const section *table, const symbol **first)
{
  if (!table || table->sh_offset % sizeof(void *) != 0)
    return 0;
  *first = (const symbol *)(const void *)(elf->bytes + table->sh_offset);
  return table->sh_size / sizeof **first;
}

void elf_imports(const struct elf_file *elf, void (*each)(void *, const char *name), void *self)
{
  const symbol *list = NULL;
  const section *table = section_of_type(elf, SHT_DYNSYM);
  size_t count = symbols_in(elf, table, &list);
  for (size_t i = 1; i < count; i++)
    if (list[i].st_shndx == SHN_UNDEF && list[i].st_name != 0)
      each(self, name_in(elf, section_at(elf, table->sh_link), list[i].st_name));
}

static const char *section_name(const struct elf_file *elf, const section *s)
{
  return name_in(elf, section_at(elf, header_of(elf)->e_shstrndx), s->sh_name);
}

/* Sections that stay writable once the object is bound and hold what somebody declared. */
static bool holds_variables(const struct elf_file *elf, const section *s)
{
  static const char *const known[] = {".data", ".bss", ".tdata", ".tbss", ".ldata", ".lbss"};
  const char *name = section_name(elf, s);
  for (size_t i = 0; i < ARRAY_SIZE(known); i++) {
    size_t length = strlen(known[i]);
    if (strncmp(name, known[i], length) == 0 && (name[length] == 0 || name[length] == '.'))
      return strncmp(name, ".data.rel.ro", strlen(".data.rel.ro")) != 0;
  }
  return false;
}

/* Of the compiler's own start and end of a shared object. */
static bool is_compilers(const char *name)
{
  return strncmp(name, "completed.", strlen("completed.")) == 0 || name[0] == 0 ||
         strncmp(name, "__", 2) == 0 || strcmp(name, "_edata") == 0 || strcmp(name, "_end") == 0;
}

void elf_variables(const struct elf_file *elf, void (*each)(void *, const char *name), void *self)
{
  enum { COMPILERS = 8 }; /* bytes in .data and in .bss */
  const symbol *list = NULL;
  const section *table = section_of_type(elf, SHT_SYMTAB);
  size_t count = symbols_in(elf, table, &list);
  for (size_t i = 1; i < count; i++) {
    const section *in = section_at(elf, list[i].st_shndx);
    const char *name = name_in(elf, section_at(elf, table->sh_link), list[i].st_name);
    const int type = ELF64_ST_TYPE(list[i].st_info);
    if (in && (type == STT_OBJECT || type == STT_TLS) && list[i].st_size > 0 &&
        holds_variables(elf, in) && !is_compilers(name))
      each(self, name);
  }
  for (size_t i = 0; count == 0 && i < header_of(elf)->e_shnum; i++)
    if (holds_variables(elf, section_at(elf, i)) && section_at(elf, i)->sh_size > COMPILERS)
      each(self, section_name(elf, section_at(elf, i)));
}
